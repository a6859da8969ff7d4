// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "scene/transfer_function.hpp"

namespace tessera::projection {

/// The scalars at which a transfer function shows nothing, as closed intervals between two doubles, so that a cell's
/// visibility is a few comparisons: a cell is invisible if one interval holds all of its scalars.
///
/// Says what TransferFunction::visible says, to the last bit: ends are where its interpolation, rounding included,
/// turns to zero, and intervals do not join over a step that shows only from below.
class ClearIntervals {
 public:
  struct Interval {
    double low, high;  ///< both inside; may be infinite
  };

  /// None: everything shows.
  ClearIntervals() = default;
  /// `boundaries`, ascending: no interval holds both such a value and what lies below it, so that cells in which the
  /// field crosses one show.
  ClearIntervals(const scene::TransferFunction& function, bool emits_without_extinction,
                 std::span<const double> boundaries = {});

  /// Those that have a value in common with [low, high], ascending.
  [[nodiscard]] std::span<const Interval> meeting(double low, double high) const;

  /// Whether nothing shows anywhere in [low, high].
  [[nodiscard]] bool hold(double low, double high) const;

 private:
  void add(double low, double high, bool joins);
  void part(std::span<const double> boundaries);

  std::vector<Interval> intervals_;
};

}  // namespace tessera::projection
