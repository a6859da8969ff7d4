// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "cells/curved/curved_lattice.hpp"
#include "io/mesh/mesh_reader.hpp"

/// Curved cells as formats' manuals describe them, with their exact volumes and integrals.
namespace tessera::io::testing {

/// What its functions have all of, in (r, s, t).
enum class CellSpace : std::uint8_t { linear, quadratic_in_r_s, quadratic };

/// One type of cell. After its corners, which go round the base and then round the top, come nodes in the middles of
/// the corners that a list names, counted from 1 as manuals do.
struct ReferenceCell {
  std::string name;
  cells::CurvedFamily shape;
  std::vector<std::vector<int>> middles;
  CellSpace space = CellSpace::quadratic;
};

/// A cell that is bent, with the field "f" at its nodes.
struct BentCell {
  std::vector<glm::dvec3> positions;
  std::vector<double> values;
  double volume, integral;  ///< exact; the integral is of the field over the cell
};

/// Position and field are polynomials of (r, s, t) that the cell's functions have. `mirrored`: corners go round the
/// base the other way.
BentCell bend(const ReferenceCell& cell, bool mirrored = false);

/// Lists of corners for nodes of third order: a third of the way from the first corner to the second; nearest to the
/// first corner inside a quadrilateral, whose corners go round it; nearest to a corner inside a hexahedron.
std::vector<int> a_third(int from, int to);
std::vector<int> near_first(const std::array<int, 4>& quadrilateral);
std::vector<int> near_corner_of_hexahedron(int corner);

/// The same of nodes at places in (r, s, t).
BentCell bend_places(cells::CurvedFamily shape, CellSpace space, const std::vector<glm::dvec3>& places);

/// Where the nodes are in (r, s, t) before it is bent.
std::vector<glm::dvec3> places_of(const ReferenceCell& cell);

/// Of the tets that were read: the sum of a field that is linear in each.
double field_integral(const scene::TetMesh& mesh);

/// Of a field "f": cells divided to 4e-4 of their size, which is quick.
ReadOptions coarse_options();

/// That what was read has the volume and the integral, of a number of such cells, and that none is drawn by its
/// corners.
void expect_same(const cells::MeshFile& read, const BentCell& cell, double count = 1);

}  // namespace tessera::io::testing
