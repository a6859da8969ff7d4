// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "integrals/lane_table.hpp"

namespace tessera::integrals {

/// Ray segments for the float integrator and the light that comes out, one array a quantity.
///
/// Arrays hold `padding` elements more than `size`, so that the last vector of lanes may read and write past it.
struct FloatBatch {
  static constexpr std::size_t padding = 64;

  std::size_t size = 0;
  // In. Lengths >= 0 in the table's length unit; scalars at entry and exit as lane_scalar() gives them. All finite.
  std::vector<float> length, scalar_front, scalar_back;
  // Out. Light that leaves the segment's front, linear RGB; alpha = 1 - exp(-optical_depth).
  std::vector<float> red, green, blue, alpha, optical_depth;

  void reserve(std::size_t capacity) {
    for (auto* a : {&length, &scalar_front, &scalar_back, &red, &green, &blue, &alpha, &optical_depth})
      if (a->size() < capacity + padding) a->resize(capacity + padding, 0.0f);
  }
};

/// `exact` in float lanes (integrate_lanes-inl.h says what and how well) over a batch. A segment's bits depend on that
/// segment alone, and are those of the same code inlined elsewhere on the same instruction set.
void integrate_lanes(const LaneTable& table, FloatBatch& batch);

/// How the table is held on the instruction set that runs: "one vector", "two vectors" or "many". For reports.
const char* lane_table_form(const LaneTable& table);

}  // namespace tessera::integrals
