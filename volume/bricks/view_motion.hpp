// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/camera.hpp"

namespace tessera::volume {

/// Returns the view that follows `now` if the camera continues its motion from `before`: the focal point moves by the
/// same vector, the camera turns about the focal point by the same rotation, and the camera's distance, angle or scale
/// change by the same factor. Returns `now` if the projection changed or the view turned by more than 45 degrees, which
/// is a jump rather than a motion. Both cameras must be valid; the result is then valid, too.
scene::Camera next_view(const scene::Camera& before, const scene::Camera& now);

}  // namespace tessera::volume
