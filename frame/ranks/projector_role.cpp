// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>

#include "compositor/gl/cell_sink.hpp"
#include "compositor/pixel_sink.hpp"
#include "compositor/run_sink.hpp"
#include "compositor/segment_sink.hpp"
#include "exchange/outbox.hpp"
#include "frame/mesh/frame_projector.hpp"
#include "frame/mesh/lattice_frame.hpp"
#include "frame/ranks/distributed_roles.hpp"
#include "scene/frame_watch.hpp"

namespace tessera::frame {
namespace {

using exchange::Channel;

/// Waits until one more frame has left the assembling rank.
void wait_for_frame(const DistributedRun& run) {
  exchange::MessageReader(run.transport.receive(Channel::frames), exchange::MessageKind::frame_left).finish();
}

/// Waits until at most `in_flight - 1` earlier frames are in progress.
void wait_for_turn(const DistributedRun& run, std::size_t frame, std::size_t& left) {
  const auto in_flight = static_cast<std::size_t>(run.settings.render.ranks.frames_in_flight);
  if (frame < left + in_flight) return;
  const scene::TraceScope timing(run.settings.projecting, "wait", static_cast<std::int32_t>(run.first + frame));
  for (; frame >= left + in_flight; ++left) wait_for_frame(run);
}

/// Returns one flag per projector: 1 for this rank and the members of its team.
std::vector<std::uint8_t> projectors_here(const DistributedRun& run, const exchange::HostTeam* team) {
  std::vector<std::uint8_t> here;
  for (const int rank : run.settings.roles.projectors)
    here.push_back(rank == run.transport.rank() ||
                           (team != nullptr && std::ranges::find(team->ranks(), rank) != team->ranks().end())
                       ? 1
                       : 0);
  return here;
}

/// The index of this rank among the projectors, 0 .. N-1.
int number_of(const DistributedRun& run) {
  const auto& projectors = run.settings.roles.projectors;
  return static_cast<int>(std::find(projectors.begin(), projectors.end(), run.transport.rank()) - projectors.begin());
}

exchange::FrameEnd counts_of(const FrameStatistics& s) { return {s, s.on_lattice ? 1u : 0u, 0, 0}; }

/// The sinks of a frame, and the objects to which they refer.
class FrameSinks {
 public:
  /// `packs(tile)` returns whether the tile's pixels leave this process.
  FrameSinks(const DistributedRun& run, const FrameJob& job, const ProjectorMesh& mesh, bool has_all_cells,
             std::function<bool(std::size_t tile)> packs, exchange::PartWriter::Deliver deliver)
      : settings_(run.settings),
        makes_pixels_(has_all_cells && run.settings.exchange == Exchange::runs &&
                      run.settings.render.mesh.device.backends.empty()),
        packs_(std::move(packs)),
        mesh_(mesh),
        deliver_(std::move(deliver)),
        cut_(exchange_budget(run.settings).cut),
        space_(job.camera, job.size),
        integrator_(run.function, integrator_of(settings_.render, settings_.frame), settings_.render.emission),
        surfaces_(settings_.render.surfaces, run.function),
        normals_(mesh.part),
        scene_{&space_, &integrator_, 1} {
    if (settings_.render.mesh.shading) light_.emplace(*settings_.render.mesh.shading, job.camera);
    const double max_color = light_ ? light_->brightest(run.function.max_color()) : run.function.max_color();
    scene_.left_out_per_transmittance =
        std::max(integrals::opacity_weight(max_color, mesh.diagonal, settings_.render.emission), surfaces_.max_color());
    if (!surfaces_.empty()) scene_.surfaces = &surfaces_;
    if (light_) scene_.light = &*light_, scene_.normals = &normals_;
    // In double precision, runs also end at the triangles of other ranks (FaceMarks); on the lattice, they do not.
    const bool runs_end_at_faces = settings_.render.surfaces.has_faces() && settings_.exchange == Exchange::runs;
    if (!runs_end_at_faces || makes_pixels_)
      lattice_ = lattice_of(space_, mesh.box, mesh.scalar_range, run.function, settings_.render, settings_.frame);
    if (!lattice_) return;
    table_.emplace(lattice_->function, lattice_->lattice, settings_.render.emission);
    surfaces_.place_on(lattice_->lattice);
    scene_.table = &*table_;
    scene_.lattice = lattice_->lattice;
  }
  FrameSinks(const FrameSinks&) = delete;
  FrameSinks& operator=(const FrameSinks&) = delete;

  [[nodiscard]] const projection::PixelSpace& space() const { return space_; }
  [[nodiscard]] const std::optional<FrameLattice>& lattice() const { return lattice_; }
  [[nodiscard]] const scene::SurfaceSet& surfaces() const { return surfaces_; }
  [[nodiscard]] const projection::MatterLight* light() const { return scene_.light; }

  [[nodiscard]] std::unique_ptr<compositor::TileSink<sorting::DoubleEncoding>> make() const {
    if (makes_pixels_)
      return std::make_unique<compositor::PixelSink<sorting::DoubleEncoding>>(scene_, packs_, deliver_);
    if (settings_.render.mesh.rasterizer == Rasterizer::scanline)
      return std::make_unique<compositor::TupleSink>(mesh_.longest_edge, deliver_);
    if (settings_.exchange == Exchange::segments)
      return std::make_unique<compositor::SegmentSink<sorting::DoubleEncoding>>(
          mesh_.part.association == scene::Association::cell, mesh_.global_tet, deliver_, scene_.normals);
    return std::make_unique<compositor::RunSink<sorting::DoubleEncoding>>(scene_, cut_, deliver_);
  }
  /// Whether devices rasterize cells. If they cannot integrate the light of segments (GlMerger), the CPU does all the
  /// work.
  [[nodiscard]] bool have_cells() const {
    return settings_.render.mesh.rasterizer == Rasterizer::device && (lattice_ || integrator_.samples() > 0);
  }
  [[nodiscard]] std::unique_ptr<compositor::CellSink> make_for_cells() const {
    return std::make_unique<compositor::CellSink>(mesh_.global_tet, deliver_);
  }
  [[nodiscard]] std::unique_ptr<compositor::TileSink<sorting::LatticeEncoding>> make_on_lattice() const {
    if (makes_pixels_)
      return std::make_unique<compositor::PixelSink<sorting::LatticeEncoding>>(scene_, packs_, deliver_);
    if (settings_.exchange == Exchange::segments)
      return std::make_unique<compositor::SegmentSink<sorting::LatticeEncoding>>(
          lattice_->lattice, deliver_, light_ && mesh_.part.association == scene::Association::point);
    return std::make_unique<compositor::RunSink<sorting::LatticeEncoding>>(scene_, cut_, deliver_);
  }

 private:
  const DistributedSettings& settings_;
  bool makes_pixels_;  ///< instead of runs
  std::function<bool(std::size_t tile)> packs_;
  const ProjectorMesh& mesh_;
  exchange::PartWriter::Deliver deliver_;
  std::uint64_t cut_;
  projection::PixelSpace space_;
  integrals::SegmentIntegrator integrator_;
  scene::SurfaceSet surfaces_;
  projection::MeshNormals normals_;
  std::optional<projection::MatterLight> light_;
  compositor::TileScene scene_;
  std::optional<FrameLattice> lattice_;
  std::optional<integrals::LaneTable> table_;
};

/// Returns, for each compositor c, the team member that is this compositor; -1: no member.
std::vector<int> members_that_composite(const DistributedRun& run, const exchange::HostTeam& team) {
  std::vector<int> members;
  for (const int rank : run.settings.roles.compositors) {
    const auto found = std::find(team.ranks().begin(), team.ranks().end(), rank);
    members.push_back(found != team.ranks().end() ? static_cast<int>(found - team.ranks().begin()) : -1);
  }
  return members;
}

/// Projects frame `number` and sends the output of its sinks.
void project_frame(const DistributedRun& run, const FrameJob& job, std::int32_t number, LoadedMesh& loaded,
                   exchange::Outbox& outbox) {
  const DistributedSettings& settings = run.settings;
  const ProjectorMesh& mesh = loaded.mesh();
  const projection::TileGrid grid{job.size, settings.render.mesh.tile_size};
  const exchange::TileMap map(grid.count(), static_cast<int>(settings.roles.compositors.size()),
                              settings.render.ranks.tile_seed);
  const std::size_t projectors = loaded.team() != nullptr ? loaded.team()->ranks().size() : 1;
  const auto packs = [&](std::size_t tile) {
    const int compositor = settings.roles.compositors[static_cast<std::size_t>(map.owner(tile))];
    return compositor != run.transport.rank() || compositor != settings.roles.assembler();
  };
  const bool has_all_cells = projectors == settings.roles.projectors.size();
  const FrameSinks sinks(run, job, mesh, has_all_cells, packs, [&](exchange::TilePart part) {
    const scene::TraceScope timing(settings.projecting, "pack", number, part.records.size(), 0);
    outbox.put(std::move(part));
  });
  const std::vector<projection::SurfaceFaces> faces =
      faces_of(settings.render.surfaces, sinks.surfaces(), loaded.boundary(), projectors_here(run, loaded.team()));
  std::vector<int> members;
  TeamTask team;
  if (loaded.team() != nullptr) {
    members = members_that_composite(run, *loaded.team());
    team = {.team = loaded.team(),
            .preferred = [&](std::size_t tile) { return members[static_cast<std::size_t>(map.owner(tile))]; },
            .skip = [&](std::size_t tile) { outbox.pass(static_cast<std::uint32_t>(tile)); },
            .before_waiting = [&] { outbox.flush(); }};
  }
  bool announced = false, stopped = false;
  const auto announce = [&](const std::vector<bool>& has_any) {
    announced = true;
    outbox.begin_frame(static_cast<std::uint32_t>(number), map, has_any,
                       {.longest_ray = mesh.diagonal,
                        .tiles = 0,
                        .longest_edge = mesh.longest_edge,
                        .stopped = stopped ? 1u : 0u,
                        .on_lattice = sinks.lattice() ? 1u : 0u,
                        .box = mesh.box,
                        .scalar_range = mesh.scalar_range});
  };
  TileSinks tile_sinks{.in_double = [&] { return sinks.make(); },
                       .on_lattice = [&] { return sinks.make_on_lattice(); },
                       .announce = announce};
  if (run.device.everywhere && sinks.have_cells()) tile_sinks.of_cells = [&] { return sinks.make_for_cells(); };
  scene::FrameWatch watch(run.stop);
  exchange::FrameEnd end{};
  run.transport.set_working(true);
  if (loaded.team() != nullptr) loaded.team()->begin();
  try {
    end = counts_of(
        loaded.projector().project({.space = &sinks.space(),
                                    .grid = grid,
                                    .function = &run.function,
                                    .surfaces = &sinks.surfaces(),
                                    .faces = faces,
                                    .lattice = sinks.lattice() ? &sinks.lattice()->lattice : nullptr,
                                    .magnified = sinks.lattice() ? std::span(std::as_const(sinks.lattice()->magnified))
                                                                 : std::span<const scene::MagnifiedRange>(),
                                    .light = sinks.light(),
                                    .number = number,
                                    .longest_edge = mesh.longest_edge,
                                    .longest_ray = mesh.box.empty() ? 0 : glm::length(mesh.box.high - mesh.box.low),
                                    .watch = &watch},
                                   tile_sinks, team));
  } catch (const scene::FrameStopped&) {
    // The other ranks wait for the announced tiles, so the frame ends here, without fragments.
    stopped = true;
    if (loaded.team() != nullptr) loaded.team()->leave();
    if (!announced) announce(std::vector<bool>(grid.count(), false));
    outbox.end_tiles();
    end.stopped = 1;
  }
  run.transport.set_working(false);
  outbox.end_frame(end);
}

}  // namespace

void run_projector(const DistributedRun& run, LoadedMesh& loaded) {
  const DistributedSettings& settings = run.settings;
  const ExchangeBudget budget = exchange_budget(settings);
  scene::Trace* const trace = settings.projecting;
  exchange::Outbox outbox(run.transport,
                          {settings.roles.compositors, budget.window, budget.backlog, trace, number_of(run)});
  std::size_t left = 0;  // frames that have left the assembling rank
  for (std::size_t frame = 0; frame < run.jobs.size(); ++frame) {
    const FrameJob& job = run.jobs[frame];
    loaded.load(job.mesh);
    const auto number = static_cast<std::int32_t>(run.first + frame);
    if (trace != nullptr) trace->set_frame(number);
    wait_for_turn(run, frame, left);
    const double start_us = trace != nullptr ? trace->now_us() : 0;
    project_frame(run, job, number, loaded, outbox);
    if (trace != nullptr) trace->add_frame(number, start_us);
  }
  // Waits, so that no frames are in progress when the next list begins.
  for (; left < run.jobs.size(); ++left) wait_for_frame(run);
}

}  // namespace tessera::frame
