// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/delta_e.hpp"

#include <cmath>
#include <numbers>

namespace tessera::analysis {
namespace {

constexpr double radian = std::numbers::pi / 180;

double lab_curve(double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; }

/// Hue angle in [0, 360) degrees; 0 for grey.
double hue(double a, double b) {
  if (a == 0 && b == 0) return 0;
  const double h = std::atan2(b, a) / radian;
  return h < 0 ? h + 360 : h;
}

}  // namespace

glm::dvec3 lab_of_linear(const glm::dvec3& c) {
  // Matrix of IEC 61966-2-1. Division by the sum of each row makes white exactly (1, 1, 1).
  const double x = (0.4124 * c.x + 0.3576 * c.y + 0.1805 * c.z) / 0.9505;
  const double y = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
  const double z = (0.0193 * c.x + 0.1192 * c.y + 0.9505 * c.z) / 1.089;
  const double fx = lab_curve(x), fy = lab_curve(y), fz = lab_curve(z);
  return {116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)};
}

double delta_e_2000(const glm::dvec3& lab_1, const glm::dvec3& lab_2) {
  // Equations 2 to 22 of Sharma et al. 2005 (delta_e.hpp).
  const double mean_chroma = 0.5 * (std::hypot(lab_1.y, lab_1.z) + std::hypot(lab_2.y, lab_2.z));
  const double c7 = std::pow(mean_chroma, 7), twenty_five_7 = std::pow(25.0, 7);
  const double g = 0.5 * (1 - std::sqrt(c7 / (c7 + twenty_five_7)));
  const double a1 = (1 + g) * lab_1.y, a2 = (1 + g) * lab_2.y;
  const double chroma1 = std::hypot(a1, lab_1.z), chroma2 = std::hypot(a2, lab_2.z);
  const double h1 = hue(a1, lab_1.z), h2 = hue(a2, lab_2.z);

  const double lightness = lab_2.x - lab_1.x, chroma = chroma2 - chroma1;
  double turn = 0, mean_hue = h1 + h2;
  if (chroma1 * chroma2 != 0) {
    turn = h2 - h1;
    if (turn > 180) turn -= 360;
    if (turn < -180) turn += 360;
    mean_hue = std::abs(h1 - h2) <= 180 ? 0.5 * (h1 + h2) : 0.5 * (h1 + h2 + (h1 + h2 < 360 ? 360 : -360));
  }
  const double hue_difference = 2 * std::sqrt(chroma1 * chroma2) * std::sin(0.5 * turn * radian);

  const double l = 0.5 * (lab_1.x + lab_2.x), c = 0.5 * (chroma1 + chroma2);
  const double t = 1 - 0.17 * std::cos((mean_hue - 30) * radian) + 0.24 * std::cos(2 * mean_hue * radian) +
                   0.32 * std::cos((3 * mean_hue + 6) * radian) - 0.20 * std::cos((4 * mean_hue - 63) * radian);
  const double rotation = 30 * std::exp(-std::pow((mean_hue - 275) / 25, 2));
  const double cm7 = std::pow(c, 7);
  const double s_l = 1 + 0.015 * (l - 50) * (l - 50) / std::sqrt(20 + (l - 50) * (l - 50));
  const double s_c = 1 + 0.045 * c, s_h = 1 + 0.015 * c * t;
  const double r_t = -std::sin(2 * rotation * radian) * 2 * std::sqrt(cm7 / (cm7 + twenty_five_7));
  const double x = lightness / s_l, y = chroma / s_c, z = hue_difference / s_h;
  return std::sqrt(x * x + y * y + z * z + r_t * y * z);
}

}  // namespace tessera::analysis
