// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene/json_transfer_function.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "colormaps/color_spaces.hpp"
#include "colormaps/transfer_curves.hpp"
#include "io/scene/knot_list.hpp"
#include "io/scene/paraview_color_map.hpp"
#include "io/text/json_text.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 5> parts{"value", "red", "green", "blue", "extinction"};

std::vector<scene::Knot> knots_of(const json& list, const std::string& source) {
  const auto fault = [&](const std::string& what) { return scene::bad_input(source + ": " + what); };
  if (!list.is_array() || list.empty())
    throw fault("knots is not a list of knots; write [[value, red, green, blue, extinction], ...]");
  std::vector<scene::Knot> knots;
  knots.reserve(list.size());
  for (const json& item : list) {
    const std::size_t number = knots.size() + 1;
    if (!item.is_array() || item.size() != parts.size())
      throw fault(
          fmt::format("knot {} is not a list of 5 numbers; write [value, red, green, blue, extinction]", number));
    std::array<double, 5> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (!item[i].is_number() || !std::isfinite(item[i].get<double>()))
        throw fault(fmt::format("knot {}: its {} is not a finite number; write one", number, parts[i]));
      numbers[i] = item[i].get<double>();
      if (i > 0 && numbers[i] < 0)
        throw fault(fmt::format("knot {}: its {} is {}, but must not be negative; give 0 or more", number, parts[i],
                                numbers[i]));
    }
    if (!knots.empty() && numbers[0] < knots.back().value)
      throw fault(fmt::format("knot {}: its value {} is below the one before it, {}; sort the knots by value", number,
                              numbers[0], knots.back().value));
    knots.push_back({numbers[0], {numbers[1], numbers[2], numbers[3]}, numbers[4]});
  }
  return knots;
}

/// Bisects [t0, t1] until `error` of each part is at most 1. Appends the upper end of each part to `at`.
template <class Error>
void cut(double t0, double t1, int depth, const Error& error, std::vector<double>& at) {
  constexpr int most_halvings = 12;
  if (depth < most_halvings && error(t0, t1) > 1) {
    const double middle = 0.5 * (t0 + t1);
    cut(t0, middle, depth + 1, error, at);
    cut(middle, t1, depth + 1, error, at);
  } else {
    at.push_back(t1);
  }
}

glm::dvec3 display(const glm::dvec3& linear) { return colormaps::encode_srgb(glm::clamp(linear, 0.0, 1.0)); }

/// Largest error at three positions inside a part, which is enough for the smooth curves here.
template <class Off>
double worst(const Off& off) {
  return std::max({off(0.25), off(0.5), off(0.75)});
}

}  // namespace

colormaps::LoadedTransferFunction parse_json_transfer_function(std::string_view text, const std::string& source,
                                                               const colormaps::TransferFunctionOptions& options) {
  const json root = parse_json(text, source);
  if (!root.is_object() || !root.contains("knots")) return color_map_of(root, source, options);
  colormaps::check(options);
  for (const auto& item : root.items())
    if (item.key() != "knots")
      throw scene::bad_input(fmt::format("{}: {} is unknown next to knots; leave it out", source, quote(item.key())));
  return loaded_knots(knots_of(root["knots"], source), source, options);
}

std::string knots_json(const scene::TransferFunction& function) {
  std::string text = "{\"knots\": [";
  const char* before = "";
  for (const scene::Knot& k : function.knots()) {
    text += std::exchange(before, ", ");
    text += json::array({k.value, k.color.x, k.color.y, k.color.z, k.extinction}).dump();
  }
  return text + "]}\n";
}

std::string color_map_json(const scene::TransferFunction& function, double unit_distance, const std::string& name) {
  const auto knots = function.knots();
  if (knots.empty()) throw scene::bad_input("transfer function: it has no knots; give at least one");
  if (!(unit_distance > 0) || !std::isfinite(unit_distance))
    throw scene::bad_input(fmt::format("`unit_distance` {}: it must be a length above 0", unit_distance));
  // Half of the largest optical depth that an opacity can represent.
  constexpr double most_depth = 6;
  if (function.max_extinction() * unit_distance > most_depth) unit_distance = most_depth / function.max_extinction();
  // Tolerances of the written map. Reading the map back may add the same error again.
  constexpr double color_tolerance = 1e-4, depth_tolerance = 1e-4;
  const auto opacity = [&](double extinction) { return -std::expm1(-extinction * unit_distance); };
  const auto depth = [](double a) { return -std::log1p(-a); };

  std::vector<double> colors, opacities;
  const auto add_color = [&](double value, const glm::dvec3& linear) {
    const glm::dvec3 c = display(linear);
    colors.insert(colors.end(), {value, c.x, c.y, c.z});
  };
  const auto add_opacity = [&](double value, double extinction) {
    opacities.insert(opacities.end(), {value, opacity(extinction), 0.5, 0.0});
  };
  add_color(knots.front().value, knots.front().color);
  add_opacity(knots.front().value, knots.front().extinction);
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const scene::Knot &a = knots[i], &b = knots[i + 1];
    const auto color_at = [&](double t) { return glm::clamp(glm::mix(a.color, b.color, t), 0.0, 1.0); };
    const auto extinction_at = [&](double t) { return std::lerp(a.extinction, b.extinction, t); };
    std::vector<double> at;
    if (a.value < b.value)
      cut(
          0, 1, 0,
          [&](double t0, double t1) {
            const glm::dvec3 c0 = display(color_at(t0)), c1 = display(color_at(t1));
            return worst([&](double u) {
                     const glm::dvec3 off =
                         glm::abs(colormaps::decode_srgb(glm::mix(c0, c1, u)) - color_at(std::lerp(t0, t1, u)));
                     return std::max({off.x, off.y, off.z});
                   }) /
                   color_tolerance;
          },
          at);
    else
      at = {1};
    for (const double t : at) add_color(t < 1 ? std::lerp(a.value, b.value, t) : b.value, color_at(t));
    at.clear();
    if (a.value < b.value)
      cut(
          0, 1, 0,
          [&](double t0, double t1) {
            const double a0 = opacity(extinction_at(t0)), a1 = opacity(extinction_at(t1));
            return worst([&](double u) {
              const double exact = extinction_at(std::lerp(t0, t1, u)) * unit_distance;
              return std::abs(depth(std::lerp(a0, a1, u)) - exact) / (depth_tolerance * std::max(exact, 0.01));
            });
          },
          at);
    else
      at = {1};
    for (const double t : at) add_opacity(t < 1 ? std::lerp(a.value, b.value, t) : b.value, extinction_at(t));
  }
  nlohmann::ordered_json map{{"Name", name},
                             {"ColorSpace", "RGB"},
                             {"ScalarOpacityUnitDistance", unit_distance},
                             {"RGBPoints", colors},
                             {"Points", opacities}};
  return nlohmann::ordered_json::array({map}).dump(1) + "\n";
}

}  // namespace tessera::io
