// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace tessera::io {

struct StoredVolume;

/// A .vti or .vtr of one piece with one binary array whose samples take more than `most_in_memory` bytes, to be read in
/// place, or in their order a part at a time. None of any other file, nor of one in which anything is odd:
/// open_vtk_xml() or VTK reads that, and reports what is wrong.
std::optional<StoredVolume> read_plain_vtk_grid(const std::filesystem::path& file, std::uint64_t most_in_memory);

}  // namespace tessera::io
