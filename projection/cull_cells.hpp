// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "projection/clear_intervals.hpp"
#include "projection/pixel_space.hpp"
#include "scene/tet_mesh.hpp"

/// The kernel of culling. It determines which cells are visible, in which tiles they are, and at which depth; 64 cells
/// at a time, on SIMD lanes.
///
/// The kernel uses float copies of the vertices, 16 bytes each, so that the box of a cell in pixels, depth and scalar
/// takes four loads and six 128-bit instructions. Cells for which floats do not give a certain result are returned as
/// `unsure`, and the caller examines them in double precision: cells whose box ends within rounding of a pixel centre
/// (one cell in 500 of an image of 1024 pixels), cells at the near plane, at the window's edge, or at a knot. So the
/// result is that of double precision for every cell.
namespace tessera::projection {

/// A vertex for culling.
struct CullVertex {
  float x, y;    ///< pixels; undefined if w <= 0
  float depth;   ///< relative to the depth origin, never greater than the exact depth
  float scalar;  ///< rounded to nearest; 0 for cell data
};
static_assert(sizeof(CullVertex) == 16);

/// Returns the smallest depth of any vertex; the largest double if there are no vertices.
double smallest_depth(std::span<const PixelVertex> vertices);

/// Sets out[v] from vertices[v] and scalars[v] for every vertex v; `scalars` is empty for cell data.
void make_cull_vertices(std::span<const PixelVertex> vertices, std::span<const double> scalars, double depth_origin,
                        CullVertex* out);

/// Bounds of a clear interval as floats. A cell whose scalars, rounded to float, are all in [sure_low, sure_high] is
/// invisible. A cell whose scalars are not all in [maybe_low, maybe_high] is not made invisible by this interval.
struct ClearFloats {
  float sure_low, sure_high, maybe_low, maybe_high;
};

/// `exact`: scalars are representable as float; both pairs of bounds are then equal, so that no cell is unsure.
ClearFloats clear_floats(const ClearIntervals::Interval& interval, bool exact);

/// What the kernel needs to know about a frame.
struct CullView {
  CullView(double near_depth, double far_depth, double depth_origin, scene::ImageSize image, int tile_size);

  /// All cells are unsure: depths exceed the range of float, or there are too many tiles for places.
  bool nothing_sure;
  float near_low, near_high, far_low, far_high;  ///< bounds of near and far depth, relative to the origin
  float depth_slack;                             ///< upper bound of the exact depth where CullVertex::depth is 0
  float width, height;
  float inverse_tile_size, columns;
};

/// Encodes the tiles that a cell's box intersects in 32 bits: the number of the upper left tile in bits 0..23, and the
/// number of further columns and rows in bits 24..27 and 28..31 (0 to 14 each). Larger boxes, and those of cells that
/// cross the eye plane, are encoded as `wide_place`; footprint() then computes the box.
constexpr std::uint32_t wide_place = 0xff000000u;
constexpr int largest_place_span = 14;
constexpr std::size_t most_places = std::size_t{1} << 24;

/// The results for 64 cells, one bit each. At most one of the first five bits of a cell is set.
struct CulledBlock {
  std::uint64_t projected = 0, invisible = 0, outside_view = 0, between_pixels = 0;
  std::uint64_t unsure = 0;
  std::uint64_t in_one_tile = 0;  ///< the cell is projected, and its box is in a single tile, whose number is the place
};

constexpr std::size_t cull_block_cells = 64;

/// At most 64 consecutive cells of a mesh.
struct CellBlock {
  const CullVertex* vertices;  ///< all vertices of the mesh
  std::span<const scene::Tet> tets;
  const double* cell_scalars;          ///< one per cell; null for point data
  std::span<const ClearFloats> clear;  ///< those clear intervals that intersect the range of these cells' scalars
};

/// Culls a block. Writes the places and near depths of projected cells; both arrays must have room for 64 values.
CulledBlock cull_cells(const CullView& view, const CellBlock& block, std::uint32_t* places, float* near_depths);

}  // namespace tessera::projection
