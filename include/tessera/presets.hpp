// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/export.hpp"
#include "tessera/transfer_function.hpp"

namespace tessera {
inline namespace v0_1 {

/// Returns the transfer function of a preset, whose name is COLOURS or COLOURS:OPACITY (preset_names(),
/// preset_opacity_names()). The function is defined for values from 0 to 1; its opacities apply to a unit distance of
/// 1. Throws Error(bad_input), which lists the known names, for an unknown name.
TESSERA_EXPORT TransferFunction preset_function(std::string_view name);

/// Returns `count` colours of a preset (preset_names()), evenly spaced from its low end to its high end, as display
/// (sRGB) values from 0 to 1. Throws the same errors as preset_function(), and Error(bad_input) if `count` is less than
/// two.
TESSERA_EXPORT std::vector<glm::dvec3> preset_colors(std::string_view name, std::size_t count);

/// The possible values of OPACITY in a preset's name, the default first.
TESSERA_EXPORT std::vector<std::string> preset_opacity_names();

}  // namespace v0_1
}  // namespace tessera
