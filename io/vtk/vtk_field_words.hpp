// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tessera::io {

/// The strings of a VTK XML file's field data, by name, where they are written as text (the codes of their letters)
/// within its first 64 KiB, as write_volume() does. Others are left out; never an error.
std::vector<std::pair<std::string, std::string>> vtk_field_words(std::string_view beginning);

/// The time that a VTK file's field data state: `TimeValue`, in legacy files `TIME` too, as VTK and VisIt write them,
/// in the same bytes; of a list of pieces that of the list, else of its first piece. Nothing of other files; never an
/// error.
std::optional<double> vtk_time_value(const std::filesystem::path& file, std::string_view beginning);
std::optional<double> vtk_time_value(const std::filesystem::path& file);

}  // namespace tessera::io
