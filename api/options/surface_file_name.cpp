// SPDX-License-Identifier: BSD-3-Clause
#include "api/options/surface_file_name.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace tessera::api {

bool names_surface_file(const std::string& name) {
  constexpr std::array<std::string_view, 7> extensions = {".ply", ".stl", ".vtp", ".vtk", ".poly", ".smesh", ".obj"};
  std::error_code unknown;
  return name.empty() || std::ranges::any_of(extensions, [&](std::string_view e) { return name.ends_with(e); }) ||
         std::filesystem::is_regular_file(name, unknown);
}

}  // namespace tessera::api
