// SPDX-License-Identifier: BSD-3-Clause
// A mesh, rendered by one process or by all ranks of a job.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>

#include "api/session_state.hpp"
#include "exchange/collectives.hpp"
#include "frame/mesh/mesh_input.hpp"
#include "frame/mesh/peel.hpp"
#include "frame/ranks/distributed.hpp"
#include "projection/partition.hpp"
#include "projection/prepared_mesh.hpp"
#include "projection/scanline/segment_tuple.hpp"
#include "scene/error.hpp"
#include "scene/threads.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

using Clock = std::chrono::steady_clock;
using api::stopped_frame;
using api::tiles_to;

FrameStatistics statistics_of(const frame::FrameStatistics& s, double milliseconds) {
  FrameStatistics statistics;
  statistics.mesh = s;
  statistics.on_lattice = s.on_lattice;
  statistics.instruction_set = s.instruction_set;
  statistics.integrator = s.integrator;
  statistics.composited_on = s.composited_on;
  statistics.milliseconds = milliseconds;
  return statistics;
}

/// Renders a mesh with this process.
class MeshAlone final : public Session::State {
 public:
  MeshAlone(Dataset dataset, const Settings& settings)
      : State(std::move(dataset), settings),
        renderer_(data().prepared(settings.threads, settings.trace), data().facts, settings) {
    frame::assign_roles(1, settings.ranks.projectors, settings.ranks.compositors);  // checks that both numbers are 1 or
                                                                                    // not set
  }

  std::size_t render(std::span<const View> views, const TransferFunction& function, const FrameSettings& settings,
                     Sink& sink, const std::stop_token& stop) override {
    renderer_.set_frame(settings);
    const bool deep = settings.by_depth();
    for (std::size_t i = 0; i < views.size(); ++i) {
      RenderedFrame frame;
      frame.number = i;
      DeepImage made;
      frame::FrameStatistics statistics;
      scene::FrameWatch watch(stop, tiles_to(sink, i));
      const auto start = Clock::now();
      try {
        frame.image =
            renderer_.render(views[i].camera, views[i].size, function, &statistics, deep ? &made : nullptr, &watch);
      } catch (const scene::FrameStopped&) {
        sink.frame(stopped_frame(i));
        return i;
      } catch (const api::SinkFailure& failure) {
        std::rethrow_exception(failure.cause);
      }
      frame.statistics =
          statistics_of(statistics, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
      if (deep) frame::put_deep(std::move(made), settings, frame);
      sink.frame(std::move(frame));
    }
    return views.size();
  }

 private:
  frame::Renderer renderer_;
};

/// Renders a mesh with several processes.
class MeshOnRanks final : public Session::State {
 public:
  MeshOnRanks(Dataset dataset, const Settings& settings, std::shared_ptr<exchange::Transport> transport)
      : State(std::move(dataset), settings),
        distributed_{.render = settings,
                     .roles = assign_roles(transport->size(), settings.ranks.projectors, settings.ranks.compositors),
                     .exchange = exchange_of(settings, false)},
        transport_(std::move(transport)) {
    if (settings.trace != nullptr) {
      distributed_.projecting = &projecting_.emplace(*settings.trace, TraceRole::projector);
      distributed_.compositing = &compositing_.emplace(*settings.trace, TraceRole::compositor);
    }
    const Dataset::State& state = data();
    check_exchange(distributed_.exchange);
    const auto projects = [&](int rank) { return distributed_.roles.projects(rank); };
    if (state.ranks > 1 && state.ranks != transport_->size())
      throw scene::bad_input(
          fmt::format("{}: it was opened by {} ranks, but the session has {}; give both the same communicator",
                      state.source, state.ranks, transport_->size()));
    if (!projects(transport_->rank()) && state.ranks > 1 && !state.mesh.tets.empty()) {
      const Error error =
          scene::bad_input(fmt::format("{}: rank {} has cells, but is not a projector; give data set and session the "
                                       "same `projectors` and `compositors`",
                                       state.source, transport_->rank()));
      transport_->fail(error);  // other ranks may not have found the error
      throw error;
    }
    renderer_.emplace(*transport_, distributed_, [this](std::size_t) { return part(); });
    if (projecting_) transport_->trace_to(&*projecting_, &*compositing_);
  }

  ~MeshOnRanks() override {
    renderer_.reset();
    if (projecting_) transport_->trace_to(nullptr, nullptr);
  }

  std::size_t render(std::span<const View> views, const TransferFunction& function, const FrameSettings& settings,
                     Sink& sink, const std::stop_token& stop) override {
    Part part;
    do {
      const Exchange exchange = overlapping_ ? Exchange::segments : exchange_of(this->settings(), settings.by_depth());
      check_exchange(exchange);
      renderer_->set_frame(settings, exchange);
      part = render_from(part.complete, views, function, settings, sink, stop);
      overlapping_ |= part.overlapping != 0;
    } while (part.overlapping != 0);
    if (!assembles() && part.complete < views.size()) sink.frame(stopped_frame(part.complete));
    return part.complete;
  }

  [[nodiscard]] bool assembles() const override { return transport_->rank() == distributed_.roles.assembler(); }

 private:
  /// Number of frames that are complete on every rank, and whether the next frame must be made from segments.
  struct Part {
    std::uint64_t complete = 0, overlapping = 0;
  };
  /// Thrown if runs of a frame overlap. All ranks then end their frames in an orderly way.
  struct Overlap {};

  Part render_from(std::size_t first, std::span<const View> views, const TransferFunction& function,
                   const FrameSettings& settings, Sink& sink, const std::stop_token& stop) {
    std::vector<frame::FrameJob> jobs;
    for (const View& view : views.subspan(first)) jobs.push_back({view.camera, view.size, 0});
    Part part{first, 0};
    bool ended = false;
    frame::DistributedCallbacks callbacks;
    callbacks.frame = [&](frame::FinishedFrame finished) {
      if (ended) return;
      if (finished.overlapping && !finished.stopped) throw Overlap();
      finished.frame += first;
      if (finished.stopped) {
        ended = true;
        api::call_sink([&] { sink.frame(stopped_frame(finished.frame)); });
        return;
      }
      ++part.complete;
      RenderedFrame frame;
      frame.number = finished.frame;
      frame.image = std::move(finished.image);
      frame.statistics = statistics_of(finished.statistics, finished.frame_ms);
      frame.statistics.overlapping = overlapping_;
      if (settings.by_depth()) frame::put_deep(std::move(finished.deep), settings, frame);
      api::call_sink([&] { sink.frame(std::move(frame)); });
    };
    if (sink.wants_tiles())
      callbacks.tile = [&](std::size_t number, const PixelRect& rect, const Image& image) {
        api::call_sink([&] { sink.tile({first + number, rect, image}); });
      };
    callbacks.memory = [&](ImageSize size) {
      Image memory;
      api::call_sink([&] { memory = sink.spare_image(size); });
      return memory;
    };
    std::exception_ptr thrown;
    try {
      renderer_->render(jobs, function, callbacks, stop);
    } catch (const api::SinkFailure& failure) {
      thrown = failure.cause;  // the other ranks have also ended in an orderly way
    } catch (const Overlap&) {
      part.overlapping = 1;
    }
    part = exchange::broadcast_value(*transport_, distributed_.roles.assembler(),
                                     exchange::MessageKind::frames_complete, part);
    if (thrown) std::rethrow_exception(thrown);
    return part;
  }

  /// Throws if the mesh has too many tets for raw segments, which are sent with the index of their tet in 32 bits.
  void check_exchange(Exchange exchange) const {
    if (exchange == Exchange::segments && data().facts.tets > 0xffffffffull)
      throw scene::bad_input(
          fmt::format("`exchange` segments: supports at most 2^32 tets, and the mesh has {}; use `exchange` runs",
                      data().facts.tets));
  }

  /// The tets that this rank projects: the part that the rank has opened or, if every rank has the whole mesh, the
  /// rank's share.
  frame::ProjectorMesh part() {
    const Dataset::State& state = data();
    frame::ProjectorMesh mesh;
    mesh.diagonal = frame::diagonal(state.facts.box);
    mesh.box = state.facts.box;
    mesh.scalar_range = state.facts.scalar_range;
    if (distributed_.render.mesh.rasterizer == Rasterizer::scanline) {
      mesh.longest_edge = projection::longest_edge(state.mesh);
      if (state.ranks > 1) mesh.longest_edge = longest_of_all(mesh.longest_edge);
    }
    const auto& projectors = distributed_.roles.projectors;
    const bool is_only_projector = projectors.size() == 1 && projectors.front() == transport_->rank();
    if (state.ranks > 1 || is_only_projector) {
      mesh.part = state.mesh;
      mesh.global_tet = state.global_tet;
      mesh.prepared = state.prepared(settings().threads, distributed_.projecting);
      return mesh;
    }
    const auto own = std::find(projectors.begin(), projectors.end(), transport_->rank());
    struct Share {
      scene::TetMesh mesh;
      std::vector<std::uint64_t> numbers;
    };
    auto share = std::make_shared<Share>();
    share->mesh.association = state.mesh.association;
    if (own != projectors.end()) {
      const auto part_of =
          projection::parts_of_whole(state.mesh, settings().ranks.partition, static_cast<int>(projectors.size()));
      std::vector<std::uint32_t> mine;
      for (std::uint32_t tet = 0; tet < part_of.size(); ++tet)
        if (part_of[tet] == static_cast<std::uint32_t>(own - projectors.begin())) mine.push_back(tet);
      share->mesh = scene::subset(state.mesh, mine);
      share->numbers.assign(mine.begin(), mine.end());
    }
    scene::with_threads(settings().threads, [&] { projection::order_corners(share->mesh); });
    mesh.part = share->mesh;
    mesh.global_tet = share->numbers;
    mesh.owner = std::move(share);
    return mesh;
  }

  float longest_of_all(float longest) {
    for (const float other : exchange::gather_values(*transport_, exchange::MessageKind::longest_edge, longest))
      longest = std::max(longest, other);
    return longest;
  }

  frame::DistributedSettings distributed_;
  std::shared_ptr<exchange::Transport> transport_;
  bool overlapping_ = false;  ///< cells of several ranks overlap: segments are exchanged from now on
  std::optional<Trace> projecting_, compositing_;  ///< the caller's trace, for each role
  std::optional<frame::DistributedRenderer> renderer_;
};

}  // namespace

}  // namespace v0_1

namespace api {

std::unique_ptr<Session::State> mesh_alone(Dataset dataset, const Settings& settings) {
  return std::make_unique<MeshAlone>(std::move(dataset), settings);
}

std::unique_ptr<Session::State> mesh_on_ranks(Dataset dataset, const Settings& settings,
                                              std::shared_ptr<exchange::Transport> transport) {
  return std::make_unique<MeshOnRanks>(std::move(dataset), settings, std::move(transport));
}

}  // namespace api
}  // namespace tessera
