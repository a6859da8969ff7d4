// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/tet_mesh.hpp"

namespace tessera::datasets {

/// Returns a wake for demonstrations: vorticity magnitude behind a cylinder, in a curvilinear mesh wrapped around the
/// body and refined towards it. It is synthetic, not a simulation: shear layers leave the cylinder and roll up into a
/// street of alternating vortices with spiral arms and a wavy span (von Karman's street), and thin ribs connect each
/// vortex to the next.
///
/// The mesh fills the box [-2.5, 10.5] x [-3, 3] x [-1.5, 1.5], in cylinder diameters, without the cylinder of radius
/// 0.5 along z: it is not convex and has genus 1. The scalar "vorticity" is point data in [0, 1], near 0 in the free
/// stream. A `resolution` of 1 gives about 0.52 M tets; the number grows with the cube of the resolution, which must be
/// in [0.2, 4].
scene::TetMesh demo(double resolution = 1);

}  // namespace tessera::datasets
