// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "analysis/chart_measure.hpp"

namespace tessera::analysis {

/// Images measured by other programs (ChartCommand describes the file), compared by colour alone on the same pixels.
/// Images are .pfm (linear RGB, bottom row first), relative to the file. Throws Error(bad_input) for missing files or
/// other sizes.
std::vector<ChartPoint> read_peers(const std::filesystem::path& file, ImageSize size,
                                   std::span<const PixelIndex> pixels, std::span<const ReferencePixel> truths);

}  // namespace tessera::analysis
