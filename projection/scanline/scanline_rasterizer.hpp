// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "projection/footprint.hpp"
#include "projection/planes_rasterizer.hpp"
#include "projection/ray_segments.hpp"
#include "projection/scanline/segment_tuple.hpp"

namespace tessera::projection {

/// Whether float32 can represent the frame: depths and scalars below 1e37, pixel coordinates up to 1e30, the longest
/// edge at least 1e-30.
bool fits_scanline(const ProjectedMesh& projected, float longest_edge);

/// What the scanline rasterizer needs to know about a frame.
struct ScanlineView {
  const ProjectedMesh& projected;
  float longest_edge;  ///< longest edge of the data set (segment_tuple.hpp)
};

/// Working memory of rasterize_scanline(), kept from call to call. Its contents have no effect on later calls.
struct ScanlineBuffers {
  /// Where a face's edges on one side meet the scanlines: x, depth and scalar, for each row of the rectangle.
  struct EdgeArrays {
    std::vector<float> x, z, s;
  };
  EdgeArrays left, right;
  std::vector<std::int32_t> first, last;  ///< pixels [first, last) of the face in each row
  std::vector<float> inverse_width;       ///< 1 / (x_right - x_left) of each row

  /// Buffer B: depth and scalar of the back-face fragment of each pixel of the rectangle, and the cell that wrote it.
  std::vector<float> z, s;
  std::vector<std::int32_t> owner;
  std::int32_t cells = 0;  ///< number of the current cell; entries of `owner` with lower numbers are stale

  [[nodiscard]] static std::size_t bytes_for(const scene::PixelRect& rect);
};

/// The `scanline` rasterizer: Juliachs, Carrard, Nominé, "Hybrid CPU-GPU Unstructured Meshes Parallel Volume Rendering
/// on PC Clusters" (EGPGV 2007), 4.1 and 4.2. This is the paper's own method, for comparison.
///
/// All arithmetic is in float32. A cell's faces are divided into back and front faces. Each face is scan-converted: its
/// edges are followed, four scanline intersections at a time, from a sub-pixel pre-step, into arrays for the left and
/// the right side; its rows are filled four pixels at a time. Back faces write depth and scalar into buffer B; front
/// faces read B and make {z_back, length, s_front, s_back}, with the length divided by the longest edge of the data
/// set. Segments are in the order of the cells. As in the paper, only orthographic views are supported. For cell data,
/// s_front = s_back.
///
/// As in the paper, there is no tie rule, and results are not exact: vertices are rounded to float pixels, so a ray
/// that passes an edge within this rounding may miss a cell or meet one too many, and depths on steep faces contain
/// magnified rounding errors. docs/ACCURACY.md has measurements. Where the paper is unspecific, or this implementation
/// differs:
/// - Rows and pixels are those with centres in [start, end), the usual interpretation of the paper's integer end
///   points.
/// - Interpolation factors are computed from the number of a row or pixel, not by adding increments: the number of
///   instructions differs by at most one, there is no drift, and the bits do not depend on where a rectangle cuts an
///   edge.
/// - B has the size of a tile's rectangle, not of the image: 12 bytes per pixel, which stay in the first-level cache
///   and are bounded for any image.
/// - B contains the cell that wrote a fragment, and each fragment is used once. A front fragment without its partner
///   does not become a segment (RasterCounts::unpaired); the paper would pair it with the fragment of any earlier cell.
/// - A length is at least 0, and z_back is not before the cell's nearest vertex, because the streaming of tiles relies
///   on this.
/// - Segments are cut at the clipping range.
/// - A flat cell, whose faces have no front and back, makes no segments.
///
/// Four lanes with Highway replace SSE intrinsics. One source is compiled for every processor and dispatched like
/// `planes`, with the masks and compiler flags of the newest instruction set, but never with more than the paper's four
/// lanes.
///
/// Takes cells in the same way as rasterize_planes(), with at most one segment per cell and pixel. Requires
/// fits_scanline(). Never writes outside the buffers, for any coordinates.
std::size_t rasterize_scanline(const ScanlineView& view, std::span<const TileEntry> entries,
                               const scene::PixelRect& rect, ScanlineBuffers& buffers, RaySegments& out,
                               RasterCounts& counts);

}  // namespace tessera::projection
