// SPDX-License-Identifier: BSD-3-Clause
#include "volume/precise/surface_walk.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "volume/precise/voxel_cubic.hpp"
#include "volume/precise/voxel_steps.hpp"

namespace tessera::volume {
namespace {

constexpr double on_level = 1e-10;  // tolerance in a clip plane, relative to a voxel's largest value

constexpr double rounding = 1e-14;  // upper bound of the error of field_at() relative to the largest value

std::array<double, 8> differences(const std::array<double, 8>& corner, double value) {
  std::array<double, 8> d;
  for (std::size_t n = 0; n < 8; ++n) d[n] = corner[n] - value;
  return d;
}

/// Linear interpolation for weights in [0, 1]. If the values have the same sign, so has the result; weights of 0 and 1
/// return the bits of a value.
double between(double low, double high, double weight) { return low * (1 - weight) + high * weight; }

double field_at(const std::array<double, 8>& v, const glm::dvec3& p) {
  return between(between(between(v[0], v[1], p.x), between(v[2], v[3], p.x), p.y),
                 between(between(v[4], v[5], p.x), between(v[6], v[7], p.x), p.y), p.z);
}

/// Returns the zero of a cubic that is monotonic from u0 to u1 and below zero at exactly one of them. Uses Newton's
/// method, with bisection where a step leaves the bracket.
double zero_of(const std::array<double, 4>& p, double u0, double u1, bool rises) {
  constexpr double close = 1e-15;
  double u = (u0 + u1) / 2;
  for (int n = 0; n < 80 && u1 - u0 > close; ++n) {
    const double value = ((p[3] * u + p[2]) * u + p[1]) * u + p[0];
    ((value < 0) == rises ? u0 : u1) = u;
    const double slope = (3 * p[3] * u + 2 * p[2]) * u + p[1], next = u - value / slope;
    const bool inside = next > u0 && next < u1;
    if (inside && std::abs(next - u) <= close) return next;
    u = inside ? next : (u0 + u1) / 2;
  }
  return u;
}

}  // namespace

/// A ray's stretch in a voxel, from `front` to `back` in the unit cube of the voxel.
struct SurfaceWalk::Stretch {
  std::array<double, 8> corner;
  glm::dvec3 front, back, side;
  bool front_cut, back_cut;
  double size;  ///< largest magnitude of the values at the corners

  [[nodiscard]] glm::dvec3 place(double u) const {
    return {between(front.x, back.x, u), between(front.y, back.y, u), between(front.z, back.z, u)};
  }
  [[nodiscard]] glm::dvec3 end_or_place(double u) const { return u == 0 ? front : u == 1 ? back : place(u); }
  [[nodiscard]] bool cut(double u) const { return (u == 0 && front_cut) || (u == 1 && back_cut); }
  /// Whether the field is below a value, exact to the last place.
  [[nodiscard]] bool below(double value, double u) const {
    const double height = field_at(differences(corner, value), end_or_place(u));
    return height < 0 && !(cut(u) && -height <= on_level * size);
  }
};

SurfaceWalk::SurfaceWalk(const scene::SampleSource& source, const GridSurfaces& surfaces)
    : geometry_(source.geometry()),
      surfaces_(surfaces),
      to_world_gradient_(glm::transpose(scene::world_to_local(geometry_))),
      voxels_(geometry_.voxels()),
      cells_(cells_along(geometry_)),
      blocks_(source) {}

bool SurfaceWalk::find(const VoxelRay& ray, double least, std::vector<SurfaceCrossing>& found) {
  constexpr std::int64_t side = CellRanges::side;
  const auto holding = surfaces_.holding();
  double through = 1;
  VoxelSteps at(geometry_, ray);
  while (at.inside()) {
    const scene::GridIndex& voxel = at.voxel();
    const scene::GridIndex cell{voxel[0] / side, voxel[1] / side, voxel[2] / side};
    if (!holding.empty() &&
        holding[static_cast<std::size_t>(cell[0] + cells_[0] * (cell[1] + cells_[1] * cell[2]))] == 0) {
      scene::GridIndex low, high;
      for (std::size_t a = 0; a < 3; ++a) low[a] = cell[a] * side, high[a] = std::min(low[a] + side, voxels_[a]);
      at.leave(low, high);
      continue;
    }
    if (at.begin() < at.end()) {
      through = cross(ray, at, through, least, found);
      if (through < least) return true;
    }
    at.step();
  }
  return false;
}

SurfaceWalk::Stretch SurfaceWalk::stretch_of(const VoxelRay& ray, const scene::GridIndex& voxel, double z0, double z1,
                                             const std::array<double, 8>& corner) const {
  Stretch stretch{corner, {}, {}, {}, z0 == ray.begin_cut, z1 == ray.end_cut, 0};
  for (const double v : corner) stretch.size = std::max(stretch.size, std::abs(v));
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const double low = geometry_.lattice(a, voxel[a]), high = geometry_.lattice(a, voxel[a] + 1);
    const double origin = ray.origin[axis], step = ray.step[axis];
    const auto place = [&](double z) {
      constexpr double near = 1e-6;  // exceeds the rounding error unless the eye is 1e9 voxels away
      const double p = (origin + z * step - low) / (high - low);
      if (p < near && step != 0 && z == (low - origin) / step) return 0.0;
      if (p > 1 - near && step != 0 && z == (high - origin) / step) return 1.0;
      return std::clamp(p, 0.0, 1.0);
    };
    stretch.front[axis] = place(z0), stretch.back[axis] = place(z1), stretch.side[axis] = high - low;
  }
  return stretch;
}

double SurfaceWalk::cosine(const VoxelRay& ray, const Stretch& stretch, double u) const {
  const glm::dvec3 p = stretch.place(u);
  std::array<double, 8> v;
  // Subtracting a constant does not change the slopes.
  for (std::size_t n = 0; n < 8; ++n) v[n] = stretch.corner[n] - stretch.corner[0];
  const auto bilinear = [](double a, double b, double c, double d, double x, double y) {
    return between(between(a, b, x), between(c, d, x), y);
  };
  const glm::dvec3 slope(bilinear(v[1] - v[0], v[3] - v[2], v[5] - v[4], v[7] - v[6], p.y, p.z),
                         bilinear(v[2] - v[0], v[3] - v[1], v[6] - v[4], v[7] - v[5], p.x, p.z),
                         bilinear(v[4] - v[0], v[5] - v[1], v[6] - v[2], v[7] - v[3], p.x, p.y));
  const glm::dvec3 gradient = to_world_gradient_ * (slope / stretch.side);
  const double steepness = glm::length(gradient);
  if (!(steepness > 0)) return 1;
  const glm::dvec3 along = geometry_.direction * ray.step;
  return std::min(1.0, std::abs(glm::dot(gradient / steepness, along)) / glm::length(along));
}

double SurfaceWalk::cross(const VoxelRay& ray, const VoxelSteps& at, double through, double least,
                          std::vector<SurfaceCrossing>& found) {
  const double z0 = at.begin(), z1 = at.end();
  const std::array<double, 8> corner = blocks_.corners(at.voxel());
  double low = corner[0], high = corner[0], all = 0;
  for (const double s : corner) low = std::min(low, s), high = std::max(high, s), all += s;
  if (std::isnan(all)) return through;
  const auto values = surfaces_.set().iso_values();
  const bool cut = z0 == ray.begin_cut || z1 == ray.end_cut;
  const double slack = cut ? on_level * std::max(std::abs(low), std::abs(high)) : 0;
  const auto first =
                 static_cast<std::size_t>(std::upper_bound(values.begin(), values.end(), low - slack) - values.begin()),
             last = static_cast<std::size_t>(std::upper_bound(values.begin(), values.end(), high + slack) -
                                             values.begin());
  if (first >= last) return through;
  const Stretch stretch = stretch_of(ray, at.voxel(), z0, z1, corner);
  // All values are relative to the first value. Where rounding may matter, below() uses differences from the value in
  // question.
  const std::array<double, 8> from_first = differences(corner, values[first]);
  const std::array<double, 4> cubic = cubic_of(from_first, stretch.front, stretch.back - stretch.front);
  std::array<double, 4> ends{0, 1, 1, 1}, field{};
  std::size_t count = 1;
  turning_points(cubic, ends, count);
  double largest = 0;
  for (const double d : from_first) largest = std::max(largest, std::abs(d));
  for (std::size_t e = 0; e <= count; ++e) field[e] = field_at(from_first, stretch.end_or_place(ends[e]));
  const auto below = [&](std::size_t iso, std::size_t e) {
    const double level = values[iso] - values[first], height = field[e] - level;
    const double unsure = rounding * (largest + level) + (stretch.cut(ends[e]) ? 2 * on_level * stretch.size : 0);
    return std::abs(height) > unsure ? height < 0 : stretch.below(values[iso], ends[e]);
  };
  double behind = 0;
  for (std::size_t e = 0; e < count; ++e) {
    // The field is monotonic from one end to the next, so surfaces are crossed in the order of their values.
    const bool up = field[e] <= field[e + 1];
    for (std::size_t n = 0; n < last - first; ++n) {
      const std::size_t iso = up ? first + n : last - 1 - n;
      const bool rises = below(iso, e);
      if (rises == below(iso, e + 1)) continue;
      std::array<double, 4> from_value = cubic;
      from_value[0] -= values[iso] - values[first];
      behind = std::max(behind, zero_of(from_value, ends[e], ends[e + 1], rises));
      const std::uint32_t number = surfaces_.set().crossing(iso, rises, scene::SurfaceSet::Place::inside);
      found.push_back(
          {behind == 1 ? z1 : z0 + (z1 - z0) * behind, surfaces_.set().light(number, cosine(ray, stretch, behind))});
      through *= 1 - found.back().light.opacity;
      if (through < least) return through;
    }
  }
  return through;
}

}  // namespace tessera::volume
