// SPDX-License-Identifier: BSD-3-Clause
#include "reference/grid/grid_integral.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "reference/gauss_legendre.hpp"
#include "reference/knot_cuts.hpp"

namespace tessera::reference {
namespace {

constexpr double largest_optical_step = 0.5;
constexpr double depth_of_nothing = 41.45;  // exp(-41.45) < 1e-18

/// Integrates a cubic from u0 to u1. The cubic is expanded about the middle to avoid cancellation in short pieces.
double area(const Cubic& p, double u0, double u1) {
  const double m = (u0 + u1) / 2, h = (u1 - u0) / 2;
  const double curvature = p.c[2] + 3 * p.c[3] * m;  // half the second derivative
  return 2 * h * (p.at(m) + curvature * h * h / 3);
}

/// Returns a + b * p.
Cubic linear_of(double a, double b, const Cubic& p) { return {{a + b * p.c[0], b * p.c[1], b * p.c[2], b * p.c[3]}}; }

/// Returns the turning points of the cubic in (0, 1).
std::vector<double> turning_points(const Cubic& p) {
  const double a = 3 * p.c[3], b = 2 * p.c[2], c = p.c[1];
  std::vector<double> points;
  const auto keep = [&](double u) {
    if (u > 0 && u < 1) points.push_back(u);
  };
  const double discriminant = b * b - 4 * a * c;
  if (!(discriminant > 0)) return points;
  // The form of the solution without cancellation; a may be zero.
  const double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
  if (a != 0) keep(q / a);
  if (q != 0) keep(c / q);
  std::sort(points.begin(), points.end());
  return points;
}

}  // namespace

double GridIntegral::opacity() const { return -std::expm1(-sum_.optical_depth); }

bool GridIntegral::opaque() const { return sum_.optical_depth > depth_of_nothing; }

void GridIntegral::add(double length, const Cubic& scalar, double depth_front, double depth_back, const Light& light,
                       double origin) {
  if (!(length > 0)) return;
  std::vector<double> ends = {0};
  for (const double u : turning_points(scalar)) ends.push_back(u);
  ends.push_back(1);
  const std::vector<double> cuts = knot_cuts(scalar, ends, knots_, origin);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
    if (cuts[i + 1] > cuts[i]) add_piece(length, scalar, cuts[i], cuts[i + 1], depth_front, depth_back, light, origin);
}

void GridIntegral::add_surface(const std::array<double, 3>& color, double opacity, double depth) {
  if (!(opacity > 0)) return;
  const double seen = std::exp(-sum_.optical_depth) * opacity;
  for (std::size_t i = 0; i < 3; ++i) sum_.color[i] += seen * color[i];
  if (std::isinf(sum_.first_visible_depth)) sum_.first_visible_depth = depth;
  sum_.optical_depth -= std::log1p(-opacity);
  if (cuts_ && cuts_->ends(sum_.optical_depth)) cuts_->end(sum_);
}

void GridIntegral::add_piece(double length, const Cubic& scalar, double u0, double u1, double depth_front,
                             double depth_back, const Light& light, double origin) {
  // The knots on either side of the piece; a value on a step belongs to the step's upper knot.
  const double within = scalar.at((u0 + u1) / 2);
  std::size_t above = 0;
  while (above < knots_.size() && knots_[above].value - origin <= within) ++above;
  const scene::Knot& low = knots_[above == 0 ? 0 : above - 1];
  const scene::Knot& high = knots_[above == knots_.size() ? above - 1 : above];
  // Computed as a difference, so that there is no cancellation where knots are close but values are large.
  Cubic from_low = scalar;
  from_low.c[0] -= low.value - origin;
  // Knots may be nearer to each other than the rounding of the cubic. Then a piece between them is too short to be
  // visible, and any value between the knots is accurate enough.
  const double width = high.value - low.value;
  const double rounding =
      0x1p-50 * (std::abs(scalar.c[0]) + std::abs(scalar.c[1]) + std::abs(scalar.c[2]) + std::abs(scalar.c[3]));
  if (width > 0 && rounding > 1e-3 * width) from_low = {{width / 2, 0, 0, 0}};
  const auto along = [&](double at_low, double at_high) {
    if (!(high.value > low.value)) return Cubic{{at_low, 0, 0, 0}};
    const double slope = (at_high - at_low) / (high.value - low.value);
    return linear_of(at_low, slope, from_low);
  };
  const Cubic extinction = along(low.extinction, high.extinction);
  const auto lit = [&](double at_low, double at_high) {
    return along(light.own * at_low + light.white, light.own * at_high + light.white);
  };
  const std::array<Cubic, 3> color = {lit(low.color.x, high.color.x), lit(low.color.y, high.color.y),
                                      lit(low.color.z, high.color.z)};
  const auto add_part = [&](double begin, double end) {
    if (low.extinction > 0 || high.extinction > 0)
      if (std::isinf(sum_.first_visible_depth))
        sum_.first_visible_depth = depth_front + (depth_back - depth_front) * begin;
    add_color(length, begin, end, 0, extinction, color, 0);
    sum_.optical_depth += std::max(0.0, length * area(extinction, begin, end));
  };
  const auto reached = [&](double u) { return sum_.optical_depth + length * area(extinction, u0, u); };
  while (cuts_ && cuts_->ends(reached(u1))) {
    const double u = cuts_->place(u0, u1, reached);
    add_part(u0, u);
    cuts_->end(sum_);
    u0 = u;
    if (!(u0 < u1)) return;
  }
  add_part(u0, u1);
}

void GridIntegral::add_color(double length, double u0, double u1, double before, const Cubic& extinction,
                             const std::array<Cubic, 3>& color, int depth) {
  constexpr int deepest = 50;
  if (sum_.optical_depth + before > depth_of_nothing) return;
  if (length * area(extinction, u0, u1) > largest_optical_step && depth < deepest) {
    const double middle = (u0 + u1) / 2;
    add_color(length, u0, middle, before, extinction, color, depth + 1);
    add_color(length, middle, u1, before + length * area(extinction, u0, middle), extinction, color, depth + 1);
    return;
  }
  for (const auto& [x, weight] : gauss_nodes)
    for (const double side : {-x, x}) {
      const double u = u0 + (u1 - u0) * (1 + side) / 2;
      const double source = emission_ == scene::Emission::absorption ? extinction.at(u) : 1;
      const double seen = std::exp(-(sum_.optical_depth + before + length * area(extinction, u0, u)));
      const double factor = weight / 2 * (u1 - u0) * length * source * seen;
      for (std::size_t i = 0; i < 3; ++i) sum_.color[i] += factor * color[i].at(u);
    }
}

}  // namespace tessera::reference
