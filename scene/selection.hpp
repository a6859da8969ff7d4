#pragma once

#include "tessera/selection.hpp"

namespace tessera::scene {

using tessera::HalfSpace;
using tessera::Selection;

}  // namespace tessera::scene
