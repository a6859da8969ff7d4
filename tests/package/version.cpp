// The library's version.
#include <cstdio>
#include <tessera/version.hpp>

int main() { std::puts(tessera::version()); }
