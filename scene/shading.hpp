// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/shading.hpp"

namespace tessera::scene {

using tessera::Shading;

}  // namespace tessera::scene
