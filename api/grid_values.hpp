// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "exchange/transport.hpp"
#include "io/volume/volume_reader.hpp"
#include "tessera/dataset.hpp"
#include "volume/bricks/cell_ranges.hpp"

/// What a grid's values stand for besides quantities: nothing, labels, another order of bytes. All are collective where
/// they take a transport, and add notes to the volume.
namespace tessera::api {

/// Values that stand for nothing would rule range, colors and what the volume is taken for: huge ones become blank, of
/// others a note tells how to leave them out.
void leave_fill_values_out(io::VolumeFile& volume, const std::filesystem::path& file, const ReadOptions& options,
                           exchange::Transport& transport, std::shared_ptr<const volume::CellRanges>& ranges);

/// Floats of a raw file in the other order of bytes are next to nothing, or huge.
void note_byte_order(io::VolumeFile& volume, const ReadOptions& options, const scene::ValueRange& range);

/// Makes each sample fill its voxel if the values are labels, unless the caller says otherwise. Returns them.
std::vector<double> take_labels(const std::filesystem::path& file, const ReadOptions& options,
                                exchange::Transport& transport, io::VolumeFile& volume);

}  // namespace tessera::api
