// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <hwy/targets.h>

#include <cstdint>

namespace tessera::tests {

/// Highway's fallbacks for processors that it does not support: plain loops.
inline constexpr std::int64_t emulated_targets = HWY_EMU128 | HWY_SCALAR;

/// Calls `check(name)` once for each of `targets` in this build, and then restores the choice.
template <class Check>
void for_each_target(std::int64_t targets, Check check) {
  for (std::int64_t left = targets & HWY_TARGETS, target = 0; left != 0; left &= ~target) {
    target = left & -left;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    check(hwy::TargetName(target));
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

/// Calls `check(name)` once for every instruction set of this machine and this build: SSE4, AVX2 and AVX-512, also in
/// sanitizer builds (the root's CMakeLists.txt; under ThreadSanitizer only AVX2).
template <class Check>
void for_each_instruction_set(Check check) {
  for_each_target(hwy::SupportedTargets() & ~emulated_targets, check);
}

}  // namespace tessera::tests
