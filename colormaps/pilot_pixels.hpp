// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scene/field_samples.hpp"

namespace tessera::colormaps {

/// What pixels of views along a box's axes would hold, from samples alone: optical depths of a 24 x 24 picture each (16
/// x 16 of few samples), along axes across which faces lie of at least 0.3 of the largest: what is flat is not looked
/// at along its plane. Good enough to choose how opaque a function is to be.
class PilotPixels {
 public:
  /// `extinctions`: value and extinction, linear between; times `unit` 1 / world unit.
  PilotPixels(const scene::FieldSamples& samples, std::span<const std::array<double, 2>> extinctions, double unit);

  /// The factor on extinction that makes pixels of alpha > 1/255 `mean_alpha` opaque in the mean, or less if else more
  /// than one in 200 had an alpha above 0.97. Where they are less than 0.15 of all, `mean_alpha` is taken times 0.6:
  /// such parts are smaller than these pixels, which show them too faint. 1 where nothing shows at any factor.
  [[nodiscard]] double scale(double mean_alpha) const;

 private:
  std::vector<double> depths_;
};

}  // namespace tessera::colormaps
