// SPDX-License-Identifier: BSD-3-Clause
#include "reference/curved/dense_matrix.hpp"

#include <algorithm>
#include <cmath>

namespace tessera::reference {

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result(a.rows, b.columns);
  for (std::size_t i = 0; i < a.rows; ++i)
    for (std::size_t j = 0; j < b.columns; ++j) {
      long double sum = 0;
      for (std::size_t k = 0; k < a.columns; ++k) sum += static_cast<long double>(a(i, k)) * b(k, j);
      result(i, j) = static_cast<double>(sum);
    }
  return result;
}

Matrix inverse(const Matrix& matrix) {
  const std::size_t n = matrix.rows, width = 2 * n;
  std::vector<long double> work(n * width);
  const auto at = [&](std::size_t i, std::size_t j) -> long double& { return work[i * width + j]; };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) at(i, j) = matrix(i, j);
    at(i, n + i) = 1;
  }
  for (std::size_t column = 0; column < n; ++column) {
    std::size_t pivot = column;
    for (std::size_t i = column; i < n; ++i)
      if (std::abs(at(i, column)) > std::abs(at(pivot, column))) pivot = i;
    for (std::size_t j = 0; j < width; ++j) std::swap(at(pivot, j), at(column, j));
    const long double scale = at(column, column);
    for (std::size_t j = column; j < width; ++j) at(column, j) /= scale;
    for (std::size_t i = 0; i < n; ++i) {
      const long double factor = at(i, column);
      if (i == column || factor == 0) continue;
      for (std::size_t j = column; j < width; ++j) at(i, j) -= factor * at(column, j);
    }
  }
  Matrix result(n, n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) result(i, j) = static_cast<double>(at(i, n + j));
  return result;
}

Matrix kronecker(const Matrix& slow, const Matrix& fast) {
  Matrix result(slow.rows * fast.rows, slow.columns * fast.columns);
  for (std::size_t i = 0; i < slow.rows; ++i)
    for (std::size_t j = 0; j < slow.columns; ++j)
      for (std::size_t k = 0; k < fast.rows; ++k)
        for (std::size_t l = 0; l < fast.columns; ++l)
          result(i * fast.rows + k, j * fast.columns + l) = slow(i, j) * fast(k, l);
  return result;
}

}  // namespace tessera::reference
