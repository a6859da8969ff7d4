// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/camera.hpp"
#include "tessera/image.hpp"

namespace tessera::scene {

using tessera::Image;

}  // namespace tessera::scene
