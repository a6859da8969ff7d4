// SPDX-License-Identifier: BSD-3-Clause
#include "colormaps/function_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "colormaps/transfer_curves.hpp"
#include "scene/error.hpp"

namespace tessera::colormaps {

void check(const TransferFunctionOptions& options) {
  const auto [low, high] = options.field_range;
  if (!std::isfinite(low) || !std::isfinite(high) || low > high)
    throw scene::bad_input(fmt::format("field range {} to {}: low must be finite and not above high", low, high));
  if (options.range) {
    const auto [from, to] = *options.range;
    if (!std::isfinite(from) || !std::isfinite(to) || !(from < to))
      throw scene::bad_input(fmt::format("`range` is {} to {}; the first must be less than the second", from, to));
  }
  double last = 0;
  for (const auto& [place, opacity] : options.opacity_points) {
    if (!(place >= last) || !(place <= 1))
      throw scene::bad_input(
          fmt::format("`opacity_points`: {} is not a fraction of the range; write 0 to 1, ascending", place));
    if (!(opacity >= 0) || !(opacity <= 1))
      throw scene::bad_input(fmt::format("`opacity_points`: the opacity {} is not 0 to 1", opacity));
    last = place;
  }
  const auto check_distance = [](double distance, const char* name) {
    if (!(distance > 0) || !std::isfinite(distance))
      throw scene::bad_input(fmt::format("{} is {}; it must be a positive length", name, distance));
  };
  if (options.unit_distance) check_distance(*options.unit_distance, "`unit_distance`");
  check_distance(options.default_unit_distance, "default unit distance");
  if (!(options.opacity_scale >= 0) || !std::isfinite(options.opacity_scale))
    throw scene::bad_input(fmt::format("opacity scale is {}; it must not be negative", options.opacity_scale));
}

std::vector<OpacityPoint> points_over(const std::vector<std::array<double, 2>>& points, double low, double high) {
  std::vector<OpacityPoint> over;
  for (const auto& [place, opacity] : points) over.push_back({std::lerp(low, high, place), opacity});
  return over;
}

bool is_far_off(const std::array<double, 2>& function, const std::array<double, 2>& field) {
  const double width = field[1] - field[0], span = function[1] - function[0];
  if (!(width > 0) || !std::isfinite(width) || !std::isfinite(span)) return false;
  const double overlap = std::min(function[1], field[1]) - std::max(function[0], field[0]);
  if (overlap >= 0.01 * width) return width < 0.01 * span;
  // A function that covers only a narrow part inside the field's range may be a threshold, which separates the values
  // on its two sides, so it is allowed.
  return function[0] <= field[0] + 0.01 * width || function[1] >= field[1] - 0.01 * width;
}

scene::TransferFunction make_transfer_function(std::vector<scene::Knot> knots, const std::string& source) {
  try {
    return scene::TransferFunction(std::move(knots));
  } catch (const scene::Error& error) {
    throw scene::Error(error.code(), source + ": " + error.what());
  }
}

}  // namespace tessera::colormaps
