// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "integrals/lane_table.hpp"
#include "scene/error_budget.hpp"
#include "volume/bricks/brick_cache.hpp"
#include "volume/bricks/cell_ranges.hpp"
#include "volume/bricks/look_ahead.hpp"
#include "volume/precise/grid_surfaces.hpp"
#include "volume/precise/voxel_cast.hpp"
#include "volume/render.hpp"

namespace tessera::volume {

/// Returns, in world units, the side of a cube with the mean volume of a voxel.
double voxel_side_of(const scene::GridGeometry& geometry);
/// Returns, in world units, a power of two near the mean voxel's side.
double length_unit_of(double voxel_side);

inline std::uint64_t microseconds_since(std::chrono::steady_clock::time_point begin) {
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begin).count());
}

/// The state of a Renderer that persists between frames.
struct RendererState {
  RendererState(const scene::SampleSource& source_, const RenderSettings& settings_,
                std::shared_ptr<const CellRanges> ranges_)
      : source(source_),
        settings(settings_),
        ranges_owner(std::move(ranges_)),
        ranges(*ranges_owner),
        bricks(source_, BrickLayout(source_.geometry(), settings_.grid.brick_size, settings_.grid.edge_bricks),
               settings_.memory_bytes, settings_.grid.cache) {
    if (settings_.grid.cache == CachePolicy::proximity && !source.geometry().rectilinear())
      look_ahead.emplace(bricks, settings_.grid.preload_limit, settings_.trace);
  }

  [[nodiscard]] integrals::LaneTable table_of(const scene::TransferFunction& function) const {
    return {function,
            ranges.lanes.origin,
            ranges.lanes.unit,
            length_unit,
            settings.emission,
            in_steps(settings.integrator.kind) ? integrals::StepRounding::nearest : integrals::StepRounding::up};
  }

  /// A ray ends when its transmittance is less than this.
  [[nodiscard]] float least_transmittance(const scene::TransferFunction& function) const {
    if (!settings.use.termination) return 0;
    if (in_steps(settings.integrator.kind)) return 1e-6f;
    return static_cast<float>(
        std::min(0.25, scene::error_budget::ended(accuracy()) / std::max(1.0, brightest(function))));
  }
  /// Upper bound of the light along a ray.
  [[nodiscard]] double brightest(const scene::TransferFunction& function) const {
    const double surfaces = scene::SurfaceSet(settings.surfaces, function).max_color();
    if (settings.emission != scene::Emission::independent) return std::max(surfaces, function.max_color());
    const scene::Box box = scene::bounds(source.geometry());
    return surfaces + function.max_color() * glm::length(box.high - box.low);
  }
  [[nodiscard]] GridSurfaces surfaces_of(const scene::TransferFunction& function) const {
    return settings.surfaces.empty() ? GridSurfaces() : GridSurfaces(settings.surfaces, function, ranges);
  }
  /// Settings of a cast in double precision; `visible` and `surfaces` must outlive it.
  [[nodiscard]] VoxelCastSettings voxel_settings(const scene::TransferFunction& function,
                                                 std::span<const std::uint8_t> visible,
                                                 const GridSurfaces* surfaces) const {
    return {{settings.emission, scene::error_budget::precise_piece(accuracy()),
             static_cast<double>(least_transmittance(function)), visible},
            settings.grid.shading,
            settings.clip,
            surfaces->any() ? surfaces : nullptr};
  }
  [[nodiscard]] double accuracy() const {
    return settings.integrator.kind == IntegratorKind::exact ? scene::error_budget::casting_of_exact_grid
                                                             : settings.integrator.accuracy;
  }
  /// Whether float lanes are accurate enough for this function.
  [[nodiscard]] bool lanes_suffice(const scene::TransferFunction& function) const {
    const scene::Box box = scene::bounds(source.geometry());
    const double surfaces = scene::SurfaceSet(settings.surfaces, function).max_color();
    const double light = surfaces + scene::most_light(function, settings.emission, glm::length(box.high - box.low));
    return settings.integrator.kind == IntegratorKind::exact
               ? scene::error_budget::exact_grid_in_lanes(light) <= scene::error_budget::exact_grid
               : scene::error_budget::grid_in_lanes(settings.integrator.accuracy, light) <=
                     settings.integrator.accuracy;
  }

  /// One byte per cell: marks the cells that a cast of a whole frame in double precision has to traverse.
  [[nodiscard]] std::vector<std::uint8_t> visible_to_walks(const integrals::LaneTable& table) const {
    std::vector<std::uint8_t> visible = visible_cells(ranges, table);
    show_more(ranges, bricks.layout(), !settings.use.culling, !settings.use.skipping, visible);
    return visible;
  }

  const scene::SampleSource& source;
  RenderSettings settings;
  double voxel_side = voxel_side_of(source.geometry()), length_unit = length_unit_of(voxel_side);
  std::shared_ptr<const CellRanges> ranges_owner;
  const CellRanges& ranges;
  BrickCache bricks;
  std::optional<LookAhead> look_ahead;  ///< only for the proximity policy and regular grids
  BrickCache::Counts counts_before;  ///< counts at the end of the last frame; later preloads count for the next frame
};

}  // namespace tessera::volume
