// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace tessera::integrals {

/// The table of partial pre-integration (Moreland, Angel, "A Fast High Accuracy Volume Renderer for Unstructured Data",
/// VolVis 2004, section 4). For a piece of a ray on which the extinction is linear, let a and b be the extinction at
/// the ends of the piece, multiplied by the length of the piece. The table contains
///   Psi(a, b) = int_0^1 exp(-(a u + (b - a) u^2 / 2)) du.
/// Psi does not depend on the transfer function.
///
/// Grid      There are size x size floats. Each row is for one value of `a`; the values are at equal steps of
///           gamma = a / (1 + a) from 0 to 1. gamma = 1 represents infinity, where Psi is 0.
/// Error     The absolute error of bilinear interpolation at the default size is below 1e-5 where a and b are below 10,
///           and at most 2e-2; it is largest near gamma = 1, where Psi behaves like a square root.
struct PsiTable {
  static constexpr int default_size = 512;
  explicit PsiTable(int size = default_size);

  int size;
  std::vector<float> psi;
};

}  // namespace tessera::integrals
