// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "cells/curved/curved_lattice.hpp"
#include "io/mesh/mesh_reader.hpp"

/// Curved cells as described in formats' manuals, with their exact volumes and integrals.
namespace tessera::io::testing {

/// The complete polynomials in (r, s, t) of its functions.
enum class CellSpace : std::uint8_t { linear, quadratic_in_r_s, quadratic };

/// One type of cell. Its corners go around the base and then around the top. The other nodes follow: each is in the
/// middle of the corners in an element of `middles` (numbered from 1 as in manuals).
struct ReferenceCell {
  std::string name;
  cells::CurvedFamily shape;
  std::vector<std::vector<int>> middles;
  CellSpace space = CellSpace::quadratic;
};

/// A bent cell, with the field "f" at its nodes.
struct BentCell {
  std::vector<glm::dvec3> positions;
  std::vector<double> values;
  double volume, integral;  ///< exact; the integral is of the field over the cell
};

/// Position and field are polynomials of (r, s, t) that the cell's functions contain. `mirrored`: corners go around the
/// base in the other direction.
BentCell bend(const ReferenceCell& cell, bool mirrored = false);

/// Lists of corners whose mean is the place of a third-order node. The node is at a third of the distance from the
/// first corner to the second; inside a quadrilateral (with corners in order around it), nearest to the first corner;
/// or inside a hexahedron, nearest to a corner.
std::vector<int> a_third(int from, int to);
std::vector<int> near_first(const std::array<int, 4>& quadrilateral);
std::vector<int> near_corner_of_hexahedron(int corner);

/// The same with nodes at places in (r, s, t).
BentCell bend_places(cells::CurvedFamily shape, CellSpace space, const std::vector<glm::dvec3>& places);

/// The places of the nodes in (r, s, t) before bending.
std::vector<glm::dvec3> places_of(const ReferenceCell& cell);

/// For the tets that were read: the integral of the field, which is linear in each.
double field_integral(const scene::TetMesh& mesh);

/// For a field "f": cells divided to 4e-4 of their size, which is fast.
ReadOptions coarse_options();

/// Expects the volume and the integral of `count` such cells, and that none is drawn by its corners.
void expect_same(const cells::MeshFile& read, const BentCell& cell, double count = 1);

}  // namespace tessera::io::testing
