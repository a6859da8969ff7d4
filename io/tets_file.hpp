#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "scene/tet_mesh.hpp"

namespace tessera::io {

/// Where the arrays of a `.tets` file lie in its bytes.
struct TetsLayout {
  std::uint64_t vertices = 0, tets = 0;
  const std::byte *xyz = nullptr, *scalar = nullptr, *corners = nullptr;

  [[nodiscard]] glm::dvec3 position(std::uint64_t vertex) const;
  [[nodiscard]] double scalar_of(std::uint64_t vertex) const;
  /// Throws Error(bad_input, "SOURCE: ...") if a corner is no vertex.
  [[nodiscard]] scene::Tet tet(std::uint64_t tet, const std::string& source) const;
};

/// Checks the header against the bytes that are there, and touches nothing else. Throws Error(bad_input, "SOURCE:
/// ...").
TetsLayout tets_layout(std::span<const std::byte> bytes, const std::string& source);

/// Parses the `.tets` format: raw little endian int64 nverts, int64 ntets, float32 xyz[3 nverts], float32
/// scalar[nverts], int32 tets[4 ntets], and nothing after that.
///
/// The sizes are checked against the bytes present before anything is allocated, every index against nverts. Numbers
/// may be NaN: blanking is the caller's. Throws Error(bad_input, "SOURCE: ...").
scene::TetMesh parse_tets(std::span<const std::byte> bytes, const std::string& source);

/// A contiguous range of a file's tets.
struct TetsRange {
  scene::TetMesh mesh;                     ///< with the vertices that these tets use only
  std::vector<std::uint32_t> file_vertex;  ///< index in the file of each of them, ascending
};

/// Tets [first, last) of the file; only these and their vertices are touched. Throws as parse_tets.
TetsRange parse_tets_range(const TetsLayout& file, std::uint64_t first, std::uint64_t last, const std::string& source);

}  // namespace tessera::io
