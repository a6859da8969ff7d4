// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace tessera::reference {

/// A dense matrix, stored row by row.
struct Matrix {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;

  Matrix() = default;
  Matrix(std::size_t row_count, std::size_t column_count)
      : rows(row_count), columns(column_count), values(row_count * column_count) {}

  double& operator()(std::size_t row, std::size_t column) { return values[row * columns + column]; }
  double operator()(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

/// Returns the product a b; `a` must have as many columns as `b` has rows.
Matrix product(const Matrix& a, const Matrix& b);

/// Returns the inverse of a non-singular square matrix by Gauss-Jordan elimination with pivots. Computed in long
/// double, so that at the condition numbers of interpolation up to degree ten the largest error is the rounding of the
/// result.
Matrix inverse(const Matrix& matrix);

/// Returns the Kronecker product. Its row for row i of `fast` and row j of `slow` is i + j * (rows of `fast`), and
/// likewise for columns.
Matrix kronecker(const Matrix& slow, const Matrix& fast);

}  // namespace tessera::reference
