// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cells/amr/amr_vertices.hpp"
#include "cells/cell_block.hpp"

namespace tessera::cells {

/// A cube of the lattice.
struct AmrCube {
  AmrIndex low;
  std::int32_t size;
};

/// Cubes that fill a part of space, with values at their corners.
///
/// Holds   cubes of a lattice that lie side by side as the leaves of a tree do: one that touches finer cubes along a
///         face touches there a grid of n x n, each of which may again be divided.
struct AmrCubes {
  AmrVertices corners;  ///< of all cubes
  std::vector<AmrCube> cubes;
  std::vector<double> values;  ///< of each corner, or of each cube

  /// What cubes of a size are divided into where they are, by size.
  std::vector<std::pair<std::int32_t, std::int32_t>> finer;
};

/// Cubes with one value each, as voxels. `steps` of `cubes` are one of `lattice`.
CellBlock voxels_of(const AmrLattice& lattice, int steps, AmrCubes cubes, const std::string& field);

/// Cubes with values at their corners, as voxels and, where a finer cube's corners lie on a cube's edges or faces, as
/// tets that meet them: a cone from the cube's centre over its faces, which are divided as the other side's are. A face
/// without corners on its edges is cut as split_cell() cuts it, another is a fan from its centre. Centres have the mean
/// of the corners. The field is continuous, and linear where the values are.
///
/// Source  Cones over subdivided faces: Weber et al., "Crack-free isosurface extraction from adaptive mesh refinement
///         data" (Hierarchical and Geometrical Methods in Scientific Visualization, 2003) stitch a dual mesh; here the
///         cubes themselves are divided, for which levels may differ by any number.
CellBlock conforming_cells(const AmrLattice& lattice, int steps, AmrCubes cubes, const std::string& field);

}  // namespace tessera::cells
