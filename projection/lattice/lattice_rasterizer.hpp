// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "projection/depth_limits.hpp"
#include "projection/lattice/segment_windows.hpp"
#include "projection/planes_rasterizer.hpp"
#include "projection/ray_segments.hpp"
#include "projection/steps.hpp"
#include "scene/lattice.hpp"

namespace tessera::projection {

/// A vertex as set-up wants it, in half a cache line: what cells share is divided and rounded once.
struct LatticeVertex {
  double x, y;                 ///< pixel position
  double inverse_w;            ///< perspective: 1 / depth, 0 for a vertex that is not in front of the eye; else 1
  std::int32_t depth, scalar;  ///< in the lattice's steps; the scalar is that of point data
};
static_assert(sizeof(LatticeVertex) == 32);

/// out[v] from vertices[v] and scalars[v]; `scalars` is empty for cell data.
void make_lattice_vertices(std::span<const PixelVertex> vertices, std::span<const double> scalars,
                           const scene::Lattice& lattice, bool perspective, std::span<LatticeVertex> out);

/// What the lattice rasterizer reads of a frame.
struct LatticeView {
  ProjectedMesh projected;
  std::span<const LatticeVertex> vertices;  ///< of all vertices of `projected`
  scene::Lattice lattice;
  bool perspective;
  DepthLimits depth_limits{};
  std::span<const Step> steps{};           ///< of the transfer function
  const CellsAtSteps* at_steps = nullptr;  ///< which of them need care; null: none
};

/// Working memory of one thread.
struct LatticeScratch {
  SplitRasterizer<RaySegments> splitter;  ///< of irregular cells, in double precision
};

/// Bit x of rows[y]: pixel (x, y) of the square still takes segments.
using OpenPixels = std::array<std::uint32_t, SegmentWindows::side>;

/// The pixels to rasterize for: a rectangle in one square of 32 x 32 pixels aligned to multiples of 32, and which of
/// its pixels are open.
struct MaskedRect {
  scene::PixelRect rect;
  const OpenPixels& open;

  [[nodiscard]] int square_x() const { return rect.x0 & ~(SegmentWindows::side - 1); }
  [[nodiscard]] int square_y() const { return rect.y0 & ~(SegmentWindows::side - 1); }
  /// The rectangle, counted from the square's corner.
  [[nodiscard]] scene::PixelRect in_square() const {
    return {rect.x0 - square_x(), rect.y0 - square_y(), rect.x1 - square_x(), rect.y1 - square_y()};
  }
};

/// A stretch of a tile's list: the cells to rasterize, and those that come next, whose numbers are fetched meanwhile.
struct ListedCells {
  std::span<const TileEntry> cells, next;
};

/// The `planes` rasterizer on the integer lattice: cells to ray segments for the pixels of a rectangle. Appends to
/// `out`.
///
/// Sixteen cells are set up at once, a cell a lane, in double precision. Then, in two steps:
///   1. Which pixels does each cover (lattice_cover-inl.h)? The edges of its outline alone tell: four additions for a
///      vector of pixels, in blocks of 4 x 4, 8 x 2 or 2 x 8 (AVX-512; else of half or a quarter as many), whichever
///      takes the fewest; cells of a few pixels (AVX-512, AVX2) go through theirs all together, a cell a lane. Less
///      than half of such vectors are hits (of blocks 43 % on cube 32, 40 on cube 64). These are packed: cell, column
///      and row in one number each.
///   2. Where do their rays pass (lattice_cross-inl.h)? A hit a lane. With AVX-512 sixteen hits are of any of the
///      sixteen cells, whose numbers then are one vector each, from which lanes take theirs by permuting; so are eight
///      of eight cells of a few pixels with AVX2. Else all are of one cell.
/// (Both at once, a block of pixels with all its planes, took 97 instructions for the 6 hits of 16 pixels that cube 64
/// has on average, and not much less time before a cell's first block; now a block takes 29, and sixteen hits of small
/// cells 138.)
///
/// Six edge functions E in float tell what is hit, and through which faces. Seen from the eye a cell has two front and
/// two back faces, or one and three; the silhouette's edges decide on the hit, the one or three inner edges on the
/// face. Each E is scaled so that its rounding error is below 1: |E| > 1 is certain (of a sum over n blocks, |E| > 2 +
/// 3 n / 4). Hits that are not (30 in a million segments on cube 64) get the exact sign with the tie rule
/// (edge_sign.hpp), so hits are those of rasterize_planes.
///
/// Depth and scalar of a face are planes over the square's pixels, in integers: start, step in x, step in y. No
/// rounding depends on block or lane, so neighbours compute the same bits for their common face. A gradient is rounded
/// to a whole step a pixel: at most 16 steps of error within the square. Under perspective 1/depth and its products are
/// the planes; a quotient of two gives what lies behind a vertex of the face, so precision is relative to the face.
/// Measured on cube 64 (31 pixels a cell): docs/RESULTS.md.
///
/// Irregular cells go through rasterize_planes: those that cross the eye plane or the clipping range, have a corner
/// within a 16th of the others' distance of the eye, have a face edge-on to 2^-9 of a pixel (but for orthographic views
/// of faces that are so for certain), or reach over 2^14 pixels; and those that need more than planes of integers and
/// float quotients give: DepthLimits says which are too thin, CellsAtSteps where steps of the transfer function are
/// too near. Their depths differ from their neighbours' by a few steps, and no segment of them crosses a step.
///
/// Cells behind closed pixels alone are skipped; single closed pixels still get segments.
void rasterize_lattice(const LatticeView& view, const ListedCells& list, const MaskedRect& pixels,
                       LatticeScratch& scratch, SegmentStream& out, RasterCounts& counts);

/// Whether this processor's instruction set has lanes (SSE4 or better).
bool lattice_available();

}  // namespace tessera::projection
