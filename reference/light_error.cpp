// SPDX-License-Identifier: BSD-3-Clause
#include "reference/light_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::reference {
namespace {

/// Cells that span more knots are treated as if they spanned all knots.
constexpr std::ptrdiff_t most_knots = 16;

}  // namespace

double LightError::matter(const scene::Knot& knot) const {
  const double colour = std::max({knot.color.x, knot.color.y, knot.color.z});
  return emission_ == scene::Emission::independent ? std::max(knot.extinction, colour) : knot.extinction;
}

LightError::LightError(const scene::TransferFunction& function, scene::Emission emission, double noise)
    : knots_(function.knots().begin(), function.knots().end()), emission_(emission), noise_(noise) {
  // Both absorption, by which a ray loses light, and emission, by which it gains light, count.
  const auto light = [&](const scene::Knot& k, int c) {
    return k.color[c] * (emission_ == scene::Emission::independent ? 1 : k.extinction);
  };
  for (const scene::Knot& knot : knots_) densest_ = std::max(densest_, matter(knot));
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
    const scene::Knot &a = knots_[i], &b = knots_[i + 1];
    double difference = std::abs(a.extinction - b.extinction);
    for (int c = 0; c < 3; ++c) difference = std::max(difference, std::abs(light(a, c) - light(b, c)));
    if (!(difference > 0)) continue;
    if (b.value - a.value < noise) {  // no wider than the noise, so treated as a step
      steps_.push_back({b.value, difference});
      largest_jump_ = std::max(largest_jump_, difference);
    } else {
      ramps_.push_back({a.value, b.value, difference / (b.value - a.value)});
      largest_slope_ = std::max(largest_slope_, ramps_.back().slope);
    }
  }
}

double LightError::steepest(double low, double high) const {
  const auto first =
      std::lower_bound(ramps_.begin(), ramps_.end(), low, [](const Ramp& r, double v) { return r.high < v; });
  double slope = 0;
  for (auto ramp = first; ramp != ramps_.end() && ramp->low <= high; ++ramp) {
    if (ramp - first > most_knots) return largest_slope_;
    slope = std::max(slope, ramp->slope);
  }
  return slope;
}

double LightError::densest(double low, double high) const {
  const scene::Knot at_low{low, {}, 0};
  const auto before = [](const scene::Knot& a, const scene::Knot& b) { return a.value < b.value; };
  auto knot = std::lower_bound(knots_.begin(), knots_.end(), at_low, before);
  if (knot != knots_.begin()) --knot;
  const auto first = knot;
  double most = 0;
  for (; knot != knots_.end(); ++knot) {
    if (knot - first > most_knots) return densest_;
    most = std::max(most, matter(*knot));
    if (knot->value > high) break;
  }
  return most;
}

double LightError::most_per_length(double low, double high) const {
  const auto step =
      std::lower_bound(steps_.begin(), steps_.end(), low - noise_, [](const Step& s, double v) { return s.value < v; });
  if (step != steps_.end() && step->value <= high + noise_) return largest_jump_;
  return std::max(noise_ * steepest(low - noise_, high + noise_), 0.0);
}

double LightError::per_length(std::span<const double> corners) const {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double s : corners) low = std::min(low, s), high = std::max(high, s);
  double error = noise_ * steepest(low - noise_, high + noise_);
  const auto first =
      std::lower_bound(steps_.begin(), steps_.end(), low - noise_, [](const Step& s, double v) { return s.value < v; });
  for (auto step = first; step != steps_.end() && step->value <= high + noise_; ++step) {
    if (step - first > most_knots) return std::max(error, largest_jump_);
    double share = noise_ / (high - low + noise_);
    const auto on_it =
        std::count_if(corners.begin(), corners.end(), [&](double s) { return std::abs(s - step->value) <= noise_; });
    share = std::max(share, static_cast<double>(on_it) / static_cast<double>(corners.size()));
    error = std::max(error, share * step->jump);
  }
  return error;
}

}  // namespace tessera::reference
