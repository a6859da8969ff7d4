// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/netcdf/netcdf_axes.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <sstream>
#include <string_view>

#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

std::string lower(std::string_view text) { return lower_case(text.substr(0, text.find_last_not_of(ascii_blanks) + 1)); }

bool is_one_of(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

bool contains(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

bool is_pressure(std::string_view units) {
  return is_one_of(units, {"pa",   "hpa",     "kpa",      "pascal",   "pascals",    "hectopascal", "hectopascals",
                           "mb",   "mbar",    "mbars",    "millibar", "millibars",  "bar",         "bars",
                           "dbar", "decibar", "decibars", "atm",      "atmosphere", "atmospheres"});
}

/// Whether a name is that of a vertical coordinate without units that is largest at the ground.
bool is_sigma(std::string_view standard_name) {
  return is_one_of(standard_name, {"atmosphere_sigma_coordinate", "atmosphere_hybrid_sigma_pressure_coordinate"});
}

AxisRole role_of_axis(std::string_view axis) {
  if (axis == "x") return AxisRole::x;
  if (axis == "y") return AxisRole::y;
  if (axis == "z") return AxisRole::z;
  if (axis == "t") return AxisRole::time;
  return axis == "e" ? AxisRole::member : AxisRole::unknown;
}

AxisRole role_of_type(std::string_view type) {
  if (is_one_of(type, {"lon", "geox"})) return AxisRole::x;
  if (is_one_of(type, {"lat", "geoy"})) return AxisRole::y;
  if (is_one_of(type, {"height", "pressure", "geoz"})) return AxisRole::z;
  if (is_one_of(type, {"time", "runtime"})) return AxisRole::time;
  return type == "ensemble" ? AxisRole::member : AxisRole::unknown;
}

AxisRole role_of_standard_name(std::string_view name) {
  if (is_one_of(name, {"longitude", "grid_longitude", "projection_x_coordinate", "projection_x_angular_coordinate"}))
    return AxisRole::x;
  if (is_one_of(name, {"latitude", "grid_latitude", "projection_y_coordinate", "projection_y_angular_coordinate"}))
    return AxisRole::y;
  if (is_one_of(name, {"time", "forecast_reference_time", "forecast_period"})) return AxisRole::time;
  if (name == "realization") return AxisRole::member;
  const bool is_parametric = (name.starts_with("atmosphere_") || name.starts_with("ocean_")) &&
                             (name.ends_with("_coordinate") || contains(name, "_coordinate_"));
  if (is_parametric || name == "model_level_number" || contains(name, "height") || contains(name, "altitude") ||
      contains(name, "depth") || contains(name, "pressure"))
    return AxisRole::z;
  return AxisRole::unknown;
}

AxisRole role_of_units(const std::string& units) {
  if (is_one_of(units, {"degrees_east", "degree_east", "degrees_e", "degree_e", "degreese", "degreee"}))
    return AxisRole::x;
  if (is_one_of(units, {"degrees_north", "degree_north", "degrees_n", "degree_n", "degreesn", "degreen"}))
    return AxisRole::y;
  if (contains(units, " since ")) return AxisRole::time;
  return is_pressure(units) || is_one_of(units, {"level", "layer", "sigma_level"}) ? AxisRole::z : AxisRole::unknown;
}

AxisRole role_of_name(const std::string& name) {
  if (is_one_of(name, {"x", "xc", "i", "ni", "nx", "lon", "nlon", "rlon", "long", "longitude", "longitudes",
                       "west_east", "west_east_stag", "easting"}))
    return AxisRole::x;
  if (is_one_of(name, {"y", "yc", "j", "nj", "ny", "lat", "nlat", "rlat", "latitude", "latitudes", "south_north",
                       "south_north_stag", "northing"}))
    return AxisRole::y;
  if (is_one_of(name, {"z", "zc", "k", "nk", "nz", "lev", "ilev", "nlev", "level", "levels", "plev", "height",
                       "altitude", "alt", "elevation", "bottom_top", "bottom_top_stag", "isobaric", "pressure"}) ||
      name.starts_with("depth"))
    return AxisRole::z;
  if (name == "t" || name.starts_with("time") || name.ends_with("_time")) return AxisRole::time;
  if (is_one_of(name, {"member", "members", "ens", "ensemble", "realization", "realisation", "number"}))
    return AxisRole::member;
  return AxisRole::unknown;
}

struct Evidence {
  AxisRole role = AxisRole::unknown;
  int strength = 0;  ///< reliability of the role; 0 if only the name suggests it
};

Evidence evidence_of_attributes(const NetcdfFile& file, const NetcdfVariable& coordinate) {
  const auto word = [&](const char* attribute) { return lower(file.text(coordinate, attribute)); };
  const std::array<AxisRole, 5> roles = {role_of_axis(word("axis")), role_of_type(word("_CoordinateAxisType")),
                                         role_of_standard_name(word("standard_name")), role_of_units(word("units")),
                                         is_one_of(word("positive"), {"up", "down"}) ? AxisRole::z : AxisRole::unknown};
  for (std::size_t k = 0; k < roles.size(); ++k)
    if (roles[k] != AxisRole::unknown) return {roles[k], 6 - static_cast<int>(k)};
  return {};
}

}  // namespace

AxisRole role_of(const NetcdfFile& file, const NetcdfVariable& coordinate) {
  const AxisRole role = evidence_of_attributes(file, coordinate).role;
  return role != AxisRole::unknown ? role : role_of_name(lower(coordinate.name));
}

std::vector<const NetcdfVariable*> named_coordinates(const NetcdfFile& file, const NetcdfVariable& variable) {
  std::vector<const NetcdfVariable*> found;
  std::istringstream names(file.text(variable, "coordinates"));
  for (std::string name; names >> name;)
    if (const NetcdfVariable* const named = file.find(variable, name.substr(name.rfind('/') + 1)))
      found.push_back(named);
  return found;
}

const NetcdfVariable* coordinate_of(const NetcdfFile& file, const NetcdfVariable& variable,
                                    const NetcdfDimension& dimension) {
  const auto is_along = [&](const NetcdfVariable* candidate) {
    return candidate != nullptr && candidate->dimensions.size() == 1 && candidate->dimensions[0].id == dimension.id;
  };
  if (const NetcdfVariable* const own = file.find(variable, dimension.name); is_along(own)) return own;
  for (const NetcdfVariable* const named : named_coordinates(file, variable))
    if (is_along(named)) return named;
  return nullptr;
}

std::optional<AxisOrder> axes_of(const NetcdfFile& file, const NetcdfVariable& variable) {
  const std::size_t count = variable.dimensions.size();
  if (count < 3) return std::nullopt;
  std::vector<Evidence> evidence(count);
  for (std::size_t d = 0; d < count; ++d) {
    const NetcdfVariable* const coordinate = coordinate_of(file, variable, variable.dimensions[d]);
    if (coordinate != nullptr) evidence[d] = evidence_of_attributes(file, *coordinate);
    if (evidence[d].role == AxisRole::unknown) evidence[d] = {role_of_name(lower(variable.dimensions[d].name)), 1};
  }
  AxisOrder order;
  std::array<bool, 3> is_known{};
  std::vector<bool> is_used(count);
  for (const std::size_t axis : {0u, 1u, 2u}) {
    int strongest = 0;
    for (std::size_t d = 0; d < count; ++d)
      if (static_cast<std::size_t>(evidence[d].role) == axis && evidence[d].strength >= strongest)
        strongest = evidence[d].strength, order.along[axis] = d, is_known[axis] = true;
    if (is_known[axis]) is_used[order.along[axis]] = true;
  }
  for (const std::size_t axis : {0u, 1u, 2u}) {
    if (is_known[axis]) continue;
    std::size_t d = count;
    while (d > 0 &&
           (is_used[d - 1] || evidence[d - 1].role == AxisRole::time || evidence[d - 1].role == AxisRole::member))
      --d;
    if (d == 0) return std::nullopt;
    order.along[axis] = d - 1;
    is_used[d - 1] = true;
  }
  for (std::size_t d = 0; d < count; ++d)
    if (!is_used[d]) order.steps.push_back(d);
  return order;
}

bool counts_downwards(const NetcdfFile& file, const NetcdfVariable& coordinate) {
  const auto word = [&](const char* attribute) { return lower(file.text(coordinate, attribute)); };
  for (const char* const attribute : {"positive", "_CoordinateZisPositive"})
    if (const std::string positive = word(attribute); positive == "up" || positive == "down") return positive == "down";
  const std::string standard_name = word("standard_name"), units = word("units"), name = lower(coordinate.name);
  if (contains(standard_name, "ln_pressure")) return false;  // the quantity is minus the logarithm of pressure
  return is_pressure(units) || is_sigma(standard_name) || units == "sigma_level" ||
         word("_CoordinateAxisType") == "pressure" || contains(standard_name, "pressure") ||
         contains(standard_name, "depth") || name.starts_with("depth") ||
         (units.empty() && is_one_of(name, {"plev", "isobaric", "pressure"}));
}

}  // namespace tessera::readers
