// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "integrals/integrate_lanes.hpp"

namespace tessera::tests {

/// integrate_lanes-inl.h inlined in a loop of our own: every other segment first, then those between, each time with
/// the rest masked off and holding NaN. Adds what comes out to the batch's outputs, so lanes that are not active must
/// give zeros.
void integrate_masked_lanes(const integrals::LaneTable& table, integrals::FloatBatch& batch);

}  // namespace tessera::tests
