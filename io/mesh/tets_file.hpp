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

/// The header of a file, whose counts match the size of the file.
struct TetsHeader {
  std::uint64_t vertices = 0, tets = 0;
};

/// Throws Error(bad_input, "SOURCE: ...") if the header does not match the available bytes.
TetsHeader tets_header(const TetsBytes& file, const std::string& source);

/// Reads the values of vertices [first, first + out.size()).
void read_scalars(const TetsBytes& file, const TetsHeader& header, std::uint64_t first, std::span<double> out);

/// Parses the `.tets` format: raw little endian int64 nverts, int64 ntets, float32 xyz[3 nverts], float32
/// scalar[nverts], int32 tets[4 ntets], and nothing after that.
///
/// The sizes are compared with the available bytes before anything is allocated, and every index with nverts. Numbers
/// may be NaN, which the caller handles as blanks. Throws Error(bad_input, "SOURCE: ...").
scene::TetMesh parse_tets(const TetsBytes& file, const std::string& source);

/// A contiguous range of a file's tets.
struct TetsRange {
  scene::TetMesh mesh;                     ///< contains only the vertices that these tets use
  std::vector<std::uint32_t> file_vertex;  ///< the file's indices of the vertices of `mesh`, ascending
};

/// Reads tets [first, last) of the file, and little more than the vertices of these tets. Throws like parse_tets.
TetsRange parse_tets_range(const TetsBytes& file, std::uint64_t first, std::uint64_t last, const std::string& source);

}  // namespace tessera::io
