// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>

namespace tessera::cells {

/// Returns the length of a tuple of any number type, without overflow or underflow. NaN or infinite if a component is.
template <class T>
double tuple_length(const T* tuple, int components) {
  double sum = 0;
  for (int k = 0; k < components; ++k) sum += static_cast<double>(tuple[k]) * static_cast<double>(tuple[k]);
  if (sum > 1e-290 && sum < 1e290) return std::sqrt(sum);
  double largest = 0;
  for (int k = 0; k < components; ++k) {
    const double a = std::abs(static_cast<double>(tuple[k]));
    if (!(a <= std::numeric_limits<double>::max())) return a;
    largest = a > largest ? a : largest;
  }
  if (largest == 0) return 0;
  sum = 0;
  for (int k = 0; k < components; ++k) {
    const double scaled = static_cast<double>(tuple[k]) / largest;
    sum += scaled * scaled;
  }
  return largest * std::sqrt(sum);
}

}  // namespace tessera::cells
