// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include "cells/cell_block.hpp"

/// Meshes of polyhedra that fill the unit box.
namespace tessera::io::testing {

using Faces = std::vector<std::vector<std::uint32_t>>;

/// A block of polyhedra: each cell's faces begin at a random corner and have a random direction, unless `outward` keeps
/// it. The point field "f" is x + 2 y + 3 z, the cell field "c" the number of the cell.
cells::CellBlock polyhedra_of(std::vector<glm::dvec3> points, const std::vector<Faces>& cells, std::mt19937& random,
                              bool outward = false);

/// The faces of each cell of a block of polyhedra.
std::vector<Faces> faces_of_cells(const cells::CellBlock& block);

/// The same cells, hexahedra, wedges, pyramids, voxels and tets, as polyhedra.
cells::CellBlock as_polyhedra(const cells::CellBlock& block, std::mt19937& random);

/// The Voronoi cells of `sites` random points, convex up to rounding.
cells::CellBlock voronoi_mesh(int sites, unsigned seed);

/// Cubes of an n x n x n lattice whose inner points are moved at random by up to `jitter` of an edge, merged into cells
/// of up to `largest`, of any shape: their faces are the cubes', and warped. `cell_of_cube`, if given, receives the
/// cell of each cube, x fastest.
cells::CellBlock agglomerates(int n, int largest, double jitter, unsigned seed,
                              std::vector<std::size_t>* cell_of_cube = nullptr);

/// Columns of layers over a plane map of squares with randomly moved corners, merged into groups of up to four: L, S, T
/// and square shapes, whose ends are polygons that may be concave.
cells::CellBlock polyominoes(int n, int layers, unsigned seed);

}  // namespace tessera::io::testing
