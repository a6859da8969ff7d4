#pragma once

#include <hwy/targets.h>

#include <cstdint>

namespace tessera::tests {

/// Calls `check(name)` once on every instruction set that this machine and this build have, and restores the choice
/// after.
template <class Check>
void for_each_instruction_set(Check check) {
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS, target = 0; left != 0; left &= ~target) {
    target = left & -left;
    // Scalar emulation is the build's fallback for processors that are not met any more; it is slow and not dispatched
    // to here.
    if (target == HWY_EMU128 || target == HWY_SCALAR) continue;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    check(hwy::TargetName(target));
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace tessera::tests
