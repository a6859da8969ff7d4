// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tessera::test {

/// Numbers of samples of a volume that has several blocks along each axis.
constexpr std::int16_t nx = 70, ny = 65, nz = 130;
constexpr std::size_t samples = std::size_t{nx} * ny * nz;

/// Bytes that can partly be packed.
std::string noise(std::size_t bytes);

/// Coordinates along each axis of a rectilinear grid, and how they are stored.
struct AxesCase {
  std::string type;
  std::array<std::vector<double>, 3> values;
  bool text = false;   ///< false: like the samples
  bool first = false;  ///< before the samples
};

/// A .vti, or .vtr if it has axes, with one array, packed in every form that writers use.
struct VtkCase {
  bool appended, base64, compressed, wide_numbers, big_endian;
  std::string type = "UInt16";
  int components = 1;
  bool of_cells = false;
  bool split_text = false;  ///< base64: the number of bytes and the bytes are separate texts with separate padding
  std::optional<AxesCase> axes{};
};

/// A file of nx * ny * nz samples, at points or in cells.
std::string vtk_file(const VtkCase& c, const std::string& bytes);

/// Coordinates of all axes, made non-uniform by `bent`, with `more` more points than samples.
AxesCase axes_of(const std::string& type, double bent, std::array<bool, 3> falls = {}, int more = 0);

}  // namespace tessera::test
