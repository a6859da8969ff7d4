// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace tessera::io {

/// The compression of blocks in a VTK XML file's arrays: each is a zlib stream, an LZ4 block without a frame, or an xz
/// stream.
enum class VtkCodec : std::uint8_t { none, zlib, lz4, lzma };

/// The codec of a file's `compressor` attribute: VtkCodec::none if it is empty, no value if it is unknown.
std::optional<VtkCodec> vtk_codec_named(std::string_view compressor);

/// Whether a block of `packed` bytes can unpack to `unpacked` bytes. Larger blocks are refused before memory is
/// allocated.
bool can_unpack_to(VtkCodec codec, std::uint64_t packed, std::uint64_t unpacked);

/// Unpacks one block into all of `out`. False if it is damaged or has more or fewer bytes.
bool unpack_block(VtkCodec codec, std::span<const std::byte> packed, std::span<std::byte> out);

}  // namespace tessera::io
