// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <hwy/targets.h>

#include <cstdint>

namespace tessera::tests {

/// Highway's fallbacks for processors of which it knows no better: plain loops.
inline constexpr std::int64_t emulated_targets = HWY_EMU128 | HWY_SCALAR;

/// Calls `check(name)` once on each of `targets` that this build has, and restores the choice after.
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

/// Calls `check(name)` once on every instruction set that this machine and this build have: SSE4, AVX2 and AVX-512, in
/// sanitized builds too (the root's CMakeLists.txt; under ThreadSanitizer AVX2 alone).
template <class Check>
void for_each_instruction_set(Check check) {
  for_each_target(hwy::SupportedTargets() & ~emulated_targets, check);
}

}  // namespace tessera::tests
