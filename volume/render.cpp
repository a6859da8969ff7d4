#include "volume/render.hpp"

#include <fmt/format.h>
#include <hwy/targets.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <glm/glm.hpp>
#include <span>
#include <thread>
#include <utility>

#include "scene/error.hpp"
#include "scene/start_thread.hpp"
#include "scene/threads.hpp"
#include "volume/cell_ranges.hpp"
#include "volume/cost_map.hpp"
#include "volume/frame_view.hpp"
#include "volume/tile_caster.hpp"
#include "volume/voxel_cast.hpp"

namespace tessera::volume {
namespace {

void check(const RenderSettings& settings, const scene::GridGeometry& geometry) {
  if (settings.brick_size < 2 || settings.brick_size > 1 << 16)
    throw scene::bad_input(fmt::format("`brick_size` {}: it must be 2 to 65536 voxels", settings.brick_size));
  if (!(settings.accuracy > 0) || !std::isfinite(settings.accuracy))
    throw scene::bad_input(fmt::format("`accuracy` {}: it must be positive", settings.accuracy));
  if (!(settings.step > 0) || !std::isfinite(settings.step))
    throw scene::bad_input(fmt::format("`step` {}: it must be positive, in voxels", settings.step));
  if (settings.threads < 0 || settings.threads > 4096)
    throw scene::bad_input(fmt::format("`threads` {}: it must be 0 (all cores) to 4096", settings.threads));
  if (settings.preload_limit < 0)
    throw scene::bad_input(fmt::format("`preload` {}: it must be 0 or more", settings.preload_limit));
  const bool in_steps = settings.method == Method::sampled || settings.method == Method::preintegrated;
  if (geometry.rectilinear() && in_steps)
    throw scene::bad_input("`integrator`: a rectilinear grid is not rendered in steps; use auto or exact");
  if (settings.shading && in_steps)
    throw scene::bad_input("`shade`: shading needs the exact or auto method; leave one of the two out");
  if (settings.shading && settings.emission == scene::Emission::independent)
    throw scene::bad_input("`shade`: shading needs emission in proportion to extinction; leave one of the two out");
  if (settings.shading && !(glm::length(settings.shading->to_light) > 0))
    throw scene::bad_input("`light`: the direction to the light has no length; give one that has");
  if (settings.method == Method::preintegrated && settings.emission == scene::Emission::independent)
    throw scene::bad_input(
        "`integrator`: pre-integration needs emission in proportion to extinction; use sampled or exact");
}

/// World units; a power of two near the mean voxel's side.
double length_unit_of(double voxel_side) { return std::ldexp(1.0, std::ilogb(voxel_side)); }

/// World units: the side of a cube as large as a mean voxel.
double voxel_side_of(const scene::GridGeometry& geometry) {
  double volume = std::abs(glm::determinant(geometry.direction));
  for (std::size_t a = 0; a < 3; ++a)
    volume *= (geometry.lattice(a, geometry.points[a] - 1) - geometry.lattice(a, 0)) /
              static_cast<double>(geometry.points[a] - 1);
  return std::cbrt(volume);
}

/// World units: no ray goes further in one voxel of a regular grid.
double longest_in_voxel(const scene::GridGeometry& geometry) {
  double sides = 0;
  for (int a = 0; a < 3; ++a) sides += glm::length(geometry.direction[a]) * std::abs(geometry.spacing[a]);
  return sides;
}

ShadingView shading_view(const scene::Shading& s, const scene::Camera& camera, const scene::GridGeometry& geometry,
                         double voxel_side) {
  ShadingView view{s.ambient, s.diffuse, s.specular, s.shininess, voxel_side, {}, {}, {}};
  const scene::ViewBasis basis = scene::view_basis(camera);
  const glm::dvec3 l = glm::normalize(s.to_light);
  const glm::dvec3 light = s.camera_light ? basis.right * l.x + basis.up * l.y - basis.forward * l.z : l;
  view.light_eye[0] = glm::dot(light, basis.right), view.light_eye[1] = glm::dot(light, basis.up);
  view.light_eye[2] = -glm::dot(light, basis.forward);
  const glm::dmat3 to_local = scene::world_to_local(geometry);
  glm::dvec3 rows[3];
  for (int a = 0; a < 3; ++a)
    rows[a] = glm::dvec3(to_local[0][a], to_local[1][a], to_local[2][a]) * (voxel_side / geometry.spacing[a]);
  for (int a = 0; a < 3; ++a) {
    view.light[a] = glm::dot(rows[a], light);
    for (int b = 0; b < 3; ++b) view.metric[a][b] = glm::dot(rows[a], rows[b]);
  }
  return view;
}

/// Distance of every brick's centre to the cone round the view frustum (Moloney 2008, 3.3), world units, 0 inside. In
/// orthographic views the cone is a cylinder.
std::vector<float> cone_distances(const scene::Camera& camera, scene::ImageSize size, const scene::PixelRect& region,
                                  const scene::GridGeometry& geometry, const BrickLayout& layout) {
  const scene::ViewBasis basis = scene::view_basis(camera);
  const bool perspective = camera.projection == scene::ProjectionKind::perspective;
  const double half_height = perspective ? std::tan(glm::radians(camera.view_angle / 2)) : camera.parallel_scale;
  const double pixel = 2 * half_height / size.height;
  const glm::dvec2 middle{(region.x0 + region.x1) / 2.0 - size.width / 2.0,
                          size.height / 2.0 - (region.y0 + region.y1) / 2.0};
  const glm::dvec3 shift = (basis.right * middle.x + basis.up * middle.y) * pixel;
  const double radius = 0.5 * pixel * std::hypot(region.x1 - region.x0, region.y1 - region.y0);
  const glm::dvec3 apex = perspective ? camera.position : camera.position + shift;
  const glm::dvec3 axis = perspective ? glm::normalize(basis.forward + shift) : basis.forward;
  const double slope = perspective ? radius : 0, across = perspective ? 0 : radius;
  std::vector<float> distances(layout.count());
  for (std::size_t brick = 0; brick < distances.size(); ++brick) {
    const scene::SampleBox box = layout.box(layout.place(brick));
    glm::dvec3 centre;
    for (int a = 0; a < 3; ++a)
      centre[a] =
          0.5 * static_cast<double>(box.low[static_cast<std::size_t>(a)] + box.high[static_cast<std::size_t>(a)] - 1);
    const glm::dvec3 from_apex = scene::world_of_index(geometry, centre) - apex;
    const double along = glm::dot(from_apex, axis), off = glm::length(from_apex - axis * along);
    const double outside = (off - across - slope * along) / std::sqrt(1 + slope * slope);
    // Behind the apex the apex itself is nearest.
    distances[brick] =
        static_cast<float>(perspective && along + slope * off < 0 ? glm::length(from_apex) : std::max(0.0, outside));
  }
  return distances;
}

/// Tiles along a curve that stays in one place for long, so that neighbours find each other's bricks.
std::vector<std::pair<int, int>> tiles_of(const scene::PixelRect& region) {
  std::vector<std::pair<int, int>> tiles;
  const int side = TileRays::side;
  for (int y = region.y0 / side * side; y < region.y1; y += side)
    for (int x = region.x0 / side * side; x < region.x1; x += side) tiles.emplace_back(x, y);
  const auto spread = [](std::uint32_t n) {
    std::uint64_t bits = 0;
    for (int b = 0; b < 16; ++b) bits |= static_cast<std::uint64_t>(n >> b & 1) << 2 * b;
    return bits;
  };
  const auto place = [&](const std::pair<int, int>& tile) {
    return spread(static_cast<std::uint32_t>(tile.first / side)) |
           spread(static_cast<std::uint32_t>(tile.second / side)) << 1;
  };
  std::sort(tiles.begin(), tiles.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
  return tiles;
}

/// The pixels of a tile that are in the region.
scene::PixelRect tile_rect(const std::pair<int, int>& tile, const scene::PixelRect& region) {
  return {std::max(tile.first, region.x0), std::max(tile.second, region.y0),
          std::min(tile.first + TileRays::side, region.x1), std::min(tile.second + TileRays::side, region.y1)};
}

scene::PixelRect within(scene::ImageSize size, const std::optional<scene::PixelRect>& region) {
  if (!region) return {0, 0, size.width, size.height};
  return {std::max(0, region->x0), std::max(0, region->y0), std::min(size.width, region->x1),
          std::min(size.height, region->y1)};
}

/// What a cast gives beside its light.
struct Cast {
  std::vector<std::uint8_t> brick_visible;
  TileCounts counts;
  std::uint64_t blocks_read = 0, block_bytes = 0;  ///< rectilinear grids
  std::uint64_t pixels_again = 0;                  ///< in double precision
};

/// Pixels of a map, each with its ray's planes of the lattice.
CostMap cost_of_planes(const scene::Camera& camera, scene::ImageSize image, const scene::GridGeometry& geometry,
                       double resolution, const std::optional<scene::PixelRect>& region) {
  CostMap map;
  map.resolution = resolution;
  map.size = map_size(image, resolution);
  map.region = region.value_or(scene::PixelRect{0, 0, map.size.width, map.size.height});
  const VoxelRays rays(camera, image, geometry);
  for (int y = map.region.y0; y < map.region.y1; ++y)
    for (int x = map.region.x0; x < map.region.x1; ++x)
      map.cost.push_back(static_cast<std::uint32_t>(
          64 * std::min(1e7, planes_crossed(rays.ray((x + 0.5) / resolution, (y + 0.5) / resolution), geometry))));
  return map;
}

}  // namespace

struct Renderer::State {
  State(const scene::SampleSource& source_, const RenderSettings& settings_, std::shared_ptr<const CellRanges> ranges_)
      : source(source_),
        settings(settings_),
        ranges_owner(std::move(ranges_)),
        ranges(*ranges_owner),
        bricks(source_, BrickLayout(source_.geometry(), settings_.brick_size, settings_.edge_bricks),
               settings_.memory_bytes, settings_.cache) {}

  [[nodiscard]] bool in_steps() const {
    return settings.method == Method::sampled || settings.method == Method::preintegrated;
  }
  [[nodiscard]] integrals::LaneTable table_of(const scene::TransferFunction& function) const {
    return {function,          ranges.lanes.origin,
            ranges.lanes.unit, length_unit,
            settings.emission, in_steps() ? integrals::StepRounding::nearest : integrals::StepRounding::up};
  }

  /// A ray that lets less through is done.
  [[nodiscard]] float least_transmittance(const scene::TransferFunction& function) const {
    if (!settings.use.termination) return 0;
    if (settings.method == Method::sampled || settings.method == Method::preintegrated) return 1e-6f;
    return static_cast<float>(std::min(0.25, accuracy() / 4 / std::max(1.0, brightest(function))));
  }
  /// Light that may come along a ray.
  [[nodiscard]] double brightest(const scene::TransferFunction& function) const {
    if (settings.emission != scene::Emission::independent) return function.max_color();
    const scene::Box box = scene::bounds(source.geometry());
    return function.max_color() * glm::length(box.high - box.low);
  }
  /// Of a cast in double precision; `visible` must outlive it.
  [[nodiscard]] VoxelCastSettings voxel_settings(const scene::TransferFunction& function,
                                                 std::span<const std::uint8_t> visible) const {
    return {{settings.emission, WalkSettings().tolerance, static_cast<double>(least_transmittance(function)), visible},
            settings.shading};
  }
  [[nodiscard]] double accuracy() const { return settings.method == Method::exact ? 2e-6 : settings.accuracy; }

  void cast(const scene::Camera& camera, scene::ImageSize size, const scene::TransferFunction& transfer_function,
            const scene::PixelRect& wanted, WorkTally* tally, scene::Image* image, float* error_bounds,
            scene::FrameWatch& watch, Cast& result);
  void cast_rectilinear(const scene::Camera& camera, const scene::TransferFunction& function,
                        const scene::PixelRect& wanted, scene::Image& image, scene::FrameWatch& watch,
                        Cast& result) const;
  void cast_again(const scene::Camera& camera, const scene::TransferFunction& function,
                  const std::vector<std::uint8_t>& visible, const std::vector<std::array<int, 2>>& pixels,
                  scene::Image& image, const std::stop_token& stop, Cast& result) const;

  /// Bricks near the view, while the picture is gathered and written; the next frame ends it.
  void begin_preload(std::vector<std::uint8_t> wanted) {
    stop_preload = false;
    preloading = scene::start_thread([this, wanted = std::move(wanted)] {
      const scene::TraceScope scope(settings.trace, "prepare");
      bricks.preload(settings.preload_limit, wanted, stop_preload, settings.trace);
    });
  }
  void end_preload() {
    if (!preloading.joinable()) return;
    stop_preload = true;
    preloading.join();
  }
  ~State() { end_preload(); }

  const scene::SampleSource& source;
  RenderSettings settings;
  double voxel_side = voxel_side_of(source.geometry()), length_unit = length_unit_of(voxel_side);
  std::shared_ptr<const CellRanges> ranges_owner;
  const CellRanges& ranges;
  BrickCache bricks;
  BrickCache::Counts counts_before;  ///< as the last frame's statistics ended: loads ahead count for the next one
  std::atomic<bool> stop_preload = false;
  std::thread preloading;
};

Renderer::Renderer(const scene::SampleSource& source, const RenderSettings& settings,
                   std::shared_ptr<const CellRanges> ranges) {
  check(settings, source.geometry());
  state_ = std::make_unique<State>(source, settings, std::move(ranges));
}

Renderer::Renderer(const scene::SampleSource& source, const RenderSettings& settings, CellRanges ranges)
    : Renderer(source, settings, std::make_shared<const CellRanges>(std::move(ranges))) {}

Renderer::Renderer(const scene::SampleSource& source, const RenderSettings& settings) {
  check(settings, source.geometry());
  state_ = std::make_unique<State>(source, settings, std::make_shared<const CellRanges>(source, settings.threads));
}

Renderer::~Renderer() = default;

scene::ValueRange Renderer::range() const { return state_->ranges.range; }

const scene::GridGeometry& Renderer::geometry() const { return state_->source.geometry(); }

std::vector<std::array<glm::dvec3, 2>> Renderer::visible_bricks(
    const scene::TransferFunction& transfer_function) const {
  const State& state = *state_;
  const integrals::LaneTable table = state.table_of(transfer_function);
  const BrickLayout& layout = state.bricks.layout();
  const std::vector<std::uint8_t> shown =
      volume::visible_bricks(state.ranges, visible_cells(state.ranges, table), layout);
  std::vector<std::array<glm::dvec3, 2>> boxes;
  for (std::size_t brick = 0; brick < shown.size(); ++brick) {
    if (shown[brick] == 0) continue;
    const scene::GridIndex place = layout.place(brick);
    std::array<glm::dvec3, 2>& box = boxes.emplace_back();
    for (std::size_t a = 0; a < 3; ++a) {
      box[0][static_cast<int>(a)] = static_cast<double>(place[a] * layout.size);
      box[1][static_cast<int>(a)] = static_cast<double>(std::min((place[a] + 1) * layout.size, layout.voxels[a]));
    }
  }
  return boxes;
}

/// The rays of the pixels `wanted`: an image, or a tally.
void Renderer::State::cast(const scene::Camera& camera, scene::ImageSize size,
                           const scene::TransferFunction& transfer_function, const scene::PixelRect& wanted,
                           WorkTally* tally, scene::Image* image, float* error_bounds, scene::FrameWatch& watch,
                           Cast& result) {
  const PixelRays rays(camera, size, source.geometry());
  const integrals::LaneTable table = table_of(transfer_function);
  std::vector<std::uint8_t> visible;
  tbb::task_arena arena(scene::threads_for(settings.threads));
  arena.execute([&] {
    {
      const scene::TraceScope scope(settings.trace, "cull");
      // A step between two values may show what neither of them shows, so pre-integration needs the true ones.
      visible = settings.method == Method::preintegrated ? std::vector<std::uint8_t>(ranges.count(), 1)
                                                         : visible_cells(ranges, table);
      if (!settings.use.culling || !settings.use.skipping)
        show_more(ranges, bricks.layout(), !settings.use.culling, !settings.use.skipping, visible);
      result.brick_visible = volume::visible_bricks(ranges, visible, bricks.layout());
    }
    FrameView frame{};
    frame.rays = &rays;
    frame.table = &table;
    frame.ranges = &ranges;
    frame.visible = visible.data();
    frame.some_hidden = std::find(visible.begin(), visible.end(), 0) != visible.end();
    frame.some_clear = any_clear(ranges, table);
    frame.brick_visible = result.brick_visible.data();
    frame.bricks = &bricks;
    frame.voxels = source.geometry().voxels();
    frame.samples = source.geometry().samples();
    frame.cell_data = source.geometry().association == scene::Association::cell;
    frame.length_unit = length_unit;
    frame.least_transmittance = least_transmittance(transfer_function);
    frame.piece_tolerance = static_cast<float>(accuracy() / 64);
    frame.largest_color = static_cast<float>(std::max(1e-30, transfer_function.max_color()));
    LaneErrorBound error_bound;
    if (settings.method != Method::sampled && settings.method != Method::preintegrated && tally == nullptr) {
      frame.error_tolerance = static_cast<float>(std::max(accuracy(), 1e-5) / 2);
      error_bound =
          LaneErrorBound(transfer_function, table, ranges,
                         {frame.cell_data, frame.largest_color, brightest(transfer_function), frame.error_tolerance,
                          longest_in_voxel(source.geometry()) / length_unit, length_unit});
      if (error_bound.any()) frame.error_bound = &error_bound;
    }
    frame.lanes = ranges.lanes;
    frame.lanes.whole = in_steps() || !table.has_steps;
    frame.tally = tally;
    // A thousand packets or more, whatever the picture's size.
    const double tiles_in_picture = static_cast<double>(size.width) * size.height / (TileRays::side * TileRays::side);
    frame.pilot_packets = static_cast<int>(std::clamp(1024 / tiles_in_picture, 2.0, 32.0));
    frame.trace = settings.trace;

    std::optional<PreintegratedTable> preintegrated;
    if (settings.method == Method::sampled || settings.method == Method::preintegrated)
      frame.step = settings.step * voxel_side / length_unit;
    if (settings.method == Method::preintegrated && tally == nullptr) {
      const auto lane_of = [&](double value) {
        return integrals::lane_scalar(value, ranges.lanes.origin, ranges.lanes.unit);
      };
      const scene::ValueRange& range = ranges.range;
      const float low = range.empty() ? 0.0f : lane_of(range.low), high = range.empty() ? 0.0f : lane_of(range.high);
      preintegrated.emplace(table, low, high, static_cast<float>(frame.step),
                            PreintegratedTable::size_for(table, low, high));
      frame.preintegrated = &*preintegrated;
    }

    ShadingView shading;
    if (settings.shading) {
      shading = shading_view(*settings.shading, camera, source.geometry(), voxel_side);
      frame.shading = &shading;
    }

    const auto tiles = tiles_of(wanted);
    tbb::enumerable_thread_specific<std::unique_ptr<TileMemory>> memories(
        [] { return std::make_unique<TileMemory>(); });
    tbb::enumerable_thread_specific<TileCounts> tile_counts;
    tbb::enumerable_thread_specific<std::vector<std::size_t>> late_tiles;  // finished by cast_again()
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, tiles.size(), 1),
        [&](const auto& some) {
          const scene::TraceScope scope(settings.trace, tally == nullptr ? "project" : "partition");
          for (std::size_t n = some.begin(); n != some.end(); ++n) {
            watch.check();
            TileMemory& memory = *memories.local();
            const std::size_t uncertain_before = memory.uncertain.size();
            cast_tile(frame, tiles[n].first, tiles[n].second, wanted, memory, image, tile_counts.local(), error_bounds);
            if (image == nullptr || !watch.wants_tiles()) continue;
            if (memory.uncertain.size() == uncertain_before)
              watch.finished(tile_rect(tiles[n], wanted), *image);
            else
              late_tiles.local().push_back(n);
          }
        },
        tbb::auto_partitioner());
    std::vector<std::array<int, 2>> uncertain;
    for (const auto& memory : memories)
      uncertain.insert(uncertain.end(), memory->uncertain.begin(), memory->uncertain.end());
    if (!uncertain.empty()) cast_again(camera, transfer_function, visible, uncertain, *image, watch.stop(), result);
    for (const auto& late : late_tiles)
      for (const std::size_t n : late) watch.finished(tile_rect(tiles[n], wanted), *image);
    for (const TileCounts& c : tile_counts) {
      result.counts.rays += c.rays;
      result.counts.voxels_visited += c.voxels_visited;
      result.counts.samples += c.samples;
    }
  });
}

/// Pixels of which float lanes are not sure.
void Renderer::State::cast_again(const scene::Camera& camera, const scene::TransferFunction& function,
                                 const std::vector<std::uint8_t>& visible,
                                 const std::vector<std::array<int, 2>>& pixels, scene::Image& image,
                                 const std::stop_token& stop, Cast& result) const {
  const scene::TraceScope scope(settings.trace, "project");
  cast_voxel_by_voxel(source, camera, function, voxel_settings(function, visible), pixels, image, stop);
  result.pixels_again = pixels.size();
}

void Renderer::State::cast_rectilinear(const scene::Camera& camera, const scene::TransferFunction& function,
                                       const scene::PixelRect& wanted, scene::Image& image, scene::FrameWatch& watch,
                                       Cast& result) const {
  const integrals::LaneTable table = table_of(function);
  tbb::task_arena arena(scene::threads_for(settings.threads));
  arena.execute([&] {
    std::vector<std::uint8_t> visible = visible_cells(ranges, table);
    show_more(ranges, bricks.layout(), !settings.use.culling, !settings.use.skipping, visible);
    result.brick_visible = volume::visible_bricks(ranges, visible, bricks.layout());
    const scene::TraceScope scope(settings.trace, "project");
    const VoxelCastCounts counts =
        cast_voxel_by_voxel(source, camera, function, voxel_settings(function, visible), wanted, image, watch);
    result.counts.rays = counts.rays, result.counts.voxels_visited = counts.voxels;
    result.counts.samples = counts.lines;
    result.blocks_read = counts.blocks_read, result.block_bytes = counts.bytes_read;
  });
}

scene::Image Renderer::render(const scene::Camera& camera, scene::ImageSize size,
                              const scene::TransferFunction& transfer_function, RenderStatistics* statistics,
                              std::optional<scene::PixelRect> region, std::vector<float>* error_bounds,
                              scene::FrameWatch* watch) {
  scene::validate(camera);
  scene::validate(size);
  State& state = *state_;
  const RenderSettings& settings = state.settings;
  const scene::TraceScope frame_scope(settings.trace, "frame");
  const scene::PixelRect wanted = within(size, region);
  state.end_preload();
  const BrickCache::Counts before = state.counts_before;
  const bool near_ones = settings.cache == CachePolicy::proximity;
  if (near_ones)
    state.bricks.set_distances(cone_distances(camera, size, wanted, state.source.geometry(), state.bricks.layout()));
  scene::FrameWatch nobody;
  if (watch == nullptr) watch = &nobody;
  watch->check();
  scene::Image image(size);
  if (error_bounds != nullptr) error_bounds->assign(image.depth.size(), 0.0f);
  Cast cast;
  const bool rectilinear = state.source.geometry().rectilinear();
  if (rectilinear)
    state.cast_rectilinear(camera, transfer_function, wanted, image, *watch, cast);
  else
    state.cast(camera, size, transfer_function, wanted, nullptr, &image,
               error_bounds == nullptr ? nullptr : error_bounds->data(), *watch, cast);
  const BrickCache::Counts after = state.bricks.counts();
  state.counts_before = after;
  if (near_ones && settings.preload_limit > 0 && !rectilinear) state.begin_preload(cast.brick_visible);
  if (statistics != nullptr) {
    RenderStatistics s;
    s.rays = cast.counts.rays, s.voxels_visited = cast.counts.voxels_visited, s.samples = cast.counts.samples;
    s.bricks_total = cast.brick_visible.size();
    s.bricks_invisible =
        static_cast<std::uint64_t>(std::count(cast.brick_visible.begin(), cast.brick_visible.end(), 0));
    s.brick_hits = after.hits - before.hits, s.bricks_loaded = after.loads - before.loads;
    s.bricks_evicted = after.evictions - before.evictions, s.bytes_loaded = after.bytes_loaded - before.bytes_loaded;
    s.bytes_resident = after.bytes, s.peak_bytes = after.peak_bytes;
    if (rectilinear) s.bricks_loaded = cast.blocks_read, s.bytes_loaded = cast.block_bytes;
    s.pixels_again = cast.pixels_again;
    s.blank_samples = state.ranges.range.blanks;
    const std::int64_t sets = hwy::SupportedTargets() & HWY_TARGETS;
    s.instruction_set = hwy::TargetName(sets & -sets);
    *statistics = s;
  }
  return image;
}

void Renderer::sample_work(const scene::Camera& camera, scene::ImageSize size,
                           const scene::TransferFunction& transfer_function, WorkTally& tally,
                           std::optional<scene::PixelRect> region, scene::FrameWatch* watch) {
  scene::validate(camera);
  scene::validate(size);
  if (state_->source.geometry().rectilinear()) return;
  Cast unused;
  scene::FrameWatch nobody;
  state_->cast(camera, size, transfer_function, within(size, region), &tally, nullptr, nullptr,
               watch == nullptr ? nobody : *watch, unused);
}

CostMap Renderer::cost_map(const scene::Camera& camera, scene::ImageSize size,
                           const scene::TransferFunction& transfer_function, CostMethod method, double resolution,
                           std::optional<scene::PixelRect> region, const WorkRates* learned) const {
  const State& state = *state_;
  const scene::GridGeometry& geometry = state.source.geometry();
  if (geometry.rectilinear()) return cost_of_planes(camera, size, geometry, resolution, region);
  const std::vector<std::uint8_t> visible = visible_cells(state.ranges, state.table_of(transfer_function));
  const bool by_voxels = state.settings.method == Method::automatic || state.settings.method == Method::exact;
  CostMap map;
  tbb::task_arena arena(scene::threads_for(state.settings.threads));
  arena.execute([&] {
    map = volume::cost_map(camera, size, geometry, {state.ranges.cells, visible},
                           {method, resolution, by_voxels, learned, state.length_unit,
                            -std::log(static_cast<double>(state.least_transmittance(transfer_function)))},
                           region);
  });
  return map;
}

}  // namespace tessera::volume
