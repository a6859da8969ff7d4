#pragma once

#include "compositor/window_sink.hpp"
#include "exchange/part_writer.hpp"

namespace tessera::compositor {

/// `--exchange segments` on the integer lattice: every ray segment as it is. The compositor, which sorts, gets them in
/// no order, so nothing is done here but copying.
class WindowSegments final : public WindowSink {
 public:
  WindowSegments(const scene::Lattice& lattice, exchange::PartWriter::Deliver deliver)
      : lattice_(lattice), writer_(exchange::RecordKind::lattice, std::move(deliver)) {
    open_.fill(~0u);  // nothing is integrated here, so no pixel is known to be opaque
  }

  void begin_tile(std::size_t tile, const scene::PixelRect& rect) override { writer_.begin_tile(tile, rect); }
  void end_tile() override { writer_.end_tile(); }
  void start(const scene::PixelRect& rect) override { writer_.start(rect); }
  void take(projection::SegmentWindows& windows, std::int64_t final_step, std::size_t at_least,
            scene::TraceLaps& laps) override;
  bool take_unordered(projection::SegmentWindows& windows, std::int64_t final_step, scene::TraceLaps& laps) override {
    take(windows, final_step, 1, laps);  // all of them, always
    return true;
  }
  [[nodiscard]] const projection::OpenPixels& open() const override { return open_; }
  [[nodiscard]] bool any_open() const override { return true; }
  void finish() override {}
  [[nodiscard]] std::uint64_t segments() const override { return segments_; }

 private:
  scene::Lattice lattice_;
  exchange::PartWriter writer_;
  projection::OpenPixels open_{};
  std::uint64_t segments_ = 0;
};

}  // namespace tessera::compositor
