#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace tessera::io {

struct StoredVolume;

/// What is said here of a .vti or .vtr of one piece with one array whose samples take more than `most_in_memory` bytes,
/// and that are raw, base64 or zlib: so that they can be read where they lie, or in their order a part at a time. None
/// of any other file, nor of one in which anything is odd: that is VTK's to read, and to find fault with.
std::optional<StoredVolume> read_plain_vtk_grid(const std::filesystem::path& file, std::uint64_t most_in_memory);

}  // namespace tessera::io
