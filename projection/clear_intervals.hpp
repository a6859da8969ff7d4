// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "scene/transfer_function.hpp"

namespace tessera::projection {

/// The scalars at which a transfer function is invisible, as closed intervals between two doubles. A cell is invisible
/// if one interval contains all of its scalars, which takes only a few comparisons.
///
/// The intervals agree with TransferFunction::visible to the last bit: an interval ends where the interpolation, with
/// its rounding, becomes zero, and intervals are not joined across a step if the function is visible just below the
/// step.
class ClearIntervals {
 public:
  struct Interval {
    double low, high;  ///< both inclusive; may be infinite
  };

  /// Makes no intervals: everything is visible.
  ClearIntervals() = default;
  /// `boundaries` must ascend. No interval contains both a boundary and values below it, so that cells in which the
  /// field crosses a boundary are visible.
  ClearIntervals(const scene::TransferFunction& function, bool emits_without_extinction,
                 std::span<const double> boundaries = {});

  /// Returns the intervals that intersect [low, high], ascending.
  [[nodiscard]] std::span<const Interval> meeting(double low, double high) const;

  /// Whether nothing in [low, high] is visible.
  [[nodiscard]] bool hold(double low, double high) const;

 private:
  void add(double low, double high, bool joins);
  void part(std::span<const double> boundaries);

  std::vector<Interval> intervals_;
};

}  // namespace tessera::projection
