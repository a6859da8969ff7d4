// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "cells/curved/curved_lattice.hpp"

namespace tessera::cells {

/// Evaluates a basis of a pyramid's functions, one per node; they are rational in (r, s, t).
///
/// 13 nodes  the serendipity hexahedron's functions with one face collapsed to a point, corrected to be quadratic
///           on the triangles (Felippa, "Advanced Finite Element Methods", University of Colorado, chapter on pyramids)
/// 19 nodes  VTK's functions: quadratic with a cubic bubble on triangles, biquadratic on the base
/// 18 nodes  as for 19 nodes without the last function, because there is no inner node
/// others    Lagrange's functions on the lattice: all polynomials of the order, and functions that complete them on the
///           base (Bergot, Cohen, Durufle, "Higher-order finite elements for hybrid meshes using new nodal pyramidal
///           elements", Journal of Scientific Computing 42, 2010)
void pyramid_functions(const CurvedLattice& lattice, const std::array<double, 3>& place, std::span<double> values);

/// Returns a matrix whose row m contains the coefficient of function m for a value of 1 at each node k: the inverse of
/// the matrix of the functions' values at the nodes.
std::vector<double> pyramid_matrix(const CurvedLattice& lattice);

}  // namespace tessera::cells
