// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/camera.hpp"

namespace tessera::volume {

/// The view that follows `now` if the camera continues its motion from `before`: the focal point moves by the same
/// vector, the camera turns about it by the same rotation, and its distance, angle or scale change by the same factor.
/// Returns `now` if the projection changed or the view turned by more than 45 degrees, which is a jump rather than a
/// motion. Both cameras must be valid; so is the result.
scene::Camera next_view(const scene::Camera& before, const scene::Camera& now);

}  // namespace tessera::volume
