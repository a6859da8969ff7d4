// SPDX-License-Identifier: BSD-3-Clause
#include "volume/frame_setup.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <utility>

#include "scene/error_budget.hpp"
#include "volume/tile_rays.hpp"

namespace tessera::volume {
namespace {

/// Upper bound, in world units, of the length of a ray in one voxel of a regular grid.
double longest_in_voxel(const scene::GridGeometry& geometry) {
  double sides = 0;
  for (int a = 0; a < 3; ++a) sides += glm::length(geometry.direction[a]) * std::abs(geometry.spacing[a]);
  return sides;
}

/// Returns the linear part of the map from world to index space, multiplied by `unit`.
std::array<glm::dvec3, 3> index_rows(const scene::GridGeometry& geometry, double unit) {
  const glm::dmat3 to_local = scene::world_to_local(geometry);
  std::array<glm::dvec3, 3> rows;
  for (int a = 0; a < 3; ++a)
    rows[static_cast<std::size_t>(a)] =
        glm::dvec3(to_local[0][a], to_local[1][a], to_local[2][a]) * (unit / geometry.spacing[a]);
  return rows;
}

/// The lowest and highest lane scalar of the volume.
std::pair<float, float> lane_range(const CellRanges& ranges) {
  if (ranges.range.empty()) return {0.0f, 0.0f};
  return {integrals::lane_scalar(ranges.range.low, ranges.lanes.origin, ranges.lanes.unit),
          integrals::lane_scalar(ranges.range.high, ranges.lanes.origin, ranges.lanes.unit)};
}

/// Lane scalars are below 2^29, so rounding to float leaves a rest of at most 2^5. The rest is stored as a float and
/// then has an error of 2^-19. A gradient is a difference of two such values.
constexpr float noise_of_rest = 0x1p-18f;

ShadingView shading_view(const scene::Shading& s, const scene::Camera& camera, const scene::GridGeometry& geometry,
                         double voxel_side) {
  const auto number = [](double v) { return static_cast<float>(v); };
  ShadingView view{};
  view.ambient = number(s.ambient), view.diffuse = number(s.diffuse);
  view.specular = number(s.specular), view.shininess = number(s.shininess);
  view.unit = voxel_side;
  const scene::ViewBasis basis = scene::view_basis(camera);
  const glm::dvec3 l = glm::normalize(s.to_light);
  const glm::dvec3 light = s.camera_light ? basis.right * l.x + basis.up * l.y - basis.forward * l.z : l;
  view.light_eye[0] = glm::dot(light, basis.right), view.light_eye[1] = glm::dot(light, basis.up);
  view.light_eye[2] = -glm::dot(light, basis.forward);
  const std::array<glm::dvec3, 3> rows = index_rows(geometry, voxel_side);
  for (std::size_t a = 0; a < 3; ++a) {
    view.light[a] = number(glm::dot(rows[a], light));
    for (std::size_t b = 0; b < 3; ++b) view.metric[a][b] = number(glm::dot(rows[a], rows[b]));
  }
  // A unit normal turns by at most the ratio of the noise to the gradient. `turn` is the largest change of light per
  // radian.
  const double turn = s.diffuse + s.specular * std::max(1.0, s.shininess);
  view.light_per_noise =
      number(turn * std::sqrt(glm::dot(rows[0], rows[0]) + glm::dot(rows[1], rows[1]) + glm::dot(rows[2], rows[2])));
  return view;
}

}  // namespace

double length_unit_of(double voxel_side) { return std::ldexp(1.0, std::ilogb(voxel_side)); }

double voxel_side_of(const scene::GridGeometry& geometry) {
  double volume = std::abs(glm::determinant(geometry.direction));
  for (std::size_t a = 0; a < 3; ++a)
    volume *= (geometry.lattice(a, geometry.points[a] - 1) - geometry.lattice(a, 0)) /
              static_cast<double>(geometry.points[a] - 1);
  return std::cbrt(volume);
}

FrameSetup::FrameSetup(RendererState& state, const scene::Camera& camera, scene::ImageSize size,
                       const scene::TransferFunction& function, WorkTally* tally)
    : rays_(camera, size, state.source.geometry(), state.settings.clip), table_(state.table_of(function)) {
  surfaces_ = state.surfaces_of(function);
  find_visible(state);
  const scene::GridGeometry& geometry = state.source.geometry();
  view_.rays = &rays_;
  view_.table = &table_;
  view_.ranges = &state.ranges;
  view_.visible = visible_.data();
  view_.some_hidden = std::find(visible_.begin(), visible_.end(), 0) != visible_.end();
  view_.some_clear = any_clear(state.ranges, table_);
  view_.brick_visible = brick_visible_.data();
  view_.bricks = &state.bricks;
  view_.voxels = geometry.voxels();
  view_.samples = geometry.samples();
  view_.cell_data = geometry.association == scene::Association::cell;
  view_.length_unit = state.length_unit;
  view_.least_transmittance = state.least_transmittance(function);
  view_.piece_tolerance = static_cast<float>(scene::error_budget::grid_piece(state.accuracy()));
  view_.largest_color = static_cast<float>(std::max(1e-30, function.max_color()));
  view_.lanes = state.ranges.lanes;
  // Steps of the transfer function, surfaces and gradients require samples that are not rounded to integers.
  const bool wants_gradients = !view_.cell_data && (state.settings.grid.shading || surfaces_.any());
  view_.lanes.whole = in_steps(state.settings.integrator.kind) || (!table_.has_steps && !wants_gradients);
  view_.has_rest = wants_gradients && !view_.lanes.exact && !in_steps(state.settings.integrator.kind);
  if (view_.has_rest) view_.rest_noise = noise_of_rest;
  view_.tally = tally;
  // In images of at least 32 tiles, a thousand packets or more are cast.
  const double tiles_in_picture = static_cast<double>(size.width) * size.height / (TileRays::side * TileRays::side);
  view_.pilot_packets = static_cast<int>(std::clamp(1024 / tiles_in_picture, 2.0, 32.0));
  view_.trace = state.settings.trace;
  set_up_method(state, function);
  if (surfaces_.any()) set_up_surfaces(state, function);
  if (state.settings.grid.shading)
    view_.shading = &shading_.emplace(shading_view(*state.settings.grid.shading, camera, geometry, state.voxel_side));
}

void FrameSetup::find_visible(RendererState& state) {
  const RenderSettings& settings = state.settings;
  const scene::TraceScope scope(settings.trace, "cull");
  const auto begin = std::chrono::steady_clock::now();
  visible_ = settings.integrator.kind == IntegratorKind::preintegrated ? visible_to_table(state)
                                                                       : visible_cells(state.ranges, table_);
  if (!settings.use.culling || !settings.use.skipping)
    show_more(state.ranges, state.bricks.layout(), !settings.use.culling, !settings.use.skipping, visible_);
  if (surfaces_.any())
    for (std::size_t cell = 0; cell < visible_.size(); ++cell) visible_[cell] |= surfaces_.holding()[cell];
  brick_visible_ = visible_bricks(state.ranges, visible_, state.bricks.layout());
  cull_us_ = microseconds_since(begin);
}

/// A pre-integrated step between two values may be visible although neither of them is, and the table is interpolated
/// linearly between its entries.
std::vector<std::uint8_t> FrameSetup::visible_to_table(const RendererState& state) const {
  const auto [low, high] = lane_range(state.ranges);
  const float entry =
      std::max(high - low, 1.0f) / static_cast<float>(PreintegratedTable::size_for(table_, low, high) - 1);
  const std::array<glm::dvec3, 3> rows =
      index_rows(state.source.geometry(), state.settings.grid.step * state.voxel_side);
  std::array<double, 3> reach;
  // This margin is much larger than the rounding errors of positions along rays.
  for (std::size_t a = 0; a < 3; ++a) reach[a] = glm::length(rows[a]) + 0.05;
  return visible_to_steps(state.ranges, table_, reach, 1.25f * entry);
}

void FrameSetup::set_up_surfaces(const RendererState& state, const scene::TransferFunction& function) {
  SurfaceView& view = surface_view_.emplace(surfaces_.set(), view_.lanes);
  view.noise = 4 * error_bound_.noise;  // at least the noise of any voxel (surface_pieces-inl.h)
  view.brightest = static_cast<float>(std::max(1.0, state.brightest(function)));
  view.unit = state.voxel_side;
  const std::array<glm::dvec3, 3> rows = index_rows(state.source.geometry(), view.unit);
  for (std::size_t a = 0; a < 3; ++a) {
    view.stretched = std::max(a == 0 ? 0.0f : view.stretched, static_cast<float>(glm::length(rows[a])));
    for (std::size_t b = 0; b < 3; ++b) view.metric[a][b] = glm::dot(rows[a], rows[b]);
  }
  view_.surfaces = &view;
}

/// Sets up the data that only some integrators need.
void FrameSetup::set_up_method(const RendererState& state, const scene::TransferFunction& function) {
  if (in_steps(state.settings.integrator.kind)) {
    view_.step = state.settings.grid.step * state.voxel_side / state.length_unit;
  } else if (view_.tally == nullptr) {
    const double promised =
        state.settings.integrator.kind == IntegratorKind::exact ? scene::error_budget::exact_grid : state.accuracy();
    view_.error_tolerance = static_cast<float>(scene::error_budget::noted(promised) / state.settings.parts);
    error_bound_ =
        LaneErrorBound(function, table_, state.ranges,
                       {view_.cell_data, view_.largest_color, state.brightest(function), view_.error_tolerance,
                        longest_in_voxel(state.source.geometry()) / state.length_unit, state.length_unit});
    if (error_bound_.any()) view_.error_bound = &error_bound_;
    if (!state.lanes_suffice(function)) view_.error_tolerance = -1;  // cast all rays again in double precision
  }
  if (state.settings.integrator.kind != IntegratorKind::preintegrated || view_.tally != nullptr) return;
  const auto [low, high] = lane_range(state.ranges);
  preintegrated_.emplace(table_, low, high, static_cast<float>(view_.step),
                         PreintegratedTable::size_for(table_, low, high));
  view_.preintegrated = &*preintegrated_;
}

}  // namespace tessera::volume
