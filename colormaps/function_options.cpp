#include "colormaps/function_options.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "scene/error.hpp"

namespace tessera::colormaps {

void check(const TransferFunctionOptions& options) {
  const auto [low, high] = options.field_range;
  if (!std::isfinite(low) || !std::isfinite(high) || low > high)
    throw scene::bad_input(fmt::format("field range {} to {}: low must be finite and not above high", low, high));
  const auto check_distance = [](double distance, const char* name) {
    if (!(distance > 0) || !std::isfinite(distance))
      throw scene::bad_input(fmt::format("{} is {}; it must be a positive length", name, distance));
  };
  if (options.unit_distance) check_distance(*options.unit_distance, "`unit_distance`");
  check_distance(options.default_unit_distance, "default unit distance");
  if (!(options.opacity_scale >= 0) || !std::isfinite(options.opacity_scale))
    throw scene::bad_input(fmt::format("opacity scale is {}; it must not be negative", options.opacity_scale));
}

scene::TransferFunction make_transfer_function(std::vector<scene::Knot> knots, const std::string& source) {
  try {
    return scene::TransferFunction(std::move(knots));
  } catch (const scene::Error& error) {
    throw scene::Error(error.code(), source + ": " + error.what());
  }
}

}  // namespace tessera::colormaps
