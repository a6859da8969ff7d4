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

/// Receives a tile's ray segments and turns them into pixels of an image, or into fragments for another process.
///
/// The tile renderer calls begin_tile(), then for each rectangle start(), take() repeatedly, and finish(), then
/// end_tile(). Pixels are numbered row by row within the rectangle of start(). A sink is used by one thread only.
template <class Encoding>
class TileSink {
 public:
  using Store = typename Encoding::Store;
  using Depth = typename Encoding::Depth;

  TileSink() = default;
  TileSink(const TileSink&) = delete;
  TileSink& operator=(const TileSink&) = delete;
  virtual ~TileSink() = default;

  /// Called once per tile, before all other calls for this tile. The rectangles of start() are the tile or parts of the
  /// tile.
  virtual void begin_tile(std::size_t /*tile*/, const scene::PixelRect& /*rect*/) {}
  virtual void end_tile() {}

  /// Discards an unfinished rectangle and begins the pixels of `rect`. On the lattice, `rect` is within one square of
  /// 32 x 32 pixels that is aligned to multiples of 32.
  virtual void start(const scene::PixelRect& rect) = 0;

  /// Takes the final segments in each pixel's order, and removes them from the store. A segment is final if its key
  /// (the front, or the back in lists ordered by the back) is less than `final_depth`: no later segment may precede it.
  /// Also removes the segments of closed pixels. On the lattice, lists with fewer than `at_least` segments may stay for
  /// later. The time is added to the stages `sort`, `integrate` and `composite` (sinks of fragments: `pack`).
  virtual void take(Store& store, Depth final_depth, std::size_t at_least, scene::StageTimer& timer) = 0;

  /// Takes all segments because the store cannot grow any further, although later segments may come between them; all
  /// segments before `final_depth` are complete. If the sink needs segments in order, it returns false and takes no
  /// segments. The renderer then starts again on a part of the rectangle, and start() must undo everything that this
  /// rectangle has contributed.
  virtual bool take_unordered(Store& store, Depth final_depth, scene::StageTimer& timer) = 0;

  /// The pixels that still accept segments, and whether there are any. Segments of other pixels may be discarded.
  [[nodiscard]] virtual const typename Encoding::Open& open() const = 0;
  [[nodiscard]] virtual bool any_open() const = 0;

  /// Called when the rectangle's last segment has been taken, or all its pixels are closed.
  virtual void finish() = 0;

  /// The number of segments taken so far, including those left out behind opaque segments.
  [[nodiscard]] virtual std::uint64_t segments() const = 0;
};

}  // namespace tessera::compositor
