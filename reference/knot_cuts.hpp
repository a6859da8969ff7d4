// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "scene/transfer_function.hpp"

namespace tessera::reference {

/// Returns the position where a scalar that is monotone in [u0, u1] takes a value between those at the ends.
template <class Scalar>
double crossing(const Scalar& scalar, double u0, double u1, double value) {
  const bool rising = scalar.at(u1) > scalar.at(u0);
  while (true) {
    const double middle = u0 + (u1 - u0) / 2;
    if (!(middle > u0 && middle < u1)) return middle;
    ((scalar.at(middle) < value) == rising ? u0 : u1) = middle;
  }
}

/// Returns, in order, `ends` and the positions where the scalar takes the knots' values minus `origin`. The scalar is
/// monotone between neighbouring `ends`.
template <class Scalar>
std::vector<double> knot_cuts(const Scalar& scalar, const std::vector<double>& ends, std::span<const scene::Knot> knots,
                              double origin) {
  std::vector<double> cuts = ends;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double one = scalar.at(ends[i]), other = scalar.at(ends[i + 1]);
    const double low = std::min(one, other), high = std::max(one, other);
    for (const scene::Knot& knot : knots) {
      const double value = knot.value - origin;
      if (value > low && value < high) cuts.push_back(crossing(scalar, ends[i], ends[i + 1], value));
    }
  }
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

}  // namespace tessera::reference
