// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/surface_set.hpp"
#include "scene/transfer_function.hpp"
#include "volume/bricks/cell_ranges.hpp"

namespace tessera::volume {

/// The iso-surfaces of a frame of a grid with point data, and the cells of 8^3 voxels that contain them.
class GridSurfaces {
 public:
  /// Makes an object without surfaces.
  GridSurfaces() = default;
  /// The surfaces must be valid. Without the ranges of a grid, any cell may contain surfaces.
  GridSurfaces(const Surfaces& surfaces, const scene::TransferFunction& function)
      : set_(surfaces, function), any_(!set_.empty()) {}
  /// Finds the cells that contain surfaces, for a grid whose cells have these ranges.
  GridSurfaces(const Surfaces& surfaces, const scene::TransferFunction& function, const CellRanges& ranges);

  [[nodiscard]] const scene::SurfaceSet& set() const { return set_; }
  /// One byte per cell (cell_ranges.hpp): 1 where the field may cross a surface's value. If empty, any cell may contain
  /// surfaces.
  [[nodiscard]] std::span<const std::uint8_t> holding() const { return holding_; }
  /// Whether any cell may contain surfaces.
  [[nodiscard]] bool any() const { return any_; }

 private:
  scene::SurfaceSet set_;
  std::vector<std::uint8_t> holding_;
  bool any_ = false;
};

}  // namespace tessera::volume
