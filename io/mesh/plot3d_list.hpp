// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace tessera::io {

/// One time step of a list of PLOT3D files.
struct Plot3dStep {
  double time = 0;                       ///< its index in the list if no time is given
  std::filesystem::path grid, solution;  ///< solution: empty if not named
  bool has_functions = false;            ///< it also names a file of functions, which is not read
};

/// Parses ParaView's list of PLOT3D files (.p3d), {"filenames": [{"time", "xyz", "q", "function"}, ...]}, and sorts it
/// by time; names are relative to the directory of `input`. Ignores its statements about the files' layout, which is
/// deduced from the files. Throws Error(bad_input).
std::vector<Plot3dStep> parse_plot3d_list(std::string_view text, const std::filesystem::path& input);

}  // namespace tessera::io
