// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace tessera::io {

/// One time step of a list of PLOT3D files.
struct Plot3dStep {
  double time = 0;                       ///< if the list does not contain the time: the index of the step
  std::filesystem::path grid, solution;  ///< `solution` is empty if the list does not name one
  bool has_functions = false;            ///< the step also names a file of functions, which is not read
};

/// Parses ParaView's list of PLOT3D files (.p3d), {"filenames": [{"time", "xyz", "q", "function"}, ...]}, and sorts the
/// steps by time. Names of files are relative to the directory of `input`. What the list states about the layout of the
/// files is ignored, because the layout is deduced from the files. Throws Error(bad_input).
std::vector<Plot3dStep> parse_plot3d_list(std::string_view text, const std::filesystem::path& input);

}  // namespace tessera::io
