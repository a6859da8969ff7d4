// SPDX-License-Identifier: BSD-3-Clause
// A grid, rendered by any number of ranks.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>
#include <utility>

#include "api/queries/verify.hpp"
#include "api/session_state.hpp"
#include "exchange/collectives.hpp"
#include "frame/grid/balance_picture.hpp"
#include "frame/grid/brick_memory.hpp"
#include "frame/grid/deep_rows.hpp"
#include "frame/grid/sort_first.hpp"
#include "frame/grid/sort_last.hpp"
#include "frame/mesh/peel.hpp"
#include "frame/ranks/run_error.hpp"
#include "scene/error.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

using api::stopped_frame;
using api::tiles_to;

FrameStatistics statistics_of(const frame::FinishedVolumeFrame& frame, const char* integrator) {
  FrameStatistics statistics;
  const volume::RenderStatistics& s = frame.statistics;
  statistics.grid = s;
  statistics.instruction_set = s.instruction_set;
  statistics.integrator = integrator;
  statistics.milliseconds = frame.frame_ms;
  statistics.rectangles = frame.regions;
  statistics.ranks = frame.ranks;
  for (const GridCounters& rank : frame.ranks) statistics.samples.push_back(rank.samples);
  for (const volume::VoxelBox& part : frame.parts) statistics.parts.push_back({part.low, part.high});
  statistics.cpu_seconds = frame.cpu_seconds;
  statistics.split_cpu_seconds = frame.split_cpu_seconds;
  return statistics;
}

const char* name_of(IntegratorKind kind) {
  switch (kind) {
    case IntegratorKind::sampled:
      return "sampled";
    case IntegratorKind::preintegrated:
      return "preintegrated";
    default:
      return "exact";
  }
}

/// Renders a grid with one or several processes.
class GridByRays final : public Session::State {
 public:
  GridByRays(Dataset dataset, const Settings& settings, std::shared_ptr<exchange::Transport> transport)
      : State(std::move(dataset), settings), transport_(std::move(transport)), trace_(settings.trace) {
    make_frames({});
  }

  std::size_t render(std::span<const View> views, const TransferFunction& function, const FrameSettings& settings,
                     Sink& sink, const std::stop_token& stop) override {
    if (settings.keep_uncertainty != keeps_uncertainty_ || settings.keep_cost != keeps_cost_) {
      keeps_uncertainty_ = settings.keep_uncertainty, keeps_cost_ = settings.keep_cost;
      make_frames(settings);
    }
    if (!settings.by_depth() && !settings.keep_cost) return render_list(views, function, sink, stop);
    for (std::size_t i = 0; i < views.size(); ++i) {
      std::optional<RenderedFrame> frame;
      try {
        make_renderer(views[i].size);
        frame = make(i, views[i], function, settings, sink, stop);
      } catch (const api::SinkFailure& failure) {
        std::rethrow_exception(failure.cause);
      } catch (const std::exception& fault) {
        fail_others(fault);
        throw;
      }
      if (!frame) {
        sink.frame(stopped_frame(i));
        return i;
      }
      if (!give(std::move(*frame), i + 1 == views.size(), sink)) return i;
    }
    return views.size();
  }

  [[nodiscard]] bool assembles() const override { return transport_->rank() == 0; }

  [[nodiscard]] BalancePictures balance_pictures(const RenderedFrame& frame, const View& view,
                                                 const TransferFunction& function) const override {
    if (!keeps_cost_ || !renderer_)
      throw scene::bad_input("balance: the last frame did not record its cost; request it in the frame's settings");
    const scene::GridGeometry& geometry = data().samples->geometry();
    if (sorts_last()) {
      BalancePictures of_parts{
          frame.image, frame::cost_of_parts(view.camera, view.size, geometry, parts_, frame.statistics.cpu_seconds)};
      frame::draw_bricks(of_parts.bricks, view.camera, geometry, renderer_->visible_bricks(function), parts_);
      return of_parts;
    }
    BalancePictures pictures{frame.image, frame::cost_picture(cost_, view.size, split_)};
    frame::draw_bricks(pictures.bricks, view.camera, geometry, renderer_->visible_bricks(function), split_);
    return pictures;
  }

 private:
  [[nodiscard]] bool sorts_last() const { return settings().ranks.distribution == Distribution::sort_last; }

  void make_frames(const FrameSettings& frame) {
    if (sorts_last())
      frames_ = std::make_unique<frame::SortLast>(*transport_, settings(), frame);
    else
      frames_ = std::make_unique<frame::SortFirst>(*transport_, settings(), frame);
  }

  [[nodiscard]] volume::RenderSettings render_settings() const {
    return {settings(), data().clip, sorts_last() ? transport_->size() : 1};
  }

  /// Makes the renderer. This requires the image size, since bricks get the memory that remains after an image of that
  /// size.
  void make_renderer(ImageSize size) {
    if (renderer_) return;
    const scene::TraceScope timing(trace_, "prepare");
    volume::RenderSettings render = render_settings();
    const scene::Grid& samples = data().samples->grid();
    const std::uint64_t frames = frame::bytes_of_frames(samples.geometry, *data().ranges, render, size);
    const std::uint64_t brick = volume::BrickCache::bytes_of(
        {samples.geometry, render.grid.brick_size, render.grid.edge_bricks}, 0, samples.type);
    render.memory_bytes = frame::brick_memory(render.memory_bytes, {resident_, frames, size, render.threads}, brick);
    renderer_.emplace(*data().samples, render, data().ranges);
  }

  /// Ends the run on all ranks and throws the run's error. Otherwise the other ranks would wait for this one.
  void fail_others(const std::exception& fault) {
    if (transport_->size() == 1) return;
    transport_->fail(frame::run_error(*transport_, fault));
    transport_->check();
  }

  /// Returns the number for a frame's spans: the one that the caller has set in the trace or, without a trace,
  /// `number`.
  [[nodiscard]] std::size_t traced(std::size_t number) const {
    return trace_ != nullptr ? static_cast<std::size_t>(std::max(trace_->frame(), 0)) : number;
  }

  /// Renders a list of frames, several at a time.
  std::size_t render_list(std::span<const View> views, const TransferFunction& function, Sink& sink,
                          const std::stop_token& stop) {
    if (views.empty()) return 0;
    ImageSize largest = views.front().size;
    std::vector<frame::VolumeJob> jobs;
    for (const View& view : views) {
      jobs.push_back({view.camera, view.size});
      if (std::int64_t{view.size.width} * view.size.height > std::int64_t{largest.width} * largest.height)
        largest = view.size;
    }
    frame::VolumeCallbacks callbacks;
    callbacks.frame = [&](frame::FinishedVolumeFrame&& finished) {
      if (finished.stopped) return;  // the stop is reported on every rank below
      RenderedFrame frame;
      frame.number = finished.frame;
      frame.statistics = statistics_of(finished, name_of(this->settings().integrator.kind));
      frame.image = std::move(finished.image);
      frame.uncertainty = std::move(finished.error_bounds);
      sink.frame(std::move(frame));
    };
    if (sink.wants_tiles())
      callbacks.tile = [&](std::size_t number, const PixelRect& rect, const Image& image) {
        sink.tile({number, rect, image});
      };
    try {
      make_renderer(largest);
    } catch (const std::exception& fault) {
      fail_others(fault);
      throw;
    }
    const std::size_t complete =
        frames_->render(*renderer_, function, jobs, traced(0), callbacks, stop, settings().ranks.frames_in_flight);
    if (complete < views.size()) sink.frame(stopped_frame(complete));
    return complete;
  }

  /// Renders a frame. Returns none if it was stopped. Throws SinkFailure on rank 0 if rank 0's sink threw an exception.
  std::optional<RenderedFrame> make(std::size_t number, const View& view, const TransferFunction& function,
                                    const FrameSettings& settings, Sink& sink, const std::stop_token& stop) {
    scene::FrameWatch watch(stop, tiles_to(sink, number));
    std::optional<frame::FinishedVolumeFrame> finished;
    std::optional<api::SinkFailure> failure;
    try {
      finished = frames_->render(*renderer_, function, {view.camera, view.size}, traced(number), &watch);
    } catch (const api::SinkFailure& thrown) {
      failure = thrown;
    }
    if (agreed(failure || (finished && finished->stopped))) {
      if (failure) throw api::SinkFailure(*failure);
      return std::nullopt;
    }
    RenderedFrame frame;
    frame.number = number;
    if (finished) {
      frame.statistics = statistics_of(*finished, name_of(this->settings().integrator.kind));
      frame.image = std::move(finished->image);
      frame.uncertainty = std::move(finished->error_bounds);
      split_ = std::move(finished->split);
      cost_ = std::move(finished->cost);
      parts_ = finished->parts;
    }
    if (settings.by_depth() && !add_depth(view, function, settings, stop, frame)) return std::nullopt;
    return frame;
  }

  /// Adds the deep image or the layers, in a separate pass. Returns false if it was stopped.
  bool add_depth(const View& view, const TransferFunction& function, const FrameSettings& settings,
                 const std::stop_token& stop, RenderedFrame& frame) {
    const auto start = std::chrono::steady_clock::now();
    std::optional<DeepImage> deep;
    try {
      const scene::TraceScope timing(trace_, "project");
      frame::StopRelay::Run relayed(frames_->relay(), stop);
      const volume::GridSurfaces surfaces(this->settings().surfaces, function, *data().ranges);
      deep = frame::deep_rows(*transport_, *data().samples, view.camera, view.size, function,
                              {render_settings(), settings, &surfaces}, static_cast<std::int32_t>(frame.number),
                              relayed.token());
    } catch (const scene::FrameStopped&) {
      return false;
    }
    if (!deep) return true;
    frame.statistics.milliseconds +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    frame::put_deep(std::move(*deep), settings, frame);
    return true;
  }

  /// Passes a frame to the sink. Returns false on other ranks if rank 0's sink threw an exception; for the last frame
  /// this is not checked.
  bool give(RenderedFrame&& frame, bool last, Sink& sink) {
    std::exception_ptr thrown;
    try {
      if (assembles()) sink.frame(std::move(frame));
    } catch (...) {
      thrown = std::current_exception();
    }
    const bool failed = !last && agreed(thrown != nullptr);
    if (thrown) std::rethrow_exception(thrown);
    return !failed;
  }

  /// Returns rank 0's value on all ranks.
  bool agreed(bool mine) {
    if (transport_->size() == 1) return mine;
    return exchange::broadcast_value(*transport_, 0, exchange::MessageKind::sink_failed, std::uint8_t{mine}) != 0;
  }

  std::shared_ptr<exchange::Transport> transport_;
  scene::Trace* trace_;
  volume::ImageSplit split_;
  volume::CostMap cost_;
  std::vector<volume::VoxelBox> parts_;
  const std::uint64_t resident_ = frame::resident_bytes();
  std::optional<volume::Renderer> renderer_;
  bool keeps_uncertainty_ = false, keeps_cost_ = false;
  std::unique_ptr<frame::VolumeFrames> frames_;
};

}  // namespace

}  // namespace v0_1

namespace api {

std::unique_ptr<Session::State> grid_by_rays(Dataset dataset, const Settings& settings,
                                             std::shared_ptr<exchange::Transport> transport) {
  return std::make_unique<GridByRays>(std::move(dataset), settings, std::move(transport));
}

}  // namespace api
}  // namespace tessera
