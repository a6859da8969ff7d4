// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace tessera::integrals {

/// A batch of ray segments for an integrator, together with the resulting light; one array per quantity.
///
/// Arrays have `padding` more elements than `size`, so that the last vector of lanes may read and write past the end.
struct SegmentBatch {
  static constexpr std::size_t padding = 16;
  static constexpr std::size_t bytes_each = 8 * sizeof(double);

  std::size_t size = 0;
  // Input. Lengths are in world units along the ray. Scalars are those at entry and exit; they are linear in between.
  std::vector<double> length, scalar_front, scalar_back;
  // Output. Light that leaves the front of the segment, linear RGB; optical depth int kappa dt; transmittance
  // exp(-optical depth).
  std::vector<double> red, green, blue, optical_depth, transmittance;

  void reserve(std::size_t capacity) {
    for (auto* a : {&length, &scalar_front, &scalar_back, &red, &green, &blue, &optical_depth, &transmittance})
      if (a->size() < capacity + padding) a->resize(capacity + padding, 0.0);
  }
};

}  // namespace tessera::integrals
