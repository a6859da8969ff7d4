// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "volume/split/image_split.hpp"
#include "volume/split/tile_costs.hpp"

namespace tessera::volume {

/// Divides an image so that the largest load of any process is as small as possible. The split consists of rows of
/// columns (Moloney, "Ray Coherence in Parallel Volume Rendering", SFU 2008, 4.2), whose vertical edges step by
/// `region_grain` pixels between two rows of tiles where that improves the balance. The load of a process is the cost
/// of its pixels (`costs`), the additional cost of tiles that it shares with other processes, and its other work
/// (`beside`, one value per process, in nanoseconds).
ImageSplit balanced_split(const TileCosts& costs, std::span<const double> beside);

}  // namespace tessera::volume
