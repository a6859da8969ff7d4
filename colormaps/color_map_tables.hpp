// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string_view>

#include "colormaps/color_spaces.hpp"

namespace tessera::colormaps {

/// Colours of a preset: display values at equal distances from the low to the high end, and the colour space that
/// interpolates them.
struct ColorMapTable {
  std::string_view name;
  ColorSpace space;
  std::span<const glm::dvec3> colors;
};

/// All tables, the default first. The sources are cited at the numbers.
std::span<const ColorMapTable> color_map_tables();

}  // namespace tessera::colormaps
