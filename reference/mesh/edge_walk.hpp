// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "reference/suspicion.hpp"
#include "scene/camera.hpp"

namespace tessera::reference {

/// Distance of a line of sight to an edge that counts as a tie, pixels: a picture may show either side within it
/// (judge.hpp).
inline constexpr double tying_distance = 1.0 / 1024;

/// Of a distance to an edge: one where it is zero, half at a millionth of a pixel.
float nearness(double pixels);

/// Raises the tie score of the pixels whose centres lie within the tying distance of an edge, to nearness times what
/// the picture shows there (`edge`, plus a millionth). The ends are homogeneous pixel coordinates (view.hpp); what lies
/// behind the eye is cut off.
void raise_ties(const glm::dvec3& a, const glm::dvec3& b, scene::ImageSize size, const SuspicionMap& edge,
                SuspicionMap& tie);

}  // namespace tessera::reference
