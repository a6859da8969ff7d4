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

/// Rasterizes cells to ray segments on a device, by compute shaders (the outlook of Juliachs et al. 2007, section 6). A
/// first pass counts the segments of every pixel; a second pass writes them into lists of these lengths.
///
/// The segments are those of rasterize_planes(): six edge functions determine the two faces that a ray passes, with
/// exact signs and the tie rule (edge_sign.hpp); where a double does not give a certain sign, 128-bit integers do.
/// Depths and scalars are interpolated in double precision from a face's corners in canonical order. Segments are not
/// clipped, because cells that cross the clipping range have no record. The segments of a list may be in any order;
/// each contains the number of its cell, so that sorting gives the same result for any order.
///
/// Memory: at most `most_cells` cells (136 bytes each) are uploaded at a time, whatever the number of cells.
///
/// May only be used on the context's thread.
class GlRasterizer {
 public:
  /// `most_cells`: the number of cells that are uploaded at a time, at least 1.
  GlRasterizer(const gl::Context& context, std::size_t most_cells);

  /// Cells to rasterize, and the pixels for which they are rasterized: those of `rect`, which are numbered row by row,
  /// from `first_pixel` on.
  struct Job {
    std::span<const CellRecord> cells;
    CellUnits units;
    scene::PixelRect rect;
    std::uint32_t first_pixel;
  };
  /// Queues commands that add every pixel's number of segments to its entry in `counts`.
  void count(std::span<const Job> jobs, const gl::Buffer& counts);

  /// Where segments are written: element next[pixel]++ of each of the other buffers.
  struct Lists {
    const gl::Buffer* next;    ///< one uint per pixel: the first free element of the pixel's list
    const gl::Buffer* keys;    ///< four uints: keys of front and back, the low half of the tet, the element
    const gl::Buffer* values;  ///< four floats: length, scalars at front and back (in the jobs' units), and -1
    const gl::Buffer*
        scalars;  ///< two floats: the scalars again, which are still needed after light has replaced the values
  };
  /// Queues commands that write all of the jobs' segments.
  void fill(std::span<const Job> jobs, const Lists& lists);

 private:
  struct Part;
  /// Cells of one job that are uploaded together.
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
