// SPDX-License-Identifier: BSD-3-Clause
#include "volume/render.hpp"

#include <hwy/targets.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/glm.hpp>
#include <utility>

#include "scene/threads.hpp"
#include "volume/bricks/cell_ranges.hpp"
#include "volume/frame_cast.hpp"
#include "volume/image_sink.hpp"
#include "volume/precise/voxel_cast.hpp"
#include "volume/renderer_state.hpp"
#include "volume/split/cost_map.hpp"
#include "volume/split/object_split.hpp"
#include "volume/split/voxel_box.hpp"

namespace tessera::volume {
namespace {

scene::PixelRect within(scene::ImageSize size, const scene::PixelRect& region) {
  return {std::max(0, region.x0), std::max(0, region.y0), std::min(size.width, region.x1),
          std::min(size.height, region.y1)};
}

/// The bounding rectangle of the regions.
scene::PixelRect around(std::span<const scene::PixelRect> regions) {
  scene::PixelRect all = regions.empty() ? scene::PixelRect{0, 0, 0, 0} : regions.front();
  for (const scene::PixelRect& r : regions)
    all = {std::min(all.x0, r.x0), std::min(all.y0, r.y0), std::max(all.x1, r.x1), std::max(all.y1, r.y1)};
  return all;
}

/// A cost map for rectilinear grids: the cost of a pixel is the number of lattice planes that its ray crosses.
CostMap cost_of_planes(const scene::Camera& camera, scene::ImageSize image, const scene::GridGeometry& geometry,
                       std::span<const scene::HalfSpace> clip, const CostSettings& settings) {
  CostMap map;
  const double resolution = map.resolution = settings.resolution;
  map.size = map_size(image, resolution);
  map.region = settings.region.value_or(scene::PixelRect{0, 0, map.size.width, map.size.height});
  const VoxelRays rays(camera, image, geometry, clip);
  for (int y = map.region.y0; y < map.region.y1; ++y)
    for (int x = map.region.x0; x < map.region.x1; ++x)
      map.cost.push_back(static_cast<std::uint32_t>(
          64 * std::min(1e7, planes_crossed(rays.ray((x + 0.5) / resolution, (y + 0.5) / resolution), geometry))));
  return map;
}

}  // namespace

Renderer::Renderer(const scene::SampleSource& source, const RenderSettings& settings,
                   std::shared_ptr<const CellRanges> ranges)
    : state_(std::make_unique<RendererState>(source, settings, std::move(ranges))) {}

Renderer::Renderer(const scene::SampleSource& source, const RenderSettings& settings, CellRanges ranges)
    : Renderer(source, settings, std::make_shared<const CellRanges>(std::move(ranges))) {}

Renderer::Renderer(const scene::SampleSource& source, const RenderSettings& settings)
    : Renderer(source, settings,
               scene::with_threads(settings.threads, [&] { return std::make_shared<const CellRanges>(source); })) {}

Renderer::~Renderer() = default;

scene::ValueRange Renderer::range() const { return state_->ranges.range; }

const scene::GridGeometry& Renderer::geometry() const { return state_->source.geometry(); }

namespace {

/// Returns one byte per cell: whether the function or a surface makes any part of the cell visible.
std::vector<std::uint8_t> cells_shown(const RendererState& state, const scene::TransferFunction& function) {
  std::vector<std::uint8_t> visible = visible_cells(state.ranges, state.table_of(function));
  const GridSurfaces surfaces = state.surfaces_of(function);
  for (std::size_t cell = 0; cell < surfaces.holding().size(); ++cell) visible[cell] |= surfaces.holding()[cell];
  return visible;
}

/// Returns the bricks that contain visible cells.
std::vector<CostBox> bricks_shown(const RendererState& state, const std::vector<std::uint8_t>& cells) {
  const BrickLayout& layout = state.bricks.layout();
  const std::vector<std::uint8_t> shown = volume::visible_bricks(state.ranges, cells, layout);
  std::vector<CostBox> boxes;
  for (std::size_t brick = 0; brick < shown.size(); ++brick) {
    if (shown[brick] == 0) continue;
    const scene::GridIndex place = layout.place(brick);
    CostBox& box = boxes.emplace_back();
    for (std::size_t a = 0; a < 3; ++a) {
      box.low[static_cast<int>(a)] = static_cast<double>(place[a] * layout.size);
      box.high[static_cast<int>(a)] = static_cast<double>(std::min((place[a] + 1) * layout.size, layout.voxels[a]));
    }
  }
  return boxes;
}

}  // namespace

std::vector<std::array<glm::dvec3, 2>> Renderer::visible_bricks(
    const scene::TransferFunction& transfer_function) const {
  std::vector<std::array<glm::dvec3, 2>> boxes;
  for (const CostBox& box : bricks_shown(*state_, visible_cells(state_->ranges, state_->table_of(transfer_function))))
    boxes.push_back({box.low, box.high});
  return boxes;
}

namespace {

/// A view, and the part of it that is cast.
struct View {
  const scene::Camera& camera;
  scene::ImageSize size;
  std::vector<scene::PixelRect> regions;
  VoxelBox part;
};

/// Results of a cast in addition to its light.
struct Cast {
  std::vector<std::uint8_t> brick_visible;
  FrameWork work;
  std::uint64_t cull_us = 0;
  std::uint64_t blocks_read = 0, block_bytes = 0;  ///< only for rectilinear grids
};

/// Restricts the visible bricks to those that have voxels of a part.
std::vector<std::uint8_t> bricks_in(const VoxelBox& part, const BrickLayout& layout, std::vector<std::uint8_t> shown) {
  for (std::size_t brick = 0; brick < shown.size(); ++brick) {
    const scene::GridIndex place = layout.place(brick);
    for (std::size_t a = 0; a < 3; ++a)
      if ((place[a] + 1) * layout.size <= part.low[a] || place[a] * layout.size >= part.high[a]) shown[brick] = 0;
  }
  return shown;
}

Cast cast_regular(RendererState& state, const View& view, const scene::TransferFunction& function, FragmentSink& sink,
                  const std::stop_token& stop) {
  Cast cast;
  tbb::task_arena arena(scene::threads_for(state.settings.threads));
  arena.execute([&] {
    const FrameSetup setup(state, view.camera, view.size, function, nullptr);
    const std::vector<std::uint8_t> of_part = bricks_in(view.part, state.bricks.layout(), setup.brick_visible());
    if (state.look_ahead) state.look_ahead->frame_shows(of_part);
    VoxelCaster in_double(state.source, view.camera, view.size, function,
                          state.voxel_settings(function, setup.visible(), setup.surfaces()));
    cast.work = cast_frame(setup, view.part, view.regions, sink, in_double, stop);
    cast.brick_visible = setup.brick_visible();
    cast.cull_us = setup.cull_us();
    if (state.look_ahead) state.look_ahead->frame_cast(of_part);
  });
  return cast;
}

Cast cast_rectilinear(RendererState& state, const View& view, const scene::TransferFunction& function,
                      FragmentSink& sink, const std::stop_token& stop) {
  Cast cast;
  const integrals::LaneTable table = state.table_of(function);
  tbb::task_arena arena(scene::threads_for(state.settings.threads));
  arena.execute([&] {
    const auto begin = std::chrono::steady_clock::now();
    const std::vector<std::uint8_t> visible = state.visible_to_walks(table);
    cast.brick_visible = visible_bricks(state.ranges, visible, state.bricks.layout());
    cast.cull_us = microseconds_since(begin);
    const scene::TraceScope scope(state.settings.trace, "project");
    const GridSurfaces surfaces = state.surfaces_of(function);
    VoxelCaster caster(state.source, view.camera, view.size, function,
                       state.voxel_settings(function, visible, &surfaces));
    for (const scene::PixelRect& region : view.regions) caster.cast(view.part, region, sink, stop);
    const VoxelCastCounts counts = caster.counts();
    TileCounts& cast_counts = cast.work.counts;
    cast_counts.rays = counts.rays, cast_counts.voxels_visited = counts.voxels, cast_counts.samples = counts.lines;
    cast.blocks_read = counts.blocks_read, cast.block_bytes = counts.bytes_read;
  });
  return cast;
}

}  // namespace

ObjectSplit Renderer::object_split(const scene::TransferFunction& transfer_function, int processes) const {
  const RendererState& state = *state_;
  return {state.source.geometry().voxels(), cells_shown(state, transfer_function), state.settings.grid.brick_size,
          processes};
}

Frame Renderer::render(const scene::Camera& camera, scene::ImageSize size,
                       const scene::TransferFunction& transfer_function, const CastRequest& request,
                       scene::FrameWatch* watch) {
  scene::validate(size);
  scene::validate(camera);
  RendererState& state = *state_;
  View view{camera, size, {}, request.part.value_or(VoxelBox::all_of(geometry()))};
  view.regions.reserve(request.regions.size());
  for (const scene::PixelRect& region : request.regions) view.regions.push_back(within(size, region));
  const BrickCache::Counts before = state.counts_before;
  if (state.look_ahead) state.look_ahead->begin(camera, size, around(view.regions));
  scene::FrameWatch nobody;
  if (watch == nullptr) watch = &nobody;
  watch->check();
  Frame frame;
  frame.image = scene::Image(size);
  if (request.error_bounds) frame.error_bounds.assign(frame.image.depth.size(), 0.0f);
  ImageSink sink(frame.image, request.error_bounds ? frame.error_bounds.data() : nullptr, *watch);
  const bool rectilinear = state.source.geometry().rectilinear();
  Cast done = (rectilinear ? cast_rectilinear : cast_regular)(state, view, transfer_function, sink, watch->stop());
  const BrickCache::Counts after = state.bricks.counts();
  state.counts_before = after;
  RenderStatistics& s = frame.statistics;
  const TileCounts& counts = done.work.counts;
  s.rays = counts.rays, s.voxels_visited = counts.voxels_visited, s.samples = counts.samples;
  s.bricks_total = done.brick_visible.size();
  s.bricks_invisible = static_cast<std::uint64_t>(std::count(done.brick_visible.begin(), done.brick_visible.end(), 0));
  s.brick_hits = after.hits - before.hits, s.bricks_loaded = after.loads - before.loads;
  s.bricks_evicted = after.evictions - before.evictions, s.bytes_loaded = after.bytes_loaded - before.bytes_loaded;
  s.bytes_resident = after.bytes, s.peak_bytes = after.peak_bytes;
  s.bricks_preloaded = after.preloads - before.preloads, s.load_us = (after.load_ns - before.load_ns) / 1000;
  s.cull_us = done.cull_us, s.evict_us = (after.evict_ns - before.evict_ns) / 1000;
  if (rectilinear) s.bricks_loaded = done.blocks_read, s.bytes_loaded = done.block_bytes;
  s.pixels_again = counts.again;
  s.blank_samples = state.ranges.range.blanks;
  const std::int64_t sets = hwy::SupportedTargets() & HWY_TARGETS;
  s.instruction_set = hwy::TargetName(sets & -sets);
  if (request.tile_times) frame.tile_times = std::move(done.work.tiles);
  return frame;
}

void Renderer::sample_work(const scene::Camera& camera, scene::ImageSize size,
                           const scene::TransferFunction& transfer_function, WorkTally& tally, const PilotPass& pass,
                           scene::FrameWatch* watch) {
  scene::validate(camera);
  scene::validate(size);
  if (state_->source.geometry().rectilinear()) return;
  tbb::task_arena arena(scene::threads_for(state_->settings.threads));
  arena.execute([&] {
    const FrameSetup setup(*state_, camera, size, transfer_function, &tally);
    const scene::PixelRect all{0, 0, size.width, size.height};
    cast_pilot(setup, within(size, pass.region.value_or(all)), pass,
               watch == nullptr ? std::stop_token() : watch->stop());
  });
}

CostMap Renderer::cost_map(const scene::Camera& camera, scene::ImageSize size,
                           const scene::TransferFunction& transfer_function, CostSettings settings) const {
  const RendererState& state = *state_;
  const scene::GridGeometry& geometry = state.source.geometry();
  if (geometry.rectilinear()) return cost_of_planes(camera, size, geometry, state_->settings.clip, settings);
  const std::vector<std::uint8_t> visible = cells_shown(state, transfer_function);
  std::vector<CostBox> bricks;
  if (settings.method != CostMethod::visited) bricks = bricks_shown(state, visible);
  settings.by_voxels = !in_steps(state.settings.integrator.kind);
  settings.length_unit = state.length_unit;
  settings.most_depth = -std::log(static_cast<double>(state.least_transmittance(transfer_function)));
  CostMap map;
  tbb::task_arena arena(scene::threads_for(state.settings.threads));
  arena.execute([&] {
    map = volume::cost_map(camera, size, geometry, {state.ranges.cells, visible}, bricks, settings);
  });
  return map;
}

}  // namespace tessera::volume
