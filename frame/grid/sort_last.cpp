// SPDX-License-Identifier: BSD-3-Clause
#include "frame/grid/sort_last.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "exchange/direct/direct_send.hpp"
#include "frame/grid/region_gather.hpp"
#include "volume/split/object_split.hpp"

namespace tessera::frame {
namespace {

using Clock = std::chrono::steady_clock;
using scene::PixelRect;

/// Returns a rank's band of the footprint, extended by pixels outside the footprint, so that the regions of all ranks
/// cover the image.
PixelRect region_of(const PixelRect& area, int number, int ranks, scene::ImageSize size) {
  const PixelRect band = exchange::band_of(area, number, ranks);
  return {0, number == 0 ? 0 : band.y0, size.width, number == ranks - 1 ? size.height : band.y1};
}

/// The pixels that each part may cover.
std::vector<PixelRect> footprints(const volume::ObjectSplit& split, const VolumeJob& job,
                                  const scene::GridGeometry& geometry, const PixelRect& area) {
  std::vector<PixelRect> own;
  for (const volume::VoxelBox& part : split.boxes()) {
    // By rounding, a part's corner may be outside the footprint of the whole volume.
    if (part.low != part.high)
      own.push_back(scene::common(area, volume::footprint(job.camera, job.size, geometry, part)));
    else
      own.push_back({area.x0, area.y0, area.x0, area.y0});
  }
  return own;
}

}  // namespace

/// One rank's state.
class SortLast::State {
 public:
  State(exchange::Transport& transport, const Settings& settings, const FrameSettings& frame)
      : transport_(transport),
        direct_send_(settings.ranks.direct_send),
        keeps_error_bounds_(frame.keep_uncertainty),
        trace_(settings.trace),
        sender_(transport) {}

  VolumePart make(volume::Renderer& renderer, const scene::TransferFunction& function, const VolumeJob& job,
                  std::size_t number, scene::FrameWatch& watch) {
    divide(renderer, function);
    const int rank = transport_.rank(), ranks = transport_.size();
    const scene::GridGeometry& geometry = renderer.geometry();
    const volume::VoxelBox& part = split_->boxes()[static_cast<std::size_t>(rank)];
    const std::vector<int> order = split_->front_to_back(geometry, job.camera);
    PixelRect area = volume::footprint(job.camera, job.size, geometry);
    if (area.empty()) area = {0, 0, 0, 0};

    const std::vector<PixelRect> own = footprints(*split_, job, geometry, area);
    const std::vector<int> bands = exchange::band_numbers(own);
    exchange::DirectSendTask task{order, bands, area, own[static_cast<std::size_t>(rank)], number, false, trace_};
    Picture mine = cast(renderer, function, job, part, task.own, watch);
    task.stopped = mine.stopped;
    const auto cast_end = Clock::now();
    const exchange::DirectSendResult sent = sender_.run(direct_send_, task, mine.image, mine.error_bounds);
    GridCounters& counters = mine.statistics;
    counters.exchange_bytes = sent.bytes, counters.exchange_messages = sent.messages;
    counters.composite_us = static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - cast_end).count());

    VolumePart made;
    const int band = bands[static_cast<std::size_t>(rank)];
    made.header = {
        number, region_of(area, band, ranks, job.size), counters, mine.cpu_seconds, 0, sent.stopped ? 1u : 0u};
    made.rectangles = {made.header.region};
    made.finished.image = std::move(mine.image);
    made.finished.error_bounds = std::move(mine.error_bounds);
    made.finished.statistics = std::move(mine.statistics);
    made.finished.parts = split_->boxes();
    if (rank == 0) {
      made.finished.stopped = sent.stopped;
      report_region(watch, made.header.region, made.finished);
      made.header.stopped = made.finished.stopped ? 1 : 0;
    }
    return made;
  }

 private:
  /// A rank's frame of its part.
  struct Picture : volume::Frame {
    double cpu_seconds = 0;
    bool stopped = false;
  };

  /// Every rank computes the same boxes, because all ranks have the range of every cell of the volume.
  void divide(const volume::Renderer& renderer, const scene::TransferFunction& function) {
    if (split_ && std::ranges::equal(function.knots(), knots_)) return;
    const scene::TraceScope timing(trace_, "partition");
    split_.emplace(renderer.object_split(function, transport_.size()));
    knots_.assign(function.knots().begin(), function.knots().end());
  }

  Picture cast(volume::Renderer& renderer, const scene::TransferFunction& function, const VolumeJob& job,
               const volume::VoxelBox& part, const PixelRect& region, const scene::FrameWatch& watch) const {
    Picture mine;
    // Pixels that lack other parts must not be reported.
    scene::FrameWatch quiet(watch.stop());
    const double cpu_before = process_cpu_seconds();
    try {
      if (!region.empty())
        static_cast<volume::Frame&>(mine) =
            renderer.render(job.camera, job.size, function,
                            {.regions = {region}, .part = part, .error_bounds = keeps_error_bounds_}, &quiet);
      mine.stopped = watch.stopped();
    } catch (const scene::FrameStopped&) {
      mine.stopped = true;
    }
    mine.cpu_seconds = process_cpu_seconds() - cpu_before;
    if (mine.image.size.width == 0) mine.image = scene::Image(job.size);
    if (keeps_error_bounds_) mine.error_bounds.resize(mine.image.depth.size(), 0.0f);
    return mine;
  }

  exchange::Transport& transport_;
  const DirectSend direct_send_;
  const bool keeps_error_bounds_;
  scene::Trace* const trace_;
  exchange::DirectSender sender_;
  std::optional<volume::ObjectSplit> split_;
  std::vector<tessera::Knot> knots_;  ///< knots for which the current split was made
};

SortLast::SortLast(exchange::Transport& transport, const Settings& settings, const FrameSettings& frame)
    : VolumeFrames(transport, settings.trace), state_(std::make_unique<State>(transport, settings, frame)) {}
SortLast::~SortLast() = default;

VolumePart SortLast::make(volume::Renderer& renderer, const scene::TransferFunction& function, const VolumeJob& job,
                          std::size_t number, scene::FrameWatch& watch) {
  return state_->make(renderer, function, job, number, watch);
}

}  // namespace tessera::frame
