// SPDX-License-Identifier: BSD-3-Clause
#include "reference/curved/curved_integral.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "reference/gauss_legendre.hpp"
#include "reference/knot_cuts.hpp"

namespace tessera::reference {
namespace {

constexpr double most_optical_step = 0.5;
constexpr double unseen_depth = 41.45;  // exp(-41.45) < 1e-18
constexpr int most_light_halvings = 50;

/// Integrates over [u0, u1] with eight points.
template <class Function>
double integral(double u0, double u1, const Function& function) {
  const double middle = (u0 + u1) / 2, half = (u1 - u0) / 2;
  double sum = 0;
  for (const auto& [x, weight] : gauss_nodes)
    sum += weight * (function(middle - half * x) + function(middle + half * x));
  return half * sum;
}

}  // namespace

double CurvedIntegral::opacity() const { return -std::expm1(-optical_depth_); }

CurvedIntegral::Ramp CurvedIntegral::ramp(double within, double origin) const {
  const auto above = static_cast<std::size_t>(
      std::upper_bound(knots_.begin(), knots_.end(), within,
                       [origin](double value, const scene::Knot& knot) { return value < knot.value - origin; }) -
      knots_.begin());
  const scene::Knot& low = knots_[above == 0 ? 0 : above - 1];
  const scene::Knot& high = knots_[above == knots_.size() ? above - 1 : above];
  Ramp result{low.value - origin, low.extinction, 0, {low.color.x, low.color.y, low.color.z}, {}};
  const double width = high.value - low.value;
  if (!(width > 0)) return result;
  result.extinction_slope = (high.extinction - low.extinction) / width;
  for (int i = 0; i < 3; ++i) result.color_slope[static_cast<std::size_t>(i)] = (high.color[i] - low.color[i]) / width;
  return result;
}

void CurvedIntegral::add(const SmoothScalar& scalar, double length_per_depth, double origin) {
  const double half_length = (scalar.back - scalar.front) / 2 * length_per_depth;
  if (!(half_length > 0)) return;
  std::vector<double> ends = scalar.turning_points();
  ends.insert(ends.begin(), -1);
  ends.push_back(1);
  const std::vector<double> cuts = knot_cuts(scalar, ends, knots_, origin);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
    if (cuts[i + 1] > cuts[i]) add_cut(scalar, cuts[i], cuts[i + 1], half_length, origin);
}

void CurvedIntegral::add_cut(const SmoothScalar& scalar, double u0, double u1, double half_length, double origin) {
  const Ramp at = ramp(scalar.at((u0 + u1) / 2), origin);
  if (std::isinf(first_visible_depth_) && (at.extinction > 0 || at.extinction_slope > 0))
    first_visible_depth_ = scalar.front + (scalar.back - scalar.front) * (1 + u0) / 2;
  add_light(scalar, at, u0, u1, half_length, 0, 0);
  // Rounding at the ends of a ramp may give a slightly negative value.
  optical_depth_ += std::max(0.0, half_length * integral(u0, u1, [&](double u) {
                                    return at.extinction + at.extinction_slope * (scalar.at(u) - at.value);
                                  }));
}

void CurvedIntegral::add_light(const SmoothScalar& scalar, const Ramp& ramp, double u0, double u1, double half_length,
                               double before, int halvings) {
  if (optical_depth_ + before > unseen_depth) return;
  const auto extinction_of = [&](double s) { return ramp.extinction + ramp.extinction_slope * (s - ramp.value); };
  const auto depth_between = [&](double a, double b) {
    return half_length * integral(a, b, [&](double u) { return extinction_of(scalar.at(u)); });
  };
  if (depth_between(u0, u1) > most_optical_step && halvings < most_light_halvings) {
    const double middle = (u0 + u1) / 2;
    add_light(scalar, ramp, u0, middle, half_length, before, halvings + 1);
    add_light(scalar, ramp, middle, u1, half_length, before + depth_between(u0, middle), halvings + 1);
    return;
  }
  const double centre = (u0 + u1) / 2, half = (u1 - u0) / 2;
  for (const auto& [x, weight] : gauss_nodes)
    for (const double side : {-x, x}) {
      const double u = centre + half * side, s = scalar.at(u);
      const double source = emission_ == scene::Emission::absorption ? extinction_of(s) : 1;
      const double seen = std::exp(-(optical_depth_ + before + depth_between(u0, u)));
      const double factor = weight * half * half_length * source * seen;
      for (std::size_t i = 0; i < 3; ++i)
        color_[i] += factor * (ramp.color[i] + ramp.color_slope[i] * (s - ramp.value));
    }
}

}  // namespace tessera::reference
