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

/// The samples of a volume: in the file at their position or, if they had to be unpacked or combined, in memory.
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

/// Returns the payload in memory, reading the file if necessary. Throws Error(system_failure) if the file was shortened
/// after it was opened.
VolumePayload in_memory(VolumePayload payload, const std::string& source);

/// Returns the samples of one step of a volume; with interleaved steps, those of all steps. Their number matches the
/// header. Throws Error(bad_input) for files that contain fewer samples, before allocating memory for the missing ones.
VolumePayload payload_of(const StoredVolume& volume, std::size_t step, const std::string& source);

/// Returns the size in bytes of all steps. Throws Error(bad_input) if the size is not addressable.
std::uint64_t payload_bytes(const StoredVolume& volume, const std::string& source);

/// Whether the result of payload_of() comes from one stream that can be unpacked a part at a time: gzip, zlib, a packed
/// VTK array.
bool comes_in_parts(const StoredVolume& volume);

/// Passes the bytes of payload_of() to `use`, in parts. Throws like payload_of(), or when the stream turns out to be
/// damaged.
void unpack_payload(const StoredVolume& volume, std::size_t step, const std::string& source,
                    const system::ByteSink& use);

/// Interleaves the components of a volume whose components are stored one after the other. The result is in memory.
VolumePayload interleaved(const StoredVolume& volume, const VolumePayload& planar);

}  // namespace tessera::io
