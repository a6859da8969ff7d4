// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "integrals/lane_table.hpp"

namespace tessera::volume {

/// Optical depth and light of one step of a ray by the scalars at its ends, the field being linear between them.
///
/// Grid      size x size entries, the front's scalar by row, from `low` on, 1 / scale apart, in lane scalars.
/// Channels  0 optical depth; 1 to 3 red, green, blue that leave the step's front. Each entry is the exact integral.
struct PreintegratedTable {
  static constexpr int least_size = 512, most_size = 2048;

  /// `step` in the table's length unit. low < high, the field's range.
  PreintegratedTable(const integrals::LaneTable& function, float low_scalar, float high_scalar, float step, int size_);

  /// Entries a side at which the closest knots are sixteen entries apart, so far as `most_size` goes: between entries
  /// the table is bilinear, and cuts peaks that lie between them.
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
