// SPDX-License-Identifier: BSD-3-Clause
// Prints the instruction set that kernels compiled here would choose on this machine, as Highway calls it.
#include <hwy/targets.h>

#include <cstdint>
#include <cstdio>

int main() {
  const std::int64_t sets = hwy::SupportedTargets() & HWY_TARGETS;
  std::printf("%s", hwy::TargetName(sets & -sets));
}
