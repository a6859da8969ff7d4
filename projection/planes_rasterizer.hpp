// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "projection/footprint.hpp"
#include "projection/pixel_space.hpp"
#include "projection/prepared_mesh.hpp"
#include "projection/ray_segments.hpp"
#include "projection/surface_crossings.hpp"

namespace tessera::projection {

/// A cell in a tile's list. order_by_depth() sorts lists by near_depth.
struct TileEntry {
  float near_depth;  ///< relative to TileLists::depth_origin(); not greater than the smallest visible depth of the cell
  std::uint32_t tet;
};

/// What a rasterizer needs to know about a frame. `vertices[v]` is the mesh's vertex v.
struct ProjectedMesh {
  const PreparedMesh* mesh;
  std::span<const PixelVertex> vertices;
  double near_depth, far_depth;  ///< the clipping range in planar depth
  double pixels_per_tangent;     ///< as in PixelSpace
  double scalar_origin = 0;      ///< the scalars of segments are relative to this value
  /// For AttributeSegments: the attribute, one value per vertex. It is linear in each cell, for both point and cell
  /// scalars.
  std::span<const double> attribute{};
  /// The frame's iso-surfaces, for SplitRasterizer and rasterize_lattice(); null: none.
  const IsoView* iso = nullptr;
};

/// Statistics of rasterization.
struct RasterCounts {
  std::uint64_t exact_sign_tests = 0;  ///< planes: edge signs decided by exact arithmetic
  /// Scanline: front-face fragments that were lost because the pixel had no back-face fragment.
  std::uint64_t unpaired = 0;
  /// Lattice: segments of irregular cells, which are computed in double precision.
  std::uint64_t irregular_segments = 0;
};

/// The `planes` rasterizer: rasterizes cells to ray segments for the pixels of one rectangle.
///
/// A ray enters a cell through one face and leaves it through another. The signs of the six edge functions
///   E_ab = | (px, py, 1) ; a ; b |
/// determine these faces: a face (a, b, c) is pierced if E_ab, E_bc and E_ca have the same sign. Depth and scalar at
/// the point are means of the corners' values, with weights |E_bc|, |E_ca|, |E_ab|. So set-up needs no divisions,
/// values never leave the face's range, an edge-on face is simply never pierced, and cells that cross the eye plane
/// need no special treatment (the weights are 3D barycentric coordinates in homogeneous space).
///
/// Watertight: vertices are in canonical order (PreparedMesh), so cells that share an edge or a face compute the same
/// bits. Signs are those of exact arithmetic on rounded lines of sight with the tie rule (edge_sign.hpp); a double
/// evaluation is used unless its result is within its error bound. Along any ray, the segments of a mesh cover the
/// ray's path through the mesh without gaps and overlaps.
///
/// The lanes of a vector are candidate pixels of the cell's box, packed row by row, so that small boxes fill the lanes.
///
/// Processes cells from the beginning of `entries` while `out` has room for a whole rectangle more, and appends to
/// `out`. Returns the number of processed cells (all if there is room; at least one if out.capacity() - out.size >=
/// rect.area()). The bits of a segment do not depend on the rectangle. Signs, not depths, select the faces, because a
/// maximum over the depths of planes would need a tie rule at every edge.
std::size_t rasterize_planes(const ProjectedMesh& projected, std::span<const TileEntry> entries,
                             const scene::PixelRect& rect, RaySegments& out, RasterCounts& counts);

/// Does the same as the function above, and stores projected.attribute at both ends of each segment.
std::size_t rasterize_planes(const ProjectedMesh& projected, std::span<const TileEntry> entries,
                             const scene::PixelRect& rect, AttributeSegments& out, RasterCounts& counts);

/// Name of the instruction set that rasterize_planes uses: "AVX3", "AVX2", "SSE4", ...
std::string instruction_set();

}  // namespace tessera::projection
