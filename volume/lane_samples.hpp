#pragma once

#include <algorithm>
#include <cmath>

#include "compositor/lane_table.hpp"
#include "scene/sample_source.hpp"

namespace tessera::volume {

/// From stored samples to the scalars of float lanes (compositor::lane_scalar): lane = round(factor * sample + term).
///
/// Unit    2^-29 of the largest distance between the origin and a value: products of few differences stay finite.
/// Origin  zero, if the range holds or nearly holds it, so that float samples keep their bits; else the range's middle.
/// Blank   a sample that is not finite gives NaN.
struct LaneSamples {
  double origin = 0, unit = 1;
  double factor = 1, term = 0;
  bool scales_floats = true;  ///< the factor is a power of two that floats hold, the term zero

  LaneSamples() = default;
  LaneSamples(const scene::Grid& grid, const scene::ValueRange& range) {
    if (range.empty()) return;
    const double width = range.high - range.low;
    if (range.low > width || range.high < -width) origin = 0.5 * (range.low + range.high);
    const double reach = std::max(std::abs(range.low - origin), std::abs(range.high - origin));
    unit = reach > 0 ? std::ldexp(1.0, std::max(std::ilogb(reach) + 1 - 29, -1000)) : 1.0;
    factor = grid.scale / unit;
    term = (grid.shift - origin) / unit;
    int exponent = 0;
    scales_floats = term == 0 && std::frexp(factor, &exponent) == 0.5 && std::abs(exponent) < 120;
  }

  [[nodiscard]] float lane(double sample) const {
    if (!std::isfinite(sample)) return NAN;
    return static_cast<float>(std::nearbyint(std::fma(factor, sample, term)));
  }
};

}  // namespace tessera::volume
