// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "analysis/chart_measure.hpp"

namespace tessera::analysis {

/// Reads the images and times of other programs (apps/commands/chart_command.hpp describes the file). The images are
/// compared by colour alone, on the same pixels. They are .pfm (linear RGB, bottom row first); their names are relative
/// to the directory of the file. Throws Error(bad_input) for missing files and for images of another size.
std::vector<ChartPoint> read_peers(const std::filesystem::path& file, ImageSize size,
                                   std::span<const PixelIndex> pixels, std::span<const ReferencePixel> truths);

}  // namespace tessera::analysis
