// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene/paraview_color_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include "colormaps/function_options.hpp"
#include "colormaps/presets.hpp"
#include "colormaps/transfer_curves.hpp"
#include "io/text/json_text.hpp"
#include "io/text/text_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

using nlohmann::json;

class MapReader {
 public:
  MapReader(const json& map, const std::string& source) : map_(map), source_(source) {}

  [[nodiscard]] scene::Error fault(const std::string& what) const { return scene::bad_input(source_ + ": " + what); }

  /// Returns the value of a key; null if the key is absent or its value is JSON's null.
  [[nodiscard]] const json* find(const char* key) const {
    const auto found = map_.find(key);
    return found == map_.end() || found->is_null() ? nullptr : &*found;
  }

  [[nodiscard]] std::string text(const char* key, const std::string& otherwise) const {
    const json* value = find(key);
    if (value == nullptr) return otherwise;
    if (!value->is_string()) throw fault(fmt::format("{} is not a string; export the map again", key));
    return value->get<std::string>();
  }

  /// Returns a flat list of numbers, `arity` per point; empty if the key is absent.
  [[nodiscard]] std::vector<double> numbers(const char* key, std::size_t arity) const {
    const json* list = find(key);
    if (list == nullptr) return {};
    if (!list->is_array()) throw fault(fmt::format("{} is not a list; write {} numbers per point", key, arity));
    if (list->size() % arity != 0)
      throw fault(fmt::format("{} has {} numbers, which is not a multiple of {}; the list is cut off or lacks a number",
                              key, list->size(), arity));
    std::vector<double> out;
    out.reserve(list->size());
    for (const json& item : *list) {
      if (!item.is_number() || !std::isfinite(item.get<double>()))
        throw fault(
            fmt::format("{}: item {} is not a finite number; write {} numbers per point", key, out.size() + 1, arity));
      out.push_back(item.get<double>());
    }
    return out;
  }

  [[nodiscard]] std::vector<colormaps::ColorPoint> colors() const {
    const std::vector<double> flat = numbers("RGBPoints", 4);
    std::vector<colormaps::ColorPoint> points;
    for (std::size_t i = 0; i + 3 < flat.size(); i += 4) {
      const glm::dvec3 color{flat[i + 1], flat[i + 2], flat[i + 3]};
      // Rounding slightly below 0 or above 1 is common in exported maps and is clamped. Values above 2 indicate colours
      // from 0 to 255 and are refused.
      if (std::max({color.x, color.y, color.z}) > 2)
        throw fault(fmt::format("RGBPoints: point {} has the colour {} {} {}; write components from 0 to 1, not bytes",
                                i / 4 + 1, color.x, color.y, color.z));
      points.push_back({flat[i], glm::clamp(color, 0.0, 1.0)});
    }
    return points;
  }

  [[nodiscard]] std::vector<colormaps::OpacityPoint> opacities() const {
    const std::vector<double> flat = numbers("Points", 4);
    std::vector<colormaps::OpacityPoint> points;
    for (std::size_t i = 0; i + 3 < flat.size(); i += 4) {
      constexpr std::array<const char*, 3> name{"opacity", "midpoint", "sharpness"};
      for (std::size_t k = 0; k < 3; ++k)
        if (!(flat[i + 1 + k] >= -1e-6 && flat[i + 1 + k] <= 1 + 1e-6))
          throw fault(
              fmt::format("Points: point {} has {} {}; it must be 0 to 1", i / 4 + 1, name[k], flat[i + 1 + k]));
      points.push_back({flat[i], std::clamp(flat[i + 1], 0.0, 1.0), flat[i + 2], flat[i + 3]});
    }
    return points;
  }

 private:
  const json& map_;
  const std::string& source_;
};

/// VTK sorts points as they are added. Points of equal value, which form steps, keep the order of the file.
template <class Point>
void sort_points(std::vector<Point>& points) {
  std::ranges::stable_sort(points, {}, &Point::value);
}

template <class Point>
std::array<double, 2> range_of(const std::vector<Point>& points) {
  return {points.front().value, points.back().value};
}

/// Maps the range `from` of the points to the range `to`. If `to` is a single value, which cannot contain the whole
/// map, this value gets the colour or opacity at the middle of `from`.
template <class Point>
void stretch(std::vector<Point>& points, const std::array<double, 2>& from, const std::array<double, 2>& to,
             auto&& at_middle) {
  if (to[0] == to[1]) {
    points = {at_middle()};
    points.front().value = to[0];
    return;
  }
  if (from[0] == from[1]) return;  // a single value: the map is constant
  for (Point& point : points) point.value = std::lerp(to[0], to[1], (point.value - from[0]) / (from[1] - from[0]));
}

/// The two points around the middle of a range, and the relative position of the middle between them.
template <class Point>
auto round_middle(const std::vector<Point>& points) {
  const double middle = 0.5 * (points.front().value + points.back().value);
  const auto above = std::ranges::upper_bound(points, middle, {}, &Point::value);
  struct Place {
    Point a, b;
    double t;
  };
  const Point &b = above == points.end() ? points.back() : *above, &a = above == points.begin() ? b : *(above - 1);
  return Place{a, b, a.value < b.value ? (middle - a.value) / (b.value - a.value) : 0};
}

/// Sets the colour space. Returns a remark for the name of the map, or "".
std::string set_color_space(const std::string& name, const MapReader& reader, colormaps::TransferCurves& curves) {
  curves.hue_wraps = false;
  if (const json* wrap = reader.find("HSVWrap"))
    curves.hue_wraps = wrap->is_boolean() ? wrap->get<bool>() : wrap->is_number() && wrap->get<double>() != 0;
  if (name == "RGB") {
    curves.space = colormaps::ColorSpace::rgb;
  } else if (name == "HSV" || name == "Wrapped") {  // ParaView's older name for HSV with wrapping
    curves.space = colormaps::ColorSpace::hsv;
    curves.hue_wraps = curves.hue_wraps || name == "Wrapped";
  } else if (name == "Lab" || name == "CIELAB" || name == "CIELab" || name == "LAB") {
    curves.space = colormaps::ColorSpace::lab;
  } else if (name == "LabCIEDE2000" || name == "Lab/CIEDE2000") {
    curves.space = colormaps::ColorSpace::lab;
    return "Lab for LabCIEDE2000";
  } else if (name == "Diverging") {
    curves.space = colormaps::ColorSpace::diverging;
  } else if (name == "Step") {
    curves.space = colormaps::ColorSpace::step;
  } else {
    throw reader.fault(fmt::format(
        "ColorSpace {} is unknown; use RGB, HSV, Lab, CIELAB, LabCIEDE2000, Diverging or Step", quote(name)));
  }
  return "";
}

/// Returns the unit distance for which opacities are given; `source` gets a description of its origin.
double unit_distance(const MapReader& reader, const colormaps::TransferFunctionOptions& options, std::string& source) {
  source = "default";
  double distance = options.default_unit_distance;
  if (const json* in_file = reader.find("ScalarOpacityUnitDistance")) {
    if (!in_file->is_number() || !(in_file->get<double>() > 0) || !std::isfinite(in_file->get<double>()))
      throw reader.fault("ScalarOpacityUnitDistance is not a positive number; it is a length in world units");
    distance = in_file->get<double>();
    source = "file";
  }
  if (options.unit_distance) {
    distance = *options.unit_distance;
    source = "`unit_distance`";
  }
  return distance;
}

}  // namespace

colormaps::LoadedTransferFunction parse_paraview_color_map(std::string_view text, const std::string& source,
                                                           const colormaps::TransferFunctionOptions& options) {
  return color_map_of(parse_json(text, source), source, options);
}

colormaps::LoadedTransferFunction color_map_of(const json& root, const std::string& source,
                                               const colormaps::TransferFunctionOptions& options) {
  colormaps::check(options);
  if (root.is_array() && root.empty())
    throw scene::bad_input(source + ": is an empty list; export a colour map to this file");
  const json& map = root.is_array() ? root.front() : root;
  if (!map.is_object())
    throw scene::bad_input(source +
                           ": is not a colour map; a map is an object with RGBPoints, or a list of such objects");
  const MapReader reader(map, source);

  std::vector<std::string> remarks;
  if (root.is_array() && root.size() > 1) remarks.push_back(fmt::format("first of {} maps", root.size()));
  const std::string given_name = reader.text("Name", "");

  colormaps::TransferCurves curves;
  curves.colors = reader.colors();
  if (curves.colors.empty())
    throw reader.fault(reader.find("IndexedColors") != nullptr
                           ? "has only IndexedColors, the colours of categories; give a continuous map with RGBPoints"
                           : "has no RGBPoints; export the map from ParaView's colour map editor");
  if (const std::string remark = set_color_space(reader.text("ColorSpace", "RGB"), reader, curves); !remark.empty())
    remarks.push_back(remark);
  curves.opacities = reader.opacities();
  const bool has_opacities = !curves.opacities.empty();
  if (!has_opacities) remarks.emplace_back("no Points: default opacity ramp");

  sort_points(curves.colors);
  const std::array<double, 2> color_range = range_of(curves.colors);
  const bool preset_like = color_range == std::array{0.0, 1.0} || color_range == std::array{-1.0, 1.0};
  const bool off = !options.range && !options.rescale && options.rescale_presets && preset_like &&
                   colormaps::is_far_off(color_range, options.field_range);
  const bool stretches = options.rescale || options.range || off;
  const std::array<double, 2> spanned = stretches ? options.spanned() : color_range;
  std::vector<std::string> warnings;
  if (off)
    warnings.push_back(fmt::format(
        "the transfer function's range, {:g} to {:g}, would show almost nothing of the field's, {:.6g} to {:.6g}: the "
        "function is used like a preset and stretched over the field's range; `range` sets another range",
        color_range[0], color_range[1], options.field_range[0], options.field_range[1]));
  if (stretches) {
    remarks.push_back(fmt::format("rescaled to {:.6g} to {:.6g}", spanned[0], spanned[1]));
    stretch(curves.colors, color_range, spanned, [&] {
      const auto [a, b, t] = round_middle(curves.colors);
      return colormaps::ColorPoint{0, colormaps::mix_colors(a.color, b.color, t, curves.space, curves.hue_wraps)};
    });
  } else if (options.field_range[1] < color_range[0] || options.field_range[0] > color_range[1]) {
    remarks.push_back(
        fmt::format("the field's range, {:.6g} to {:.6g}, is outside the transfer function's range, {:.6g} to {:.6g}: "
                    "`rescale` stretches the transfer function",
                    options.field_range[0], options.field_range[1], color_range[0], color_range[1]));
  }
  if (!has_opacities) curves.opacities = colormaps::opacity_ramp();
  sort_points(curves.opacities);
  if (!options.opacity_points.empty())
    curves.opacities = colormaps::points_over(options.opacity_points, spanned[0], spanned[1]);
  else if (stretches || !has_opacities)
    stretch(curves.opacities, range_of(curves.opacities), spanned, [&] {
      const auto [a, b, t] = round_middle(curves.opacities);
      return colormaps::OpacityPoint{0, colormaps::mix_opacities(a, b, t)};
    });

  colormaps::LoadedTransferFunction loaded;
  const double distance = unit_distance(reader, options, loaded.unit_distance_source);
  loaded.unit_distance = distance;
  loaded.warnings = std::move(warnings);
  if (options.range) loaded.range = options.range;
  loaded.name = given_name.empty() ? source : source + " " + quote(given_name);
  if (!remarks.empty()) loaded.name += fmt::format(" ({})", fmt::join(remarks, "; "));
  try {
    loaded.function = scene::TransferFunction(colormaps::refined_knots(
        curves,
        {.unit_distance = distance, .opacity_scale = options.opacity_scale, .display_colors = options.display_colors}));
  } catch (const scene::Error& error) {
    throw scene::Error(error.code(), source + ": " + error.what());
  }
  return loaded;
}

}  // namespace tessera::io
