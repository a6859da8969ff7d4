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

/// The triangles of one surface of a frame. All processes have all of them, in one order.
struct SurfaceFaces {
  const tessera::TriangleMesh* mesh;
  std::uint32_t entering, leaving;           ///< scene::SurfaceSet::face_crossing() where a ray enters, leaves
  std::span<const std::uint8_t> own{};       ///< by triangle: 1 if it is this process's
  std::uint32_t process = 0, processes = 1;  ///< `own` empty: those whose number leaves `process` over
  [[nodiscard]] bool owns(std::size_t triangle) const {
    return own.empty() ? triangle % processes == process : own[triangle] != 0;
  }
};

/// Surfaces of triangles as a view sees them: which tiles each triangle is in, and where rays meet it.
///
/// Signs, not depths, tell whether a ray goes through a triangle: those of the three edges, with the tie rule of
/// edge_sign.hpp, so that triangles which share corners' places leave no gap and no overlap. Depth and value are means
/// of the corners' with the edge functions as weights (planes_rasterizer.hpp). A triangle that shows as a line is met
/// by no ray, nor is one where the eye lies in it.
class FrameFaces {
 public:
  /// All must outlive this object. Work runs in the caller's task arena (oneTBB).
  FrameFaces(std::span<const SurfaceFaces> surfaces, const PixelSpace& space, const TileGrid& grid);

  /// Whether this process has triangles in a tile.
  [[nodiscard]] bool owns_in(std::size_t tile) const { return owned_[tile] != 0; }

  /// The marks of a rectangle that lies in one tile, sorted.
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
  std::vector<std::vector<PixelVertex>> vertices_;  ///< by surface
  std::vector<std::size_t> begin_;                  ///< by tile
  std::vector<Place> places_;
  std::vector<std::uint8_t> owned_;  ///< by tile
};

}  // namespace tessera::projection
