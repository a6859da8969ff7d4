// SPDX-License-Identifier: BSD-3-Clause
#include "projection/edge_sign.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace tessera::projection {
namespace {

/// A sum of doubles without rounding. Its components do not overlap and increase in magnitude, so the last component
/// has the sign of the sum.
class ExactSum {
 public:
  void add(double value) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const double sum = value + parts_[i];
      const double back = sum - value;
      const double rest = (value - (sum - back)) + (parts_[i] - back);  // Knuth's two-sum
      if (rest != 0) parts_[kept++] = rest;
      value = sum;
    }
    if (value != 0) parts_[kept++] = value;
    size_ = kept;
  }

  void add_product(double a, double b) {
    const double product = a * b;
    add(product);
    add(std::fma(a, b, -product));
  }

  void add_product(double a, double b, double c) {
    const double product = a * b;
    add_product(product, c);
    add_product(std::fma(a, b, -product), c);
  }

  [[nodiscard]] int sign() const { return size_ == 0 ? 0 : (parts_[size_ - 1] > 0 ? 1 : -1); }

 private:
  // A sum has 4 triple products of 4 terms and 2 products of 2 terms: at most 20 components.
  std::array<double, 24> parts_{};
  std::size_t size_ = 0;
};

/// Returns the sign of a * d - b * c.
int sign_2x2(double a, double b, double c, double d) {
  ExactSum sum;
  sum.add_product(a, d);
  sum.add_product(-b, c);
  return sum.sign();
}

constexpr double finest_step = 0x1p-32, position_precision = 0x1p-46, most_per_tangent = 0x1p22;
constexpr double beside_reach = 0x1p46, beside_precision = 0x1p-40;

/// Returns the power of two at or below a positive number.
double power_of_two(double v) { return std::bit_cast<double>(std::bit_cast<std::uint64_t>(v) & 0x7ff0000000000000u); }

/// Returns the multiple of the power of two `step` that is nearest to v; v must be less than 2^51 times `step`.
double rounded(double v, double step) { return step > 0 ? std::nearbyint(v / step) * step : v; }

}  // namespace

LineOfSight line_of_sight(const PixelVertex& v, double pixels_per_tangent) {
  if (pixels_per_tangent == 0) return {v.x, v.y, v.w};
  const double x = v.x / v.w, y = v.y / v.w, reach = std::max(std::abs(x), std::abs(y));
  if (reach < beside_reach) {
    const double step =
        std::max(finest_step,
                 power_of_two(std::max(reach, std::min(pixels_per_tangent, most_per_tangent))) * position_precision);
    const double side = v.w > 0 ? 1 : -1;
    return {side * rounded(x, step), side * rounded(y, step), side};
  }
  const double step = power_of_two(std::max(std::abs(v.x), std::abs(v.y))) * beside_precision;
  return {rounded(v.x, step), rounded(v.y, step), 0};
}

double sight_error(const PixelVertex& v, double pixels_per_tangent, double most_pixels) {
  if (pixels_per_tangent == 0) return 0;
  const double size = std::max(std::abs(v.x), std::abs(v.y)), w = std::abs(v.w);
  // The bounds are whole steps, although rounding changes a position by half a step at most: the other half covers the
  // rounding errors of the values that are compared here.
  if (size < 0.5 * beside_reach * w)
    return std::max(finest_step * w,
                    position_precision * std::max(size, std::min(pixels_per_tangent, most_per_tangent) * w));
  return beside_precision * size + most_pixels * w;
}

int edge_sign(const PixelVertex& from, const PixelVertex& to, double px, double py, double pixels_per_tangent,
              bool* on_edge) {
  const LineOfSight a = line_of_sight(from, pixels_per_tangent), b = line_of_sight(to, pixels_per_tangent);
  ExactSum sum;
  sum.add_product(a.x, b.y);
  sum.add_product(-a.y, b.x);
  sum.add_product(a.y, b.w, px);
  sum.add_product(-a.w, b.y, px);
  sum.add_product(a.w, b.x, py);
  sum.add_product(-a.x, b.w, py);
  if (const int sign = sum.sign(); sign != 0) return sign;
  if (on_edge != nullptr) *on_edge = true;
  if (const int along_x = sign_2x2(a.y, a.w, b.y, b.w); along_x != 0) return along_x;
  return sign_2x2(a.w, a.x, b.w, b.x);
}

}  // namespace tessera::projection
