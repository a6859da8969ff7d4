// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "analysis/chart_measure.hpp"

namespace tessera::analysis {

/// Other programs' measured pictures (ChartCommand says the file's shape), judged by colour alone on the same pixels.
/// Pictures are .pfm (linear RGB, bottom row first), named beside the file. Throws Error(bad_input) for what is missing
/// or of another size.
std::vector<ChartPoint> read_peers(const std::filesystem::path& file, ImageSize size,
                                   std::span<const PixelIndex> pixels, std::span<const ReferencePixel> truths);

}  // namespace tessera::analysis
