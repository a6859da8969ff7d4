// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "integrals/lane_table.hpp"

namespace tessera::integrals {

/// A batch of ray segments for the float integrator, together with the resulting light; one array per quantity.
///
/// Arrays have `padding` more elements than `size`, so that the last vector of lanes may read and write past the end.
struct FloatBatch {
  static constexpr std::size_t padding = 64;

  std::size_t size = 0;
  // Input. Lengths are >= 0, in the table's length unit. Scalars at entry and exit are results of lane_scalar(). All
  // values must be finite.
  std::vector<float> length, scalar_front, scalar_back;
  // Output. Light that leaves the front of the segment, linear RGB; alpha = 1 - exp(-optical_depth).
  std::vector<float> red, green, blue, alpha, optical_depth;

  void reserve(std::size_t capacity) {
    for (auto* a : {&length, &scalar_front, &scalar_back, &red, &green, &blue, &alpha, &optical_depth})
      if (a->size() < capacity + padding) a->resize(capacity + padding, 0.0f);
  }
};

/// Integrates a batch by the `exact` integrator in float lanes; integrate_lanes-inl.h describes the method and its
/// accuracy. The bits of a segment's result depend only on the segment, and equal those of the same code inlined
/// elsewhere on the same instruction set.
void integrate_lanes(const LaneTable& table, FloatBatch& batch);

/// Returns how the running instruction set stores the table, for reports: "one vector", "two vectors" or "many".
const char* lane_table_form(const LaneTable& table);

}  // namespace tessera::integrals
