// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "api/options/argument_values.hpp"
#include "api/options/choices.hpp"
#include "api/options/values.hpp"
#include "tessera/error.hpp"
#include "tessera/program/method_words.hpp"

namespace tessera {
namespace api {
namespace {

/// Pairs T:A, separated by commas, with T ascending from 0 to 1.
std::vector<std::array<double, 2>> opacity_points(const OptionWords& words) {
  std::vector<std::array<double, 2>> points;
  if (!words.given("opacity-points")) return points;
  for (const std::string& point : split_at_commas(words.word("opacity-points"))) {
    const std::size_t colon = point.find(':');
    if (colon == std::string::npos)
      throw bad_input(fmt::format("`opacity_points`: '{}' has no opacity; write T:A, like 0.3:0.02", point));
    const double place = parse_number("`opacity_points`", point.substr(0, colon));
    const double opacity = parse_number("`opacity_points`", point.substr(colon + 1));
    if (!(place >= (points.empty() ? 0 : points.back()[0])) || !(place <= 1))
      throw bad_input(
          fmt::format("`opacity_points`: {} is not a fraction of the range; write 0 to 1, ascending", place));
    if (!(opacity >= 0) || !(opacity <= 1))
      throw bad_input(fmt::format("`opacity_points`: the opacity {} is not 0 to 1", opacity));
    points.push_back({place, opacity});
  }
  return points;
}

}  // namespace

void set_function(const OptionWords& words, RenderOptions& options) {
  TransferFunctionOptions& function = options.function;
  options.transfer_function = words.word("transfer-function");
  function.rescale = words.given("rescale");
  if (function.rescale && options.transfer_function.empty())
    throw bad_input("`rescale`: it is for a `transfer_function` file; give one, or leave `rescale` out");
  function.rescale_presets = true;
  assign(function.unit_distance, words.positive("unit-distance"));
  assign(function.opacity_scale, words.positive("opacity"));
  assign(function.display_colors, words.choice("blend", off_on));
  function.logarithmic = words.given("log");
  function.range = words.interval("range");
  function.opacity_points = opacity_points(words);
  options.read.shape = !options.is_grid() && options.transfer_function.empty();
}

LoadedTransferFunction chosen_function(const Dataset& data, const RenderOptions& options) {
  TransferFunctionOptions function = options.function;
  function.emission = options.settings.emission;
  function.with_surfaces = !options.settings.surfaces.empty() || !options.block_surfaces.empty();
  LoadedTransferFunction loaded = data.transfer_function(options.transfer_function, function);
  if (options.settings.mesh.shading && data.is_mesh() && data.association() == Association::cell)
    loaded.warnings.emplace_back(
        "`shade`: it has no effect, because a field with one value per cell has no gradient; `smooth` gives values at "
        "the points");
  if (!options.settings.surfaces.empty())
    for (const std::string& warning : unseen_surfaces(options.settings.surfaces, data.range()))
      loaded.warnings.push_back(warning);
  return loaded;
}

}  // namespace api

inline namespace v0_1 {

LoadedTransferFunction transfer_function_of(const Dataset& data, const RenderOptions& options) {
  LoadedTransferFunction loaded = api::chosen_function(data, options);
  loaded.name = with_options(loaded.name);
  loaded.unit_distance_source = with_options(loaded.unit_distance_source);
  loaded.warnings = with_options(loaded.warnings);
  return loaded;
}

bool shades_by_default(const LoadedTransferFunction& loaded, const RenderOptions& options) {
  const Settings& settings = options.settings;
  if (!loaded.shaded || options.no_shade || (options.frame.deep && !options.frame.peel) || settings.grid.shading)
    return false;
  return !takes_steps(settings.integrator) && settings.emission == Emission::absorption;
}

}  // namespace v0_1
}  // namespace tessera
