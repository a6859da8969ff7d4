// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scene/tet_mesh.hpp"
#include "system/positional_file.hpp"

namespace tessera::io {

/// The bytes of a `.tets` file, accessed by position: in a file or in memory.
struct TetsBytes {
  explicit TetsBytes(std::span<const std::byte> bytes);
  explicit TetsBytes(const system::PositionalFile& file);

  std::uint64_t size = 0;
  /// Copies `count` bytes starting at byte `at`. Throws like PositionalFile.
  std::function<void(std::uint64_t at, std::byte* to, std::uint64_t count)> copy;
};

/// The header of a file; it agrees with the file's size.
struct TetsHeader {
  std::uint64_t vertices = 0, tets = 0;
};

/// Throws Error(bad_input, "SOURCE: ...") if the header does not match the available bytes.
TetsHeader tets_header(const TetsBytes& file, const std::string& source);

/// Values of vertices [first, first + out.size()).
void read_scalars(const TetsBytes& file, const TetsHeader& header, std::uint64_t first, std::span<double> out);

/// Parses the `.tets` format: raw little endian int64 nverts, int64 ntets, float32 xyz[3 nverts], float32
/// scalar[nverts], int32 tets[4 ntets], and nothing after that.
///
/// The sizes are checked against the bytes present before anything is allocated, every index against nverts. Numbers
/// may be NaN: the caller handles blanking. Throws Error(bad_input, "SOURCE: ...").
scene::TetMesh parse_tets(const TetsBytes& file, const std::string& source);

/// A contiguous range of a file's tets.
struct TetsRange {
  scene::TetMesh mesh;                     ///< contains only the vertices that these tets use
  std::vector<std::uint32_t> file_vertex;  ///< their indices in the file, ascending
};

/// Reads tets [first, last) of the file and little more than their vertices. Throws like parse_tets.
TetsRange parse_tets_range(const TetsBytes& file, std::uint64_t first, std::uint64_t last, const std::string& source);

}  // namespace tessera::io
