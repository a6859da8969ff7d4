// SPDX-License-Identifier: BSD-3-Clause
#include "volume/chunk_cast.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "scene/error.hpp"
#include "scene/frame_watch.hpp"
#include "scene/threads.hpp"
#include "volume/frame_setup.hpp"
#include "volume/precise/voxel_cast.hpp"
#include "volume/render.hpp"
#include "volume/renderer_state.hpp"
#include "volume/split/tile_order.hpp"
#include "volume/tile_caster.hpp"

namespace tessera::volume {

/// Common interface of rays in float lanes and rays in double precision.
class ChunkCast::State {
 public:
  virtual ~State() = default;
  virtual void advance(const VoxelBox& chunk, const std::stop_token& stop) = 0;
  [[nodiscard]] virtual bool open(int x, int y) const = 0;
  [[nodiscard]] virtual bool any_open() const = 0;
  [[nodiscard]] virtual float transmittance(int x, int y) const = 0;
  virtual void close(int x, int y) = 0;
  virtual void emit(FragmentSink& sink, const std::stop_token& stop) = 0;
  [[nodiscard]] virtual GridCounters counters() const = 0;

  const scene::GridGeometry* geometry = nullptr;  ///< geometry of the volume that chunks divide
};

namespace {

scene::PixelRect within(scene::ImageSize size, const std::optional<scene::PixelRect>& region) {
  if (!region) return {0, 0, size.width, size.height};
  return {std::max(0, region->x0), std::max(0, region->y0), std::min(size.width, region->x1),
          std::min(size.height, region->y1)};
}

/// The cast of regular grids, with tiles of rays in float lanes.
class LaneChunks final : public ChunkCast::State {
 public:
  LaneChunks(RendererState& state, const scene::Camera& camera, scene::ImageSize size,
             const scene::TransferFunction& function, const scene::PixelRect& region)
      : function_(function), arena_(scene::threads_for(state.settings.threads)), region_(region) {
    arena_.execute([&] {
      setup_.emplace(state, camera, size, function_, nullptr);
      in_double_.emplace(state.source, camera, size, function_,
                         state.voxel_settings(function_, setup_->visible(), setup_->surfaces()));
      places_ = tiles_of({&region_, 1});
      tiles_.resize(places_.size());
      columns_ = (region.x1 + TileRays::side - 1) / TileRays::side - region.x0 / TileRays::side;
      numbers_.resize(places_.size());
      for (std::size_t n = 0; n < places_.size(); ++n) numbers_[number_at(places_[n].x, places_[n].y)] = n;
      for_tiles({}, [&](std::size_t n, Worker& worker) {
        tiles_[n].begin(setup_->view(), places_[n].x, places_[n].y, region_, worker.counts);
      });
    });
  }

  void advance(const VoxelBox& chunk, const std::stop_token& stop) override {
    for_tiles(stop, [&](std::size_t n, Worker& worker) {
      cast_tile(setup_->view(), chunk, tiles_[n], worker.memory, worker.counts);
    });
  }

  [[nodiscard]] bool open(int x, int y) const override { return tile(x, y).open(setup_->view(), x, y); }
  [[nodiscard]] bool any_open() const override {
    return std::any_of(tiles_.begin(), tiles_.end(),
                       [this](const TileState& tile) { return tile.any_open(setup_->view()); });
  }
  [[nodiscard]] float transmittance(int x, int y) const override { return tile(x, y).transmittance(x, y); }
  void close(int x, int y) override { tiles_[numbers_[number_at(x, y)]].close(x, y); }

  void emit(FragmentSink& sink, const std::stop_token& stop) override {
    std::vector<UncertainRay> uncertain;
    for_tiles(stop, [&](std::size_t n, Worker& worker) {
      worker.fragments.clear();
      tiles_[n].fragments(setup_->view(), worker.fragments, worker.uncertain);
      sink.take(worker.fragments);
      tiles_[n].restart();
    });
    for (Worker& worker : workers_) {
      uncertain.insert(uncertain.end(), worker.uncertain.begin(), worker.uncertain.end());
      worker.uncertain.clear();
    }
    again_ += uncertain.size();
    arena_.execute([&] { in_double_->cast(uncertain, sink, stop); });
    sink.finished(region_);
  }

  [[nodiscard]] GridCounters counters() const override {
    TileCounts sum;
    for (const Worker& worker : workers_) sum += worker.counts;
    GridCounters counters;
    counters.rays = sum.rays, counters.voxels_visited = sum.voxels_visited, counters.samples = sum.samples;
    counters.pixels_again = again_;
    return counters;
  }

 private:
  struct Worker {
    TileMemory memory;
    TileCounts counts;
    std::vector<RayFragment> fragments;
    std::vector<UncertainRay> uncertain;
  };

  /// Calls f(tile number, the thread's worker) for all tiles.
  template <class F>
  void for_tiles(const std::stop_token& stop, const F& f) {
    arena_.execute([&] {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tiles_.size(), 1), [&](const auto& some) {
        for (std::size_t n = some.begin(); n != some.end(); ++n) {
          scene::throw_if_stopped(stop);
          f(n, workers_.local());
        }
      });
    });
  }

  /// Returns the index of the tile of a pixel; tiles are numbered row by row.
  [[nodiscard]] std::size_t number_at(int x, int y) const {
    return static_cast<std::size_t>((y / TileRays::side - region_.y0 / TileRays::side) * columns_ + x / TileRays::side -
                                    region_.x0 / TileRays::side);
  }
  [[nodiscard]] const TileState& tile(int x, int y) const { return tiles_[numbers_[number_at(x, y)]]; }

  const scene::TransferFunction function_;
  mutable tbb::task_arena arena_;
  scene::PixelRect region_;
  std::optional<FrameSetup> setup_;
  std::optional<VoxelCaster> in_double_;
  std::vector<TilePlace> places_;  ///< one per element of `tiles_`
  std::vector<TileState> tiles_;
  int columns_ = 0;
  std::vector<std::size_t> numbers_;  ///< indices into `tiles_`, row by row
  tbb::enumerable_thread_specific<Worker> workers_;
  std::uint64_t again_ = 0;
};

/// The cast of rectilinear grids, with rays in double precision.
class VoxelChunks final : public ChunkCast::State {
 public:
  VoxelChunks(RendererState& state, const scene::Camera& camera, scene::ImageSize size,
              const scene::TransferFunction& function, const scene::PixelRect& region)
      : function_(function), arena_(scene::threads_for(state.settings.threads)), region_(region) {
    arena_.execute([&] { visible_ = state.visible_to_walks(state.table_of(function_)); });
    surfaces_ = state.surfaces_of(function_);
    const VoxelCastSettings settings = state.voxel_settings(function_, visible_, &surfaces_);
    least_ = settings.walk.least;
    caster_.emplace(state.source, camera, size, function_, settings);
    for (int y = region.y0; y < region.y1; ++y)
      for (int x = region.x0; x < region.x1; ++x) {
        const VoxelRay ray = caster_->ray(x, y);
        pixels_.push_back({ray, {}, ray.begin, ray.begin});
        met_ += ray.begin < ray.end ? 1 : 0;
      }
  }

  void advance(const VoxelBox& chunk, const std::stop_token& stop) override {
    for_rows(stop, [&](int y) {
      for (int x = region_.x0; x < region_.x1; ++x) {
        Pixel& pixel = pixels_[at(x, y)];
        if (pixel.closed) continue;
        const VoxelRay part = caster_->part_in(chunk, pixel.ray);
        if (!(part.begin < part.end)) continue;
        if (!(pixel.begun < pixel.reached)) pixel.begun = part.begin;
        pixel.reached = part.end;
        caster_->add(part, pixel.sum);
      }
    });
  }

  [[nodiscard]] bool open(int x, int y) const override { return is_open(pixels_[at(x, y)]); }
  [[nodiscard]] bool any_open() const override {
    return std::any_of(pixels_.begin(), pixels_.end(), [this](const Pixel& pixel) { return is_open(pixel); });
  }
  [[nodiscard]] float transmittance(int x, int y) const override {
    const Pixel& pixel = pixels_[at(x, y)];
    return static_cast<float>(pixel.passed * pixel.sum.transmittance);
  }
  void close(int x, int y) override { pixels_[at(x, y)].closed = true; }

  void emit(FragmentSink& sink, const std::stop_token& stop) override {
    for_rows(stop, [&](int y) {
      std::vector<RayFragment> fragments;
      for (int x = region_.x0; x < region_.x1; ++x) {
        Pixel& pixel = pixels_[at(x, y)];
        if (pixel.begun < pixel.reached) fragments.push_back(pixel.sum.fragment(x, y, pixel.reached, 0));
        pixel.begun = pixel.reached;
        pixel.passed *= pixel.sum.transmittance;
        pixel.sum = {};
      }
      sink.take(fragments);
    });
    sink.finished(region_);
  }

  [[nodiscard]] GridCounters counters() const override {
    const VoxelCastCounts sum = caster_->counts();
    GridCounters counters;
    counters.rays = met_, counters.voxels_visited = sum.voxels, counters.samples = sum.lines;
    return counters;
  }

 private:
  struct Pixel {
    VoxelRay ray;
    RaySum sum;
    double begun, reached;  ///< planar depths cast since the last emit()
    double passed = 1;      ///< transmittance of the part before `begun`
    bool closed = false;
  };

  [[nodiscard]] bool is_open(const Pixel& pixel) const {
    return !pixel.closed && pixel.reached < pixel.ray.end && pixel.passed * pixel.sum.transmittance >= least_;
  }
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y - region_.y0) * static_cast<std::size_t>(region_.width()) +
           static_cast<std::size_t>(x - region_.x0);
  }
  template <class F>
  void for_rows(const std::stop_token& stop, const F& f) {
    arena_.execute([&] {
      tbb::parallel_for(region_.y0, region_.y1, [&](int y) {
        scene::throw_if_stopped(stop);
        f(y);
      });
    });
  }

  const scene::TransferFunction function_;
  tbb::task_arena arena_;
  scene::PixelRect region_;
  std::vector<std::uint8_t> visible_;
  GridSurfaces surfaces_;
  double least_ = 0;
  std::optional<VoxelCaster> caster_;
  std::vector<Pixel> pixels_;  ///< row by row
  std::uint64_t met_ = 0;
};

}  // namespace

ChunkCast::ChunkCast(Renderer& renderer, const scene::Camera& camera, scene::ImageSize size,
                     const scene::TransferFunction& function, std::optional<scene::PixelRect> region) {
  scene::validate(camera);
  scene::validate(size);
  RendererState& state = *renderer.state_;
  const scene::PixelRect wanted = within(size, region);
  if (state.source.geometry().rectilinear())
    state_ = std::make_unique<VoxelChunks>(state, camera, size, function, wanted);
  else
    state_ = std::make_unique<LaneChunks>(state, camera, size, function, wanted);
  state_->geometry = &state.source.geometry();
}

ChunkCast::~ChunkCast() = default;

void ChunkCast::advance(const VoxelBox& chunk, const std::stop_token& stop) {
  const scene::GridIndex voxels = state_->geometry->voxels();
  for (std::size_t a = 0; a < 3; ++a)
    if (chunk.low[a] < 0 || chunk.low[a] >= chunk.high[a] || chunk.high[a] > voxels[a])
      throw scene::bad_input(fmt::format("chunk: voxels {} to {} along axis {}; the volume has {}", chunk.low[a],
                                         chunk.high[a], a, voxels[a]));
  state_->advance(chunk, stop);
}

bool ChunkCast::open(int x, int y) const { return state_->open(x, y); }
bool ChunkCast::any_open() const { return state_->any_open(); }
float ChunkCast::transmittance(int x, int y) const { return state_->transmittance(x, y); }
void ChunkCast::close(int x, int y) { state_->close(x, y); }
void ChunkCast::emit(FragmentSink& sink, const std::stop_token& stop) { state_->emit(sink, stop); }
GridCounters ChunkCast::counters() const { return state_->counters(); }

}  // namespace tessera::volume
