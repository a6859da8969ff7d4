// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "integrals/integrate_lanes.hpp"

namespace tessera::tests {

/// integrate_lanes-inl.h inlined in a separate loop: first every second segment, then those between, each time with the
/// rest masked off and set to NaN. Adds the results to the batch's outputs, so inactive lanes must return zeros.
void integrate_masked_lanes(const integrals::LaneTable& table, integrals::FloatBatch& batch);

}  // namespace tessera::tests
