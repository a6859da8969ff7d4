#pragma once

#include "projection/footprint.hpp"
#include "projection/ray_segments.hpp"
#include "sorting/pixel_lists.hpp"

namespace tessera::compositor {

/// What becomes of a tile's ray segments: pixels of a picture, or fragments for another process.
///
/// The tile renderer calls begin_tile(); start(), then take() window by window, then finish(); end_tile(). Pixels are
/// numbered row by row within the rectangle given to start(). One sink serves one thread.
class TileSink {
 public:
  TileSink() = default;
  TileSink(const TileSink&) = delete;
  TileSink& operator=(const TileSink&) = delete;
  virtual ~TileSink() = default;

  /// Called once a tile around all else; the rectangles given to start() are the tile or parts of it.
  virtual void begin_tile(std::size_t /*tile*/, const scene::PixelRect& /*rect*/) {}
  virtual void end_tile() {}

  /// Forgets what an unfinished rectangle left and begins on the pixels of `rect`.
  virtual void start(const scene::PixelRect& rect) = 0;

  /// Takes, in each pixel's order, the segments that are final: those whose key (the lists' Entry::depth: the front,
  /// unless the back is the key) lies before `final_depth`, as no later segment may come before them. The rest will be
  /// given again.
  virtual void take(const projection::RaySegments& segments, const sorting::PixelLists& lists, double final_depth) = 0;

  /// Takes all segments, final or not, because the renderer has no room for more. False: it cannot, as it needs them
  /// in order; nothing was taken, and the renderer starts again on a part of the tile.
  virtual bool take_unordered(const projection::RaySegments& segments, const sorting::PixelLists& lists,
                              double final_depth) = 0;

  /// Whether the pixel still takes anything. Segments of closed pixels may be dropped.
  [[nodiscard]] virtual bool open(std::size_t pixel) const = 0;
  [[nodiscard]] virtual std::size_t open_count() const = 0;

  /// The rectangle's last segment has been taken, or all its pixels are closed.
  virtual void finish() = 0;
};

}  // namespace tessera::compositor
