// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/mesh/plot3d_layout.hpp"

namespace tessera::io {

/// PLOT3D as text: the same numbers as in binary files, separated by blanks. All numbers are checked, because VTK's
/// reader would replace an invalid number by the number before it. Both functions throw Error(bad_input) with the line
/// at fault.

/// Returns the layout whose count of numbers matches the text; no value if there is none.
std::optional<Plot3dLayout> plot3d_text_layout(std::string_view text, const std::string& source);

/// Throws unless a solution has the layout's dimensions and at least 4 + 5 n numbers per grid. Returns how many further
/// numbers the text contains.
std::uint64_t check_plot3d_text_solution(std::string_view text, const Plot3dLayout& layout, const std::string& source);

}  // namespace tessera::io
