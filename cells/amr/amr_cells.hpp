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

/// Cubes that fill a part of space, with values at their corners or in the cubes.
///
/// Invariant  the cubes belong to a lattice and are adjacent like the leaves of a tree: where a cube has
///            finer neighbours at a face, n x n of them cover the face; each may be divided further.
struct AmrCubes {
  AmrVertices corners;  ///< corners of all cubes
  std::vector<AmrCube> cubes;
  std::vector<double> values;  ///< one value per corner, or per cube

  /// For each size of cubes that have finer neighbours, the size of these neighbours.
  std::vector<std::pair<std::int32_t, std::int32_t>> finer;
};

/// Converts cubes with one value each to voxels. `steps` steps of the cubes' lattice are one step of `lattice`.
CellBlock voxels_of(const AmrLattice& lattice, int steps, AmrCubes cubes, const std::string& field);

/// Converts cubes with values at their corners. A cube becomes a voxel, unless corners of finer cubes are on its edges
/// or faces. In that case it becomes tets that conform to the finer cubes: a cone from the cube's centre over its
/// faces, which are divided like the faces on the other side. A face without corners on its edges is cut as in
/// split_cell(); any other face becomes a fan around its centre. The value at a centre is the mean of the values at the
/// corners. The resulting field is continuous, and linear if the values are linear.
///
/// Source  Cones over subdivided faces: Weber et al., "Crack-free isosurface extraction from adaptive mesh refinement
///         data" (Hierarchical and Geometrical Methods in Scientific Visualization, 2003) stitch a dual mesh; here the
///         cubes themselves are divided, so levels may differ by any number.
CellBlock conforming_cells(const AmrLattice& lattice, int steps, AmrCubes cubes, const std::string& field);

}  // namespace tessera::cells
