#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace tessera::io {

/// Range of an array's finite values; of vectors, of their lengths.
struct NumberTally {
  double low = 0, high = 0;
  std::uint64_t not_finite = 0;
  bool any_finite = false;  ///< else low and high mean nothing

  void add(std::span<const double> values) {
    for (const double value : values) {
      if (!std::isfinite(value)) {
        ++not_finite;
        continue;
      }
      low = any_finite ? std::min(low, value) : value;
      high = any_finite ? std::max(high, value) : value;
      any_finite = true;
    }
  }
};

}  // namespace tessera::io
