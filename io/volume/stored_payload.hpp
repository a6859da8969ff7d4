// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "io/volume/streamed_bricks.hpp"
#include "io/volume/volume_formats.hpp"

namespace tessera::io {

/// The samples of a volume, at their position in the file or, if they had to be unpacked or combined, in memory.
struct VolumePayload {
  struct Place {
    std::filesystem::path file;
    std::uint64_t first_byte;
  };
  std::span<const std::byte> bytes;  ///< empty if the samples are in a file
  std::shared_ptr<const void> owner;
  std::optional<Place> in_file{};
  std::uint64_t count = 0;  ///< number of bytes
};

/// The same payload in memory. Throws Error(system_failure) if the file was shortened since it was opened.
VolumePayload in_memory(VolumePayload payload, const std::string& source);

/// The samples of one step of a volume; with interleaved steps, of all. Their number matches the header. Throws
/// Error(bad_input) for files that contain fewer, before it allocates memory that they could not fill.
VolumePayload payload_of(const StoredVolume& volume, std::size_t step, const std::string& source);

/// Size in bytes of all steps. Throws Error(bad_input) if it is not addressable.
std::uint64_t payload_bytes(const StoredVolume& volume, const std::string& source);

/// Whether the result of payload_of() comes from one stream that can be unpacked a part at a time: gzip, zlib, a packed
/// VTK array.
bool comes_in_parts(const StoredVolume& volume);

/// Passes those bytes to `use`, in parts. Throws like payload_of(), or when the stream turns out to be damaged.
void unpack_payload(const StoredVolume& volume, std::size_t step, const std::string& source,
                    const system::ByteSink& use);

/// Interleaves the components of a volume that are stored one after the other; the result is in memory.
VolumePayload interleaved(const StoredVolume& volume, const VolumePayload& planar);

}  // namespace tessera::io
