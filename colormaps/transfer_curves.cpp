// SPDX-License-Identifier: BSD-3-Clause
#include "colormaps/transfer_curves.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "scene/error.hpp"

namespace tessera::colormaps {
namespace {

constexpr double step_sharpness = 0.99, linear_sharpness = 0.01;  // bounds of vtkPiecewiseFunction
constexpr std::size_t most_knots = 200000;

double clamped_midpoint(const OpacityPoint& p) { return std::clamp(p.midpoint, 1e-5, 1 - 1e-5); }

/// Returns the position of x between low and high, as a fraction.
double fraction(double x, double low, double high) {
  // Large numbers are halved, because high - low may overflow. Others are not, because halves of the smallest doubles
  // are zero.
  const double scale = std::max(std::abs(low), std::abs(high)) > 1e300 ? 0.5 : 1;
  return (x * scale - low * scale) / (high * scale - low * scale);
}

/// Colour and kappa * unit distance at one value.
struct Sample {
  glm::dvec3 color;
  double depth;
};

Sample mix(const Sample& a, const Sample& b, double u) {
  return {glm::mix(a.color, b.color, u), std::lerp(a.depth, b.depth, u)};
}

/// The pair of neighbouring points around a piece between breaks. Both are equal where the curve is clamped.
template <class Point>
struct Span {
  const Point *a, *b;
  double t_begin, t_end;  ///< ends of the piece, as fractions from a to b

  Span(const std::vector<Point>& points, double begin, double end) {
    // Every point is a break, so the first point beyond `begin` is not inside the piece.
    const auto above =
        std::upper_bound(points.begin(), points.end(), begin, [](double v, const Point& p) { return v < p.value; });
    b = above == points.end() ? &points.back() : &*above;
    a = above == points.begin() ? &points.front() : &*(above - 1);
    const bool clamped = above == points.begin() || above == points.end();
    if (clamped) a = b;
    t_begin = clamped ? 0 : fraction(begin, a->value, b->value);
    t_end = clamped ? 1 : fraction(end, a->value, b->value);
  }
  [[nodiscard]] double at(double u) const { return std::lerp(t_begin, t_end, u); }
};

class Refiner {
 public:
  Refiner(const TransferCurves& curves, const RefineSettings& settings) : curves_(curves), settings_(settings) {}

  std::vector<scene::Knot> run() {
    const std::vector<double> breaks = find_breaks();
    emit(breaks.front(), sample(curves_.colors.front().color, curves_.opacities.front().opacity));
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) refine(breaks[i], breaks[i + 1]);
    emit(breaks.back(), sample(curves_.colors.back().color, curves_.opacities.back().opacity));
    return std::move(knots_);
  }

 private:
  /// Returns the values where the function or its slope may jump.
  [[nodiscard]] std::vector<double> find_breaks() const {
    std::vector<double> breaks;
    const auto& colors = curves_.colors;
    const auto& opacities = curves_.opacities;
    for (std::size_t i = 0; i < colors.size(); ++i) {
      breaks.push_back(colors[i].value);
      if (curves_.space == ColorSpace::diverging && i + 1 < colors.size())
        breaks.push_back(std::lerp(colors[i].value, colors[i + 1].value, 0.5));
    }
    for (std::size_t i = 0; i < opacities.size(); ++i) {
      breaks.push_back(opacities[i].value);
      const bool straight = opacities[i].midpoint == 0.5 && opacities[i].sharpness < linear_sharpness;
      if (!straight && i + 1 < opacities.size()) breaks.push_back(middle(opacities[i], opacities[i + 1]));
    }
    std::sort(breaks.begin(), breaks.end());
    breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
    return breaks;
  }

  static double middle(const OpacityPoint& a, const OpacityPoint& b) {
    return std::lerp(a.value, b.value, clamped_midpoint(a));
  }

  [[nodiscard]] Sample sample(const glm::dvec3& display, double opacity) const {
    return {settings_.display_colors ? display : decode_srgb(display),
            -std::log1p(-std::min(opacity, largest_opacity))};
  }

  [[nodiscard]] bool fits(const Sample& exact, const Sample& straight) const {
    const glm::dvec3 miss = glm::abs(exact.color - straight.color);
    return std::max({miss.x, miss.y, miss.z}) <= settings_.color_tolerance &&
           std::abs(exact.depth - straight.depth) <= settings_.extinction_tolerance * std::max(exact.depth, 0.01);
  }

  /// Adds knots from the right-hand limit at `begin` to the left-hand limit at `end`.
  void refine(double begin, double end) {
    const Span<ColorPoint> colors(curves_.colors, begin, end);
    const Span<OpacityPoint> opacities(curves_.opacities, begin, end);
    // The side of a step is determined by the beginning of the piece, because a fraction at the step may have been
    // rounded to the other side.
    const bool step = opacities.a->sharpness > step_sharpness && opacities.a != opacities.b;
    const double level =
        step && begin < middle(*opacities.a, *opacities.b) ? opacities.a->opacity : opacities.b->opacity;
    const auto exact = [&](double u) {
      return sample(mix_colors(colors.a->color, colors.b->color, colors.at(u), curves_.space, curves_.hue_wraps),
                    step ? level : mix_opacities(*opacities.a, *opacities.b, opacities.at(u)));
    };
    // Fifteen test points per chord are enough, because between two points the curve is an arc or an S with at most one
    // gamut edge or sextant.
    const auto chord_fits = [&](double u, const Sample& at_u, double v, const Sample& at_v) {
      for (int i = 1; i < 16; ++i)
        if (!fits(exact(std::lerp(u, v, i / 16.0)), mix(at_u, at_v, i / 16.0))) return false;
      return true;
    };

    double u = 0, last_step = 1;
    Sample at_u = exact(0);
    emit(begin, at_u);
    while (u < 1) {
      // Finds the length of the longest chord from u within the tolerance, with an error of at most an eighth. Chords
      // shorter than the smallest step are not useful.
      constexpr double smallest_step = 1.0 / (1 << 16);
      double good = std::min(smallest_step, 1 - u), bad = 2 - u;
      for (double trial = std::min(last_step * 1.5, 1 - u); bad > good * 1.125;) {
        const Sample at_trial = exact(u + trial);
        (chord_fits(u, at_u, u + trial, at_trial) ? good : bad) = trial;
        if (good >= 1 - u) break;
        trial = bad > 1 - u ? std::min(good * 2, 1 - u) : std::sqrt(good * bad);
        if (trial >= bad) trial = 0.5 * (good + bad);
      }
      last_step = good;
      u = good >= 1 - u ? 1 : u + good;
      at_u = exact(u);
      emit(u < 1 ? std::lerp(begin, end, u) : end, at_u);
    }
  }

  void emit(double value, const Sample& s) {
    const scene::Knot knot{value, glm::max(s.color, glm::dvec3(0)),
                           s.depth * (settings_.opacity_scale / settings_.unit_distance)};
    if (!knots_.empty() && knots_.back() == knot) return;
    if (knots_.size() >= most_knots) throw scene::bad_input("refines to more than 200,000 knots; give fewer points");
    knots_.push_back(knot);
  }

  const TransferCurves& curves_;
  const RefineSettings& settings_;
  std::vector<scene::Knot> knots_;
};

}  // namespace

double mix_opacities(const OpacityPoint& a, const OpacityPoint& b, double t) {
  const double middle = clamped_midpoint(a);
  // The fraction is stretched so that the midpoint is at one half.
  t = t < middle ? 0.5 * t / middle : 0.5 + 0.5 * (t - middle) / (1 - middle);
  if (a.sharpness > step_sharpness) return t < 0.5 ? a.opacity : b.opacity;
  if (a.sharpness < linear_sharpness) return std::lerp(a.opacity, b.opacity, t);
  // The fraction is pulled toward the middle by a power. The result is the parameter of a cubic Hermite spline whose
  // ends are flatter the larger the sharpness is.
  const double power = 1 + 10 * a.sharpness;
  t = t < 0.5 ? 0.5 * std::pow(2 * t, power) : 1 - 0.5 * std::pow(2 * (1 - t), power);
  const double rise = b.opacity - a.opacity, slope = (1 - a.sharpness) * rise, t2 = t * t, t3 = t2 * t;
  const double value = a.opacity + rise * (3 * t2 - 2 * t3) + slope * ((t3 - 2 * t2 + t) + (t3 - t2));
  return std::clamp(value, std::min(a.opacity, b.opacity), std::max(a.opacity, b.opacity));
}

std::vector<scene::Knot> refined_knots(const TransferCurves& curves, const RefineSettings& settings) {
  return Refiner(curves, settings).run();
}

}  // namespace tessera::colormaps
