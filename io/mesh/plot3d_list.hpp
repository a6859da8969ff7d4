// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace tessera::io {

/// One time of a list of PLOT3D files.
struct Plot3dStep {
  double time = 0;                       ///< its place in the list where none is given
  std::filesystem::path grid, solution;  ///< solution: empty if none is named
  bool has_functions = false;            ///< a file of functions, which is not read
};

/// The text of ParaView's list of PLOT3D files (.p3d), {"filenames": [{"time", "xyz", "q", "function"}, ...]}, in the
/// order of time; names are against the folder of `input`. What it says of the files' layout is left aside: that is
/// found from the files. Throws Error(bad_input).
std::vector<Plot3dStep> parse_plot3d_list(std::string_view text, const std::filesystem::path& input);

}  // namespace tessera::io
