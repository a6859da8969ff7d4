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
namespace {

void check_scanline(const FrameProjector::Task& task, const projection::ProjectedMesh& projected, float longest_edge) {
  if (task.team != nullptr) task.team->barrier();  // it looks at all vertices
  if (task.space->perspective())
    throw scene::bad_input(
        "`rasterizer` scanline: it projects orthographically only; use an orthographic view, or `rasterizer` planes");
  if (!projection::fits_scanline(projected, longest_edge))
    throw scene::bad_input(
        "`rasterizer` scanline: its 32-bit floats do not hold this scene's depths, pixels or scalars; use `rasterizer` "
        "planes");
}

/// Optical depth of a ray as long as `length` that meets all of the function's scalars equally often.
double usual_optical_depth(const scene::TransferFunction& function, double length) {
  const auto knots = function.knots();
  double sum = 0;
  for (std::size_t i = 1; i < knots.size(); ++i)
    sum += (knots[i].value - knots[i - 1].value) * (knots[i].extinction + knots[i - 1].extinction) / 2;
  const double span = knots.back().value - knots.front().value;
  return length * (span > 0 ? sum / span : knots.front().extinction);
}
constexpr double opaque_depth = 40;  // of which a ray that ends at a transmittance of 1e-3 sees a sixth

/// One thread's part in a frame: tiles, one after the other.
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
    statistics.tiles_split += counts.tiles_split;
    if (cells_ != nullptr) statistics.cells_on_device += cells_->cells();
  }

 private:
  TileContext context_;
  TileRenderer<Source> renderer_;
  std::unique_ptr<Sink> sink_;
  std::unique_ptr<compositor::CellSink> cells_;  ///< null: the CPU rasterizes all
};

/// What is left of the budget for segments, shared by the threads.
std::uint64_t segment_budget(const Settings& settings, std::uint64_t held, int threads) {
  const std::uint64_t least = held + static_cast<std::uint64_t>(threads) * (1u << 20);
  if (settings.memory_bytes < least)
    throw scene::bad_input(
        fmt::format("`memory`: projection has {} MiB of it and needs at least {} MiB for this mesh and image; raise it",
                    settings.memory_bytes >> 20, (least >> 20) + 1));
  return (settings.memory_bytes - held) / static_cast<std::uint64_t>(threads);
}

}  // namespace

void order_corners(scene::TetMesh& mesh, int threads, scene::Trace* trace) {
  const scene::TraceScope timing(trace, "prepare");
  tbb::task_arena(scene::threads_for(threads)).execute([&] { projection::order_corners(mesh); });
}

namespace {

std::shared_ptr<const projection::PreparedMesh> prepared(const scene::TetMeshView& mesh, const Settings& settings) {
  return tbb::task_arena(scene::threads_for(settings.threads)).execute([&] {
    const scene::TraceScope timing(settings.trace, "prepare");
    return std::make_shared<const projection::PreparedMesh>(mesh);
  });
}

}  // namespace

FrameProjector::FrameProjector(const scene::TetMeshView& mesh, const Settings& settings)
    : FrameProjector(prepared(mesh, settings), scene::bounds(mesh, settings.threads), settings) {}

FrameProjector::FrameProjector(std::shared_ptr<const projection::PreparedMesh> mesh, const scene::Box& box,
                               const Settings& settings)
    : settings_(settings), arena_(scene::threads_for(settings.threads)), prepared_(std::move(mesh)), box_(box) {
  diagonal_ = box_.empty() ? 0 : glm::length(box_.high - box_.low);
  if (settings.mesh.rasterizer == Rasterizer::scanline)
    longest_edge_ = arena_.execute([&] { return projection::longest_edge(prepared_->mesh()); });
}

namespace {

/// Room for `size` elements of no value, in the team's memory if there is one.
template <class T>
void make_room(projection::LargeArray<T>& array, std::size_t size, scene::Team* team, scene::Team::Room room) {
  if (team == nullptr)
    array.reset(size);
  else
    array.refer(team->memory_of<T>(room, size), size);
}

}  // namespace

void FrameProjector::project_vertices(const Task& task, const std::stop_token& stop) {
  const scene::TraceScope timing(settings_.trace, "transform", task.frame);
  const std::span<const glm::dvec3> positions = prepared_->mesh().positions;
  make_room(vertices_, positions.size(), task.team, scene::Team::Room::vertices);
  const scene::Share own = scene::share_of(positions.size(), task.team);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(own.first, own.last, 4096), [&](const auto& range) {
    scene::throw_if_stopped(stop);
    const scene::TraceScope helping(settings_.trace, "transform", task.frame);
    const std::size_t n = range.end() - range.begin();
    task.space->project(positions.subspan(range.begin(), n), {vertices_.data() + range.begin(), n});
  });
}

void FrameProjector::place_on_lattice(const Task& task, const std::stop_token& stop) {
  const scene::TetMeshView& mesh = prepared_->mesh();
  const bool per_point = mesh.association == scene::Association::point;
  make_room(lattice_vertices_, vertices_.size(), task.team, scene::Team::Room::lattice_vertices);
  const scene::Share own = scene::share_of(vertices_.size(), task.team);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(own.first, own.last, 4096), [&](const auto& range) {
    scene::throw_if_stopped(stop);
    const scene::TraceScope timing(settings_.trace, "transform");
    const std::size_t n = range.end() - range.begin();
    projection::make_lattice_vertices(
        std::span<const projection::PixelVertex>(vertices_.data() + range.begin(), n),
        per_point ? std::span(mesh.scalars).subspan(range.begin(), n) : std::span<const double>(), *task.lattice,
        task.space->perspective(), {lattice_vertices_.data() + range.begin(), n});
  });
}

FrameStatistics FrameProjector::project(const Task& task) {
  return arena_.execute([&] { return project_in_arena(task); });
}

namespace {

using Workers = tbb::enumerable_thread_specific<std::unique_ptr<TileWorker>>;

/// Who makes a tile.
enum class Maker : std::uint8_t { nobody, self, another, first_to_come };

/// Who makes which tile: of a process alone, itself those that have cells or triangles. A team's members get half of
/// the cells beforehand, equally many each: a tile goes to the one that is preferred, unless that has a hundredth more
/// than another, then to the one that has least. The rest, the tiles that come last, are drawn one by one, so that none
/// waits for a slower one at the end.
std::vector<Maker> makers(const FrameProjector::Task& task, const projection::TileLists& lists,
                          const projection::FrameFaces* faces) {
  std::vector<Maker> made_by(task.grid.count(), Maker::nobody);
  std::uint64_t all = 0;
  for (std::size_t tile = 0; tile < made_by.size(); ++tile) {
    if (lists.entry_count(tile) > 0 || (faces != nullptr && faces->owns_in(tile))) made_by[tile] = Maker::self;
    all += lists.entry_count(tile);
  }
  if (task.team == nullptr) return made_by;
  std::vector<std::uint64_t> given(static_cast<std::size_t>(task.team->size()));
  const std::uint64_t most_ahead = all / given.size() / 100;
  std::uint64_t shared_out = 0;
  for (std::size_t tile = 0; tile < made_by.size(); ++tile) {
    if (made_by[tile] == Maker::nobody) continue;
    if (2 * shared_out >= all) {
      made_by[tile] = Maker::first_to_come;
      continue;
    }
    auto least = std::min_element(given.begin(), given.end());
    const int preferred = task.preferred ? task.preferred(tile) : -1;
    if (preferred >= 0 && given[static_cast<std::size_t>(preferred)] <= *least + most_ahead)
      least = given.begin() + preferred;
    *least += lists.entry_count(tile);
    shared_out += lists.entry_count(tile);
    made_by[tile] = least - given.begin() == task.team->rank() ? Maker::self : Maker::another;
  }
  return made_by;
}

void announce(const FrameProjector::Task& task, const std::vector<Maker>& made_by) {
  if (!task.announce) return;
  std::vector<bool> may_come(made_by.size());
  for (std::size_t tile = 0; tile < made_by.size(); ++tile)
    may_come[tile] = made_by[tile] == Maker::self || made_by[tile] == Maker::first_to_come;
  task.announce(may_come);
}

/// The tiles that a team's members draw, for the threads of one.
class DrawnTiles {
 public:
  DrawnTiles(const FrameProjector::Task& task, const std::vector<Maker>& made_by) : task_(&task) {
    for (std::size_t tile = 0; tile < made_by.size(); ++tile)
      if (made_by[tile] == Maker::first_to_come) tiles_.push_back(tile);
  }
  /// The next tile before `last`; `last` if there is none.
  std::size_t next(std::size_t last) {
    if (tiles_.empty()) return last;
    const auto count = static_cast<std::size_t>(std::lower_bound(tiles_.begin(), tiles_.end(), last) - tiles_.begin());
    const std::lock_guard lock(mutex_);  // what other threads of this process draw is not another member's
    const std::size_t drawn = task_->team->draw(static_cast<std::uint32_t>(count));
    for (; passed_ < drawn; ++passed_)
      if (task_->pass) task_->pass(tiles_[passed_]);
    if (drawn >= count) return last;
    ++passed_;
    return tiles_[drawn];
  }

 private:
  const FrameProjector::Task* task_;
  std::vector<std::size_t> tiles_;
  std::mutex mutex_;
  std::size_t passed_ = 0;  ///< that this process has drawn or passed
};

std::uint64_t members_of(const FrameProjector::Task& task) {
  return task.team != nullptr ? static_cast<std::uint64_t>(task.team->size()) : 1;
}

void count_culled(const projection::CullCounts& culled, FrameStatistics& statistics) {
  statistics.tets_invisible = culled.invisible;
  statistics.tets_outside_view = culled.outside_view;
  statistics.tets_between_pixels = culled.between_pixels;
  statistics.tets_projected = culled.projected;
}

/// Of this process's share and its workers.
FrameStatistics counted(const FrameProjector::Task& task, const projection::PreparedMesh& mesh,
                        const projection::TileLists& lists, const Workers& workers) {
  constexpr std::size_t block = projection::PreparedMesh::block_tets;
  const scene::Share blocks = scene::share_of(mesh.block_count(), task.team);
  FrameStatistics statistics;
  statistics.tets_total = std::min(blocks.last * block, mesh.tet_count()) - blocks.first * block;
  statistics.on_lattice = task.lattice != nullptr;
  count_culled(lists.counts(), statistics);
  for (const std::unique_ptr<TileWorker>& worker : workers) worker->add_to(statistics);
  return statistics;
}

/// Renders tiles [first, last) of a task, whose lists are filled.
void render_tiles(const FrameProjector::Task& task, projection::TileLists& lists, const std::vector<Maker>& made_by,
                  DrawnTiles& drawn, Workers& workers, std::size_t first, std::size_t last,
                  const std::stop_token& stop) {
  // Threads draw tiles in order: fragments then leave in the order in which all processes send them.
  std::atomic<std::size_t> next = first;
  tbb::parallel_for(
      0, tbb::this_task_arena::max_concurrency(),
      [&](int) {
        TileWorker& worker = *workers.local();
        for (std::size_t tile = next++; tile < last; tile = next++) {
          scene::throw_if_stopped(stop);
          const scene::PixelRect rect = task.grid.rect(tile);
          if (made_by[tile] == Maker::self) worker.render(tile, rect, lists.tile(tile));
          if (task.image != nullptr && task.watch != nullptr) task.watch->finished(rect, *task.image);
        }
        for (std::size_t tile = drawn.next(last); tile < last; tile = drawn.next(last)) {
          scene::throw_if_stopped(stop);
          worker.render(tile, task.grid.rect(tile), lists.tile(tile));
        }
      },
      tbb::simple_partitioner());
}

}  // namespace

namespace {

/// A task's work beside the mesh, ended when this is.
class Beside {
 public:
  Beside(const FrameProjector::Task& task, scene::Trace* trace) {
    if (!task.beside) return;
    group_.run([&task, trace] {
      const scene::TraceScope timing(trace, "prepare", task.frame);
      task.beside();
    });
  }
  ~Beside() {
    if (waited_for_) return;
    try {
      group_.wait();
    } catch (...) {  // the frame ends with another error
    }
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;
  /// Throws what the work threw.
  void wait() {
    waited_for_ = true;
    group_.wait();
  }

 private:
  tbb::task_group group_;
  bool waited_for_ = false;
};

}  // namespace

FrameStatistics FrameProjector::project_in_arena(const Task& task) {
  const projection::PixelSpace& space = *task.space;
  const std::stop_token stop = task.watch != nullptr ? task.watch->stop() : std::stop_token();
  scene::throw_if_stopped(stop);
  Beside beside(task, settings_.trace);
  project_vertices(task, stop);
  projection::ProjectedMesh projected{prepared_.get(),
                                      {vertices_.data(), vertices_.size()},
                                      space.near_depth(),
                                      space.far_depth(),
                                      space.pixels_per_tangent()};
  const projection::IsoView iso{task.surfaces, &space, task.lattice};
  if (task.surfaces != nullptr && !task.surfaces->iso_values().empty()) projected.iso = &iso;
  const float longest_edge = task.longest_edge > 0 ? task.longest_edge : longest_edge_;
  if (settings_.mesh.rasterizer == Rasterizer::scanline) check_scanline(task, projected, longest_edge);
  if (task.lattice != nullptr) place_on_lattice(task, stop);

  const double longest_ray = task.longest_ray > 0 ? task.longest_ray : diagonal_;
  // Sampling promises nothing that steps could break.
  const bool exact = settings_.mesh.rasterizer != Rasterizer::scanline &&
                     (settings_.integrator.kind == scene::IntegratorKind::exact ||
                      settings_.integrator.kind == scene::IntegratorKind::automatic);
  std::vector<projection::Step> steps;
  projection::CellsAtSteps at_steps;
  std::optional<projection::TileLists> lists;
  std::optional<projection::FrameFaces> faces;
  {
    const scene::TraceScope timing(settings_.trace, "cull", task.frame);
    if (exact || projected.iso != nullptr) {
      if (exact) steps = projection::steps_of(*task.function, settings_.emission, longest_ray);
      steps = projection::with_surfaces(std::move(steps), projected.iso);
      at_steps = projection::CellsAtSteps(*prepared_, steps, longest_ray, task.lattice, stop, task.team);
    }
    lists.emplace(projected, task.grid, *task.function, settings_.emission == scene::Emission::independent,
                  settings_.trace, &list_buffers_, settings_.use.culling, stop, task.team);
    if (!task.faces.empty()) faces.emplace(task.faces, space, task.grid);
  }
  const projection::FrameFaces* const faces_or_null = faces ? &*faces : nullptr;
  const std::vector<Maker> made_by = makers(task, *lists, faces_or_null);
  announce(task, made_by);
  DrawnTiles drawn(task, made_by);

  const std::uint64_t vertex_bytes = (vertices_.bytes() + lattice_vertices_.bytes()) / members_of(task);
  const std::uint64_t held = vertex_bytes + lists->bytes() + (faces ? faces->bytes() : 0) + task.kept_bytes;
  const TileContext context{&projected,
                            lists->depth_origin(),
                            segment_budget(settings_, held, arena_.max_concurrency()) / 4 * 3,
                            settings_.trace,
                            settings_.mesh.rasterizer,
                            longest_edge,
                            usual_optical_depth(*task.function, diagonal_) > opaque_depth,
                            steps,
                            at_steps.empty() ? nullptr : &at_steps,
                            faces_or_null,
                            stop};
  Workers workers([&]() -> std::unique_ptr<TileWorker> {
    auto cells = task.make_cell_sink ? task.make_cell_sink() : nullptr;
    if (task.lattice == nullptr)
      return std::make_unique<Worker<DoubleSource>>(task.make_sink(), std::move(cells), context);
    const projection::LatticeView view{
        projected,
        {lattice_vertices_.data(), lattice_vertices_.size()},
        *task.lattice,
        space.perspective(),
        depth_limits_of(space, *task.lattice, *task.function, settings_.emission, longest_ray),
        steps,
        context.at_steps};
    return std::make_unique<Worker<LatticeSource>>(task.make_lattice_sink(), std::move(cells), context, view);
  });
  beside.wait();
  const std::uint64_t most_list_bytes = render_bands(task, *lists, held, [&](std::size_t first, std::size_t last) {
    render_tiles(task, *lists, made_by, drawn, workers, first, last, stop);
  });

  FrameStatistics statistics = counted(task, *prepared_, *lists, workers);
  statistics.peak_buffer_bytes += vertex_bytes + most_list_bytes;
  return statistics;
}

/// Calls `render` for band after band of tiles, as many as a quarter of what is left of the budget holds lists for; the
/// rest is for segments. Returns the most bytes of lists.
std::uint64_t FrameProjector::render_bands(const Task& task, projection::TileLists& lists, std::uint64_t held,
                                           const std::function<void(std::size_t, std::size_t)>& render) const {
  const std::uint64_t most_entries =
      scene::least_of(
          std::max<std::uint64_t>(segment_budget(settings_, held, 1) / 4 / sizeof(projection::TileEntry), 1),
          task.team) *
      members_of(task);
  std::uint64_t most_bytes = 0;
  for (std::size_t first = 0; first < task.grid.count();) {
    std::size_t last = first;
    for (std::uint64_t entries = 0; last < task.grid.count(); ++last) {
      entries += lists.entry_count(last);
      if (last > first && entries > most_entries) break;
    }
    if (first > 0 && task.team != nullptr) {
      if (task.before_waiting) task.before_waiting();
      task.team->barrier();  // nobody reads the last band's lists any more
    }
    {
      const scene::TraceScope timing(settings_.trace, "bin", task.frame);
      lists.fill(first, last);
    }
    most_bytes = std::max<std::uint64_t>(most_bytes, lists.bytes());
    render(first, last);
    first = last;
  }
  return most_bytes;
}

}  // namespace tessera::frame
