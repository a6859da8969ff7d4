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

/// The samples of a volume, where they lie in the file or, if they had to be unpacked or put together, in memory.
struct VolumePayload {
  struct Place {
    std::filesystem::path file;
    std::uint64_t first_byte;
  };
  std::span<const std::byte> bytes;  ///< empty where they lie in a file
  std::shared_ptr<const void> owner;
  std::optional<Place> in_file{};
  std::uint64_t count = 0;  ///< of the bytes
};

/// The same in memory. Throws Error(system_failure) if the file has been shortened meanwhile.
VolumePayload in_memory(VolumePayload payload, const std::string& source);

/// The samples of one step of a volume; with interleaved steps, of all. They are as many as the header says. Throws
/// Error(bad_input) for files that hold fewer, before memory is asked for that they could not fill.
VolumePayload payload_of(const StoredVolume& volume, std::size_t step, const std::string& source);

/// Bytes of all steps. Throws Error(bad_input) for more than can be addressed.
std::uint64_t payload_bytes(const StoredVolume& volume, const std::string& source);

/// Whether what payload_of() gives comes out of one stream that can be unpacked a part at a time: gzip, zlib, a packed
/// array of VTK's.
bool comes_in_parts(const StoredVolume& volume);

/// Gives `use` those bytes, in parts. Throws as payload_of(), or when the stream turns out to be damaged.
void unpack_payload(const StoredVolume& volume, std::size_t step, const std::string& source,
                    const system::ByteSink& use);

/// The tuples of a volume whose components lie one after the other, in memory, each tuple together.
VolumePayload interleaved(const StoredVolume& volume, const VolumePayload& planar);

}  // namespace tessera::io
