// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/lattice_frame.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "compositor/window_kernel.hpp"
#include "projection/lattice/lattice_rasterizer.hpp"
#include "projection/matter_light.hpp"
#include "projection/steps.hpp"
#include "scene/error_budget.hpp"
#include "scene/surface_set.hpp"

namespace tessera::frame {
namespace {

namespace budget = scene::error_budget;

constexpr double most_optical_depth = 2000;
/// The brightest light of a frame's rays, and the largest change of a pixel per step of depth.
struct Brightness {
  double of_rays, of_surfaces, per_step;
};
/// Returns the largest change of a pixel that the rounding of scalars may cause. It is this rounding's share of the
/// error budget, or what the other errors leave of the budget if that is less. If it is not above zero, float lanes are
/// not accurate enough.
double most_error_of(const Settings& settings, const Brightness& light, const FrameSettings& frame) {
  const scene::Integrator& integrator = settings.integrator;
  if (frame.peel) {
    const bool exact = integrator.kind == scene::IntegratorKind::exact;
    const double accuracy = exact ? budget::exact_layers : std::min(integrator.accuracy, budget::exact_layers);
    return budget::scalars_of_layers(accuracy, frame.peel->threshold, light.of_rays, settings.mesh.shading.has_value());
  }
  const Surfaces& surfaces = settings.surfaces;
  const bool automatic = integrator.kind == scene::IntegratorKind::automatic,
             shaded = settings.mesh.shading.has_value();
  const double brightest = std::max(light.of_rays, light.of_surfaces);
  // A piece may be moved by compositor::touching_steps to the end of a sample, which changes light and transmittance.
  const double moved = 2 * compositor::touching_steps * light.per_step;
  if (frame.deep && budget::deep_on_lattice(frame.deep_accuracy, brightest, shaded) + moved > frame.deep_accuracy)
    return 0;
  const double share = automatic ? budget::lattice_scalars(integrator.accuracy) : budget::lattice_scalars_of_exact;
  const double all = automatic ? budget::mesh_on_lattice(integrator.accuracy, brightest, shaded)
                               : budget::exact_mesh_on_lattice(brightest, shaded);
  const double promised = automatic ? integrator.accuracy : budget::exact_mesh;
  if (all > promised) return 0;
  double of_surfaces = surfaces.empty() ? 0 : budget::lane_surfaces(surfaces.light);
  // Matter may be on the wrong side of a triangle.
  if (surfaces.has_faces())
    of_surfaces += projection::LatticeFaces::reach * light.per_step + projection::DepthLimits::most_error;
  const double left = std::min(share, promised - (all - share) - of_surfaces * std::max(1.0, light.of_surfaces));
  return frame.deep ? std::min(left, budget::lattice_scalars_of_exact) : left;
}
// An error of at most D in the extinctions of one piece of the function changes light and opacity by at most D int T dt
// times the largest contribution behind the piece. The integral is over the part of the ray whose scalars are in the
// piece. Transmittance T falls at least like exp(-sigma t), where sigma is the piece's smallest extinction. Let x_i be
// the integral of piece i. Then sum x_i <= L and sum sigma_i x_i <= 1. If D_i <= E (1 / L + sigma_i) / 2 for all
// pieces, their total error is at most E.
double seen_length(double length, double least_extinction) {
  return std::min(length, 2 / (1 / length + least_extinction));
}
// Upper bound of a change in optical depth: what is behind such an optical depth is invisible. Only rays at the foot of
// a very steep ramp could show more.
constexpr double most_change_of_depth = 64;
constexpr double margin = 1.001;  // keeps rounding and the planes' error inside the lattice

/// Returns the range of planar depths of the box that is in front of the eye and inside the clipping range.
std::array<double, 2> depth_range(const projection::PixelSpace& space, const scene::Box& box) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p((corner & 1) != 0 ? box.high.x : box.low.x, (corner & 2) != 0 ? box.high.y : box.low.y,
                       (corner & 4) != 0 ? box.high.z : box.low.z);
    const double depth = space.project(p).depth;
    low = std::min(low, depth), high = std::max(high, depth);
  }
  return {std::max(low, space.near_depth()), std::min(high, space.far_depth())};
}

/// Returns the box together with the corners of triangle surfaces.
scene::Box with_triangles(scene::Box box, const Surfaces& surfaces) {
  for (const TriangleSurface& surface : surfaces.triangles)
    for (const glm::dvec3& p : surface.mesh->points) box.low = glm::min(box.low, p), box.high = glm::max(box.high, p);
  return box;
}

/// Returns the range together with the values of the triangles that have the colour of their values.
std::array<double, 2> with_values(std::array<double, 2> range, const Surfaces& surfaces) {
  for (const TriangleSurface& surface : surfaces.triangles)
    if (!surface.color)
      for (const double value : surface.mesh->values) range = {std::min(range[0], value), std::max(range[1], value)};
  return range;
}

/// The largest world length per planar depth of any ray of the image.
double most_length_per_depth(const projection::PixelSpace& space) { return space.length_per_depth(0, 0); }

std::optional<FrameLattice> lattice_for(const projection::PixelSpace& space, const scene::Box& box,
                                        const std::array<double, 2>& scalar_range,
                                        const scene::TransferFunction& transfer_function, const Settings& settings,
                                        const FrameSettings& frame) {
  using scene::Lattice;
  const std::optional<scene::Shading>& shading = settings.mesh.shading;
  const scene::TransferFunction function =
      shading ? projection::brightest(*shading, transfer_function) : transfer_function;
  const bool exact = settings.integrator.kind == scene::IntegratorKind::exact ||
                     settings.integrator.kind == scene::IntegratorKind::automatic;
  const bool has_faces = settings.surfaces.has_faces(), has_devices = !settings.mesh.device.backends.empty();
  if (!settings.use.lattice || settings.mesh.rasterizer == Rasterizer::scanline || box.empty() ||
      (!exact && (has_devices || projection::has_steps(function))) || (has_faces && !settings.surfaces.iso.empty()) ||
      !projection::lattice_available())
    return std::nullopt;
  const auto [near, far] = depth_range(space, with_triangles(box, settings.surfaces));
  if (!(near <= far) || !std::isfinite(far - near)) return std::nullopt;

  Lattice lattice{};
  lattice.depth_origin = near + (far - near) / 2;
  // The lattice's origin is rounded relative to the eye's distance. If a mesh is flat in comparison to this distance,
  // its thin cells keep their thickness only in double precision.
  const double half_depth = (far - near) / 2;
  if (half_depth < 1e-6 * std::abs(far)) return std::nullopt;
  lattice.depth_unit = Lattice::unit_for(margin * half_depth);
  const double longest = (far - near) * most_length_per_depth(space);
  if (function.max_extinction() * longest > most_optical_depth) return std::nullopt;

  const auto knots = function.knots();
  const auto [low, high] = with_values(scalar_range, settings.surfaces);
  const double first = std::clamp(knots.front().value, low, high), last = std::clamp(knots.back().value, low, high);
  const double origin = first + (last - first) / 2;
  const double reach = std::max({high - origin, origin - low, 1e-12 * std::abs(origin)});
  if (!std::isfinite(reach)) return std::nullopt;
  const double length = std::min(longest, glm::length(box.high - box.low));
  const bool independent = settings.emission == scene::Emission::independent;
  const double of_surfaces = scene::SurfaceSet(settings.surfaces, transfer_function).max_color();
  const double per_step = depth_limits_of(space, lattice, function, settings.emission, longest).light_per_step;
  const double most_error =
      most_error_of(settings, {scene::most_light(function, settings.emission, length), of_surfaces, per_step}, frame);
  if (!(most_error > 0)) return std::nullopt;
  const double brightest = std::max({1.0, function.max_color() * (independent ? length : 1), of_surfaces});
  std::vector<FunctionPiece> pieces;
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const scene::Knot &a = knots[i - 1], &b = knots[i];
    if (a.value == b.value || b.value < low || a.value > high) continue;
    const glm::dvec3 color = glm::abs(b.color - a.color);
    const double seen = seen_length(length, std::min(a.extinction, b.extinction));
    const double depth = std::min(std::abs(b.extinction - a.extinction) * seen, most_change_of_depth) * brightest;
    // A triangle surface may show the colour itself.
    const double most_color =
        std::max({color.x, color.y, color.z}) * (independent ? std::max(seen, has_faces ? 1.0 : 0.0) : 1);
    const bool step_above = i + 1 < knots.size() && knots[i + 1].value == b.value;
    pieces.push_back({a.value, b.value, std::max(most_color, depth), step_above});
  }
  ScalarLattice scalars{lattice, 0};
  scalars.place(origin, reach);
  if (std::ranges::all_of(pieces, [&](const FunctionPiece& p) { return scalars.resolves(p, most_error); }))
    return FrameLattice{scalars.lattice, transfer_function};
  if (!exact || has_faces || has_devices) return std::nullopt;
  return magnify(scalars, {low, high}, pieces, most_error, transfer_function);
}

}  // namespace

std::optional<FrameLattice> lattice_of(const projection::PixelSpace& space, const scene::Box& box,
                                       const std::array<double, 2>& scalar_range,
                                       const scene::TransferFunction& function, const Settings& settings) {
  return lattice_for(space, box, scalar_range, function, settings, {});
}

std::optional<FrameLattice> lattice_of(const projection::PixelSpace& space, const scene::Box& box,
                                       const std::array<double, 2>& scalar_range,
                                       const scene::TransferFunction& function, const Settings& settings,
                                       const FrameSettings& frame) {
  if (frame.by_depth() && (settings.emission == Emission::independent || !settings.surfaces.empty()))
    return std::nullopt;
  return lattice_for(space, box, scalar_range, function, settings, frame);
}

scene::Integrator integrator_of(const Settings& settings, const FrameSettings& frame) {
  scene::Integrator integrator = settings.integrator;
  if (frame.deep && !frame.peel)
    integrator.accuracy = std::min(integrator.accuracy, budget::integrator_of_deep(frame.deep_accuracy));
  return integrator;
}

projection::DepthLimits depth_limits_of(const projection::PixelSpace& space, const scene::Lattice& lattice,
                                        const scene::TransferFunction& function, scene::Emission emission,
                                        double longest_ray) {
  const bool independent = emission == scene::Emission::independent;
  const double brightest = std::max(1.0, function.max_color() * (independent ? longest_ray : 1));
  const double light_per_length = function.max_extinction() * brightest + (independent ? function.max_color() : 0);
  return {light_per_length * most_length_per_depth(space) * lattice.depth_unit, space.perspective()};
}

}  // namespace tessera::frame
