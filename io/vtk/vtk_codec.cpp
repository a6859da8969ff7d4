// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/vtk_codec.hpp"

#include <lz4.h>
#include <lzma.h>

#include <algorithm>
#include <limits>

#include "system/gzip.hpp"

namespace tessera::io {
namespace {

bool unpack_lz4(std::span<const std::byte> packed, std::span<std::byte> out) {
  constexpr std::size_t most = std::numeric_limits<int>::max();
  if (packed.size() > most || out.size() > most) return false;
  return LZ4_decompress_safe(reinterpret_cast<const char*>(packed.data()), reinterpret_cast<char*>(out.data()),
                             static_cast<int>(packed.size()),
                             static_cast<int>(out.size())) == static_cast<int>(out.size());
}

bool unpack_lzma(std::span<const std::byte> packed, std::span<std::byte> out) {
  std::uint64_t memory = 256 << 20;  // the highest preset needs 65 MiB
  std::size_t in_at = 0, out_at = 0;
  return ::lzma_stream_buffer_decode(&memory, 0, nullptr, reinterpret_cast<const std::uint8_t*>(packed.data()), &in_at,
                                     packed.size(), reinterpret_cast<std::uint8_t*>(out.data()), &out_at,
                                     out.size()) == LZMA_OK &&
         out_at == out.size();
}

}  // namespace

std::optional<VtkCodec> vtk_codec_named(std::string_view compressor) {
  if (compressor.empty()) return VtkCodec::none;
  if (compressor == "vtkZLibDataCompressor") return VtkCodec::zlib;
  if (compressor == "vtkLZ4DataCompressor") return VtkCodec::lz4;
  if (compressor == "vtkLZMADataCompressor") return VtkCodec::lzma;
  return std::nullopt;
}

bool can_unpack_to(VtkCodec codec, std::uint64_t packed, std::uint64_t unpacked) {
  // The best ratios are 1032 for deflate and 255 for LZ4. For xz, 64 MiB of zeros reach 7,000 at the highest preset.
  const std::uint64_t best = codec == VtkCodec::zlib ? 1040 : codec == VtkCodec::lz4 ? 256 : 16384;
  return codec == VtkCodec::none ? unpacked <= packed : unpacked / best <= packed;
}

bool unpack_block(VtkCodec codec, std::span<const std::byte> packed, std::span<std::byte> out) {
  switch (codec) {
    case VtkCodec::none:
      if (packed.size() != out.size()) return false;
      std::ranges::copy(packed, out.begin());
      return true;
    case VtkCodec::zlib:
      return system::inflate_block(packed, out);
    case VtkCodec::lz4:
      return unpack_lz4(packed, out);
    case VtkCodec::lzma:
      return unpack_lzma(packed, out);
  }
  return false;
}

}  // namespace tessera::io
