// SPDX-License-Identifier: BSD-3-Clause
#include "reference/smooth_scalar.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tessera::reference {
namespace {

constexpr double accuracy = 1e-14, rounding_of_scale = 2e-16;

/// Evaluates a Chebyshev series by Clenshaw's sum.
double series(const std::array<double, SmoothScalar::terms>& c, std::size_t used, double u) {
  double one = 0, two = 0;
  for (std::size_t k = used; k-- > 1;) {
    const double next = c[k] + 2 * u * one - two;
    two = one;
    one = next;
  }
  return c[0] + u * one - two;
}

}  // namespace

SmoothScalar::SmoothScalar(double front_depth, double back_depth, double value) : front(front_depth), back(back_depth) {
  coefficients_[0] = value;
}

SmoothScalar::SmoothScalar(double front_depth, double back_depth, const std::array<double, terms>& values,
                           double rounding)
    : front(front_depth), back(back_depth) {
  constexpr double n = terms;
  for (std::size_t k = 0; k < terms; ++k) {
    double sum = 0;
    for (std::size_t i = 0; i < terms; ++i) {
      const double angle = std::numbers::pi * (n - static_cast<double>(i) - 0.5) / n;
      sum += values[i] * std::cos(static_cast<double>(k) * angle);
    }
    coefficients_[k] = sum * (k == 0 ? 1 : 2) / n;
  }
  used_ = terms;
  while (used_ > 1 && std::abs(coefficients_[used_ - 1]) <= rounding) --used_;
}

std::array<double, SmoothScalar::terms> SmoothScalar::nodes() {
  std::array<double, terms> result;
  for (std::size_t i = 0; i < terms; ++i)
    result[i] = std::cos(std::numbers::pi * (terms - static_cast<double>(i) - 0.5) / terms);
  return result;
}

double SmoothScalar::at(double u) const { return series(coefficients_, used_, u); }

double SmoothScalar::slope(double u) const {
  // Computes the sum of k c_k U_{k-1}(u), with U from its recurrence.
  double before = 0, second_kind = 1, sum = 0;
  for (std::size_t k = 1; k < used_; ++k) {
    sum += static_cast<double>(k) * coefficients_[k] * second_kind;
    const double next = 2 * u * second_kind - before;
    before = second_kind;
    second_kind = next;
  }
  return sum;
}

double SmoothScalar::tail() const {
  double sum = 0;
  for (std::size_t k = terms - 3; k < used_; ++k) sum += std::abs(coefficients_[k]);
  return sum;
}

std::vector<double> SmoothScalar::turning_points() const {
  constexpr double narrowest = 0x1p-24, noise = 1e-14;
  // A bound of |U''| from the series: T_k'' is at most k^2 (k^2 - 1) / 3.
  double largest_bend = 0, size = 0;
  for (std::size_t k = 1; k < used_; ++k) {
    const double kk = static_cast<double>(k * k);
    largest_bend += std::abs(coefficients_[k]) * kk * (kk - 1) / 3;
    size += std::abs(coefficients_[k]);
  }
  std::vector<double> found;
  if (used_ < 3) return found;
  const auto search = [&](const auto& self, double low, double high, double slope_low, double slope_high) -> void {
    const double middle = (low + high) / 2, half = (high - low) / 2, slope_middle = slope(middle);
    const double change = largest_bend * half;
    if (std::abs(slope_middle) > change || std::abs(slope_middle) + change < noise * size) return;
    if (half < narrowest) {
      if ((slope_low < 0) != (slope_high < 0)) found.push_back(middle);
      return;
    }
    self(self, low, middle, slope_low, slope_middle);
    self(self, middle, high, slope_middle, slope_high);
  };
  search(search, -1, 1, slope(-1), slope(1));
  return found;
}

std::vector<SmoothScalar> smooth_pieces(double front, double back, double scale,
                                        const std::function<double(double depth)>& scalar) {
  constexpr int most_halvings = 30;
  constexpr std::size_t many = 100;  // more than any scalar of a one-to-one cell needs
  const std::array<double, SmoothScalar::terms> nodes = SmoothScalar::nodes();
  std::vector<SmoothScalar> pieces;
  const auto add = [&](const auto& self, double low, double high, int halvings) -> void {
    std::array<double, SmoothScalar::terms> values;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = scalar(low + (high - low) * (1 + nodes[i]) / 2);
    const SmoothScalar piece(low, high, values, rounding_of_scale * scale);
    const double middle = low + (high - low) / 2;
    if (piece.tail() <= std::ldexp(accuracy * scale, halvings) || halvings == most_halvings || pieces.size() > many ||
        !(middle > low) || !(middle < high)) {
      pieces.push_back(piece);
      return;
    }
    self(self, low, middle, halvings + 1);
    self(self, middle, high, halvings + 1);
  };
  add(add, front, back, 0);
  return pieces;
}

}  // namespace tessera::reference
