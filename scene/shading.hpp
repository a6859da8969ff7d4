#pragma once

#include "tessera/shading.hpp"

namespace tessera::scene {

using tessera::Shading;

}  // namespace tessera::scene
