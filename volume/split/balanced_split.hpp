// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "volume/split/image_split.hpp"
#include "volume/split/tile_costs.hpp"

namespace tessera::volume {

/// Cuts a picture so that the process that has most to do has as little as can be: rows of columns (Moloney, "Ray
/// Coherence in Parallel Volume Rendering", SFU 2008, 4.2), whose vertical edges step by `region_grain` pixels between
/// two rows of tiles where that is more even. A process has what its
/// pixels cost (`costs`), what tiles that it shares with others cost once more, and what it does beside, by process,
/// nanoseconds.
ImageSplit balanced_split(const TileCosts& costs, std::span<const double> beside);

}  // namespace tessera::volume
