// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/mechanisms.hpp"

namespace tessera::scene {

using tessera::Mechanisms;

}  // namespace tessera::scene
