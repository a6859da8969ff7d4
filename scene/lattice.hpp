// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tessera::scene {

/// The integer lattice of depths and scalars in the lattice rasterizer: value = origin + n * unit, n a signed 32-bit
/// integer, |n| <= 2^30 over the mesh.
///
/// Integers are exact where floats round: a face's plane is an integer at every pixel, the same for both cells that
/// share the face, whatever tile, block or lane computes it, and wraps harmlessly outside the face. The step, 2^-30 of
/// half the mesh's depth, is 64 times finer than a float's. Units are powers of two, so that conversions are exact.
struct Lattice {
  static constexpr double limit = 0x1p30;

  double depth_origin = 0, depth_unit = 0;
  double scalar_origin = 0, scalar_unit = 0;

  /// The smallest power of two for which `limit` steps span `reach`.
  static double unit_for(double reach) {
    return reach > 0 ? std::exp2(std::max(std::ceil(std::log2(reach / limit)), -1000.0)) : 0x1p-30;
  }

  [[nodiscard]] static std::int32_t step_of(double value, double origin, double unit) {
    const double steps = std::nearbyint((value - origin) / unit);
    // The form of these comparisons also maps NaN, which vertices of no cell may have, to the limit.
    return static_cast<std::int32_t>(steps > -limit ? std::min(steps, limit) : -limit);
  }
  [[nodiscard]] std::int32_t depth_step(double depth) const { return step_of(depth, depth_origin, depth_unit); }
  [[nodiscard]] std::int32_t scalar_step(double scalar) const { return step_of(scalar, scalar_origin, scalar_unit); }
  [[nodiscard]] double depth(double n) const { return depth_origin + n * depth_unit; }
  [[nodiscard]] double scalar(double n) const { return scalar_origin + n * scalar_unit; }
};

}  // namespace tessera::scene
