// SPDX-License-Identifier: BSD-3-Clause
// PNG (ISO/IEC 15948): a zlib stream of filtered rows in chunks. Written here and not by libpng, which compresses on
// one thread: strips of rows are compressed separately, each a run of whole deflate blocks that ends at a byte
// boundary, as in pigz (Adler, zlib.net/pigz). Strips do not depend on the number of threads, so neither do the bytes.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <new>
#include <string_view>
#include <vector>

#include "io/image/display_rows.hpp"
#include "io/image/image_formats.hpp"
#include "io/image/picture_strips.hpp"
#include "scene/error.hpp"
#include "system/atomic_file.hpp"

namespace tessera::io {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Write = std::function<void(const void*, std::size_t)>;

// The only filter that is used. Trying all filters for every row took as long as compression and saved 2 %.
constexpr std::uint8_t filter_up = 2;

struct Strip {
  Bytes deflated;
  uLong adler = 0;  ///< checksum of the filtered rows
  uLong length = 0;
};

void append_be32(Bytes& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void write_chunk(const Write& write, std::string_view name, const Bytes& content) {
  Bytes head;
  append_be32(head, static_cast<std::uint32_t>(content.size()));
  head.insert(head.end(), name.begin(), name.end());
  uLong crc = crc32(0, head.data() + 4, 4);
  // For an empty content, zlib would return the initial value instead of `crc`.
  if (!content.empty()) crc = crc32(crc, content.data(), static_cast<uInt>(content.size()));
  Bytes tail;
  append_be32(tail, static_cast<std::uint32_t>(crc));
  write(head.data(), head.size());
  write(content.data(), content.size());
  write(tail.data(), tail.size());
}

/// Compresses rows to raw deflate blocks. The blocks of all strips except the last end with an empty block that pads to
/// a whole byte.
Bytes deflated(const Bytes& rows, bool is_last) {
  z_stream stream{};
  constexpr int raw_32k = -15, memory_level = 8;
  if (deflateInit2(&stream, deflate_level, Z_DEFLATED, raw_32k, memory_level, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  struct End {
    z_stream& stream;
    ~End() { deflateEnd(&stream); }
  } const end{stream};
  Bytes out(deflateBound(&stream, static_cast<uLong>(rows.size())) + 16);  // 16 bytes for the empty block
  stream.next_in = const_cast<Bytef*>(rows.data());                        // zlib only reads the input
  stream.avail_in = static_cast<uInt>(rows.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, is_last ? Z_FINISH : Z_SYNC_FLUSH);  // cannot fail: the buffer is large enough
  out.resize(stream.total_out);
  out.shrink_to_fit();
  return out;
}

/// Returns rows [begin, end), each preceded by the type of its filter.
Bytes filtered_rows(const DisplayRows& display, int begin, int end) {
  const std::size_t row_bytes = display.row_bytes();
  Bytes rows(static_cast<std::size_t>(end - begin) * (row_bytes + 1));
  std::vector<float> rgba;
  Bytes above(row_bytes), here(row_bytes);
  if (begin > 0) display.row(begin - 1, rgba, above.data());
  for (int y = begin; y < end; ++y) {
    display.row(y, rgba, here.data());
    std::uint8_t* out = rows.data() + static_cast<std::size_t>(y - begin) * (row_bytes + 1);
    *out++ = filter_up;
    for (std::size_t i = 0; i < row_bytes; ++i) out[i] = static_cast<std::uint8_t>(here[i] - above[i]);
    above.swap(here);
  }
  return rows;
}

std::vector<Strip> make_strips(const DisplayRows& display, int height, int threads) {
  const int rows = std::max(1, static_cast<int>(deflated_bytes / (display.row_bytes() + 1)));
  std::vector<Strip> strips(static_cast<std::size_t>((height + rows - 1) / rows));
  for_each_strip(height, rows, threads, [&](std::size_t i, int begin, int end) {
    Strip& strip = strips[i];
    const Bytes filtered = filtered_rows(display, begin, end);
    strip.length = static_cast<uLong>(filtered.size());
    strip.adler = adler32(adler32(0, nullptr, 0), filtered.data(), static_cast<uInt>(filtered.size()));
    strip.deflated = deflated(filtered, end == height);
  });
  return strips;
}

void write_head(const Write& write, const scene::Image& image, int bits, int channels) {
  constexpr std::array<std::uint8_t, 8> signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  write(signature.data(), signature.size());
  constexpr std::uint8_t rgb = 2, rgb_alpha = 6;
  Bytes header;
  append_be32(header, static_cast<std::uint32_t>(image.size.width));
  append_be32(header, static_cast<std::uint32_t>(image.size.height));
  header.insert(header.end(), {static_cast<std::uint8_t>(bits), channels == 4 ? rgb_alpha : rgb, 0, 0, 0});
  write_chunk(write, "IHDR", header);
  write_chunk(write, "sRGB", {0});  // perceptual
  Bytes gamma, primaries;           // for readers without sRGB support; the numbers are from the standard
  append_be32(gamma, 45455);
  for (const std::uint32_t place : {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000})
    append_be32(primaries, place);
  write_chunk(write, "gAMA", gamma);
  write_chunk(write, "cHRM", primaries);
}

void encode(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options,
            const Write& write) {
  if (options.png_bits != 8 && options.png_bits != 16)
    throw scene::bad_input(
        fmt::format("{}: {} bits per channel are not supported; a .png has 8 or 16", file.string(), options.png_bits));
  const int channels = options.background ? 3 : 4;
  const DisplayRows display(image, file, options, channels);
  std::vector<Strip> strips = make_strips(display, image.size.height, options.threads);
  write_head(write, image, options.png_bits, channels);
  uLong adler = adler32(0, nullptr, 0);
  for (std::size_t i = 0; i < strips.size(); ++i) {
    Strip& strip = strips[i];
    adler = adler32_combine(adler, strip.adler, static_cast<z_off_t>(strip.length));
    if (i == 0) strip.deflated.insert(strip.deflated.begin(), {0x78, 0x5e});  // zlib header: 32 KiB window, fast
    if (i + 1 == strips.size()) append_be32(strip.deflated, static_cast<std::uint32_t>(adler));
    write_chunk(write, "IDAT", strip.deflated);
    strip.deflated = {};
  }
  write_chunk(write, "IEND", {});
}

}  // namespace

void write_png(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options) {
  system::AtomicFile target(file);
  encode(image, file, options, [&](const void* bytes, std::size_t count) { target.write(bytes, count); });
  target.commit();
}

std::vector<std::byte> png_bytes(const scene::Image& image, const ImageFileOptions& options) {
  std::vector<std::byte> all;
  encode(image, "image", options, [&](const void* bytes, std::size_t count) {
    const auto* const first = static_cast<const std::byte*>(bytes);
    all.insert(all.end(), first, first + count);
  });
  return all;
}

}  // namespace tessera::io
