// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/frame_projector.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <glm/geometric.hpp>
#include <mutex>
#include <optional>

#include "frame/mesh/double_source.hpp"
#include "frame/mesh/lattice_frame.hpp"
#include "frame/mesh/lattice_source.hpp"
#include "frame/mesh/tile_renderer.hpp"
#include "scene/error.hpp"
#include "scene/threads.hpp"

namespace tessera::frame {

/// The result of culling a frame.
struct FrameProjector::Culled {
  std::vector<projection::Step> steps;  ///< steps of the transfer function and of surfaces
  projection::CellsAtSteps at_steps;    ///< cells whose segments are cut at the steps
  projection::TileLists lists;
  std::optional<projection::FrameFaces> faces;
};

namespace {

std::shared_ptr<const projection::PreparedMesh> prepared(const scene::TetMeshView& mesh, const Settings& settings) {
  return scene::with_threads(settings.threads, [&] {
    const scene::TraceScope timing(settings.trace, "prepare");
    return std::make_shared<const projection::PreparedMesh>(mesh);
  });
}

/// Resizes `array` to `size` uninitialized elements, in the team's memory if there is one.
template <class T>
void make_room(projection::LargeArray<T>& array, std::size_t size, scene::Team* team, scene::Team::Room room) {
  if (team == nullptr)
    array.reset(size);
  else
    array.refer(team->memory_of<T>(room, size), size);
}

void check_scanline(const FrameTask& frame, const projection::ProjectedMesh& projected, float longest_edge) {
  if (frame.space->perspective())
    throw scene::bad_input(
        "`rasterizer` scanline: it projects orthographically only; use an orthographic view, or `rasterizer` planes");
  if (!projection::fits_scanline(projected, longest_edge))
    throw scene::bad_input(
        "`rasterizer` scanline: its 32-bit floats do not hold this scene's depths, pixels or scalars; use `rasterizer` "
        "planes");
}

/// Returns the optical depth of a ray of this length if it meets all of the function's scalars equally often.
double usual_optical_depth(const scene::TransferFunction& function, double length) {
  const auto knots = function.knots();
  double sum = 0;
  for (std::size_t i = 1; i < knots.size(); ++i)
    sum += (knots[i].value - knots[i - 1].value) * (knots[i].extinction + knots[i - 1].extinction) / 2;
  const double span = knots.back().value - knots.front().value;
  return length * (span > 0 ? sum / span : knots.front().extinction);
}
constexpr double opaque_depth = 40;  // optical depth; a ray that ends at a transmittance of 1e-3 reaches a sixth of it

/// One thread's part of a frame. It renders tiles one after the other.
class TileWorker {
 public:
  TileWorker() = default;
  TileWorker(const TileWorker&) = delete;
  TileWorker& operator=(const TileWorker&) = delete;
  virtual ~TileWorker() = default;
  virtual void render(std::size_t tile, const scene::PixelRect& rect, std::span<projection::TileEntry> entries) = 0;
  virtual void add_to(FrameStatistics& statistics) const = 0;
};

template <class Source>
class Worker final : public TileWorker {
 public:
  using Sink = typename TileRenderer<Source>::Sink;
  template <class... More>
  Worker(std::unique_ptr<Sink> sink, std::unique_ptr<compositor::CellSink> cells, const TileContext& context,
         const More&... more)
      : context_(context), renderer_(context, more...), sink_(std::move(sink)), cells_(std::move(cells)) {}
  void render(std::size_t tile, const scene::PixelRect& rect, std::span<projection::TileEntry> entries) override {
    const scene::TraceTile of_tile(context_.trace, tile);
    if (cells_ != nullptr) {
      const scene::TraceScope timing(context_.trace, "project");
      entries = cells_->take(tile, rect, *context_.projected, context_.at_steps, entries);
    }
    sink_->begin_tile(tile, rect);
    if (cells_ == nullptr || !entries.empty()) renderer_.render(rect, entries, *sink_);
    sink_->end_tile();
  }
  void add_to(FrameStatistics& statistics) const override {
    const TileCounts& counts = renderer_.counts();
    statistics.segments += sink_->segments();
    statistics.max_segments_alive = std::max(statistics.max_segments_alive, counts.max_segments_alive);
    statistics.peak_buffer_bytes += counts.peak_bytes;
    statistics.exact_sign_tests += counts.raster.exact_sign_tests;
    statistics.unpaired += counts.raster.unpaired;
    statistics.segments_in_double_precision += counts.raster.irregular_segments;
    statistics.tiles_split += counts.tiles_split;
    if (cells_ != nullptr) statistics.cells_on_device += cells_->cells();
  }

 private:
  TileContext context_;
  TileRenderer<Source> renderer_;
  std::unique_ptr<Sink> sink_;
  std::unique_ptr<compositor::CellSink> cells_;  ///< null: the CPU rasterizes all cells
};

/// Returns the remaining memory budget for segments, which the threads share.
std::uint64_t segment_budget(const Settings& settings, std::uint64_t held, int threads) {
  const std::uint64_t least = held + static_cast<std::uint64_t>(threads) * (1u << 20);
  if (settings.memory_bytes < least)
    throw scene::bad_input(
        fmt::format("`memory`: {} MiB of it are left for projection, which needs at least {} MiB for this mesh and "
                    "image; raise `memory`",
                    settings.memory_bytes >> 20, (least >> 20) + 1));
  return (settings.memory_bytes - held) / static_cast<std::uint64_t>(threads);
}

using Workers = tbb::enumerable_thread_specific<std::unique_ptr<TileWorker>>;

/// Runs TileSinks::prepare in parallel with other work. The destructor waits for it.
class SideTask {
 public:
  SideTask(const std::function<void()>& work, scene::Trace* trace, std::int32_t frame) {
    if (!work) return;
    group_.run([&work, trace, frame] {
      const scene::TraceScope timing(trace, "prepare", frame);
      work();
    });
  }
  ~SideTask() {
    if (waited_for_) return;
    try {
      group_.wait();
    } catch (...) {  // the frame ends with an earlier error
    }
  }
  SideTask(const SideTask&) = delete;
  SideTask& operator=(const SideTask&) = delete;
  /// Throws the exception of the work.
  void wait() {
    waited_for_ = true;
    group_.wait();
  }

 private:
  tbb::task_group group_;
  bool waited_for_ = false;
};

/// The process that renders a tile.
enum class Owner : std::uint8_t { none, self, another, first_to_come };

/// Returns the owner of each tile. A single process owns the tiles that have cells or triangles. Half of the cells are
/// distributed to the members of a team in advance, in equal numbers: a tile goes to the preferred member, unless this
/// member is ahead of another by more than a hundredth of its share; it then goes to the member that has the fewest
/// cells. The members take the remaining tiles, which come last, one by one, so that no member waits for a slower one
/// at the end.
std::vector<Owner> share_out(const FrameTask& frame, const TeamTask& team, const projection::TileLists& lists,
                             const projection::FrameFaces* faces) {
  std::vector<Owner> owners(frame.grid.count(), Owner::none);
  std::uint64_t all = 0;
  for (std::size_t tile = 0; tile < owners.size(); ++tile) {
    if (lists.entry_count(tile) > 0 || (faces != nullptr && faces->owns_in(tile))) owners[tile] = Owner::self;
    all += lists.entry_count(tile);
  }
  if (team.team == nullptr) return owners;
  std::vector<std::uint64_t> given(static_cast<std::size_t>(team.team->size()));
  const std::uint64_t most_ahead = all / given.size() / 100;
  std::uint64_t shared_out = 0;
  for (std::size_t tile = 0; tile < owners.size(); ++tile) {
    if (owners[tile] == Owner::none) continue;
    if (2 * shared_out >= all) {
      owners[tile] = Owner::first_to_come;
      continue;
    }
    auto least = std::min_element(given.begin(), given.end());
    const int preferred = team.preferred ? team.preferred(tile) : -1;
    if (preferred >= 0 && given[static_cast<std::size_t>(preferred)] <= *least + most_ahead)
      least = given.begin() + preferred;
    *least += lists.entry_count(tile);
    shared_out += lists.entry_count(tile);
    owners[tile] = least - given.begin() == team.team->rank() ? Owner::self : Owner::another;
  }
  return owners;
}

void announce(const TileSinks& sinks, const std::vector<Owner>& owners) {
  if (!sinks.announce) return;
  std::vector<bool> may_come(owners.size());
  for (std::size_t tile = 0; tile < owners.size(); ++tile)
    may_come[tile] = owners[tile] == Owner::self || owners[tile] == Owner::first_to_come;
  sinks.announce(may_come);
}

/// The tiles that a team's members take one by one, shared by the threads of one member.
class SharedTiles {
 public:
  SharedTiles(const TeamTask& team, const std::vector<Owner>& owners) : team_(&team) {
    for (std::size_t tile = 0; tile < owners.size(); ++tile)
      if (owners[tile] == Owner::first_to_come) tiles_.push_back(tile);
  }
  /// Takes the next tile before `last`; returns `last` if there is none.
  std::size_t take(std::size_t last) {
    if (tiles_.empty()) return last;
    const auto count = static_cast<std::size_t>(std::lower_bound(tiles_.begin(), tiles_.end(), last) - tiles_.begin());
    const std::lock_guard lock(mutex_);  // tiles of this process's other threads are not skipped
    const std::size_t taken = team_->team->draw(static_cast<std::uint32_t>(count));
    for (; seen_ < taken; ++seen_)
      if (team_->skip) team_->skip(tiles_[seen_]);
    if (taken >= count) return last;
    ++seen_;
    return tiles_[taken];
  }

 private:
  const TeamTask* team_;
  std::vector<std::size_t> tiles_;
  std::mutex mutex_;
  std::size_t seen_ = 0;  ///< tiles that this process has taken or skipped
};

std::uint64_t members_of(const TeamTask& team) {
  return team.team != nullptr ? static_cast<std::uint64_t>(team.team->size()) : 1;
}

/// Renders tiles [first, last), whose lists have been filled.
void render_tiles(const FrameTask& frame, const scene::Image* image, projection::TileLists& lists,
                  const std::vector<Owner>& owners, SharedTiles& shared, Workers& workers, std::size_t first,
                  std::size_t last, const std::stop_token& stop) {
  // Threads take tiles in order, so that fragments leave in the same order on all processes.
  std::atomic<std::size_t> next = first;
  tbb::parallel_for(
      0, tbb::this_task_arena::max_concurrency(),
      [&](int) {
        TileWorker& worker = *workers.local();
        for (std::size_t tile = next++; tile < last; tile = next++) {
          scene::throw_if_stopped(stop);
          const scene::PixelRect rect = frame.grid.rect(tile);
          if (owners[tile] == Owner::self) worker.render(tile, rect, lists.tile(tile));
          if (image != nullptr && frame.watch != nullptr) frame.watch->finished(rect, *image);
        }
        for (std::size_t tile = shared.take(last); tile < last; tile = shared.take(last)) {
          scene::throw_if_stopped(stop);
          worker.render(tile, frame.grid.rect(tile), lists.tile(tile));
        }
      },
      tbb::simple_partitioner());
}

/// Returns the frame's function with every color replaced by the brightest color that lighting may make of it.
scene::TransferFunction brightest(const FrameTask& frame) {
  return frame.light != nullptr ? projection::brightest(frame.light->shading(), *frame.function) : *frame.function;
}

/// Statistics of this process's share and its workers.
FrameStatistics count(const FrameTask& frame, const TeamTask& team, const projection::PreparedMesh& mesh,
                      const projection::TileLists& lists, const Workers& workers) {
  constexpr std::size_t block = projection::PreparedMesh::block_tets;
  const scene::Share blocks = scene::share_of(mesh.block_count(), team.team);
  const projection::CullCounts& culled = lists.counts();
  FrameStatistics statistics;
  statistics.tets_total = std::min(blocks.last * block, mesh.tet_count()) - blocks.first * block;
  statistics.tets_invisible = culled.invisible;
  statistics.tets_outside_view = culled.outside_view;
  statistics.tets_between_pixels = culled.between_pixels;
  statistics.tets_projected = culled.projected;
  statistics.on_lattice = frame.lattice != nullptr;
  for (const std::unique_ptr<TileWorker>& worker : workers) worker->add_to(statistics);
  if (!statistics.on_lattice) statistics.segments_in_double_precision = statistics.segments;
  return statistics;
}

}  // namespace

FrameProjector::FrameProjector(const scene::TetMeshView& mesh, const Settings& settings)
    : FrameProjector(prepared(mesh, settings),
                     scene::with_threads(settings.threads, [&] { return scene::bounds(mesh); }), settings) {}

FrameProjector::FrameProjector(std::shared_ptr<const projection::PreparedMesh> mesh, const scene::Box& box,
                               const Settings& settings)
    : settings_(settings), arena_(scene::threads_for(settings.threads)), prepared_(std::move(mesh)), box_(box) {
  diagonal_ = box_.empty() ? 0 : glm::length(box_.high - box_.low);
  if (settings.mesh.rasterizer == Rasterizer::scanline)
    longest_edge_ = arena_.execute([&] { return projection::longest_edge(prepared_->mesh()); });
}

FrameStatistics FrameProjector::project(const FrameTask& frame, const TileSinks& sinks, const TeamTask& team) {
  return arena_.execute([&] { return project_in_arena(frame, sinks, team); });
}

FrameStatistics FrameProjector::project_in_arena(const FrameTask& frame, const TileSinks& sinks, const TeamTask& team) {
  const std::stop_token stop = frame.watch != nullptr ? frame.watch->stop() : std::stop_token();
  scene::throw_if_stopped(stop);
  SideTask side(sinks.prepare, settings_.trace, frame.number);
  projection::ProjectedMesh projected = transform(frame, team, stop);
  const projection::IsoView iso{frame.surfaces, frame.space, frame.lattice};
  if (frame.surfaces != nullptr && !frame.surfaces->iso_values().empty()) projected.iso = &iso;
  const float longest_edge = frame.longest_edge > 0 ? frame.longest_edge : longest_edge_;
  if (settings_.mesh.rasterizer == Rasterizer::scanline) {
    if (team.team != nullptr) team.team->barrier();  // the check reads all vertices
    check_scanline(frame, projected, longest_edge);
  }
  if (frame.lattice != nullptr) place_on_lattice(frame, team, stop);

  Culled culled = cull(frame, projected, team, stop);
  const projection::FrameFaces* const faces = culled.faces ? &*culled.faces : nullptr;
  const std::vector<Owner> owners = share_out(frame, team, culled.lists, faces);
  announce(sinks, owners);
  SharedTiles shared(team, owners);

  const std::uint64_t vertex_bytes = (vertices_.bytes() + lattice_vertices_.bytes()) / members_of(team);
  const std::uint64_t held =
      vertex_bytes + culled.lists.bytes() + (faces != nullptr ? faces->bytes() : 0) + sinks.kept_bytes;
  const TileContext context{.projected = &projected,
                            .depth_origin = culled.lists.depth_origin(),
                            .budget_bytes = segment_budget(settings_, held, arena_.max_concurrency()) / 4 * 3,
                            .trace = settings_.trace,
                            .rasterizer = settings_.mesh.rasterizer,
                            .longest_edge = longest_edge,
                            .opaque = usual_optical_depth(*frame.function, diagonal_) > opaque_depth,
                            .steps = culled.steps,
                            .at_steps = culled.at_steps.empty() ? nullptr : &culled.at_steps,
                            .faces = faces,
                            .stop = stop};
  Workers workers([&]() -> std::unique_ptr<TileWorker> {
    auto cells = sinks.of_cells ? sinks.of_cells() : nullptr;
    if (frame.lattice == nullptr)
      return std::make_unique<Worker<DoubleSource>>(sinks.in_double(), std::move(cells), context);
    const projection::LatticeView view{
        projected,
        {lattice_vertices_.data(), lattice_vertices_.size()},
        *frame.lattice,
        frame.space->perspective(),
        depth_limits_of(*frame.space, *frame.lattice, brightest(frame), settings_.emission, longest_ray(frame)),
        culled.steps,
        context.at_steps,
        frame.magnified,
        prepared_->mesh().association == scene::Association::point ? frame.light : nullptr,
        frame.space};
    return std::make_unique<Worker<LatticeSource>>(sinks.on_lattice(), std::move(cells), context, view);
  });
  side.wait();
  const std::uint64_t most_list_bytes =
      render_bands(frame, team, culled.lists, held, [&](std::size_t first, std::size_t last) {
        render_tiles(frame, sinks.image, culled.lists, owners, shared, workers, first, last, stop);
      });

  FrameStatistics statistics = count(frame, team, *prepared_, culled.lists, workers);
  statistics.peak_buffer_bytes += vertex_bytes + most_list_bytes;
  return statistics;
}

projection::ProjectedMesh FrameProjector::transform(const FrameTask& frame, const TeamTask& team,
                                                    const std::stop_token& stop) {
  const scene::TraceScope timing(settings_.trace, "transform", frame.number);
  const projection::PixelSpace& space = *frame.space;
  const std::span<const glm::dvec3> positions = prepared_->mesh().positions;
  make_room(vertices_, positions.size(), team.team, scene::Team::Room::vertices);
  const scene::Share own = scene::share_of(positions.size(), team.team);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(own.first, own.last, 4096), [&](const auto& range) {
    scene::throw_if_stopped(stop);
    const scene::TraceScope helping(settings_.trace, "transform", frame.number);
    const std::size_t n = range.end() - range.begin();
    space.project(positions.subspan(range.begin(), n), {vertices_.data() + range.begin(), n});
  });
  return {prepared_.get(),
          {vertices_.data(), vertices_.size()},
          space.near_depth(),
          space.far_depth(),
          space.pixels_per_tangent()};
}

void FrameProjector::place_on_lattice(const FrameTask& frame, const TeamTask& team, const std::stop_token& stop) {
  const scene::TetMeshView& mesh = prepared_->mesh();
  const bool per_point = mesh.association == scene::Association::point;
  make_room(lattice_vertices_, vertices_.size(), team.team, scene::Team::Room::lattice_vertices);
  const scene::Share own = scene::share_of(vertices_.size(), team.team);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(own.first, own.last, 4096), [&](const auto& range) {
    scene::throw_if_stopped(stop);
    const scene::TraceScope timing(settings_.trace, "transform");
    const std::size_t n = range.end() - range.begin();
    projection::make_lattice_vertices(
        std::span<const projection::PixelVertex>(vertices_.data() + range.begin(), n),
        per_point ? std::span(mesh.scalars).subspan(range.begin(), n) : std::span<const double>(), *frame.lattice,
        frame.space->perspective(), {lattice_vertices_.data() + range.begin(), n});
  });
}

FrameProjector::Culled FrameProjector::cull(const FrameTask& frame, const projection::ProjectedMesh& projected,
                                            const TeamTask& team, const std::stop_token& stop) {
  // Sampling methods do not guarantee an accuracy, so steps cannot violate it.
  const bool exact =
      settings_.mesh.rasterizer != Rasterizer::scanline &&
      (settings_.integrator.kind == IntegratorKind::exact || settings_.integrator.kind == IntegratorKind::automatic);
  const scene::TraceScope timing(settings_.trace, "cull", frame.number);
  std::vector<projection::Step> steps;
  projection::CellsAtSteps at_steps;
  if (exact || projected.iso != nullptr) {
    if (exact) steps = projection::steps_of(brightest(frame), settings_.emission, longest_ray(frame));
    steps = projection::with_cuts(std::move(steps), projected.iso, frame.magnified);
    at_steps = projection::CellsAtSteps(*prepared_, steps, longest_ray(frame), frame.lattice, frame.magnified, stop,
                                        team.team);
  }
  const bool shows_color_alone = settings_.emission == Emission::independent;
  using Faces = std::optional<projection::FrameFaces>;
  return {.steps = std::move(steps),
          .at_steps = std::move(at_steps),
          .lists = {projected,
                    frame.grid,
                    *frame.function,
                    shows_color_alone,
                    {settings_.trace, &list_buffers_, settings_.use.culling, stop, team.team}},
          .faces = frame.faces.empty() ? Faces() : Faces(std::in_place, frame.faces, *frame.space, frame.grid)};
}

/// Calls `render` for one band of tiles after another. The lists of a band take at most a quarter of the remaining
/// budget; the rest is for segments. Returns the largest number of bytes that the lists of a band took.
std::uint64_t FrameProjector::render_bands(const FrameTask& frame, const TeamTask& team, projection::TileLists& lists,
                                           std::uint64_t held,
                                           const std::function<void(std::size_t, std::size_t)>& render) const {
  const std::uint64_t most_entries =
      scene::least_of(
          std::max<std::uint64_t>(segment_budget(settings_, held, 1) / 4 / sizeof(projection::TileEntry), 1),
          team.team) *
      members_of(team);
  std::uint64_t most_bytes = 0;
  for (std::size_t first = 0; first < frame.grid.count();) {
    std::size_t last = first;
    for (std::uint64_t entries = 0; last < frame.grid.count(); ++last) {
      entries += lists.entry_count(last);
      if (last > first && entries > most_entries) break;
    }
    if (first > 0 && team.team != nullptr) {
      if (team.before_waiting) team.before_waiting();
      team.team->barrier();  // no member still reads the last band's lists
    }
    {
      const scene::TraceScope timing(settings_.trace, "bin", frame.number);
      lists.fill(first, last);
    }
    most_bytes = std::max<std::uint64_t>(most_bytes, lists.bytes());
    render(first, last);
    first = last;
  }
  return most_bytes;
}

}  // namespace tessera::frame
