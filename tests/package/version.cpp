// SPDX-License-Identifier: BSD-3-Clause
// The library's version.
#include <cstdio>
#include <tessera/version.hpp>

int main() { std::puts(tessera::version()); }
