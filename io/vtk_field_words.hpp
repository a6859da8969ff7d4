#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tessera::io {

/// The strings of a VTK XML file's field data, by name, where they are written as text (the codes of their letters)
/// within its first 64 KiB, as write_volume() does. Others are left out; never an error.
std::vector<std::pair<std::string, std::string>> vtk_field_words(const std::filesystem::path& file);

/// The number `TimeValue` of a VTK XML file's field data, as VTK writes it, in the same bytes; never an error.
std::optional<double> vtk_time_value(const std::filesystem::path& file);

}  // namespace tessera::io
