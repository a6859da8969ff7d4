// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "integrals/lane_table.hpp"
#include "scene/sample_source.hpp"

namespace tessera::volume {

/// The map from stored samples to the scalars of float lanes (integrals::lane_scalar): lane = round(factor * (lift *
/// sample) + term).
///
/// Unit      The unit is 2^-29 of a power of two above the largest distance between the origin and a value, so that
///           products of few differences remain finite.
/// Origin    The origin is zero if the range contains or almost contains zero, so that float samples keep their bits;
///           otherwise it is the middle of the range.
/// Lift      The lift is a power of two. It is 1 except for values near the smallest doubles, where the inverse of the
///           unit would be infinite.
/// One       If all values are equal, the origin is this value, and the value's last place is many units. All but the
///           nearest knots are then out of range, and are replaced by the function's values near the origin.
/// Exact     A lane is (value - origin) / unit without rounding, so it is on the same side of a step as the value. For
///           float samples, this is true only if lanes keep fractions of a unit (`whole` is false).
/// Blank     A sample that is not finite becomes NaN.
struct LaneSamples {
  double origin = 0, unit = 1;
  double factor = 1, term = 0, lift = 1;
  bool scales_floats = true;   ///< the factor is a power of two that a float can represent, and the term is zero
  bool whole = true;           ///< lanes are rounded to integers
  bool exact = false;          ///< see Exact above
  bool whole_numbers = false;  ///< lanes are exact integers regardless of `whole`

  LaneSamples() = default;
  LaneSamples(const scene::Grid& grid, const scene::ValueRange& range) {
    if (range.empty()) return;
    const double width = range.high - range.low;
    if (range.low > width || range.high < -width) origin = 0.5 * (range.low + range.high);
    const double reach = std::max(std::abs(range.low - origin), std::abs(range.high - origin));
    if (reach > 0) {
      unit = std::ldexp(1.0, std::max(std::ilogb(reach) + 1 - 29, -1074));
      if (unit < 0x1p-1000) lift = 0x1p128;
      factor = grid.scale / (unit * lift);
      term = (grid.shift - origin) / unit;
    } else {
      unit = origin == 0 ? std::ldexp(1.0, -1000) : std::ldexp(1.0, std::max(std::ilogb(origin) - 52 - 27, -1074));
      factor = term = 0;
    }
    int exponent = 0;
    scales_floats = term == 0 && std::frexp(factor, &exponent) == 0.5 && std::abs(exponent) < 120;
    exact = !(reach > 0) || is_exact(grid, std::max(std::abs(range.low), std::abs(range.high)));
    whole_numbers = exact && (!(reach > 0) || !scene::is_float(grid.type) || origin != 0);
  }

  [[nodiscard]] float lane(double sample) const {
    if (!std::isfinite(sample)) return NAN;
    const double lane = std::fma(factor, lift * sample, term);
    return static_cast<float>(whole ? std::nearbyint(lane) : lane);
  }

 private:
  /// Whether floats represent all lanes exactly. This is true for float samples without scale and shift, and for
  /// integers of at most 23 bits. (If the origin is the middle of the range, floats are multiples of 2^-24 of the
  /// middle.)
  static bool is_exact(const scene::Grid& grid, double largest) {
    if (grid.type == scene::SampleType::float32) return grid.scale == 1 && grid.shift == 0;
    return !scene::is_float(grid.type) && grid.scale == std::nearbyint(grid.scale) &&
           grid.shift == std::nearbyint(grid.shift) && std::abs(grid.shift) < 0x1p23 && largest < 0x1p23;
  }
};

}  // namespace tessera::volume
