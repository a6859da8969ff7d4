// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "reference/suspicion.hpp"
#include "scene/camera.hpp"

namespace tessera::reference {

/// Distance in pixels of a line of sight to an edge that counts as a tie: within it an image may show either side
/// (judge.hpp).
inline constexpr double tying_distance = 1.0 / 1024;

/// Maps a distance to an edge to a score: one at distance zero, one half at a millionth of a pixel.
float nearness(double pixels);

/// Raises the tie score of the pixels whose centres are within the tying distance of an edge, to nearness times the
/// image's contrast there (`edge`, plus a millionth). The ends are homogeneous pixel coordinates (view.hpp); parts
/// behind the eye are cut off.
void raise_ties(const glm::dvec3& a, const glm::dvec3& b, scene::ImageSize size, const SuspicionMap& edge,
                SuspicionMap& tie);

}  // namespace tessera::reference
