// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace tessera::integrals {

/// The table of partial pre-integration (Moreland, Angel, "A Fast High Accuracy Volume Renderer for Unstructured Data",
/// VolVis 2004, section 4). Over a piece of a ray on which the extinction is linear, where a and b are the extinction
/// at its ends times its length, it contains
///   Psi(a, b) = int_0^1 exp(-(a u + (b - a) u^2 / 2)) du.
/// Psi does not depend on the transfer function.
///
/// Grid      size x size floats, one row per a, at equal steps of gamma = a / (1 + a) from 0 to 1, which represents
///           infinity (Psi is 0).
/// Error     of bilinear interpolation at the default size, absolute: below 1e-5 where a and b are below 10, and at
///           most 2e-2, near gamma = 1, where Psi behaves like a square root.
struct PsiTable {
  static constexpr int default_size = 512;
  explicit PsiTable(int size = default_size);

  int size;
  std::vector<float> psi;
};

}  // namespace tessera::integrals
