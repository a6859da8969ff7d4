// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "scene/tet_mesh.hpp"

/// Meshes whose shape is the point: curved, with holes, in several parts. Conventions as in boxes.hpp.
namespace tessera::datasets {

/// One tet with corners (0,0,0), (1,0,0), (0,1,0), (0,0,1) and scalars 0, 1/3, 2/3, 1.
scene::TetMesh single_tet();

/// The unit ball: an octahedron cut into eight tets, divided 1:8 `levels` times (0 to 7) and pushed out to the sphere.
/// 8^(levels + 1) tets.
scene::TetMesh ball(int levels);

/// A thick ring round the z axis, radii 0.5 and 1, height 0.5: not convex, genus 1. n hexahedra round it (>= 8), n / 8
/// through the thickness and the height. With `seam`, the closing cells have vertices of their own that coincide with
/// the first ones, as in curvilinear grids wrapped round a body.
scene::TetMesh annulus(int n, bool seam = false);

/// `count` (1 to 20) concentric spherical shells with empty space between, the outermost of radius 1: components inside
/// one another. Each is `layers` prisms deep on an octahedron divided `levels` times: 24 * 4^levels * layers tets.
scene::TetMesh shells(int count = 4, int levels = 3, int layers = 2);

/// Three long bars, each in front of the next and the last in front of the first: no order of whole bars is right, an
/// order per ray is. Each is n x 1 x 1 hexahedra.
scene::TetMesh cyclic_bars(int n = 16);

}  // namespace tessera::datasets
