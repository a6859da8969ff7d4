// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/surface_set.hpp"
#include "scene/transfer_function.hpp"
#include "volume/bricks/cell_ranges.hpp"

namespace tessera::volume {

/// The iso-surfaces of a frame of a grid with point data, and which cells of 8^3 voxels hold some of them.
class GridSurfaces {
 public:
  /// None.
  GridSurfaces() = default;
  /// Of valid surfaces. Of no grid in particular: any cell may hold them.
  GridSurfaces(const Surfaces& surfaces, const scene::TransferFunction& function)
      : set_(surfaces, function), any_(!set_.empty()) {}
  /// Of a grid with these ranges.
  GridSurfaces(const Surfaces& surfaces, const scene::TransferFunction& function, const CellRanges& ranges);

  [[nodiscard]] const scene::SurfaceSet& set() const { return set_; }
  /// One byte a cell (cell_ranges.hpp): 1 where the field may go from below a surface's value to it. Empty: any may.
  [[nodiscard]] std::span<const std::uint8_t> holding() const { return holding_; }
  /// Whether any cell does.
  [[nodiscard]] bool any() const { return any_; }

 private:
  scene::SurfaceSet set_;
  std::vector<std::uint8_t> holding_;
  bool any_ = false;
};

}  // namespace tessera::volume
