// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace tessera::io {

struct StoredVolume;

/// Opens a .vti or .vtr of one piece with one binary array whose samples take more than `most_in_memory` bytes, so that
/// the samples can be read in place, or sequentially a part at a time. No value for any other file, or if the file has
/// an unusual feature: open_vtk_xml() or VTK then reads the file and reports errors.
std::optional<StoredVolume> read_plain_vtk_grid(const std::filesystem::path& file, std::uint64_t most_in_memory);

}  // namespace tessera::io
