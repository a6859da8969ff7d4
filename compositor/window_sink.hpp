#pragma once

#include <cstdint>

#include "projection/lattice_rasterizer.hpp"
#include "projection/segment_windows.hpp"
#include "scene/trace.hpp"

namespace tessera::compositor {

/// What becomes of a tile's lattice segments: pixels of a picture, or runs for another process. The counterpart of
/// TileSink on the integer lattice.
///
/// The tile's renderer calls begin_tile(); for each of its squares start(), then take() window by window, then
/// finish(); end_tile(). One sink serves one thread.
class WindowSink {
 public:
  WindowSink() = default;
  WindowSink(const WindowSink&) = delete;
  WindowSink& operator=(const WindowSink&) = delete;
  virtual ~WindowSink() = default;

  /// Called once a tile around all else.
  virtual void begin_tile(std::size_t /*tile*/, const scene::PixelRect& /*rect*/) {}
  virtual void end_tile() {}

  /// Forgets what an unfinished rectangle left and begins on the pixels of `rect`, which lies in one square of 32 x 32
  /// pixels aligned to multiples of 32.
  virtual void start(const scene::PixelRect& rect) = 0;

  /// Takes, in each pixel's order, all segments whose front lies before `final_step` (a lattice depth) and removes them
  /// from the windows; no later segment may come before them. Lists of less than `at_least` may be left for later.
  /// What it does is lapped as `sort`, `integrate` and `composite` (fragments: `pack`).
  virtual void take(projection::SegmentWindows& windows, std::int64_t final_step, std::size_t at_least,
                    scene::TraceLaps& laps) = 0;

  /// Takes all segments, though later ones may come between them; what lies before `final_step` is complete. False, and
  /// nothing taken, if the sink needs them in order; start() must then undo all that the rectangle gave it so far.
  virtual bool take_unordered(projection::SegmentWindows& windows, std::int64_t final_step, scene::TraceLaps& laps) = 0;

  /// Pixels that still take anything, and whether there are any.
  [[nodiscard]] virtual const projection::OpenPixels& open() const = 0;
  [[nodiscard]] virtual bool any_open() const = 0;

  /// The rectangle's last segment has been taken, or all its pixels are closed.
  virtual void finish() = 0;

  /// Segments taken, or left out behind opaque ones, so far.
  [[nodiscard]] virtual std::uint64_t segments() const = 0;
};

}  // namespace tessera::compositor
