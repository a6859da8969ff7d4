// TIFF 6.0 with its Adobe supplements: one image in strips, deflated (8) after horizontal differencing (predictor 2),
// which all readers of TIFF know. Little endian, 32-bit offsets.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <new>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/display_rows.hpp"
#include "io/image_formats.hpp"
#include "io/picture_strips.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

void append_le(Bytes& bytes, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

/// Each number less the one of the pixel before it.
void difference(std::uint8_t* row, std::size_t row_bytes, int channels, int bits) {
  const auto pixel = static_cast<std::size_t>(channels * bits / 8);
  if (bits == 8) {
    for (std::size_t i = row_bytes - 1; i >= pixel; --i) row[i] = static_cast<std::uint8_t>(row[i] - row[i - pixel]);
    return;
  }
  const auto number = [&](std::size_t i) { return static_cast<unsigned>(row[i] | row[i + 1] << 8); };
  for (std::size_t i = row_bytes - 2; i >= pixel; i -= 2) {
    const unsigned less = number(i) - number(i - pixel);
    row[i] = static_cast<std::uint8_t>(less & 0xff);
    row[i + 1] = static_cast<std::uint8_t>(less >> 8 & 0xff);
  }
}

Bytes zlib_stream(const Bytes& rows) {
  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  Bytes out(size);
  // With room for all only memory can fail.
  if (compress2(out.data(), &size, rows.data(), static_cast<uLong>(rows.size()), deflate_level) != Z_OK)
    throw std::bad_alloc();
  out.resize(size);
  return out;
}

/// The directory of tags, and behind it the numbers that do not fit into its entries.
class Directory {
 public:
  explicit Directory(std::uint32_t place) : place_(place) {}

  void add(std::uint16_t tag, const std::vector<std::uint32_t>& numbers, bool is_short) {
    Bytes content;
    for (const std::uint32_t number : numbers) append_le(content, number, is_short ? 2 : 4);
    entries_.push_back({tag, static_cast<std::uint16_t>(is_short ? 3 : 4), static_cast<std::uint32_t>(numbers.size()),
                        std::move(content)});
  }

  [[nodiscard]] Bytes bytes() const {
    Bytes out, behind;
    append_le(out, static_cast<std::uint32_t>(entries_.size()), 2);
    const auto after = place_ + 2 + 12 * static_cast<std::uint32_t>(entries_.size()) + 4;
    for (const Entry& entry : entries_) {
      append_le(out, entry.tag, 2);
      append_le(out, entry.type, 2);
      append_le(out, entry.count, 4);
      Bytes content = entry.content;
      content.resize(std::max<std::size_t>(content.size() + content.size() % 2, 4));
      if (content.size() == 4) {
        out.insert(out.end(), content.begin(), content.end());
      } else {
        append_le(out, after + static_cast<std::uint32_t>(behind.size()), 4);
        behind.insert(behind.end(), content.begin(), content.end());
      }
    }
    append_le(out, 0, 4);  // no further image
    out.insert(out.end(), behind.begin(), behind.end());
    return out;
  }

 private:
  struct Entry {
    std::uint16_t tag, type;
    std::uint32_t count;
    Bytes content;
  };
  std::uint32_t place_;
  std::vector<Entry> entries_;
};

}  // namespace

void write_tiff(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options) {
  if (options.png_bits != 8 && options.png_bits != 16)
    throw scene::bad_input(fmt::format("{}: {} bits a channel; a .tif has 8 or 16", file.string(), options.png_bits));
  AtomicFile target(file);
  const int channels = options.background ? 3 : 4;
  const DisplayRows display(image, file, options, channels, DisplayRows::Order::little);
  const std::size_t row_bytes = display.row_bytes();
  const int rows = std::clamp(static_cast<int>(deflated_bytes / row_bytes), 1, image.size.height);
  std::vector<Bytes> strips(static_cast<std::size_t>((image.size.height + rows - 1) / rows));
  for_each_strip(image.size.height, rows, options.threads, [&](std::size_t strip, int begin, int end) {
    Bytes plain(static_cast<std::size_t>(end - begin) * row_bytes);
    std::vector<float> rgba;
    for (int y = begin; y < end; ++y) {
      std::uint8_t* const row = plain.data() + static_cast<std::size_t>(y - begin) * row_bytes;
      display.row(y, rgba, row);
      difference(row, row_bytes, channels, options.png_bits);
    }
    strips[strip] = zlib_stream(plain);
  });

  constexpr std::array<std::uint8_t, 8> head{'I', 'I', 42, 0, 0, 0, 0, 0};
  target.write(head.data(), head.size());
  std::vector<std::uint32_t> offsets, lengths;
  std::uint64_t place = head.size();
  for (Bytes& strip : strips) {
    offsets.push_back(static_cast<std::uint32_t>(place));
    lengths.push_back(static_cast<std::uint32_t>(strip.size()));
    strip.resize(strip.size() + strip.size() % 2);
    place += strip.size();
    if (place > std::numeric_limits<std::uint32_t>::max() - (std::uint64_t{1} << 20))
      throw scene::bad_input(file.string() + ": the picture takes more than the 4 GiB of a .tif; write .png or .exr");
    target.write(strip.data(), strip.size());
    strip = {};
  }
  const auto n = static_cast<std::size_t>(channels);
  Directory tags(static_cast<std::uint32_t>(place));
  const auto bits = static_cast<std::uint32_t>(options.png_bits);
  tags.add(256, {static_cast<std::uint32_t>(image.size.width)}, false);
  tags.add(257, {static_cast<std::uint32_t>(image.size.height)}, false);
  tags.add(258, std::vector<std::uint32_t>(n, bits), true);  // BitsPerSample
  tags.add(259, {8}, true);                                  // Compression: deflate
  tags.add(262, {2}, true);                                  // PhotometricInterpretation: RGB
  tags.add(273, offsets, false);                             // StripOffsets
  tags.add(277, {static_cast<std::uint32_t>(n)}, true);      // SamplesPerPixel
  tags.add(278, {static_cast<std::uint32_t>(rows)}, false);  // RowsPerStrip
  tags.add(279, lengths, false);                             // StripByteCounts
  tags.add(284, {1}, true);                                  // PlanarConfiguration: pixel by pixel
  tags.add(317, {2}, true);                                  // Predictor: horizontal differencing
  if (channels == 4) tags.add(338, {2}, true);               // ExtraSamples: straight alpha
  tags.add(339, std::vector<std::uint32_t>(n, 1), true);     // SampleFormat: unsigned
  const Bytes directory = tags.bytes();
  target.write(directory.data(), directory.size());
  Bytes offset;
  append_le(offset, static_cast<std::uint32_t>(place), 4);
  target.seek(4);
  target.write(offset.data(), offset.size());
  target.commit();
}

}  // namespace tessera::io
