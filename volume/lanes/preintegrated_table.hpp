// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "integrals/lane_table.hpp"

namespace tessera::volume {

/// Optical depth and light of one step of a ray, indexed by the scalars at the ends of the step; the field is linear in
/// between.
///
/// Grid      There are size x size entries, one row per front scalar. Scalars are lane scalars, from `low` in steps of
///           1 / scale.
/// Channels  0: optical depth; 1 to 3: red, green and blue that leave the step's front. Each entry is the exact
///           integral.
struct PreintegratedTable {
  static constexpr int least_size = 512, most_size = 2048;

  /// `step` is in the table's length unit. The range of the field, low_scalar < high_scalar, must not be empty.
  PreintegratedTable(const integrals::LaneTable& function, float low_scalar, float high_scalar, float step, int size_);

  /// Returns the number of entries per side with which the closest knots are sixteen entries apart, at most
  /// `most_size`. The table is bilinear between entries, and therefore cuts off peaks between them.
  static int size_for(const integrals::LaneTable& function, float low_scalar, float high_scalar);

  [[nodiscard]] const float* channel(int c) const {
    return entries.data() +
           static_cast<std::size_t>(c) * static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  }

  int size;
  float low, scale;
  std::vector<float> entries;
};

}  // namespace tessera::volume
