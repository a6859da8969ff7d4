// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/frame_counters.hpp"

namespace tessera::scene {

using tessera::frame_counters;
using tessera::FrameCounter;
using tessera::FrameCounters;
using tessera::grid_counters;
using tessera::GridCounter;
using tessera::GridCounters;

}  // namespace tessera::scene
