// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "projection/face_marks.hpp"
#include "projection/pixel_space.hpp"
#include "projection/tile_lists.hpp"
#include "tessera/surfaces.hpp"

namespace tessera::projection {

/// The triangles of one surface of a frame. All processes have all triangles, in the same order.
struct SurfaceFaces {
  const tessera::TriangleMesh* mesh;
  std::uint32_t entering, leaving;      ///< scene::SurfaceSet::face_crossing() of rays that enter, or leave
  std::span<const std::uint8_t> own{};  ///< one flag per triangle: 1 if this process owns it
  /// If `own` is empty, process p of all processes has the triangles with triangle % processes == p. One flag per
  /// process: 1 if its triangles belong to this process, or to the team that renders together with this process.
  std::vector<std::uint8_t> here{1};
  [[nodiscard]] bool owns(std::size_t triangle) const {
    return (own.empty() ? here[triangle % here.size()] : own[triangle]) != 0;
  }
};

/// Triangle surfaces in one view: determines the tiles in which each triangle is, and where rays meet it.
///
/// Signs, not depths, determine whether a ray passes through a triangle: the signs of the three edges, with the tie
/// rule of edge_sign.hpp, so that triangles with common corner positions leave no gap and do not overlap. Depth and
/// value are means of the corners' values with the edge functions as weights (planes_rasterizer.hpp). No ray meets a
/// triangle that appears as a line, or one whose plane contains the eye.
class FrameFaces {
 public:
  /// All arguments must outlive this object. Runs in the caller's task arena (oneTBB).
  FrameFaces(std::span<const SurfaceFaces> surfaces, const PixelSpace& space, const TileGrid& grid);

  /// Whether this process has triangles in a tile.
  [[nodiscard]] bool owns_in(std::size_t tile) const { return owned_[tile] != 0; }

  /// Sets `marks` to the sorted marks of a rectangle, which must be within one tile.
  void meet(const scene::PixelRect& rect, FaceMarks& marks) const;

  [[nodiscard]] std::uint64_t bytes() const;

 private:
  struct Place {
    std::uint32_t surface, triangle;
  };
  void meet_triangle(const Place& place, const scene::PixelRect& rect, FaceMarks& marks) const;

  std::span<const SurfaceFaces> surfaces_;
  const PixelSpace* space_;
  TileGrid grid_;
  std::vector<std::vector<PixelVertex>> vertices_;  ///< one list per surface
  std::vector<std::size_t> begin_;                  ///< begin of each tile's triangles in `places_`
  std::vector<Place> places_;
  std::vector<std::uint8_t> owned_;  ///< one flag per tile
};

}  // namespace tessera::projection
