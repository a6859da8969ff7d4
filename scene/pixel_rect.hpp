#pragma once

#include "tessera/pixel_rect.hpp"

namespace tessera::scene {

using tessera::PixelRect;

}  // namespace tessera::scene
