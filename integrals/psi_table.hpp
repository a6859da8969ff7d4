// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace tessera::integrals {

/// What partial pre-integration looks up (Moreland, Angel, "A Fast High Accuracy Volume Renderer for Unstructured
/// Data", VolVis 2004, section 4): over a stretch of a ray on which the extinction is linear, a and b being extinction
/// at its ends times its length,
///   Psi(a, b) = int_0^1 exp(-(a u + (b - a) u^2 / 2)) du.
/// It depends on no transfer function.
///
/// Grid    size x size floats, a by row, at equal steps of gamma = a / (1 + a) from 0 to 1, which is infinity (Psi 0).
/// Error   of bilinear interpolation, at the default size, absolute: below 1e-5 where a and b are below 10, and 2e-2 at
///         worst, near gamma = 1, where Psi has the slope of a square root.
struct PsiTable {
  static constexpr int default_size = 512;
  explicit PsiTable(int size = default_size);

  int size;
  std::vector<float> psi;
};

}  // namespace tessera::integrals
