// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "scene/pixel_rect.hpp"
#include "scene/trace.hpp"
#include "sorting/encodings.hpp"

namespace tessera::compositor {

using sorting::DoubleEncoding;
using sorting::LatticeEncoding;

/// What becomes of a tile's ray segments: pixels of a picture, or fragments for another process.
///
/// The tile renderer calls begin_tile(); for each of its rectangles start(), then take() again and again, then
/// finish(); end_tile(). Pixels are numbered row by row within the rectangle given to start(). One sink serves one
/// thread.
template <class Encoding>
class TileSink {
 public:
  using Store = typename Encoding::Store;
  using Depth = typename Encoding::Depth;

  TileSink() = default;
  TileSink(const TileSink&) = delete;
  TileSink& operator=(const TileSink&) = delete;
  virtual ~TileSink() = default;

  /// Called once a tile around all else; the rectangles given to start() are the tile or parts of it.
  virtual void begin_tile(std::size_t /*tile*/, const scene::PixelRect& /*rect*/) {}
  virtual void end_tile() {}

  /// Forgets what an unfinished rectangle left and begins on the pixels of `rect`; on the lattice it lies in one square
  /// of 32 x 32 pixels aligned to multiples of 32.
  virtual void start(const scene::PixelRect& rect) = 0;

  /// Takes, in each pixel's order, the segments that are final: those whose key (the front, or the back where lists are
  /// ordered by it) lies before `final_depth`, as no later segment may come before them. Removes them from the store,
  /// with those of closed pixels. On the lattice lists of less than `at_least` may be left for later. The time goes to
  /// the stages `sort`, `integrate` and `composite` (fragments: `pack`).
  virtual void take(Store& store, Depth final_depth, std::size_t at_least, scene::StageTimer& timer) = 0;

  /// Takes all segments, though later ones may come between them, because there is no room for more; what lies before
  /// `final_depth` is complete. False, and nothing taken, if the sink needs them in order: the renderer then starts
  /// again on a part of the rectangle, and start() must undo all that this one gave.
  virtual bool take_unordered(Store& store, Depth final_depth, scene::StageTimer& timer) = 0;

  /// Pixels that still take anything, and whether there are any. Segments of others may be dropped.
  [[nodiscard]] virtual const typename Encoding::Open& open() const = 0;
  [[nodiscard]] virtual bool any_open() const = 0;

  /// The rectangle's last segment has been taken, or all its pixels are closed.
  virtual void finish() = 0;

  /// Segments taken, or left out behind opaque ones, so far.
  [[nodiscard]] virtual std::uint64_t segments() const = 0;
};

}  // namespace tessera::compositor
