// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cells/cell_block.hpp"
#include "scene/tet_mesh.hpp"
#include "support/temporary_folder.hpp"

/// Measurements and files for the mesh tests.
namespace tessera::io::testing {

using Point = std::array<double, 3>;
using TrianglePlace = std::array<Point, 3>;

/// The number of tets of each triangle, identified by position, not by index.
std::vector<std::pair<TrianglePlace, int>> count_triangles(const scene::TetMesh& mesh);

inline double volume(const scene::TetMesh& mesh) {
  double sum = 0;
  for (const scene::Tet& t : mesh.tets) {
    const glm::dvec3 a = mesh.positions[t[0]];
    sum += std::abs(glm::dot(glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a), mesh.positions[t[3]] - a));
  }
  return sum / 6;
}

/// The one-line message of the error thrown by `work`; "" if it throws none.
template <class Work>
std::string message_of(const Work& work) {
  return test::fault_of(work).message;
}

/// A block as the text of a .vtu file.
std::string vtu_text(const cells::CellBlock& block);

/// The text of a .pvtu file over pieces with the fields of `block`.
std::string pvtu_text(const cells::CellBlock& block, const std::vector<std::string>& pieces);

/// [0, 1]^3 as n^3 cubes, inner points moved at random: columns along z of wedges or of hexahedra, voxels and fans of
/// six pyramids, every cell numbered from a random corner and with either handedness. The point field "f" is x + 2 y +
/// 3 z. With `own_points` each cell has its own points, so that only positions reveal that cells touch.
cells::CellBlock mixed_mesh(int n, unsigned seed, bool own_points);

}  // namespace tessera::io::testing
