// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "compositor/gl/gl_merger.hpp"
#include "compositor/image_assembly.hpp"
#include "compositor/tile_merger.hpp"
#include "exchange/frame_collector.hpp"
#include "frame/mesh/lattice_frame.hpp"
#include "frame/ranks/distributed_roles.hpp"
#include "frame/ranks/run_error.hpp"
#include "frame/ranks/worker_threads.hpp"
#include "projection/planes_rasterizer.hpp"
#include "scene/threads.hpp"

namespace tessera::frame {
namespace {

using exchange::Channel;

/// Each worker that feeds a device waits for the device with one tile, so a few more workers are needed to keep tiles
/// in flight.
int worker_count(const DistributedRun& run) {
  constexpr int tiles_in_flight = 6;
  return scene::threads_for(run.settings.render.threads) + (run.device.device != nullptr ? tiles_in_flight : 0);
}

/// One thread takes a few milliseconds to assemble an image of 1024 x 1024 pixels.
int assembling_threads(const DistributedSettings& settings) {
  constexpr int most = 8;
  return std::min(scene::threads_for(settings.render.threads), most);
}

std::optional<projection::MatterLight> light_of(const DistributedRun& run, const FrameJob& job) {
  if (!run.settings.render.mesh.shading) return std::nullopt;
  return projection::MatterLight(*run.settings.render.mesh.shading, job.camera);
}

/// The data of a frame on its compositor.
struct Frame {
  Frame(const DistributedRun& run, std::uint32_t number, int compositor)
      : number(number),
        grid{job_of(run, number).size, run.settings.render.mesh.tile_size},
        map(grid.count(), static_cast<int>(run.settings.roles.compositors.size()), run.settings.render.ranks.tile_seed),
        collector(static_cast<int>(run.settings.roles.projectors.size()), map, compositor),
        space(job_of(run, number).camera, job_of(run, number).size),
        integrator(run.function, integrator_of(run.settings.render, run.settings.frame), run.settings.render.emission),
        surfaces(run.settings.render.surfaces, run.function),
        light(light_of(run, job_of(run, number))),
        sender(run.transport, run.settings.roles.assembler(), number) {}

  std::uint32_t number;
  projection::TileGrid grid;
  exchange::TileMap map;
  exchange::FrameCollector collector;
  projection::PixelSpace space;
  integrals::SegmentIntegrator integrator;
  scene::SurfaceSet surfaces;
  std::optional<projection::MatterLight> light;
  compositor::TileSender sender;
  std::optional<FrameLattice> lattice;        ///< set for lattice segments
  std::optional<integrals::LaneTable> table;  ///< set for lattice segments, or for a device
  scene::Lattice units;                       ///< on a device: the units of the table
  double start_us = 0;
  std::atomic<std::uint64_t> segments = 0;  ///< number of segments of cells that the device rasterized
  std::atomic<bool> overlapping = false;    ///< whether cells of several projectors overlap
  std::atomic<bool> stopped = false;        ///< whether tiles lack fragments from now on, so that they are not sent

  struct Merge {
    std::unique_ptr<compositor::TileMerger> merger;
    bool running = false;
  };
  std::map<std::uint32_t, Merge> merges;  ///< tiles with fragments that are not finished
};

/// Receives messages on the calling thread, and merges on its own threads.
class CompositorLoop {
 public:
  explicit CompositorLoop(const DistributedRun& run)
      : run_(run),
        budget_(exchange_budget(run.settings)),
        trace_(run.settings.compositing),
        credit_(run.settings.roles.projectors.size()),
        workers_(worker_count(run),
                 [&](const std::exception& fault) { run_.transport.fail(run_error(run_.transport, fault)); }) {
    const auto& ranks = run.settings.roles.compositors;
    self_ = static_cast<int>(std::find(ranks.begin(), ranks.end(), run.transport.rank()) - ranks.begin());
  }

  void loop() {
    while (frames_finished_ < run_.jobs.size()) {
      exchange::Message message = [&] {
        const scene::TraceScope timing(trace_, "wait");
        return next();
      }();
      if (message.bytes.empty()) continue;
      if (exchange::MessageReader(message.bytes, message.from).kind() == exchange::MessageKind::wake) continue;
      const std::lock_guard lock(mutex_);
      accept(message.from, std::make_shared<const exchange::Bytes>(std::move(message.bytes)));
    }
  }

 private:
  /// Returns the next message, or an empty message if none arrives within 20 ms: the last frame may finish without a
  /// further message.
  exchange::Message next() {
    auto message = run_.transport.receive(Channel::fragments, std::chrono::milliseconds(20));
    if (message) return std::move(*message);
    const std::lock_guard lock(mutex_);
    for (std::size_t p = 0; p < credit_.size(); ++p) pay_out(p);
    return {-1, {}};
  }

  Frame& frame(std::uint32_t number) {
    auto& at = frames_[number];
    if (at == nullptr) {
      at = std::make_unique<Frame>(run_, number, self_);
      if (trace_ != nullptr) at->start_us = trace_->now_us();
    }
    return *at;
  }

  /// Takes a message. Parts refer to the memory of their message.
  void accept(int from, const std::shared_ptr<const exchange::Bytes>& message) {
    exchange::MessageReader reader(*message, from);
    const auto number = static_cast<std::uint32_t>(reader.take<std::uint64_t>());
    // Messages from a rank to itself do not move.
    const bool moved = from != run_.transport.rank();
    const scene::TraceScope timing(trace_, "receive", static_cast<std::int32_t>(number), moved ? message->size() : 0,
                                   moved ? 1 : 0, from);
    const auto& projectors = run_.settings.roles.projectors;
    const auto projector = static_cast<int>(std::find(projectors.begin(), projectors.end(), from) - projectors.begin());
    if (static_cast<std::size_t>(projector) == projectors.size()) reader.refuse_kind();
    Frame& to = frame(number);
    std::uint64_t credit = message->size();
    switch (reader.kind()) {
      case exchange::MessageKind::begin: {
        const auto begin = reader.take<exchange::FrameBegin>();
        to.collector.begin(projector, begin, reader.take_bytes(begin.tiles / 8 + (begin.tiles % 8 != 0 ? 1 : 0)));
        reader.finish();
        if (begin.stopped != 0) to.stopped = true;
        if (begin.on_lattice != 0 && !to.lattice) {
          to.lattice = lattice_of(to.space, begin.box, begin.scalar_range, run_.function, run_.settings.render,
                                  run_.settings.frame);
          if (!to.lattice)
            throw scene::Error(scene::ErrorCode::system_failure,
                               "exchange: a projector has a lattice and this compositor has none; give all ranks the "
                               "same arguments");
          to.table.emplace(to.lattice->function, to.lattice->lattice, run_.settings.render.emission);
          to.surfaces.place_on(to.lattice->lattice);
        }
        if (to.collector.has_all_begins())
          for (auto& [tile, merge] : to.merges) schedule(to, tile);
        break;
      }
      case exchange::MessageKind::parts:
        while (!reader.empty()) {
          const auto part = reader.take<exchange::PartHeader>();
          const auto records = reader.take_bytes(part.bytes);
          const bool stopped = part.last == 2;
          if (stopped) to.stopped = true;
          const double start = to.collector.add(
              projector, {part.tile, part.kind, part.last != 0, stopped, part.final_depth, part.fragments,
                          exchange::Records(message, records), part.ascending != 0, part.segments != 0});
          to.collector.owe(projector, part.tile, start, part.bytes);
          credit -= part.bytes;
          to.merges.try_emplace(part.tile);
          schedule(to, part.tile);
        }
        break;
      case exchange::MessageKind::end:
        to.collector.end(reader.take<exchange::FrameEnd>());
        reader.finish();
        break;
      default:
        reader.refuse_kind();
    }
    give_back(projector, credit);
    settle();
  }

  /// Returns credit in few messages, because each message wakes threads at both ends: when the credit reaches an eighth
  /// of the bytes that the projector may have in transit, or when no other message arrives.
  void give_back(int projector, std::uint64_t bytes) {
    const auto p = static_cast<std::size_t>(projector);
    credit_[p] += bytes;
    if (credit_[p] > budget_.window / 8) pay_out(p);
  }

  void pay_out(std::size_t projector) {
    if (credit_[projector] == 0) return;
    run_.transport.send(run_.settings.roles.projectors[projector], Channel::credit,
                        exchange::message_of(exchange::MessageKind::credit, std::exchange(credit_[projector], 0)));
  }

  /// Ends finished frames, and returns the credit that is due for the first unfinished frame.
  void settle() {
    while (!frames_.empty()) {
      Frame& first = *frames_.begin()->second;
      for (std::size_t p = 0; p < run_.settings.roles.projectors.size(); ++p)
        give_back(static_cast<int>(p), first.collector.pay(static_cast<int>(p)));
      if (first.number - run_.first != frames_finished_ || !first.collector.finished()) return;
      exchange::FrameEnd sums = first.collector.sums();
      sums.failed_devices += run_.device.failed ? 1 : 0;
      sums.counters.segments += first.segments;
      sums.stopped += first.stopped ? 1 : 0;
      sums.overlapping += first.overlapping ? 1 : 0;
      first.sender.end(sums);
      if (trace_ != nullptr) trace_->add_frame(static_cast<std::int32_t>(first.number), first.start_us);
      frames_.erase(frames_.begin());
      if (++frames_finished_ == run_.jobs.size())  // the loop may be waiting, and no other message will come
        run_.transport.send(run_.transport.rank(), Channel::fragments,
                            exchange::begin_message(exchange::MessageKind::wake));
    }
  }

  void schedule(Frame& of, std::uint32_t tile) {
    auto& merge = of.merges.at(tile);
    if (merge.running || !of.collector.has_work(tile)) return;
    merge.running = true;
    workers_.run([this, &of, tile] { merge_tile(of, tile); });
  }

  /// Returns the context of a frame's mergers.
  compositor::MergeContext context_of(Frame& of, double longest_ray, float longest_edge, bool on_lattice) {
    const Settings& render = run_.settings.render;
    compositor::MergeContext context{
        &of.space, &of.integrator, run_.function.max_color(), longest_ray, longest_edge, render.emission, budget_.tile};
    context.function = of.lattice ? &of.lattice->function : &run_.function;
    context.deep_accuracy = run_.settings.frame.by_depth() ? run_.settings.frame.deep_accuracy : 0;
    context.peel = run_.settings.frame.peel;
    context.lattice = run_.device.device != nullptr ? &of.units : of.lattice ? &of.lattice->lattice : nullptr;
    context.table = of.table ? &*of.table : nullptr;
    context.trace = trace_;
    context.device = run_.device.device.get();
    context.on_lattice = on_lattice;
    context.frame = of.number;
    context.device_failed = run_.device.may_fail ? &run_.device.failed : nullptr;
    context.segments = &of.segments;
    context.overlapping = &of.overlapping;
    context.surfaces = of.surfaces.empty() ? nullptr : &of.surfaces;
    context.light = of.light ? &*of.light : nullptr;
    return context;
  }

  /// Called on a worker thread. The frame exists until all its tiles are finished.
  void merge_tile(Frame& of, std::uint32_t tile) {
    std::unique_lock lock(mutex_);
    for (bool all = false; !all;) {
      Frame::Merge& merge = of.merges.at(tile);
      if (!of.collector.has_work(tile)) {
        merge.running = false;
        return;
      }
      exchange::FrameCollector::Waiting waiting = of.collector.take(tile);
      const double longest_ray = of.collector.longest_ray();
      const float longest_edge = of.collector.longest_edge();
      const bool on_lattice = of.lattice.has_value();
      if (run_.device.device != nullptr && of.units.depth_unit == 0) {
        of.units = on_lattice ? of.lattice->lattice : compositor::device_units(run_.function, longest_ray);
        if (!of.table) of.table.emplace(run_.function, of.units, run_.settings.render.emission);
      }
      all = waiting.all;
      lock.unlock();
      {
        const scene::TraceTile of_tile(trace_, tile);
        const scene::TraceScope timing(trace_, "composite", static_cast<std::int32_t>(of.number));
        if (run_.stop.stop_requested()) waiting.parts.clear(), of.stopped = true;
        if (merge.merger == nullptr && !waiting.parts.empty())
          merge.merger = compositor::make_tile_merger(
              waiting.parts.front().kind, context_of(of, longest_ray, longest_edge, on_lattice), of.grid.rect(tile));
        if (merge.merger != nullptr) compositor::merge(*merge.merger, waiting.parts, waiting.final_depth, budget_.tile);
        // A tile without fragments is not sent: the assembled image is already empty there.
        if (all && merge.merger != nullptr && !of.stopped) of.sender.send(tile, merge.merger->finish());
      }
      lock.lock();
    }
    of.merges.erase(tile);
    of.collector.finish(tile);
    settle();
  }

  const DistributedRun& run_;
  ExchangeBudget budget_;
  scene::Trace* trace_;
  int self_;
  std::mutex mutex_;  // guards the frames, their collectors and merges, and credit
  std::map<std::uint32_t, std::unique_ptr<Frame>> frames_;
  std::vector<std::uint64_t> credit_;  // bytes to return to each projector
  std::atomic<std::size_t> frames_finished_ = 0;
  WorkerThreads workers_;  // last: its threads use all of the above
};

}  // namespace

void run_compositor(const DistributedRun& run) { CompositorLoop(run).loop(); }

std::exception_ptr run_assembler(const DistributedRun& run, const DistributedCallbacks& callbacks,
                                 const std::function<void()>& stop_all) {
  // Exceptions of the caller's functions reach the caller after all ranks have ended their frames in order.
  std::exception_ptr thrown;
  std::mutex calls;  // one call at a time
  const auto guarded = [&](const auto& call) {
    const std::lock_guard lock(calls);
    if (thrown) return;
    try {
      call();
    } catch (...) {
      thrown = std::current_exception();
      stop_all();
    }
  };
  const DistributedSettings& settings = run.settings;
  const integrals::SegmentIntegrator integrator(run.function, settings.render.integrator, settings.render.emission);
  // Declared before the assembly, whose destructor waits for the tasks of the workers.
  std::optional<WorkerThreads> workers;
  compositor::AssemblySettings how;
  how.grid_of = [&](std::uint32_t frame) {
    return projection::TileGrid{job_of(run, frame).size, settings.render.mesh.tile_size};
  };
  how.deep_bytes = settings.frame.by_depth() ? settings.render.memory_bytes / 2 : 0;
  how.trace = settings.compositing;
  if (callbacks.tile)
    how.finished = [&](std::uint32_t frame, const scene::PixelRect& rect, const scene::Image& image) {
      if (!run.stop.stop_requested()) guarded([&] { callbacks.tile(frame - run.first, rect, image); });
    };
  if (callbacks.memory)
    how.memory = [&](scene::ImageSize size) {
      scene::Image memory;
      guarded([&] { memory = callbacks.memory(size); });
      return memory;
    };
  if (const int threads = assembling_threads(settings); threads > 1) {
    workers.emplace(threads, [&](const std::exception& fault) { run.transport.fail(run_error(run.transport, fault)); });
    how.run = [&](std::function<void()> work) { workers->run(std::move(work)); };
  }
  compositor::ImageAssembly assembly(static_cast<int>(settings.roles.compositors.size()), std::move(how));
  auto last = run.start;
  for (std::size_t left = 0; left < run.jobs.size();) {
    exchange::Message message = [&] {
      const scene::TraceScope timing(settings.compositing, "wait");
      return run.transport.receive(Channel::tiles);
    }();
    std::optional<compositor::AssembledFrame> assembled;
    {
      const scene::TraceScope timing(settings.compositing, "assemble");
      assembled = assembly.accept(std::move(message));
    }
    if (!assembled) continue;
    for (const int projector : settings.roles.projectors)
      run.transport.send(projector, Channel::frames, exchange::begin_message(exchange::MessageKind::frame_left));
    FinishedFrame finished{
        assembled->frame - run.first, std::move(assembled->image), std::move(assembled->deep), {}, 0};
    const auto now = std::chrono::steady_clock::now();
    finished.frame_ms = std::chrono::duration<double, std::milli>(now - std::exchange(last, now)).count();
    const exchange::FrameEnd& sums = assembled->sums;
    FrameStatistics& statistics = finished.statistics;
    static_cast<scene::FrameCounters&>(statistics) = sums.counters;
    statistics.on_lattice = sums.on_lattice > 0;
    statistics.deep_samples = finished.deep.samples.size();
    statistics.instruction_set = projection::instruction_set();
    statistics.integrator = integrator.name();
    statistics.composited_on = run.device.name;
    if (sums.failed_devices > 0)
      statistics.composited_on += fmt::format("; {} failed, so the CPU composited the rest", sums.failed_devices);
    finished.stopped = sums.stopped > 0;
    finished.overlapping = sums.overlapping > 0;
    ++left;
    guarded([&] { callbacks.frame(std::move(finished)); });
  }
  return thrown;
}

}  // namespace tessera::frame
