// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/tet_mesh.hpp"

namespace tessera::datasets {

/// Appends the six tets around a hexahedron's main diagonal, positively oriented.
/// Corner b of `corners` is at (b & 1, b >> 1 & 1, b >> 2 & 1). Every face is cut along the diagonal from its lowest to
/// its highest corner, so that hexahedra with the same numbering agree on the faces they share.
/// Source: Kuhn, "Some combinatorial lemmas in topology", IBM Journal, 1960.
void append_kuhn(const std::array<std::uint32_t, 8>& corners, std::vector<scene::Tet>& tets);

/// Appends the three tets of a prism with triangles `low` and `high`, where low[i] is connected to high[i]. Prisms
/// agree on a shared quadrilateral, because the cut starts at the smaller index of `low`. The orientation of the tets
/// depends on the order of the indices; see `orient`.
void append_prism(std::array<std::uint32_t, 3> low, std::array<std::uint32_t, 3> high, std::vector<scene::Tet>& tets);

/// Vertices and tets of a structured block of nx x ny x nz hexahedra. Vertex (i, j, k) has index (i (ny + 1) + j) (nz +
/// 1) + k. With `wrap_x` the block is periodic: i = nx is the same as i = 0 and has no vertices of its own.
struct Lattice {
  std::uint32_t nx, ny, nz;
  bool wrap_x = false;

  [[nodiscard]] std::uint32_t columns() const { return wrap_x ? nx : nx + 1; }
  [[nodiscard]] std::uint64_t vertices() const { return std::uint64_t{columns()} * (ny + 1) * (nz + 1); }
  [[nodiscard]] std::uint32_t vertex(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
    return ((wrap_x && i == nx ? 0 : i) * (ny + 1) + j) * (nz + 1) + k;
  }
  /// Returns the block's tets, hexahedron by hexahedron, k fastest.
  [[nodiscard]] std::vector<scene::Tet> tets() const;
  /// Returns the corners of hexahedron (i, j, k) in append_kuhn's order.
  [[nodiscard]] std::array<std::uint32_t, 8> corners(std::uint32_t i, std::uint32_t j, std::uint32_t k) const;
};

/// Returns six times the signed volume of a tet.
double signed_volume_6(const scene::TetMesh& mesh, const scene::Tet& tet);

/// Swaps vertices so that every signed volume is positive; zero stays zero.
void orient(scene::TetMesh& mesh);

}  // namespace tessera::datasets
