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

/// The transfer function of this name, COLOURS or COLOURS:OPACITY (preset_names()), over the values from 0 to 1, per
/// unit distance 1. Throws Error(bad_input) for an unknown name, listing the known ones.
TESSERA_EXPORT TransferFunction preset_function(std::string_view name);

/// The colours of a name (preset_names()) at `count` evenly spaced places from the low end to the high end: display
/// (sRGB) values, 0 to 1. Throws as preset_function(), and Error(bad_input) for fewer than two.
TESSERA_EXPORT std::vector<glm::dvec3> preset_colors(std::string_view name, std::size_t count);

/// The values that OPACITY may have, the default first.
TESSERA_EXPORT std::vector<std::string> preset_opacity_names();

}  // namespace v0_1
}  // namespace tessera
