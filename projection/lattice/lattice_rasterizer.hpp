// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "projection/depth_limits.hpp"
#include "projection/lattice/lattice_faces.hpp"
#include "projection/lattice/segment_windows.hpp"
#include "projection/matter_light.hpp"
#include "projection/pixel_space.hpp"
#include "projection/planes_rasterizer.hpp"
#include "projection/ray_segments.hpp"
#include "projection/steps.hpp"
#include "scene/lattice.hpp"

namespace tessera::projection {

/// A vertex prepared for set-up, in half a cache line. Values that cells share are divided and rounded only once.
struct LatticeVertex {
  double x, y;       ///< pixel position
  double inverse_w;  ///< perspective: 1 / depth, or 0 for a vertex that is not in front of the eye; orthographic: 1
  std::int32_t depth, scalar;  ///< in the lattice's steps; the scalar is only set for point data
};
static_assert(sizeof(LatticeVertex) == 32);

/// Sets out[v] from vertices[v] and scalars[v] for every vertex v; `scalars` is empty for cell data.
void make_lattice_vertices(std::span<const PixelVertex> vertices, std::span<const double> scalars,
                           const scene::Lattice& lattice, bool perspective, std::span<LatticeVertex> out);

/// What the lattice rasterizer needs to know about a frame.
struct LatticeView {
  ProjectedMesh projected;
  std::span<const LatticeVertex> vertices;  ///< one per vertex of `projected`
  scene::Lattice lattice;
  bool perspective;
  DepthLimits depth_limits{};
  std::span<const Step> steps{};           ///< steps of the transfer function
  const CellsAtSteps* at_steps = nullptr;  ///< the cells that are irregular because of these steps; null: none
  std::span<const scene::MagnifiedRange> magnified{};
  /// Lighting of the matter of point data: segments get a SegmentLight; null: no lighting.
  const MatterLight* light = nullptr;
  const PixelSpace* space = nullptr;  ///< only needed with `light`
};

/// Working memory of one thread.
struct LatticeScratch {
  SplitRasterizer<RaySegments> splitter;  ///< rasterizes irregular cells, in double precision
};

/// Bit x of element y is set if pixel (x, y) of the square still accepts segments.
using OpenPixels = std::array<std::uint32_t, SegmentWindows::side>;

/// The pixels to rasterize: a rectangle in one square of 32 x 32 pixels aligned to multiples of 32, which of its pixels
/// are open, and the triangle surfaces at which segments are cut.
struct MaskedRect {
  scene::PixelRect rect;
  const OpenPixels& open;
  const LatticeFaces* faces = nullptr;  ///< null: none

  [[nodiscard]] int square_x() const { return rect.x0 & ~(SegmentWindows::side - 1); }
  [[nodiscard]] int square_y() const { return rect.y0 & ~(SegmentWindows::side - 1); }
  /// The rectangle, relative to the square's corner.
  [[nodiscard]] scene::PixelRect in_square() const {
    return {rect.x0 - square_x(), rect.y0 - square_y(), rect.x1 - square_x(), rect.y1 - square_y()};
  }
};

/// A part of a tile's list: the cells to rasterize, and the cells that follow, which are prefetched.
struct ListedCells {
  std::span<const TileEntry> cells, next;
};

/// The `planes` rasterizer on the integer lattice: rasterizes cells to ray segments for the pixels of a rectangle.
/// Appends to `out`.
///
/// Sixteen cells are set up at once, one cell per lane, in double precision. Two steps follow:
///   1. Which pixels does each cell cover (lattice_cover-inl.h)? The edges of the cell's outline determine this, with
///      four additions per vector of pixels. A vector is a block of 4 x 4, 8 x 2 or 2 x 8 pixels (AVX-512; otherwise
///      half or a quarter as many pixels); the shape that takes the fewest blocks is used. Cells of a few pixels
///      (AVX-512, AVX2) are processed together, one cell per lane. Less than half of the lanes are hits (43 % on cube
///      32 and 40 % on cube 64, in blocks). Hits are packed: cell, column and row in one integer each.
///   2. Where do the rays of the hits pass through the cell (lattice_cross-inl.h)? This is computed with one hit per
///      lane. With AVX-512, the sixteen hits of a vector may belong to any of the sixteen cells: a property of all
///      cells is one vector, and a permutation gives each lane the value of its cell. With AVX2, the same holds for
///      eight hits of eight cells of a few pixels. Otherwise, all hits of a vector belong to one cell.
/// (A single step that computes all planes for every pixel of a block takes 97 instructions per block of 16 pixels,
/// which has 6 hits on average on cube 64, and almost as much time before a cell's first block. With two steps, a block
/// takes 29 instructions, and sixteen hits of small cells take 138.)
///
/// Six edge functions E in float determine which pixels are hit, and through which faces. Seen from the eye, a cell has
/// two front and two back faces, or one and three. The silhouette's edges determine whether a pixel is hit; the inner
/// edges (one or three) determine the face. Each E is scaled so that its rounding error is below 1: the sign is certain
/// if |E| > 1 (for a sum over n blocks, if |E| > 2 + 3 n / 4). For hits that are not certain (30 in a million segments
/// on cube 64), the exact sign with the tie rule (edge_sign.hpp) is computed, so the hits are those of
/// rasterize_planes.
///
/// Depth and scalar of a face are planes over the square's pixels, in integers: start, step in x, step in y. Rounding
/// does not depend on the block or lane, so neighbours compute the same bits for their common face. A gradient is
/// rounded to an integer step per pixel, which causes an error of at most 16 steps within the square. Under
/// perspective, the planes are those of 1/depth and its products; a quotient of two planes gives the difference from a
/// vertex of the face, so precision is relative to the face. docs/RESULTS.md has measurements on cube 64 (31 pixels per
/// cell).
///
/// Irregular cells are rasterized by rasterize_planes. These are cells that cross the eye plane or the clipping range,
/// have a corner nearer than a 16th of another corner's distance from the eye, have a face that is edge-on within 2^-9
/// of a pixel (except faces of orthographic views that are certainly edge-on), or extend beyond 2^14 pixels. Cells are
/// also irregular if integer planes and float quotients are not accurate enough for them: DepthLimits determines which
/// cells are too thin, CellsAtSteps which are too close to steps of the transfer function. The depths of irregular
/// cells differ from their neighbours' by a few steps, and none of their segments crosses a step.
///
/// Cells whose candidate pixels are all closed are skipped; otherwise, closed pixels still get segments.
void rasterize_lattice(const LatticeView& view, const ListedCells& list, const MaskedRect& pixels,
                       LatticeScratch& scratch, SegmentStream& out, RasterCounts& counts);

/// Whether this processor has an instruction set with lanes (SSE4 or better).
bool lattice_available();

}  // namespace tessera::projection
