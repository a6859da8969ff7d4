// SPDX-License-Identifier: BSD-3-Clause
#include "colormaps/presets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "colormaps/color_map_tables.hpp"
#include "colormaps/function_options.hpp"
#include "scene/error.hpp"
#include "tessera/program/nearest_name.hpp"
#include "tessera/program/text.hpp"

namespace tessera::colormaps {
namespace {

/// Presets are defined by this project, and their colours are approximate (color_map_tables.cpp): errors of this size
/// are invisible, and keep the number of knots small.
constexpr double preset_color_tolerance = 5e-4, preset_extinction_tolerance = 5e-3;

constexpr double flat_opacity = 0.1;

std::vector<OpacityPoint> inverse_ramp() { return {{0, 0.2}, {1, 0.03}}; }
std::vector<OpacityPoint> ends() { return {{0, 0.2}, {0.5, 0.005}, {1, 0.2}}; }
/// Clear at the low end, because the background of a scan or a simulation usually has low values, and would hide
/// objects.
std::vector<OpacityPoint> rise() { return {{0, 0}, {0.1, 0}, {0.5, 0.15}, {1, 0.6}}; }
std::vector<OpacityPoint> surface() { return {{0, 0}, {0.45, 0}, {0.55, 0.9}, {1, 0.9}}; }
std::vector<OpacityPoint> flat() { return {{0, flat_opacity}, {1, flat_opacity}}; }

/// Shells at 1/10, 3/10, ... of the range; each is a tent with a base of 1/25 of the range.
std::vector<OpacityPoint> peaks() {
  constexpr double half_width = 0.02;
  std::vector<OpacityPoint> points{{0, 0}};
  for (int i = 0; i < 5; ++i) {
    const double center = 0.1 + 0.2 * i;
    points.insert(points.end(), {{center - half_width, 0}, {center, 0.7}, {center + half_width, 0}});
  }
  points.push_back({1, 0});
  return points;
}

struct Variant {
  std::string_view name;
  std::vector<OpacityPoint> (*points)();
};
constexpr std::array<Variant, 7> variants{{{"ramp", opacity_ramp},
                                           {"inverse", inverse_ramp},
                                           {"ends", ends},
                                           {"peaks", peaks},
                                           {"rise", rise},
                                           {"surface", surface},
                                           {"flat", flat}}};

const ColorMapTable* find_table(std::string_view name) {
  const auto tables = color_map_tables();
  const auto found = std::ranges::find(tables, name, &ColorMapTable::name);
  return found == tables.end() ? nullptr : &*found;
}

}  // namespace

std::vector<OpacityPoint> opacity_ramp() { return {{0, 0.03}, {1, 0.2}}; }

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const ColorMapTable& table : color_map_tables()) names.emplace_back(table.name);
  return names;
}

std::vector<std::string> preset_opacity_names() {
  std::vector<std::string> names;
  for (const Variant& variant : variants) names.emplace_back(variant.name);
  return names;
}

bool is_preset(std::string_view name) { return find_table(name.substr(0, name.find(':'))) != nullptr; }

LoadedTransferFunction preset(std::string_view name, const TransferFunctionOptions& options) {
  check(options);
  const std::size_t colon = name.find(':');
  const ColorMapTable* table = find_table(name.substr(0, colon));
  const std::string_view variant_name = colon == std::string_view::npos ? "ramp" : name.substr(colon + 1);
  const auto variant = std::ranges::find(variants, variant_name, &Variant::name);
  if (table == nullptr || variant == variants.end()) {
    const std::vector<std::string> known = preset_opacity_names();
    const auto near = table == nullptr ? std::nullopt : nearest_name(variant_name, known);
    throw scene::bad_input(
        fmt::format("{}: no such preset; {}write COLOURS or COLOURS:OPACITY with colours {} and "
                    "opacity {}",
                    quote(name), near ? fmt::format("did you mean {}:{}? ", table->name, *near) : "",
                    fmt::join(preset_names(), ", "), fmt::join(known, ", ")));
  }

  const auto [low, high] = options.spanned();
  TransferCurves curves;
  curves.space = table->space;
  const std::size_t count = table->colors.size();
  for (std::size_t i = 0; i < count; ++i)
    curves.colors.push_back(
        {count > 1 ? std::lerp(low, high, static_cast<double>(i) / static_cast<double>(count - 1)) : low,
         table->colors[i]});
  curves.opacities = variant->points();
  for (OpacityPoint& point : curves.opacities) point.value = std::lerp(low, high, point.value);
  if (!options.opacity_points.empty()) curves.opacities = points_over(options.opacity_points, low, high);
  if (low == high) {
    // A constant field gets the middle of the map, because no variant may make the only existing value invisible.
    const double middle = 0.5 * static_cast<double>(count - 1);
    const auto below = static_cast<std::size_t>(middle);
    const glm::dvec3 color = mix_colors(table->colors[below], table->colors[std::min(below + 1, count - 1)],
                                        middle - static_cast<double>(below), table->space);
    curves.colors = {{low, color}};
    curves.opacities = {{low, flat_opacity}};
  }

  const double distance = options.unit_distance.value_or(options.default_unit_distance);
  LoadedTransferFunction loaded{
      make_transfer_function(refined_knots(curves, {.unit_distance = distance,
                                                    .opacity_scale = options.opacity_scale,
                                                    .display_colors = options.display_colors,
                                                    .color_tolerance = preset_color_tolerance,
                                                    .extinction_tolerance = preset_extinction_tolerance}),
                             std::string(name)),
      std::string(name), distance, options.unit_distance ? "`unit_distance`" : "default"};
  if (options.range) {
    loaded.name += fmt::format(" over {:.6g} to {:.6g}", low, high);
    loaded.range = options.range;
  }
  return loaded;
}

LoadedTransferFunction default_transfer_function(const TransferFunctionOptions& options) {
  LoadedTransferFunction loaded = preset("cool-warm:ramp", options);
  loaded.name = "cool-warm:ramp (default)";
  return loaded;
}

}  // namespace tessera::colormaps
