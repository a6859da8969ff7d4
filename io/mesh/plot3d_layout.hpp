// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace tessera::io {

/// How a PLOT3D file lies on disk; the format itself does not say.
struct Plot3dLayout {
  bool big_endian = true;
  bool record_marks = false;                       ///< Fortran: every record between two byte counts of 4 bytes
  bool multi_grid = false;                         ///< the number of grids comes first
  bool double_precision = false;                   ///< coordinates and solution of 8 bytes, not 4
  bool iblank = false;                             ///< an int32 a point after the coordinates
  std::vector<std::array<std::int32_t, 3>> grids;  ///< points along i, j, k
  bool is_text = false;                            ///< then of the rest multi_grid and iblank count
};

/// The only layout whose arithmetic gives the file's exact size (and whose record marks are right), or of a text how
/// many numbers it has. Reads a few bytes a grid, but texts whole. Throws Error(bad_input) if none does: the file is
/// truncated, two-dimensional, or no PLOT3D grid.
Plot3dLayout detect_plot3d(const std::filesystem::path& grid_file);

/// Throws Error(bad_input) unless the solution (Q) file has the grid's dimensions and at least 4 + 5 n numbers a grid.
/// Returns the bytes, of texts numbers, after them: some old files are padded to whole disk blocks.
std::uint64_t check_plot3d_solution(const std::filesystem::path& q_file, const Plot3dLayout& layout);

/// The solution file that goes with a grid by name: "postxyz.bin" -> "postq.bin", "fin.xyz" -> "fin.q" (also .x, .p3d).
/// Empty if there is no such file.
std::filesystem::path find_plot3d_solution(const std::filesystem::path& grid_file);

}  // namespace tessera::io
