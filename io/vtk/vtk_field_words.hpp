// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tessera::io {

/// Returns the strings in the field data of a VTK XML file, with their names, if they are stored as text (character
/// codes) within the first 64 KiB of the file, where write_volume() stores them. Other strings are omitted, without an
/// error.
std::vector<std::pair<std::string, std::string>> vtk_field_words(std::string_view beginning);

/// Returns the time in the field data of a VTK file: `TimeValue`, or in legacy files also `TIME`, which VTK and VisIt
/// write. `beginning` contains the first bytes of the file, in which the time is searched. For a list of pieces, it is
/// the time in the list or else in the first piece. No value for other files; never reports an error.
std::optional<double> vtk_time_value(const std::filesystem::path& file, std::string_view beginning);
std::optional<double> vtk_time_value(const std::filesystem::path& file);

}  // namespace tessera::io
