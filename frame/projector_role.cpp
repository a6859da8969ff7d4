#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <memory>
#include <optional>

#include "compositor/run_sink.hpp"
#include "compositor/segment_sink.hpp"
#include "exchange/outbox.hpp"
#include "frame/distributed_roles.hpp"
#include "frame/frame_projector.hpp"
#include "frame/lattice_frame.hpp"
#include "scene/frame_watch.hpp"

namespace tessera::frame {
namespace {

using exchange::Channel;

/// Waits until one frame more has left the assembling rank.
void await_frame(const DistributedRun& run) {
  exchange::MessageReader(run.transport.receive(Channel::frames), exchange::MessageKind::frame_left).finish();
}

/// Waits until no more than `in_flight - 1` frames before this one are on their way.
void wait_for_turn(const DistributedRun& run, std::size_t frame, std::size_t& left) {
  const auto in_flight = static_cast<std::size_t>(run.settings.frames_in_flight);
  if (frame < left + in_flight) return;
  const scene::TraceScope timing(run.settings.projecting, "wait", static_cast<std::int32_t>(run.first + frame));
  for (; frame >= left + in_flight; ++left) await_frame(run);
}

exchange::FrameEnd counts_of(const FrameStatistics& s) { return {s, s.on_lattice ? 1u : 0u, 0, 0}; }

}  // namespace

void run_projector(const DistributedRun& run, LoadedMesh& loaded) {
  const DistributedSettings& settings = run.settings;
  const ExchangeBudget budget = exchange_budget(settings);
  RenderSettings render = settings.render;
  render.trace = settings.projecting;

  exchange::Outbox outbox(run.transport,
                          {settings.roles.compositors, budget.window, budget.backlog, settings.projecting});
  std::size_t left = 0;  // frames that have left the assembling rank
  for (std::size_t frame = 0; frame < run.jobs.size(); ++frame) {
    const FrameJob& job = run.jobs[frame];
    loaded.load(job.mesh);
    const ProjectorMesh& mesh = loaded.mesh();
    const auto number = static_cast<std::int32_t>(run.first + frame);
    if (render.trace != nullptr) render.trace->set_frame(number);
    wait_for_turn(run, frame, left);
    const double start_us = render.trace != nullptr ? render.trace->now_us() : 0;

    const projection::PixelSpace space(job.camera, job.size);
    const integrals::SegmentIntegrator integrator(run.function, render.integrator, render.emission);
    FrameProjector::Task task;
    task.space = &space;
    task.grid = {job.size, render.tile_size};
    task.function = &run.function;
    task.frame = number;
    task.longest_edge = mesh.longest_edge;
    task.longest_ray = mesh.box.empty() ? 0 : glm::length(mesh.box.high - mesh.box.low);
    const exchange::TileMap map(task.grid.count(), static_cast<int>(settings.roles.compositors.size()),
                                settings.tile_seed);
    const auto deliver = [&](exchange::TilePart part) {
      const scene::TraceScope timing(render.trace, "pack", number, part.records.size(), 0);
      outbox.put(std::move(part));
    };
    compositor::TileScene scene{&space, &integrator,
                                integrals::opacity_weight(run.function.max_color(), mesh.diagonal, render.emission)};
    task.make_sink = [&]() -> std::unique_ptr<compositor::TileSink<sorting::DoubleEncoding>> {
      if (render.rasterizer == Rasterizer::scanline)
        return std::make_unique<compositor::TupleSink>(mesh.longest_edge, deliver);
      if (settings.exchange == Exchange::segments)
        return std::make_unique<compositor::SegmentSink<sorting::DoubleEncoding>>(
            mesh.part.association == scene::Association::cell, mesh.global_tet, deliver);
      return std::make_unique<compositor::RunSink<sorting::DoubleEncoding>>(scene, budget.cut, deliver);
    };
    const std::optional<scene::Lattice> lattice =
        settings.deep ? std::nullopt : lattice_of(space, mesh.box, mesh.scalar_range, run.function, render);
    std::optional<integrals::LaneTable> table;
    if (lattice) {
      table.emplace(run.function, lattice->scalar_origin, lattice->scalar_unit, lattice->depth_unit, render.emission);
      scene.table = &*table;
      scene.lattice = *lattice;
      task.lattice = &*lattice;
      task.make_lattice_sink = [&]() -> std::unique_ptr<compositor::TileSink<sorting::LatticeEncoding>> {
        if (settings.exchange == Exchange::segments)
          return std::make_unique<compositor::SegmentSink<sorting::LatticeEncoding>>(*lattice, deliver);
        return std::make_unique<compositor::RunSink<sorting::LatticeEncoding>>(scene, budget.cut, deliver);
      };
    }
    bool announced = false, stopped = false;
    task.announce = [&](const std::vector<bool>& has_cells) {
      announced = true;
      outbox.begin_frame(static_cast<std::uint32_t>(number), map, has_cells,
                         {.longest_ray = mesh.diagonal,
                          .tiles = 0,
                          .longest_edge = mesh.longest_edge,
                          .stopped = stopped ? 1u : 0u,
                          .lattice = lattice.value_or(scene::Lattice{})});
    };
    scene::FrameWatch watch(run.stop);
    task.watch = &watch;
    exchange::FrameEnd end{};
    run.transport.set_working(true);
    try {
      end = counts_of(loaded.projector().project(task));
    } catch (const scene::FrameStopped&) {
      // The others wait for what they were told of: it ends here, empty.
      stopped = true;
      if (!announced) task.announce(std::vector<bool>(task.grid.count(), false));
      outbox.end_tiles();
      end.stopped = 1;
    }
    run.transport.set_working(false);
    outbox.end_frame(end);
    if (render.trace != nullptr) render.trace->add_frame(number, start_us);
  }
  // The next list begins with none on their way.
  for (; left < run.jobs.size(); ++left) await_frame(run);
}

}  // namespace tessera::frame
