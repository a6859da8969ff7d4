// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/camera.hpp"

namespace tessera::scene {

using tessera::Box;
using tessera::Camera;
using tessera::ClippingRange;
using tessera::frame_box;
using tessera::ImageSize;
using tessera::max_image_side;
using tessera::orbit;
using tessera::ProjectionKind;
using tessera::validate;
using tessera::view_basis;
using tessera::ViewBasis;

}  // namespace tessera::scene
