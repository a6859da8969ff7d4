#pragma once

#include "compositor/window_pixels.hpp"
#include "exchange/part_writer.hpp"

namespace tessera::compositor {

/// `--exchange runs` on the integer lattice, RunSink's counterpart: segments of a pixel that touch end to end become
/// one fragment, in the same pass that sorts and integrates them.
class WindowRuns final : public WindowSink {
 public:
  /// Runs are cut, and the tile's compositor told so, after `bytes_between_cuts` of records of a tile.
  WindowRuns(const WindowScene& scene, std::uint64_t bytes_between_cuts, exchange::PartWriter::Deliver deliver)
      : scene_(scene),
        rules_{scene.table, scene.least_transmittance(), true},
        bytes_between_cuts_(bytes_between_cuts),
        writer_(exchange::RecordKind::lattice_runs, std::move(deliver)) {}

  void begin_tile(std::size_t tile, const scene::PixelRect& rect) override;
  void end_tile() override { writer_.end_tile(); }
  void start(const scene::PixelRect& rect) override;
  void take(projection::SegmentWindows& windows, std::int64_t final_step, std::size_t at_least,
            scene::TraceLaps& laps) override;
  /// Runs are then shorter, and no pixel of the rectangle closes any more, as what hides it may lie behind it.
  bool take_unordered(projection::SegmentWindows& windows, std::int64_t final_step, scene::TraceLaps& laps) override;
  [[nodiscard]] const projection::OpenPixels& open() const override { return open_; }
  [[nodiscard]] bool any_open() const override { return open_count_ > 0; }
  void finish() override;
  [[nodiscard]] std::uint64_t segments() const override { return segments_; }

 private:
  void end_runs();
  void append_run(exchange::Bytes& out, const WindowState::Run& run) const;
  void cut(std::int64_t final_step);
  void write_ended();

  WindowScene scene_;
  WindowRules rules_;
  std::uint64_t bytes_between_cuts_, bytes_since_cut_ = 0;
  exchange::PartWriter writer_;
  projection::OpenPixels open_{};
  int open_count_ = 0;
  std::uint64_t segments_ = 0;
  WindowState state_;
};

}  // namespace tessera::compositor
