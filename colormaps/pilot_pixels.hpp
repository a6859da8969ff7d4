// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scene/field_samples.hpp"

namespace tessera::colormaps {

/// Estimates the pixels of views along a box's axes from samples alone: optical depths of a 24 x 24 image each (16 x 16
/// for few samples), along axes whose normal faces have at least 0.3 of the area of the largest: flat boxes are not
/// viewed along their plane. Accurate enough to choose the opacity of a function.
class PilotPixels {
 public:
  /// `extinctions`: pairs of value and extinction, linear between them; in units of `unit` / world unit.
  PilotPixels(const scene::FieldSamples& samples, std::span<const std::array<double, 2>> extinctions, double unit);

  /// The factor on extinction that makes the mean opacity of pixels with alpha > 1/255 `mean_alpha`, or less if
  /// otherwise more than one in 200 would have an alpha above 0.97. If these are less than 0.15 of all pixels, the
  /// target is 0.6 `mean_alpha`: such parts are smaller than the estimated pixels and appear too faint in them. 1 if no
  /// factor makes anything visible.
  [[nodiscard]] double scale(double mean_alpha) const;

 private:
  std::vector<double> depths_;
};

}  // namespace tessera::colormaps
