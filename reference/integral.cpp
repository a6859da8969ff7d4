// SPDX-License-Identifier: BSD-3-Clause
#include "reference/integral.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "reference/gauss_legendre.hpp"

namespace tessera::reference {
namespace {

constexpr double largest_step = 0.5;    // in units of optical depth
constexpr double opaque_depth = 41.45;  // exp(-41.45) < 1e-18

double mixed(double a, double b, double u) { return a + (b - a) * u; }

}  // namespace

double Integral::opacity() const { return -std::expm1(-sum_.optical_depth); }

Integral::Optics Integral::optics(double s, double within, double origin) const {
  const auto value_less = [origin](double value, const scene::Knot& knot) { return value < knot.value - origin; };
  const auto of = [](const scene::Knot& k) { return Optics{k.extinction, {k.color.x, k.color.y, k.color.z}}; };
  // The last knot at or below `within`, which is the upper one of a step.
  const auto above =
      static_cast<std::size_t>(std::upper_bound(knots_.begin(), knots_.end(), within, value_less) - knots_.begin());
  if (above == 0) return of(knots_.front());
  if (above == knots_.size()) return of(knots_.back());
  const Optics low = of(knots_[above - 1]), high = of(knots_[above]);
  const double v0 = knots_[above - 1].value - origin, v1 = knots_[above].value - origin;
  const double u = std::clamp((s - v0) / (v1 - v0), 0.0, 1.0);
  Optics between{mixed(low.extinction, high.extinction, u), {}};
  for (int i = 0; i < 3; ++i) between.color[i] = mixed(low.color[i], high.color[i], u);
  return between;
}

void Integral::add(double length, double scalar_front, double scalar_back, double depth_front, double depth_back,
                   double origin, const Light& light) {
  if (!(length > 0)) return;
  const auto value_less = [origin](double value, const scene::Knot& knot) { return value < knot.value - origin; };

  // Positions on the segment, 0 to 1, where the scalar passes a knot.
  std::vector<double> cuts{0, 1};
  const auto [low, high] = std::minmax(scalar_front, scalar_back);
  for (auto knot = std::upper_bound(knots_.begin(), knots_.end(), low, value_less);
       knot != knots_.end() && knot->value - origin < high; ++knot)
    cuts.push_back((knot->value - origin - scalar_front) / (scalar_back - scalar_front));
  std::sort(cuts.begin(), cuts.end());

  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (!(cuts[i + 1] > cuts[i])) continue;
    const double s0 = mixed(scalar_front, scalar_back, cuts[i]), s1 = mixed(scalar_front, scalar_back, cuts[i + 1]);
    const double middle = low == high ? low : mixed(scalar_front, scalar_back, (cuts[i] + cuts[i + 1]) / 2);
    Optics a = optics(s0, middle, origin), b = optics(s1, middle, origin);
    for (Optics* end : {&a, &b})
      for (double& c : end->color) c = light.own * c + light.white;
    add_piece(length * (cuts[i + 1] - cuts[i]), a, b, mixed(depth_front, depth_back, cuts[i]),
              mixed(depth_front, depth_back, cuts[i + 1]));
  }
}

void Integral::add_surface(const std::array<double, 3>& color, double opacity, double depth) {
  if (!(opacity > 0)) return;
  const double transmittance = std::exp(-sum_.optical_depth);
  for (int i = 0; i < 3; ++i) sum_.color[i] += transmittance * opacity * color[i];
  if (std::isinf(sum_.first_visible_depth)) sum_.first_visible_depth = depth;
  sum_.optical_depth -= std::log1p(-opacity);
  if (cuts_ && cuts_->ends(sum_.optical_depth)) cuts_->end(sum_);
}

void Integral::add_piece(double length, Optics a, const Optics& b, double depth_front, double depth_back) {
  const auto begin = [&] {
    if (std::isinf(sum_.first_visible_depth) && (a.extinction > 0 || b.extinction > 0))
      sum_.first_visible_depth = depth_front;
  };
  const auto reached = [&](double u) {
    return sum_.optical_depth + length * u * (a.extinction + (b.extinction - a.extinction) * u / 2);
  };
  while (cuts_ && cuts_->ends(reached(1))) {
    const double u = cuts_->place(0, 1, reached);
    Optics at{mixed(a.extinction, b.extinction, u), {}};
    for (int i = 0; i < 3; ++i) at.color[i] = mixed(a.color[i], b.color[i], u);
    begin();
    add_linear(length * u, a, at);
    cuts_->end(sum_);
    a = at, length *= 1 - u, depth_front = mixed(depth_front, depth_back, u);
    if (!(length > 0)) return;
  }
  begin();
  add_linear(length, a, b);
}

void Integral::add_linear(double length, const Optics& a, const Optics& b) {
  const double rise = b.extinction - a.extinction;
  const double optical_depth_before = sum_.optical_depth;
  const double total = length * (a.extinction + b.extinction) / 2;
  for (double begin = 0; begin < 1 && sum_.optical_depth < opaque_depth;) {
    const double extinction = a.extinction + rise * begin;
    // Computes the longest step d with (extinction + max(rise, 0) d) d length <= largest_step.
    const double q = largest_step / length;
    const double step = rise > 0 ? 2 * q / (extinction + std::sqrt(extinction * extinction + 4 * rise * q))
                                 : q / extinction;  // infinite if nothing absorbs
    const double end = step < 1 - begin ? begin + step : 1;
    if (!(end > begin)) break;  // a step below double's spacing at `begin`
    const double width = end - begin;
    const auto optical_depth_at = [&](double d) { return length * d * (extinction + rise * d / 2); };
    for (const GaussNode& node : gauss_nodes)
      for (const double x : {-node.x, node.x}) {
        const double d = width * (1 + x) / 2, u = begin + d;
        const double source = emission_ == scene::Emission::absorption ? extinction + rise * d : 1;
        const double weight =
            node.weight / 2 * width * length * source * std::exp(-(sum_.optical_depth + optical_depth_at(d)));
        for (int i = 0; i < 3; ++i) sum_.color[i] += weight * mixed(a.color[i], b.color[i], u);
      }
    sum_.optical_depth += optical_depth_at(width);
    begin = end;
  }
  // The optical depth of the complete piece is computed in closed form. It has no rounding errors of the steps, and is
  // correct even if the loop ended early.
  sum_.optical_depth = optical_depth_before + total;
}

}  // namespace tessera::reference
