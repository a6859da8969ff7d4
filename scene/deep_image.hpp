// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/camera.hpp"
#include "tessera/deep_image.hpp"

namespace tessera::scene {

using tessera::DeepImage;
using tessera::DeepImageSample;

}  // namespace tessera::scene
