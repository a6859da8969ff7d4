// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace tessera::integrals {

/// Ray segments on their way through an integrator: what goes in and the light that comes out, one array a quantity.
///
/// Arrays hold `padding` elements more than `size`, so that the last vector of lanes may read and write past it.
struct SegmentBatch {
  static constexpr std::size_t padding = 16;
  static constexpr std::size_t bytes_each = 8 * sizeof(double);

  std::size_t size = 0;
  // In. Length in world units along the ray; scalars at entry and exit, linear in between.
  std::vector<double> length, scalar_front, scalar_back;
  // Out. Light that leaves the segment's front, linear RGB; optical depth int kappa dt, and transmittance exp(-optical
  // depth).
  std::vector<double> red, green, blue, optical_depth, transmittance;

  void reserve(std::size_t capacity) {
    for (auto* a : {&length, &scalar_front, &scalar_back, &red, &green, &blue, &optical_depth, &transmittance})
      if (a->size() < capacity + padding) a->resize(capacity + padding, 0.0);
  }
};

}  // namespace tessera::integrals
