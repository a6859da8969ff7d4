// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "reference/suspicion.hpp"
#include "scene/camera.hpp"

namespace tessera::reference {

/// Largest distance in pixels between a line of sight and an edge that counts as a tie. Within this distance an image
/// may show either side of the edge (judge.hpp).
inline constexpr double tying_distance = 1.0 / 1024;

/// Converts a distance to an edge to a score: one at distance zero, one half at a millionth of a pixel.
float nearness(double pixels);

/// Raises tie scores along an edge. The score of a pixel whose centre is within the tying distance of the edge becomes
/// at least nearness() times the image's contrast at the pixel (`edge`, plus a millionth). The ends of the edge are
/// homogeneous pixel coordinates (view.hpp); parts behind the eye are cut off.
void raise_ties(const glm::dvec3& a, const glm::dvec3& b, scene::ImageSize size, const SuspicionMap& edge,
                SuspicionMap& tie);

}  // namespace tessera::reference
