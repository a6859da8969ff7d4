// SPDX-License-Identifier: BSD-3-Clause
#include "scene/error_budget.hpp"

#include <fmt/format.h>

#include <cmath>

#include "scene/error.hpp"

namespace tessera::scene {

double most_light(const TransferFunction& function, Emission emission, double length) {
  if (emission == Emission::absorption) return std::max(1.0, function.max_color());
  double light = 0;
  for (const Knot& knot : function.knots()) {
    const double color = std::max({knot.color.x, knot.color.y, knot.color.z});
    if (color > 0) light = std::max(light, color / knot.extinction);
  }
  return std::max(1.0, std::min(light, function.max_color() * length));
}

void check_accuracy(double accuracy) {
  if (!(accuracy > 0) || !std::isfinite(accuracy))
    throw bad_input(fmt::format("`accuracy` {}: it must be positive", accuracy));
  if (accuracy < error_budget::least_accuracy)
    throw bad_input(fmt::format(
        "`accuracy` {}: images consist of 32-bit floats, which are accurate to {} at best; give this or more", accuracy,
        error_budget::least_accuracy));
}

}  // namespace tessera::scene
