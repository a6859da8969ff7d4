// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "cells/cell_block.hpp"
#include "cells/curved/curved_lattice.hpp"

/// Meshes of higher-order cells for tests.
namespace tessera::io::testing {

struct Kind {
  std::uint8_t type;
  std::size_t nodes;
  int degree;  ///< degree of the complete polynomials in (r, s, t) that are reproduced from values at the nodes
  std::array<int, 3> degrees{};
};

/// One of each type that is divided, several of Lagrange's.
extern const std::vector<Kind> kinds;

using Field = std::function<double(const glm::dvec3&)>;
using Warp = std::function<glm::dvec3(const glm::dvec3&)>;

/// A node's place in its cell.
glm::dvec3 place_of(const cells::CurvedLattice& lattice, std::size_t node);

/// The unit cube as n^3 cubes of cells of one kind, then warped: field "f" at the nodes. With `turned`, each cell is
/// numbered from a random corner. Every cell has its own points, so that only positions reveal that cells touch.
cells::CellBlock warped_box(const Kind& kind, int n, const Warp& warp, const Field& field, bool turned);

glm::dvec3 bent(const glm::dvec3& p);

}  // namespace tessera::io::testing
