// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "scene/tet_mesh.hpp"

/// Meshes whose cells are split hexahedra in a box. All tets are positively oriented, faces match, and each tet is one
/// original cell. The data are point data unless stated otherwise. The same arguments give the same bits. A count out
/// of range throws Error(bad_input).
namespace tessera::datasets {

/// Returns [-1, 1]^3 as n^3 voxels of six tets with smooth_field. Inner vertices are moved by up to `jitter` voxels
/// along each axis (0 to 0.25: more may invert tets). Positions and scalars are float numbers, so that files that store
/// floats (.tets) describe the same mesh. n in [1, 1000].
scene::TetMesh cube(int n, double jitter = 0.2, std::uint64_t seed = 7);

/// Returns nx x ny x nz voxels of six tets at origin + (i, j, k) * spacing. The scalars are those of smooth_field if
/// the box is mapped to [-1, 1]^3. With dyadic origin and spacing all coordinates are exact, so a view along an axis
/// can put vertices exactly on pixel centres and rays exactly in faces.
scene::TetMesh regular_split(int nx, int ny, int nz, const glm::dvec3& spacing = glm::dvec3(0.25),
                             const glm::dvec3& origin = glm::dvec3(0));

/// Returns [-1, 1]^3 as n^3 voxels of six tets that shrink towards the origin in geometric progression, so that the
/// largest cell has about `volume_ratio` times the volume of the smallest (1 to 1e15). n must be even and at least 4.
scene::TetMesh graded(int n, double volume_ratio = 1e6);

/// Returns n x n x n voxels in [-1, 1]^3. The layers between voxels along z contain one sliver per voxel: a tet whose
/// four vertices are almost the corners of a square, `aspect` times wider than high (>= n * n, so that layers do not
/// cross). 6 n^3 + (n - 1) n^2 tets. This is the classic failure of Delaunay meshes, without flat faces or short edges.
scene::TetMesh slivers(int n, double aspect = 1e4);

/// Returns a stack of `layers` thin voxels (six tets each) with a square base of side `width`, `thickness` high in
/// total, centred on the z axis. The stack is in the middle of a plate of 8 x 8 shallow voxels over [-1, 1]^2, in a
/// hole that leaves a gap of a tenth of the base. Seen along z, a few pixels have all the depth complexity. The scalar
/// alternates from layer to layer, so that any wrong order is visible. Number of tets: 6 (layers + 60).
scene::TetMesh thin_stack(int layers = 20000, double width = 0.02, double thickness = 1);

}  // namespace tessera::datasets
