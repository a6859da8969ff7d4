// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/deep/deep_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/error_budget.hpp"

namespace tessera::compositor {

double most_optical_depth(double accuracy, double transmittance, double ratio) {
  constexpr double alpha_rounding = 0x1p-24;
  const double share = scene::error_budget::deep_alpha(accuracy);
  return 1 + std::log(std::max(1.0, share / (alpha_rounding * (1 + ratio) * std::max(transmittance, 1e-300))));
}

PieceCutter::PieceCutter(const scene::TransferFunction& function, scene::Emission emission, double accuracy)
    : knots_(function.knots().begin(), function.knots().end()),
      independent_(emission == scene::Emission::independent),
      accuracy_(accuracy) {}

PieceCutter::Optics PieceCutter::optics(std::size_t interval, double s) const {
  if (interval == 0 || interval == knots_.size()) {
    const scene::Knot& k = interval == 0 ? knots_.front() : knots_.back();
    return {k.extinction, {k.color.x, k.color.y, k.color.z}};
  }
  const scene::Knot &a = knots_[interval - 1], &b = knots_[interval];
  const double at = b.value > a.value ? std::clamp((s - a.value) / (b.value - a.value), 0.0, 1.0) : 1;
  const auto mix = [&](double p, double q) { return p + (q - p) * at; };
  return {mix(a.extinction, b.extinction),
          {mix(a.color.x, b.color.x), mix(a.color.y, b.color.y), mix(a.color.z, b.color.z)}};
}

void PieceCutter::cut_linear(const DeepPiece& stretch, const Optics& a, const Optics& b, double length_per_depth,
                             double& transmittance, std::vector<DeepPiece>& pieces) const {
  const double length = (stretch.back - stretch.front) * length_per_depth;
  const double most = std::max({a.color[0], a.color[1], a.color[2], b.color[0], b.color[1], b.color[2]});
  const bool dark = a.extinction == 0 && b.extinction == 0;
  if (!(length > 0) || (dark && (!independent_ || most == 0))) return;
  double color_change = 0;
  for (int c = 0; c < 3; ++c) color_change = std::max(color_change, std::abs(b.color[c] - a.color[c]));

  // A piece that is the fraction h of this length has an error of at most `steepness` h^2.
  const double bend = std::abs(b.extinction - a.extinction) * length / 8;
  const double steepness = independent_
                               ? bend + length * color_change / 4 + length * most * bend / 2
                               : (1 + most) * bend + color_change * std::max(a.extinction, b.extinction) * length / 4;
  const double hidden = independent_ ? 1 + most * length : 1 + most;  // upper bound of any error at transmittance 1
  const auto at = [&](double x) {
    return x >= 1 ? std::pair(stretch.back, stretch.scalar_back)
                  : std::pair(stretch.front + (stretch.back - stretch.front) * x,
                              stretch.scalar_front + (stretch.scalar_back - stretch.scalar_front) * x);
  };
  double x = 0;
  auto [front, scalar_front] = at(x);
  while (x < 1) {
    const double allowed = scene::error_budget::deep_pieces(accuracy_) / std::max(transmittance, 1e-300);
    double step = 1 - x;
    const bool is_thin = std::max(a.extinction, b.extinction) * length <= 1 && (!independent_ || bend <= 1);
    if (hidden > allowed && !(is_thin && steepness <= allowed)) {
      double h = steepness > 0 ? std::sqrt(allowed / steepness) : 1;
      if (independent_ && bend > 0) h = std::min(h, 1 / std::sqrt(bend));  // d <= 1
      // The optical depth of the fraction h is length (k h + rise h^2 / 2); if the extinction decreases, the first term
      // is an upper bound.
      const double k = a.extinction + (b.extinction - a.extinction) * x;
      const double most_depth =
          most_optical_depth(accuracy_, transmittance, independent_ ? 2 * most * length : most) / length;
      const double rise = std::max(0.0, b.extinction - a.extinction);
      h = std::min(h, 2 * most_depth / std::max(1e-300, k + std::sqrt(k * k + 2 * rise * most_depth)));
      if (h < step) step /= std::ceil(step / h);
    }
    const double next = x + step > x ? x + step : 1;
    const auto [back, scalar_back] = at(1 - next < 1e-9 ? 1 : next);
    if (back > front) {
      const double mean = a.extinction + (b.extinction - a.extinction) * (x + std::min(next, 1.0)) / 2;
      const double optical_depth = mean * (back - front) * length_per_depth;
      pieces.push_back({front, back, scalar_front, scalar_back, optical_depth});
      transmittance *= std::exp(-optical_depth);
      front = back, scalar_front = scalar_back;
    }

    x = 1 - next < 1e-9 ? 1 : next;
  }
}

void PieceCutter::cut(const DeepPiece& segment, double length_per_depth, double& transmittance,
                      std::vector<DeepPiece>& pieces) const {
  const double s0 = segment.scalar_front, s1 = segment.scalar_back;
  const auto value_below = [](const scene::Knot& knot, double s) { return knot.value < s; };
  const auto value_above = [](double s, const scene::Knot& knot) { return s < knot.value; };
  if (s0 == s1) {
    const auto interval =
        static_cast<std::size_t>(std::upper_bound(knots_.begin(), knots_.end(), s0, value_above) - knots_.begin());
    const Optics all = optics(interval, s0);
    return cut_linear(segment, all, all, length_per_depth, transmittance, pieces);
  }
  // The segment is cut at the knots strictly inside its range of scalars. The two knots of a step cut at the same
  // depth, so the piece between them is empty.
  const double low = std::min(s0, s1), high = std::max(s0, s1);
  const auto first =
      static_cast<std::size_t>(std::upper_bound(knots_.begin(), knots_.end(), low, value_above) - knots_.begin());
  const auto last =
      static_cast<std::size_t>(std::lower_bound(knots_.begin(), knots_.end(), high, value_below) - knots_.begin());
  DeepPiece stretch{segment.front, segment.front, s0, s0};
  for (std::size_t i = first; i <= last; ++i) {
    const bool end = i == last;
    const std::size_t knot = s0 < s1 ? i : first + last - 1 - i;
    const std::size_t interval = s0 < s1 ? i : first + last - i;
    stretch.scalar_back = end ? s1 : knots_[knot].value;
    stretch.back = end ? segment.back
                       : segment.front + (segment.back - segment.front) *
                                             std::clamp((stretch.scalar_back - s0) / (s1 - s0), 0.0, 1.0);
    cut_linear(stretch, optics(interval, stretch.scalar_front), optics(interval, stretch.scalar_back), length_per_depth,
               transmittance, pieces);
    stretch.front = stretch.back, stretch.scalar_front = stretch.scalar_back;
  }
}

}  // namespace tessera::compositor
