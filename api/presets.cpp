// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/presets.hpp"

#include <glm/common.hpp>

#include "colormaps/presets.hpp"
#include "tessera/error.hpp"

namespace tessera {
inline namespace v0_1 {

TransferFunction preset_function(std::string_view name) { return colormaps::preset(name, {}).function; }

std::vector<std::string> preset_opacity_names() { return colormaps::preset_opacity_names(); }

std::vector<glm::dvec3> preset_colors(std::string_view name, std::size_t count) {
  if (count < 2) throw bad_input("preset: fewer than two colours do not show a range; request two or more");
  colormaps::TransferFunctionOptions options;
  options.display_colors = true;
  const TransferFunction function = colormaps::preset(name, options).function;
  std::vector<glm::dvec3> colors;
  for (std::size_t i = 0; i < count; ++i)
    colors.push_back(
        glm::clamp(function.evaluate(static_cast<double>(i) / static_cast<double>(count - 1)).color, 0.0, 1.0));
  return colors;
}

}  // namespace v0_1
}  // namespace tessera
