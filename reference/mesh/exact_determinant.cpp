// SPDX-License-Identifier: BSD-3-Clause
#include "reference/mesh/exact_determinant.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace tessera::reference {
namespace {

/// The sum high + low equals the exact result, and high is the rounded result.
struct TwoParts {
  double high, low;
};

TwoParts exact_product(double a, double b) {
  const double high = a * b;
  return {high, std::fma(a, b, -high)};
}

TwoParts exact_sum(double a, double b) {
  const double high = a + b, b_part = high - a, a_part = high - b_part;
  return {high, (a - a_part) + (b - b_part)};
}

/// An exact sum of doubles, as non-overlapping parts of increasing size. The last part has the sign of the sum.
class ExactSum {
 public:
  void add(double term) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const TwoParts sum = exact_sum(term, parts_[i]);
      if (sum.low != 0) parts_[kept++] = sum.low;
      term = sum.high;
    }
    if (term != 0) parts_[kept++] = term;
    count_ = kept;
  }

  void add_product(double a, double b, double c) {
    const TwoParts ab = exact_product(a, b);
    for (const double factor : {ab.low, ab.high}) {
      const TwoParts abc = exact_product(factor, c);
      add(abc.low);
      add(abc.high);
    }
  }

  [[nodiscard]] Determinant rounded() const {
    if (count_ == 0) return {};
    double value = 0;
    for (std::size_t i = 0; i < count_; ++i) value += parts_[i];
    return {parts_[count_ - 1] > 0 ? 1 : -1, value};
  }

 private:
  std::array<double, 24> parts_{};
  std::size_t count_ = 0;
};

}  // namespace

Determinant exact_determinant(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  ExactSum sum;
  sum.add_product(a.x, b.y, c.z);
  sum.add_product(-a.x, b.z, c.y);
  sum.add_product(a.y, b.z, c.x);
  sum.add_product(-a.y, b.x, c.z);
  sum.add_product(a.z, b.x, c.y);
  sum.add_product(-a.z, b.y, c.x);
  return sum.rounded();
}

}  // namespace tessera::reference
