// SPDX-License-Identifier: BSD-3-Clause
#include "volume/precise/voxel_walk.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "volume/precise/voxel_cubic.hpp"
#include "volume/precise/voxel_steps.hpp"

namespace tessera::volume {
namespace {

constexpr std::int64_t cell_side = 8;

}  // namespace

/// The field s as a cubic in u, for u in [0, 1].
struct VoxelWalk::FieldCubic {
  static constexpr double last_places = 0x1p-51;
  std::array<double, 4> c;

  [[nodiscard]] double at(double u) const { return ((c[3] * u + c[2]) * u + c[1]) * u + c[0]; }
  [[nodiscard]] double mean(double u0, double u1) const {
    const double m = (u0 + u1) / 2, h = (u1 - u0) / 2;
    return at(m) + (c[2] + 3 * c[3] * m) * h * h / 3;
  }
  [[nodiscard]] double slope(double u) const { return (3 * c[3] * u + 2 * c[2]) * u + c[1]; }
  /// Returns a position at or just behind which the cubic has the given value, which is between the values at u0 and
  /// u1. The cubic must be monotonic from u0 to u1. Uses Newton's method within a shrinking bracket, with bisection
  /// where a step leaves the bracket or convergence is slow.
  [[nodiscard]] double crossing(double u0, double u1, double value) const {
    const double s_0 = at(u0), s_1 = at(u1);
    const bool rising = s_1 > s_0;
    double u = u0 + (u1 - u0) * ((value - s_0) / (s_1 - s_0));
    for (int n = 0; n < 60 && u1 - u0 > last_places * u1; ++n) {
      if (!(u0 < u && u < u1) || n % 8 == 7) u = (u0 + u1) / 2;
      const double above = at(u) - value;
      const bool before = (above < 0) == rising;
      (before ? u0 : u1) = u;
      // The step goes slightly beyond the root, so that the other end of the bracket moves as well.
      const double step = above / slope(u), beyond = std::abs(step) * 0x1p-8 + last_places / 2 * u1;
      u -= before ? step - beyond : step + beyond;
    }
    return u1;
  }
};

/// A ray's stretch in one voxel, from depth z0 to z1.
struct VoxelWalk::CubicStretch {
  FieldCubic field;
  double z0, z1, length;

  [[nodiscard]] double depth(double u) const { return u == 0 ? z0 : u == 1 ? z1 : z0 + (z1 - z0) * u; }
};

scene::TransferFunction over_knot_numbers(const scene::TransferFunction& function) {
  std::vector<scene::Knot> knots(function.knots().begin(), function.knots().end());
  for (std::size_t k = 0; k < knots.size(); ++k) knots[k].value = static_cast<double>(k);
  return scene::TransferFunction(std::move(knots));
}

VoxelWalk::VoxelWalk(const scene::SampleSource& source, const scene::TransferFunction& function,
                     const WalkSettings& settings)
    : geometry_(source.geometry()),
      settings_(settings),
      blocks_(source),
      knots_(function.knots().begin(), function.knots().end()),
      independent_(settings.emission == scene::Emission::independent) {
  const scene::GridIndex voxels = geometry_.voxels();
  for (std::size_t a = 0; a < 3; ++a) cells_[a] = (voxels[a] + cell_side - 1) / cell_side;
}

void VoxelWalk::walk(const VoxelRay& ray, WalkSink& sink) {
  for (VoxelSteps at(geometry_, ray); at.inside(); at.step()) {
    if (!(at.begin() < at.end())) continue;
    if (sink.transmittance() < settings_.least) return;
    cross(ray, at.voxel(), at.begin(), at.end(), sink);
  }
}

/// Walks through the voxel in which the ray is from depth z0 to z1.
void VoxelWalk::cross(const VoxelRay& ray, const scene::GridIndex& voxel, double z0, double z1, WalkSink& sink) {
  if (!settings_.visible.empty() &&
      settings_.visible[static_cast<std::size_t>(
          voxel[0] / cell_side + cells_[0] * (voxel[1] / cell_side + cells_[1] * (voxel[2] / cell_side)))] == 0)
    return;
  ++voxels_;
  VoxelStretch stretch{z0, z1, blocks_.corners(voxel), {}, {}, {}};
  const std::array<double, 8>& corner = stretch.corner;
  double low = corner[0], high = corner[0], all = 0;
  for (const double s : corner) low = std::min(low, s), high = std::max(high, s), all += s;
  if (std::isnan(all) || !shows(low, high)) return;
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const double first = geometry_.lattice(a, voxel[a]), side = geometry_.lattice(a, voxel[a] + 1) - first;
    stretch.front[axis] = (ray.origin[axis] + z0 * ray.step[axis] - first) / side;
    stretch.rise[axis] = (z1 - z0) * ray.step[axis] / side;
    stretch.side[axis] = side;
  }
  sink.enter(stretch);
  const auto first = std::lower_bound(knots_.begin(), knots_.end(), low,
                                      [](const scene::Knot& knot, double v) { return knot.value < v; });
  origin_ = first != knots_.end() && first->value <= high ? first->value : low;
  if (low == high) {  // includes cell data
    const double number = knot_number(knots_above(low - origin_), low - origin_);
    return sink.line(z0, z1, number, number);
  }
  std::array<double, 8> differences;
  std::transform(corner.begin(), corner.end(), differences.begin(), [&](double s) { return s - origin_; });
  const CubicStretch cubic{
      {cubic_of(differences, stretch.front, stretch.rise)}, z0, z1, (z1 - z0) * ray.length_per_depth};
  const FieldCubic& field = cubic.field;

  std::array<double, 4> ends{0, 1, 1, 1};
  std::size_t count = 1;
  turning_points(field.c, ends, count);
  for (std::size_t e = 0; e < count; ++e) {
    double u = ends[e];
    const double stop = ends[e + 1], s_stop = field.at(stop);
    // The cubic is monotonic from u to `stop`, so knots are crossed in order.
    while (u < stop) {
      const double s = field.at(u);
      const bool up = s_stop >= s;
      const double knot = next_knot(s, u > ends[e] ? last_knot_ : std::nan(""), up);
      const double next = (up ? knot < s_stop : knot > s_stop) ? field.crossing(u, stop, knot) : stop;
      last_knot_ = knot;
      if (next > u) add_smooth(cubic, u, next, 0, sink);
      if (!(next > u) && next != stop) {  // the crossing is at u itself: continue behind the knot
        u = std::nextafter(u, 2.0);
        continue;
      }
      u = next;
    }
  }
}

/// Returns the next knot from s on, other than the knot that was just crossed; infinite if there is none.
double VoxelWalk::next_knot(double s, double crossed, bool up) const {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (up) {
    const std::size_t k = knots_above(std::isnan(crossed) ? s : std::max(s, crossed));
    return k == knots_.size() ? none : knots_[k].value - origin_;
  }
  const double past = std::isnan(crossed) ? s : std::min(s, crossed);
  const auto k = std::lower_bound(knots_.begin(), knots_.end(), past,
                                  [&](const scene::Knot& knot, double v) { return knot.value - origin_ < v; });
  return k == knots_.begin() ? -none : std::prev(k)->value - origin_;
}

/// Returns the index of the first knot above s.
std::size_t VoxelWalk::knots_above(double s) const {
  return static_cast<std::size_t>(
      std::upper_bound(knots_.begin(), knots_.end(), s,
                       [&](double v, const scene::Knot& knot) { return v < knot.value - origin_; }) -
      knots_.begin());
}

/// Returns the knot number of s, which is between knot `above` and the knot before it.
double VoxelWalk::knot_number(std::size_t above, double s) const {
  if (above == 0) return -1;
  const auto below = static_cast<double>(above - 1);
  if (above == knots_.size()) return below;
  const double low = knots_[above - 1].value - origin_, high = knots_[above].value - origin_;
  return below + std::clamp((s - low) / (high - low), 0.0, 1.0);
}

/// Adds a monotonic stretch in one interval of the transfer function. The stretch is halved until a line with the same
/// mean is accurate enough.
void VoxelWalk::add_smooth(const CubicStretch& stretch, double u0, double u1, int halvings, WalkSink& sink) const {
  const FieldCubic& p = stretch.field;
  const double s_0 = p.at(u0), s_1 = p.at(u1), middle = p.at((u0 + u1) / 2), e = u1 - u0;
  const std::size_t above = knots_above(middle);
  // The line that replaces the stretch is its chord, shifted to the mean of the cubic.
  const double shift = p.mean(u0, u1) - (s_0 + s_1) / 2;
  double low = -std::numeric_limits<double>::infinity(), high = -low, kappa = 0;
  if (above > 0) low = knots_[above - 1].value - origin_, kappa = knots_[above - 1].extinction;
  if (above < knots_.size()) high = knots_[above].value - origin_, kappa = std::max(kappa, knots_[above].extinction);
  if (above > 0 && above < knots_.size() && halvings < 12) {
    const scene::Knot &a = knots_[above - 1], &b = knots_[above];
    const double width = high - low, slope = std::abs(b.extinction - a.extinction) / width;
    const glm::dvec3 change = glm::abs(b.color - a.color) / width;
    const double color_slope = std::max({change.x, change.y, change.z});
    const double color = std::max({a.color.x, a.color.y, a.color.z, b.color.x, b.color.y, b.color.z});
    const double l = e * stretch.length, span = std::abs(s_1 - s_0), even = std::abs(middle - (s_0 + s_1) / 2);
    const double odd = std::abs(p.c[3]) * e * e * e, rho = even + odd / 4;
    const double tau = kappa * l, weight = independent_ ? l : tau;
    // Lines are clipped to the interval; `cut` is the largest part of the shifted chord that is outside of it.
    const double cut = std::max({0.0, low - std::min(s_0, s_1) - shift, std::max(s_0, s_1) + shift - high});
    const double cut_error = l * cut * (slope * std::max(1.0, color) + (independent_ ? 1 : kappa) * color_slope);
    const double error = cut_error +
                         l * rho * (rho + 0.3 * span) * (0.1 * slope * color_slope + 0.03 * slope * slope * color * l) +
                         color_slope * weight * tau * (odd / 120 + tau * even / 90);
    if (error * sink.transmittance() > settings_.tolerance) {
      add_smooth(stretch, u0, (u0 + u1) / 2, halvings + 1, sink);
      add_smooth(stretch, (u0 + u1) / 2, u1, halvings + 1, sink);
      return;
    }
  }
  sink.line(stretch.depth(u0), stretch.depth(u1), knot_number(above, s_0 + shift), knot_number(above, s_1 + shift));
}

/// Whether the transfer function is visible anywhere between two values.
bool VoxelWalk::shows(double low, double high) const {
  const auto lit = [&](const scene::Knot& k) {
    return k.extinction > 0 || (independent_ && std::max({k.color.x, k.color.y, k.color.z}) > 0);
  };
  const auto first = std::upper_bound(knots_.begin(), knots_.end(), low,
                                      [](double v, const scene::Knot& knot) { return v < knot.value; });
  const auto last = std::upper_bound(knots_.begin(), knots_.end(), high,
                                     [](double v, const scene::Knot& knot) { return v < knot.value; });
  return std::any_of(first == knots_.begin() ? first : std::prev(first), last == knots_.end() ? last : std::next(last),
                     lit);
}

}  // namespace tessera::volume
