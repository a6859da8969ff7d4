// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gl/buffer.hpp"
#include "gl/shader.hpp"
#include "projection/cell_record.hpp"
#include "scene/pixel_rect.hpp"

namespace tessera::projection {

/// Cells to ray segments on a device, by compute shaders (the outlook of Juliachs et al. 2007, section 6): counted
/// first, pixel by pixel, then, once there are lists that long, written into them.
///
/// The segments are those of rasterize_planes(): six edge functions say which two faces a ray passes, with exact signs
/// and the tie rule (edge_sign.hpp); where a double is not certain, 128-bit integers decide. Depths and scalars are
/// interpolated in double from a face's corners in canonical order. No segment is clipped: cells that cross the
/// clipping range have no record. A list's segments come in no order; each has its cell's number, so that sorting makes
/// the same of any.
///
/// Memory: cells go up `most_cells` at a time (136 bytes each), however many there are.
///
/// Used on the context's thread.
class GlRasterizer {
 public:
  /// `most_cells`: at once, 1 or more.
  GlRasterizer(const gl::Context& context, std::size_t most_cells);

  /// Some cells, and the pixels that they are wanted for: `rect`, numbered from `first_pixel` on, row by row.
  struct Job {
    std::span<const CellRecord> cells;
    CellUnits units;
    scene::PixelRect rect;
    std::uint32_t first_pixel;
  };
  /// Queues commands that add every pixel's number of segments to its uint in `counts`.
  void count(std::span<const Job> jobs, const gl::Buffer& counts);

  /// Where segments go: element next[pixel]++ of each of the others.
  struct Lists {
    const gl::Buffer* next;     ///< uint a pixel: the first free element of its list
    const gl::Buffer* keys;     ///< four uints: keys of front and back, the tet's lower half, the element's number
    const gl::Buffer* values;   ///< four floats: length and scalars at front and back in the jobs' units, -1
    const gl::Buffer* scalars;  ///< two floats: the scalars once more, for after the values have become light
  };
  /// Queues commands that write all of the jobs' segments.
  void fill(std::span<const Job> jobs, const Lists& lists);

 private:
  struct Part;
  /// Cells of one job, as many as go up at once.
  struct Stretch {
    const Job* job;
    std::span<const CellRecord> cells;
  };
  void run(std::span<const Job> jobs, const Lists& lists, bool counting);
  void dispatch(std::span<const Stretch> stretches, const Lists& lists, bool counting);

  const gl::Context* context_;
  std::size_t most_cells_;
  gl::Program program_;
  gl::Buffer upload_cells_, upload_parts_, cells_, parts_;
  gl::Fence uploaded_;
};

}  // namespace tessera::projection
