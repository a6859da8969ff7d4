// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace tessera::cells {

/// Returns the inverse of a non-singular matrix of n rows, stored row by row, by Gauss-Jordan elimination with partial
/// pivoting in long double.
inline std::vector<double> inverse_matrix(std::vector<long double> a, std::size_t n) {
  std::vector<long double> b(n * n, 0);
  for (std::size_t i = 0; i < n; ++i) b[i * n + i] = 1;
  for (std::size_t column = 0; column < n; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < n; ++row)
      if (std::abs(a[row * n + column]) > std::abs(a[pivot * n + column])) pivot = row;
    for (std::size_t k = 0; k < n; ++k) {
      std::swap(a[pivot * n + k], a[column * n + k]);
      std::swap(b[pivot * n + k], b[column * n + k]);
    }
    const long double scale = 1 / a[column * n + column];
    for (std::size_t k = 0; k < n; ++k) a[column * n + k] *= scale, b[column * n + k] *= scale;
    for (std::size_t row = 0; row < n; ++row) {
      const long double factor = a[row * n + column];
      if (row == column || factor == 0) continue;
      for (std::size_t k = 0; k < n; ++k) {
        a[row * n + k] -= factor * a[column * n + k];
        b[row * n + k] -= factor * b[column * n + k];
      }
    }
  }
  return {b.begin(), b.end()};
}

}  // namespace tessera::cells
