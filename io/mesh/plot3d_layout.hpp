// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace tessera::io {

/// The binary layout of a PLOT3D file, which the format does not record.
struct Plot3dLayout {
  bool big_endian = true;
  bool record_marks = false;                       ///< Fortran: every record is enclosed in two 4-byte counts
  bool multi_grid = false;                         ///< the number of grids comes first
  bool double_precision = false;                   ///< coordinates and solution have 8 bytes, not 4
  bool iblank = false;                             ///< the coordinates are followed by an int32 per point
  std::vector<std::array<std::int32_t, 3>> grids;  ///< points along i, j, k
  bool is_text = false;                            ///< then only multi_grid and iblank of the above apply
};

/// Finds the only layout whose size matches the file exactly (and whose record marks are right), or, for a text, its
/// number of values. Reads a few bytes per grid; reads texts completely. Throws Error(bad_input) if no layout matches:
/// the file is truncated, two-dimensional, or not a PLOT3D grid.
Plot3dLayout detect_plot3d(const std::filesystem::path& grid_file);

/// Throws Error(bad_input) unless the solution (Q) file has the grid's dimensions and at least 4 + 5 n numbers per
/// grid. Returns the number of bytes (for texts, numbers) after them: some old files are padded to whole disk blocks.
std::uint64_t check_plot3d_solution(const std::filesystem::path& q_file, const Plot3dLayout& layout);

/// The solution file that belongs to a grid, by name: "postxyz.bin" -> "postq.bin", "fin.xyz" -> "fin.q" (also .x,
/// .p3d). Empty if there is no such file.
std::filesystem::path find_plot3d_solution(const std::filesystem::path& grid_file);

}  // namespace tessera::io
