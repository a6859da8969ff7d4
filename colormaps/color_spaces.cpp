// SPDX-License-Identifier: BSD-3-Clause
#include "colormaps/color_spaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace tessera::colormaps {
namespace {

using glm::dvec3;
using std::numbers::pi;

/// The matrix from linear sRGB to XYZ (IEC 61966-2-1), by columns.
const glm::dmat3& xyz_from_rgb() {
  static const glm::dmat3 matrix{{0.4124, 0.2126, 0.0193}, {0.3576, 0.7152, 0.1192}, {0.1805, 0.0722, 0.9505}};
  return matrix;
}

/// The exact inverse of xyz_from_rgb() instead of the standard's four digits, so that colours do not change when they
/// are converted back.
const glm::dmat3& rgb_from_xyz() {
  static const glm::dmat3 matrix = glm::inverse(xyz_from_rgb());
  return matrix;
}

/// The XYZ of (1, 1, 1), which is D65. With this white, greys have exactly a* = b* = 0.
dvec3 display_white() { return xyz_from_rgb() * dvec3(1); }

double lab_curve(double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; }
double lab_curve_inverse(double f) { return f * f * f > 0.008856 ? f * f * f : (f - 16.0 / 116) / 7.787; }

dvec3 lab_from_display(const dvec3& display) {
  const dvec3 xyz = xyz_from_rgb() * decode_srgb(display) / display_white();
  const dvec3 f{lab_curve(xyz.x), lab_curve(xyz.y), lab_curve(xyz.z)};
  return {116 * f.y - 16, 500 * (f.x - f.y), 200 * (f.y - f.z)};
}

dvec3 display_from_lab(const dvec3& lab) {
  const double y = (lab.x + 16) / 116;
  const dvec3 xyz{lab_curve_inverse(lab.y / 500 + y), lab_curve_inverse(y), lab_curve_inverse(y - lab.z / 200)};
  const dvec3 display = encode_srgb(rgb_from_xyz() * (xyz * display_white()));
  const double largest = std::max({1.0, display.x, display.y, display.z});
  return glm::max(display / largest, dvec3(0));
}

/// Magnitude, saturation and hue: L*a*b* in polar coordinates about black (Moreland 2009, section 4).
struct Msh {
  double m, s, h;
};

Msh msh_from_lab(const dvec3& lab) {
  const double m = glm::length(lab);
  const double s = m > 0.001 ? std::acos(std::clamp(lab.x / m, -1.0, 1.0)) : 0;
  return {m, s, s > 0.001 ? std::atan2(lab.z, lab.y) : 0};
}

dvec3 lab_from_msh(const Msh& c) {
  return {c.m * std::cos(c.s), c.m * std::sin(c.s) * std::cos(c.h), c.m * std::sin(c.s) * std::sin(c.h)};
}

double angle_between(double a, double b) {
  const double turn = std::fmod(std::abs(a - b), 2 * pi);
  return turn > pi ? 2 * pi - turn : turn;
}

/// Returns the hue of an unsaturated end of magnitude `m`: the hue of the saturated end, rotated so that the path
/// between both ends is perceptually straight (Moreland 2009, listing 2).
double hue_of_unsaturated(const Msh& saturated, double m) {
  if (saturated.m >= m - 0.1) return saturated.h;
  const double turn =
      saturated.s * std::sqrt(m * m - saturated.m * saturated.m) / (saturated.m * std::sin(saturated.s));
  return saturated.h > -0.3 * pi ? saturated.h + turn : saturated.h - turn;
}

dvec3 mix_diverging(const dvec3& a, const dvec3& b, double t) {
  constexpr double colourless = 0.05;
  Msh low = msh_from_lab(lab_from_display(a)), high = msh_from_lab(lab_from_display(b));
  if (low.s > colourless && high.s > colourless && angle_between(low.h, high.h) > 0.33 * pi) {
    const Msh middle{std::max({low.m, high.m, 88.0}), 0, 0};
    if (t < 0.5) {
      high = middle;
      t = 2 * t;
    } else {
      low = middle;
      t = 2 * t - 1;
    }
  }
  if (low.s < colourless && high.s > colourless)
    low.h = hue_of_unsaturated(high, low.m);
  else if (high.s < colourless && low.s > colourless)
    high.h = hue_of_unsaturated(low, high.m);
  return display_from_lab(
      lab_from_msh({std::lerp(low.m, high.m, t), std::lerp(low.s, high.s, t), std::lerp(low.h, high.h, t)}));
}

/// Returns hue in [0, 1), saturation and value.
dvec3 hsv_from_rgb(const dvec3& c) {
  const double high = std::max({c.x, c.y, c.z}), low = std::min({c.x, c.y, c.z}), spread = high - low;
  if (!(spread > 0)) return {0, 0, high};
  double sextant = 0;
  if (c.x == high)
    sextant = (c.y - c.z) / spread;
  else if (c.y == high)
    sextant = 2 + (c.z - c.x) / spread;
  else
    sextant = 4 + (c.x - c.y) / spread;
  return {(sextant < 0 ? sextant + 6 : sextant) / 6, spread / high, high};
}

dvec3 rgb_from_hsv(const dvec3& c) {
  // Each channel is a trapezoid in hue: full within one sextant of its own hue, zero beyond two.
  const auto channel = [&](double own) {
    const double away = std::abs(6 * c.x - own), round = std::min(away, 6 - away);
    return c.z * (1 - c.y * std::clamp(round - 1, 0.0, 1.0));
  };
  return {channel(0), channel(2), channel(4)};
}

dvec3 mix_hsv(const dvec3& a, const dvec3& b, double t, bool hue_wraps) {
  dvec3 low = hsv_from_rgb(a), high = hsv_from_rgb(b);
  if (hue_wraps && std::abs(low.x - high.x) > 0.5) (low.x > high.x ? low.x : high.x) -= 1;
  dvec3 mixed = glm::mix(low, high, t);
  if (mixed.x < 0) mixed.x += 1;
  return rgb_from_hsv(mixed);
}

}  // namespace

double decode_srgb(double display) {
  const double v = std::abs(display);
  return std::copysign(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4), display);
}

double encode_srgb(double linear) {
  const double v = std::abs(linear);
  return std::copysign(v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055, linear);
}

dvec3 decode_srgb(const dvec3& c) { return {decode_srgb(c.x), decode_srgb(c.y), decode_srgb(c.z)}; }
dvec3 encode_srgb(const dvec3& c) { return {encode_srgb(c.x), encode_srgb(c.y), encode_srgb(c.z)}; }

dvec3 mix_colors(const dvec3& a, const dvec3& b, double t, ColorSpace space, bool hue_wraps) {
  if (space == ColorSpace::step || t >= 1) return b;
  if (t <= 0) return a;
  switch (space) {
    case ColorSpace::hsv:
      return mix_hsv(a, b, t, hue_wraps);
    case ColorSpace::lab:
      return display_from_lab(glm::mix(lab_from_display(a), lab_from_display(b), t));
    case ColorSpace::diverging:
      return mix_diverging(a, b, t);
    default:
      return glm::mix(a, b, t);
  }
}

}  // namespace tessera::colormaps
