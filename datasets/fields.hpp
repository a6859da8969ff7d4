// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>

#include "scene/tet_mesh.hpp"

namespace tessera::datasets {

/// The field that most generators sample, intended for [-1, 1]^3: 0.5 + 0.25 sin 5x cos(4y + z) + 0.25 cos(6 |p|),
/// clipped to [0, 1]. It has ripples around the origin, and is smooth and not linear.
double smooth_field(const glm::dvec3& p);

/// Assigns every vertex smooth_field of its position, as point data "f".
void sample_smooth_field(scene::TetMesh& mesh);

}  // namespace tessera::datasets
