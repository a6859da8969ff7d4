// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "projection/clear_intervals.hpp"
#include "projection/pixel_space.hpp"
#include "scene/tet_mesh.hpp"

/// The kernel of culling, 64 cells at a time on SIMD lanes: which cells are seen, in which tiles and how deep.
///
/// It works on float copies of the vertices, 16 bytes each, so that the box of a cell in pixels, depth and scalar is
/// four loads and six 128-bit instructions. What floats cannot decide with certainty (a box that ends within rounding
/// of a pixel centre, one cell in 500 of a picture of 1024 pixels; cells at the near plane, at the window's edge, at a
/// knot) is left to the caller as unsure, who asks the doubles. So the outcome is that of double precision, cell by
/// cell.
namespace tessera::projection {

/// A vertex as culling sees it.
struct CullVertex {
  float x, y;    ///< pixels; meaningless where w <= 0
  float depth;   ///< behind the depth origin, never above the exact one
  float scalar;  ///< rounded to nearest; 0 for cell data
};
static_assert(sizeof(CullVertex) == 16);

/// The smallest depth of any vertex; the largest double if there are none.
double smallest_depth(std::span<const PixelVertex> vertices);

/// Vertex v from vertices[v] and scalars[v]; `scalars` is empty for cell data.
void make_cull_vertices(std::span<const PixelVertex> vertices, std::span<const double> scalars, double depth_origin,
                        CullVertex* out);

/// Bounds of a clear interval as floats: a cell whose scalars, rounded to float, lie in [sure_low, sure_high] is
/// invisible; one whose scalars do not lie in [maybe_low, maybe_high] is not hidden by this interval.
struct ClearFloats {
  float sure_low, sure_high, maybe_low, maybe_high;
};

/// `exact`: scalars are floats already, so that both bounds agree and nothing is unsure.
ClearFloats clear_floats(const ClearIntervals::Interval& interval, bool exact);

/// A frame as the kernel wants it.
struct CullView {
  CullView(double near_depth, double far_depth, double depth_origin, scene::ImageSize image, int tile_size);

  bool
      nothing_sure;  ///< depths beyond what floats hold, or no numbers left for places: ask the doubles about all cells
  float near_low, near_high, far_low, far_high;  ///< around near and far depth, relative to the origin
  float depth_slack;                             ///< how much farther than CullVertex::depth at depth 0 a vertex may be
  float width, height;
  float inverse_tile_size, columns;
};

/// Tiles that a cell's box meets, in 32 bits: the upper left one's number in bits 0..23, how many columns and rows the
/// box has beyond that tile's in bits 24..27 and 28..31 (0 to 14). Larger boxes, and those of cells that cross the eye
/// plane, are `wide_place`: ask footprint().
constexpr std::uint32_t wide_place = 0xff000000u;
constexpr int largest_place_span = 14;
constexpr std::size_t most_places = std::size_t{1} << 24;

/// What became of 64 cells, a bit each: at most one of the first five.
struct CulledBlock {
  std::uint64_t projected = 0, invisible = 0, outside_view = 0, between_pixels = 0;
  std::uint64_t unsure = 0;
  std::uint64_t in_one_tile = 0;  ///< projected, and the box meets one tile alone: the place is its number
};

constexpr std::size_t cull_block_cells = 64;

/// At most 64 neighbouring cells of a mesh.
struct CellBlock {
  const CullVertex* vertices;  ///< all of the mesh
  std::span<const scene::Tet> tets;
  const double* cell_scalars;          ///< theirs; null for point data
  std::span<const ClearFloats> clear;  ///< the clear intervals that have values in common with these cells' scalars
};

/// Culls a block. Writes the places and near depths of projected cells; both arrays have room for 64.
CulledBlock cull_cells(const CullView& view, const CellBlock& block, std::uint32_t* places, float* near_depths);

}  // namespace tessera::projection
