// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::reference {

/// How much the light in a cell depends on rounding of the field; used by mesh_suspicion.hpp and grid_suspicion.hpp.
/// The numbers are estimates for ranking pixels, not bounds.
class LightError {
 public:
  /// `noise` is the rounding error of the field in a renderer; > 0.
  LightError(const scene::TransferFunction& function, scene::Emission emission, double noise);

  /// Returns the error of light or opacity per unit of length in a cell with these values at its corners. At a step of
  /// the transfer function, it is the jump times the fraction of the cell that may be on the wrong side. That fraction
  /// is the ratio of the rounding error to the cell's range of values, or the fraction of corners on the step itself.
  /// On a ramp, the error is the slope times the noise.
  [[nodiscard]] double per_length(std::span<const double> corners) const;
  /// Returns an upper limit of per_length() for any cell with values in [low, high].
  [[nodiscard]] double most_per_length(double low, double high) const;

  /// Returns the largest extinction (for independent emission, also colour) of values in [low, high].
  [[nodiscard]] double densest(double low, double high) const;

 private:
  struct Step {
    double value, jump;
  };
  struct Ramp {
    double low, high, slope;
  };
  [[nodiscard]] double steepest(double low, double high) const;
  [[nodiscard]] double matter(const scene::Knot& knot) const;

  std::vector<scene::Knot> knots_;
  std::vector<Step> steps_;  ///< sorted by value
  std::vector<Ramp> ramps_;  ///< sorted by value, only those with a slope
  scene::Emission emission_;
  double noise_, largest_jump_ = 0, largest_slope_ = 0, densest_ = 0;
};

}  // namespace tessera::reference
