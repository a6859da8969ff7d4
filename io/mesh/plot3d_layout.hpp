// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace tessera::io {

/// The binary layout of a PLOT3D file, which the file does not describe.
struct Plot3dLayout {
  bool big_endian = true;
  bool record_marks = false;                       ///< Fortran's: two 4-byte counts enclose every record
  bool multi_grid = false;                         ///< the file begins with the number of grids
  bool double_precision = false;                   ///< coordinates and solution are numbers of 8 bytes instead of 4
  bool iblank = false;                             ///< an int32 per point follows the coordinates
  std::vector<std::array<std::int32_t, 3>> grids;  ///< number of points along i, j and k of each grid
  bool is_text = false;                            ///< the file is text; then only multi_grid and iblank apply
};

/// Finds the only layout whose size matches the file exactly and whose record marks are right; for a text, the only
/// layout that has as many values as the text. Reads a few bytes per grid, but reads texts completely. Throws
/// Error(bad_input) if no layout matches: the file is truncated, two-dimensional, or not a PLOT3D grid.
Plot3dLayout detect_plot3d(const std::filesystem::path& grid_file);

/// Throws Error(bad_input) unless the solution (Q) file has the grid's dimensions and at least 4 + 5 n numbers per
/// grid. Returns how many bytes (for texts, how many numbers) follow: some old files are padded to whole disk blocks.
std::uint64_t check_plot3d_solution(const std::filesystem::path& q_file, const Plot3dLayout& layout);

/// Returns the solution file that belongs to a grid according to its name: "postxyz.bin" -> "postq.bin", "fin.xyz" ->
/// "fin.q" (also .x, .p3d). Empty if there is no file with that name.
std::filesystem::path find_plot3d_solution(const std::filesystem::path& grid_file);

}  // namespace tessera::io
