// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "cells/curved/curved_lattice.hpp"

namespace tessera::cells {

/// A basis of a pyramid's functions, one per node; they are rational in (r, s, t).
///
/// 13 nodes  the serendipity hexahedron's with one face collapsed to a point, corrected to be quadratic on the
///           triangles (Felippa, "Advanced Finite Element Methods", University of Colorado, chapter on pyramids)
/// 19 nodes  VTK's: quadratic with a cubic bubble on triangles, biquadratic on the base
/// 18 nodes  the same without the last function, because there is no inner node
/// others    Lagrange's on the lattice: all polynomials of the order, and functions that complete them on the base
///           (Bergot, Cohen, Durufle, "Higher-order finite elements for hybrid meshes using new nodal pyramidal
///           elements", Journal of Scientific Computing 42, 2010)
void pyramid_functions(const CurvedLattice& lattice, const std::array<double, 3>& place, std::span<double> values);

/// Row m has the share of each node k in function m: the inverse of the functions' values at the nodes.
std::vector<double> pyramid_matrix(const CurvedLattice& lattice);

}  // namespace tessera::cells
