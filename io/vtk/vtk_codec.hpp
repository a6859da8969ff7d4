// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace tessera::io {

/// The compression of blocks in a VTK XML file's arrays: each block is a zlib stream, an LZ4 block without a frame, or
/// an xz stream.
enum class VtkCodec : std::uint8_t { none, zlib, lz4, lzma };

/// Returns the codec that a file's attribute `compressor` names: VtkCodec::none if the attribute is empty, no value if
/// it is unknown.
std::optional<VtkCodec> vtk_codec_named(std::string_view compressor);

/// Whether a block of `packed` bytes can unpack to `unpacked` bytes. Blocks that state a larger size are refused before
/// memory is allocated.
bool can_unpack_to(VtkCodec codec, std::uint64_t packed, std::uint64_t unpacked);

/// Unpacks one block and fills `out`. Returns false if the block is damaged or does not have exactly as many bytes as
/// `out`.
bool unpack_block(VtkCodec codec, std::span<const std::byte> packed, std::span<std::byte> out);

}  // namespace tessera::io
