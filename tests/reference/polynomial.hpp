// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace tessera::reference {

/// A polynomial in one variable, c[0] + c[1] x + ..., for closed forms in tests.
struct Polynomial {
  std::vector<double> c;

  [[nodiscard]] double at(double x) const {
    double sum = 0;
    for (std::size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
    return sum;
  }

  [[nodiscard]] Polynomial derivative() const {
    Polynomial result;
    for (std::size_t i = 1; i < c.size(); ++i) result.c.push_back(static_cast<double>(i) * c[i]);
    return result;
  }

  [[nodiscard]] double integral(double from, double to) const {
    Polynomial result{{0}};
    for (std::size_t i = 0; i < c.size(); ++i) result.c.push_back(c[i] / static_cast<double>(i + 1));
    return result.at(to) - result.at(from);
  }

  /// All real roots in (from, to), by bisection between those of the derivative.
  [[nodiscard]] std::vector<double> roots(double from, double to) const {
    if (c.size() < 2) return {};
    std::vector<double> ends = derivative().roots(from, to);
    ends.insert(ends.begin(), from);
    ends.push_back(to);
    std::vector<double> found;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      double low = ends[i], high = ends[i + 1];
      if ((at(low) < 0) == (at(high) < 0)) continue;
      const bool rising = at(low) < 0;
      for (int n = 0; n < 200; ++n) {
        const double middle = (low + high) / 2;
        ((at(middle) < 0) == rising ? low : high) = middle;
      }
      found.push_back((low + high) / 2);
    }
    return found;
  }
};

inline Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  Polynomial result;
  result.c.assign(a.c.size() + b.c.size() - 1, 0);
  for (std::size_t i = 0; i < a.c.size(); ++i)
    for (std::size_t j = 0; j < b.c.size(); ++j) result.c[i + j] += a.c[i] * b.c[j];
  return result;
}

inline Polynomial operator+(Polynomial a, const Polynomial& b) {
  a.c.resize(std::max(a.c.size(), b.c.size()));
  for (std::size_t i = 0; i < b.c.size(); ++i) a.c[i] += b.c[i];
  return a;
}

inline Polynomial operator*(double factor, Polynomial a) {
  for (double& c : a.c) c *= factor;
  return a;
}

}  // namespace tessera::reference
