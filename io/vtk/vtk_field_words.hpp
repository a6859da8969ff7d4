// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tessera::io {

/// The strings of a VTK XML file's field data, by name, if they are stored as text (character codes) within its first
/// 64 KiB, as write_volume() does. Others are omitted; never an error.
std::vector<std::pair<std::string, std::string>> vtk_field_words(std::string_view beginning);

/// The time in a VTK file's field data: `TimeValue`, or in legacy files also `TIME`, as VTK and VisIt write it, within
/// the same bytes. For a list of pieces, the time of the list, else of its first piece. No value for other files; never
/// an error.
std::optional<double> vtk_time_value(const std::filesystem::path& file, std::string_view beginning);
std::optional<double> vtk_time_value(const std::filesystem::path& file);

}  // namespace tessera::io
