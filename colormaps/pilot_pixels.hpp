// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scene/field_samples.hpp"

namespace tessera::colormaps {

/// Estimates the pixels of views along the axes of a box from samples alone. For each axis, the optical depths of an
/// image of 24 x 24 pixels are estimated (16 x 16 for few samples). Axes are used if the area of their normal faces is
/// at least 0.3 of the largest, so that flat boxes are not viewed along their plane. The estimate is accurate enough to
/// choose the opacity of a function.
class PilotPixels {
 public:
  /// `extinctions` are pairs of value and extinction, linear between them; extinctions are in units of `unit` / world
  /// unit.
  PilotPixels(const scene::FieldSamples& samples, std::span<const std::array<double, 2>> extinctions, double unit);

  /// Returns the factor on extinction that makes the mean opacity of pixels with alpha > 1/255 equal to `mean_alpha`.
  /// The factor is smaller if otherwise more than one in 200 of these pixels would have an alpha above 0.97. If these
  /// pixels are less than 0.15 of all pixels, the target is 0.6 `mean_alpha`, because the visible parts are then
  /// smaller than the estimated pixels and appear too faint in them. Returns 1 if no factor makes anything visible.
  [[nodiscard]] double scale(double mean_alpha) const;

 private:
  std::vector<double> depths_;
};

}  // namespace tessera::colormaps
