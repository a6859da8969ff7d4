// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tessera::scene {

/// The integer lattice to which the lattice rasterizer rounds depths and scalars: value = origin + n * unit, where n is
/// a signed 32-bit integer and |n| <= 2^30 over the mesh.
///
/// Integers are exact where floats round. The depth of a face's plane is an integer at every pixel. It is the same for
/// both cells that share the face, in any tile, block or lane, and overflows only outside the face, where this does no
/// harm. The step is 2^-30 of half of the mesh's depth, 64 times finer than that of a float. Units are powers of two,
/// so that conversions are exact.
struct Lattice {
  static constexpr double limit = 0x1p30;

  double depth_origin = 0, depth_unit = 0;
  double scalar_origin = 0, scalar_unit = 0;

  /// Returns the smallest power of two for which `limit` steps are at least as long as `reach`.
  static double unit_for(double reach) {
    return reach > 0 ? std::exp2(std::max(std::ceil(std::log2(reach / limit)), -1000.0)) : 0x1p-30;
  }

  [[nodiscard]] static std::int32_t step_of(double value, double origin, double unit) {
    const double steps = std::nearbyint((value - origin) / unit);
    // These comparisons also map NaN to the limit. Only vertices without cells may be NaN.
    return static_cast<std::int32_t>(steps > -limit ? std::min(steps, limit) : -limit);
  }
  [[nodiscard]] std::int32_t depth_step(double depth) const { return step_of(depth, depth_origin, depth_unit); }
  [[nodiscard]] std::int32_t scalar_step(double scalar) const { return step_of(scalar, scalar_origin, scalar_unit); }
  [[nodiscard]] double depth(double n) const { return depth_origin + n * depth_unit; }
  [[nodiscard]] double scalar(double n) const { return scalar_origin + n * scalar_unit; }
};

/// A range of scalars that also has a magnified copy on the lattice, above all scalars of the mesh. In the copy, the
/// lattice is fine enough for a transfer function that is too steep for the usual steps. The cells that reach the range
/// are irregular, and their segments are cut at its ends (CellsAtSteps, SplitRasterizer), so no segment is partly
/// inside.
struct MagnifiedRange {
  double low, high;
  double place, factor;  ///< `place`: the scalar to which `low` is moved; `factor`: the magnification

  [[nodiscard]] bool contains(double scalar) const { return low <= scalar && scalar < high; }
  [[nodiscard]] double moved(double scalar) const { return place + (scalar - low) * factor; }
};

}  // namespace tessera::scene
