// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tessera::test {

/// Samples of a volume that has several blocks along each axis.
constexpr std::int16_t nx = 70, ny = 65, nz = 130;
constexpr std::size_t samples = std::size_t{nx} * ny * nz;

/// So many bytes, of which a part can be packed away.
std::string noise(std::size_t bytes);

/// Along each axis of a rectilinear grid, and how they are stored.
struct AxesCase {
  std::string type;
  std::array<std::vector<double>, 3> values;
  bool text = false;   ///< else as the samples are
  bool first = false;  ///< before the samples
};

/// A .vti, or .vtr if it has axes, of one array, packed in every way that writers have.
struct VtkCase {
  bool appended, base64, compressed, wide_numbers, big_endian;
  std::string type = "UInt16";
  int components = 1;
  bool of_cells = false;
  bool split_text = false;  ///< base64: the number's and the bytes' text each with its own padding
  std::optional<AxesCase> axes{};
};

/// A file of nx * ny * nz samples, of points or of cells.
std::string vtk_file(const VtkCase& c, const std::string& bytes);

/// Coordinates of all axes, uneven by `bent`, of so many more points than there are samples.
AxesCase axes_of(const std::string& type, double bent, std::array<bool, 3> falls = {}, int more = 0);

}  // namespace tessera::test
