// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "exchange/transport.hpp"
#include "io/volume/volume_reader.hpp"
#include "volume/bricks/cell_ranges.hpp"

/// Detection of values of a grid that are not quantities: fill values, labels, values in the wrong byte order.
/// Functions with a transport are collective. All functions add notes to the volume.
namespace tessera::api {

/// Detects fill values, which would dominate the range and the colours. Huge fill values become blank; for other fill
/// values, a note explains how to leave them out.
void leave_fill_values_out(io::VolumeFile& volume, const std::filesystem::path& file,
                           const std::optional<std::array<double, 2>>& threshold, exchange::Transport& transport,
                           std::shared_ptr<const volume::CellRanges>& ranges);

/// Floats of a raw file in the wrong byte order are almost zero, or huge; a note suggests the other order.
void note_byte_order(io::VolumeFile& volume, bool big_endian, const scene::ValueRange& range);

/// Makes each sample fill its voxel if the values are labels, unless `asked` (ReadOptions::labels) states otherwise.
/// Returns the labels.
std::vector<double> take_labels(const std::filesystem::path& file, std::optional<bool> asked,
                                exchange::Transport& transport, io::VolumeFile& volume);

}  // namespace tessera::api
