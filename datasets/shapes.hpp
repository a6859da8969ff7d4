// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "scene/tet_mesh.hpp"

/// Meshes with special shapes: curved, with holes, in several parts. The conventions are those of boxes.hpp.
namespace tessera::datasets {

/// Returns one tet with corners (0,0,0), (1,0,0), (0,1,0), (0,0,1) and scalars 0, 1/3, 2/3, 1.
scene::TetMesh single_tet();

/// Returns the unit ball: an octahedron cut into eight tets, divided 1:8 `levels` times (0 to 7) and projected to the
/// sphere. It has 8^(levels + 1) tets.
scene::TetMesh ball(int levels);

/// Returns a thick ring around the z axis, with radii 0.5 and 1 and height 0.5: not convex, genus 1. It has n hexahedra
/// around the axis (>= 8), and n / 8 through the thickness and the height. With `seam`, the cells that close the ring
/// have their own vertices, which coincide with the first ones, as in curvilinear grids wrapped around a body.
scene::TetMesh annulus(int n, bool seam = false);

/// Returns `count` (1 to 20) concentric spherical shells separated by empty space, the outermost of radius 1: nested
/// components. Each shell is `layers` prisms deep on an octahedron divided `levels` times: 24 * 4^levels * layers tets.
scene::TetMesh shells(int count = 4, int levels = 3, int layers = 2);

/// Returns three long bars, each in front of the next and the last in front of the first: no order of whole bars is
/// correct, only an order per ray. Each bar is n x 1 x 1 hexahedra.
scene::TetMesh cyclic_bars(int n = 16);

}  // namespace tessera::datasets
