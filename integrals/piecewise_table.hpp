// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "scene/transfer_function.hpp"

namespace tessera::integrals {

/// A transfer function as a table for lanes: K knots make K + 1 intervals, on each of which extinction and colour are
/// linear.
///
/// Interval 0 is below the first knot and interval K above the last; both are constant. Interval i is [below[i],
/// above[i]], and channel(s) = start + slope * (s - base). The two knots of a step make an interval of width zero,
/// through which rays pass without effect.
struct PiecewiseTable {
  struct Channel {
    std::vector<double> start, slope;
  };

  explicit PiecewiseTable(const scene::TransferFunction& function);

  std::size_t knot_count;
  /// K + 1 elements each, zero-padded to at least 8; below[0] = -inf, above[K] = +inf.
  std::vector<double> below, above, base;
  std::vector<double> values;       ///< the K knots' values, then +inf up to a power of two minus one
  std::array<Channel, 4> channels;  ///< extinction, red, green, blue
};

}  // namespace tessera::integrals
