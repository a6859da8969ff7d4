// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string_view>

#include "colormaps/color_spaces.hpp"

namespace tessera::colormaps {

/// The colours of a preset: display values at equal distances from the low to the high end, and the colour space in
/// which they are interpolated.
struct ColorMapTable {
  std::string_view name;
  ColorSpace space;
  std::span<const glm::dvec3> colors;
};

/// Returns all tables, the default first. Comments at the numbers cite the sources.
std::span<const ColorMapTable> color_map_tables();

}  // namespace tessera::colormaps
