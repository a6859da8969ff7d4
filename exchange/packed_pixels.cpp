// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/packed_pixels.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "exchange/packed_pixels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef TESSERA_EXCHANGE_PACKED_PIXELS
#define TESSERA_EXCHANGE_PACKED_PIXELS
namespace tessera::exchange {

constexpr std::size_t columns = 16, channels = 5, color_channels = 4;
constexpr std::size_t word_bytes = columns * sizeof(std::uint32_t);

/// A band of up to 16 columns of an image.
template <class Float>
struct PixelBand {
  Float *rgba, *depth;  ///< pixels begin here: the band's first pixel
  std::size_t row;      ///< pixels from one row to the next
  std::size_t width;    ///< at most 16
  std::size_t height;
};

/// A position in the streams of a rectangle.
template <class Byte>
struct Streams {
  Byte *words, *last;    ///< first and last group of 16 words that may be accessed
  std::size_t bits = 0;  ///< position in each stream
  [[nodiscard]] Byte* word() const { return words + bits / 32 * word_bytes; }
  [[nodiscard]] int shift() const { return static_cast<int>(bits % 32); }
};

}  // namespace tessera::exchange
#endif

HWY_BEFORE_NAMESPACE();
namespace tessera::exchange {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DU = hn::CappedTag<std::uint32_t, columns>;
using DI = hn::RebindToSigned<DU>;
using DF = hn::RebindToFloat<DU>;
using U = hn::Vec<DU>;

/// One value per column, for each channel.
struct Rows {
  HWY_ALIGN_MAX std::uint32_t of[channels][columns];
};

// Words in messages are not aligned.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE U load_words(const std::byte* from) {
  std::uint32_t word;
  std::memcpy(&word, from, sizeof word);
  return Set(DU(), word);
}
HWY_INLINE void store_words(U words, std::byte* to) {
  const std::uint32_t word = GetLane(words);
  std::memcpy(to, &word, sizeof word);
}
#else
using DB = hn::Repartition<std::uint8_t, DU>;
HWY_INLINE U load_words(const std::byte* from) {
  return BitCast(DU(), LoadU(DB(), reinterpret_cast<const std::uint8_t*>(from)));
}
HWY_INLINE void store_words(U words, std::byte* to) {
  StoreU(BitCast(DB(), words), DB(), reinterpret_cast<std::uint8_t*>(to));
}
#endif

/// Separates the channels of 16 pixels.
HWY_INLINE void split_channels(const float* rgba, const float* depth, Rows& rows) {
  const DU du;
  const DF df;
  const std::size_t lanes = hn::Lanes(du);
  for (std::size_t c = 0; c < columns; c += lanes) {
    hn::Vec<DF> red, green, blue, alpha;
    LoadInterleaved4(df, rgba + color_channels * c, red, green, blue, alpha);
    Store(BitCast(du, red), du, &rows.of[0][c]);
    Store(BitCast(du, green), du, &rows.of[1][c]);
    Store(BitCast(du, blue), du, &rows.of[2][c]);
    Store(BitCast(du, alpha), du, &rows.of[3][c]);
    Store(BitCast(du, LoadU(df, depth + c)), du, &rows.of[4][c]);
  }
}

HWY_INLINE void join_channels(const Rows& rows, float* rgba, float* depth) {
  const DU du;
  const DF df;
  const std::size_t lanes = hn::Lanes(du);
  for (std::size_t c = 0; c < columns; c += lanes) {
    const auto channel = [&](std::size_t k) { return BitCast(df, Load(du, &rows.of[k][c])); };
    StoreInterleaved4(channel(0), channel(1), channel(2), channel(3), df, rgba + color_channels * c);
    StoreU(channel(4), df, depth + c);
  }
}

/// Computes the prediction errors of `next` from the rows above, as unsigned integers with the sign in the lowest bit.
/// Then `next` becomes the row above. Returns the number of bits of the largest error.
HWY_INLINE unsigned differ(const std::uint32_t* HWY_RESTRICT next, std::uint32_t* HWY_RESTRICT above,
                           std::uint32_t* HWY_RESTRICT step, std::uint32_t* HWY_RESTRICT differences) {
  const DU du;
  const DI di;
  const std::size_t lanes = hn::Lanes(du);
  U all = Zero(du);
  for (std::size_t c = 0; c < columns; c += lanes) {
    const U value = Load(du, next + c);
    const U now = value - Load(du, above + c);
    const U off = now - Load(du, step + c);
    const U sign = BitCast(du, ShiftRight<31>(BitCast(di, off)));
    const U difference = Xor(ShiftLeft<1>(off), sign);
    Store(value, du, above + c);
    Store(now, du, step + c);
    Store(difference, du, differences + c);
    all = Or(all, difference);
  }
  return 32u - static_cast<unsigned>(std::countl_zero(GetLane(MaxOfLanes(du, all))));
}

// Widths are practically random: put() and get() therefore have no branches on them.

HWY_INLINE void put(const std::uint32_t* HWY_RESTRICT differences, unsigned width, Streams<std::byte>& to,
                    std::uint32_t* HWY_RESTRICT unfinished) {
  const DU du;
  const std::size_t lanes = hn::Lanes(du);
  const int shift = to.shift();
  std::byte* word = to.word();
  const U finishes = Set(du, static_cast<unsigned>(shift) + width >= 32 ? ~std::uint32_t{0} : 0);
  for (std::size_t c = 0; c < columns; c += lanes, word += lanes * sizeof(std::uint32_t)) {
    const U difference = Load(du, differences + c);
    const U all = Or(Load(du, unfinished + c), ShiftLeftSame(difference, shift));
    store_words(all, word);
    const U rest = ShiftRightSame(ShiftRight<1>(difference), 31 - shift);
    Store(Or(And(finishes, rest), AndNot(finishes, all)), du, unfinished + c);
  }
  to.bits += width;
}

/// Reads differences, and computes the next row from them and the rows above.
HWY_INLINE void get(unsigned width, Streams<const std::byte>& from, std::uint32_t* HWY_RESTRICT value,
                    std::uint32_t* HWY_RESTRICT step) {
  const DU du;
  const DI di;
  const std::size_t lanes = hn::Lanes(du);
  const int shift = from.shift();
  const std::byte *word = from.word(), *next = std::min(word + word_bytes, from.last);
  word = std::min(word, from.last);
  const U mask = Set(du, static_cast<std::uint32_t>((std::uint64_t{1} << width) - 1));
  for (std::size_t c = 0; c < columns; c += lanes) {
    const U low = ShiftRightSame(load_words(word + c * sizeof(std::uint32_t)), shift);
    const U high = ShiftLeftSame(ShiftLeft<1>(load_words(next + c * sizeof(std::uint32_t))), 31 - shift);
    const U difference = And(Or(low, high), mask);
    const U sign = BitCast(du, Neg(BitCast(di, And(difference, Set(du, 1)))));
    const U now = Load(du, step + c) + Xor(ShiftRight<1>(difference), sign);
    Store(now, du, step + c);
    Store(Load(du, value + c) + now, du, value + c);
  }
  from.bits += width;
}

/// `unfinished`: for each stream, the bits of the last word, which is not full yet.
void pack_band(const PixelBand<const float>& band, std::uint8_t* widths, Streams<std::byte>& to,
               std::uint32_t* unfinished) {
  Rows next, above{}, step{}, differences;
  float rgba[color_channels * columns] = {}, depth[columns] = {};
  for (std::size_t y = 0; y < band.height; ++y) {
    const float *row_rgba = band.rgba + color_channels * band.row * y, *row_depth = band.depth + band.row * y;
    if (band.width < columns) {
      std::memcpy(rgba, row_rgba, band.width * color_channels * sizeof(float));
      std::memcpy(depth, row_depth, band.width * sizeof(float));
      row_rgba = rgba, row_depth = depth;
    }
    split_channels(row_rgba, row_depth, next);
    for (std::size_t k = 0; k < channels; ++k) {
      const unsigned width = differ(next.of[k], above.of[k], step.of[k], differences.of[k]);
      *widths++ = static_cast<std::uint8_t>(width);
      put(differences.of[k], width, to, unfinished);
    }
  }
}

void unpack_band(const std::uint8_t* widths, Streams<const std::byte>& from, const PixelBand<float>& band) {
  Rows value{}, step{};
  float rgba[color_channels * columns], depth[columns];
  for (std::size_t y = 0; y < band.height; ++y) {
    for (std::size_t k = 0; k < channels; ++k) get(*widths++, from, value.of[k], step.of[k]);
    float *row_rgba = band.rgba + color_channels * band.row * y, *row_depth = band.depth + band.row * y;
    if (band.width == columns) {
      join_channels(value, row_rgba, row_depth);
      continue;
    }
    join_channels(value, rgba, depth);
    std::memcpy(row_rgba, rgba, band.width * color_channels * sizeof(float));
    std::memcpy(row_depth, depth, band.width * sizeof(float));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::exchange
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::exchange {
HWY_EXPORT(pack_band);
HWY_EXPORT(unpack_band);

namespace {

std::size_t raw_bytes(const PixelRect& rect) {
  return static_cast<std::size_t>(rect.area()) * channels * sizeof(float);
}

/// The number of widths of a band.
std::size_t widths_of_band(const PixelRect& rect) { return channels * static_cast<std::size_t>(rect.height()); }

std::size_t bands(const PixelRect& rect) { return (static_cast<std::size_t>(rect.width()) + columns - 1) / columns; }

/// Band `b` of the rectangle in an image.
template <class Float, class Image>
PixelBand<Float> band_of(Image& image, const PixelRect& rect, std::size_t b) {
  const std::size_t first = image.index(rect.x0, rect.y0) + b * columns;
  return {image.rgba.data() + color_channels * first, image.depth.data() + first,
          static_cast<std::size_t>(image.size.width),
          std::min(columns, static_cast<std::size_t>(rect.width()) - b * columns),
          static_cast<std::size_t>(rect.height())};
}

void append_raw(Bytes& bytes, const scene::Image& image, const PixelRect& rect) {
  append(bytes, std::uint32_t{0});
  const auto width = static_cast<std::size_t>(rect.width());
  for (int y = rect.y0; y < rect.y1; ++y)
    append_values(bytes,
                  std::span(image.rgba).subspan(color_channels * image.index(rect.x0, y), color_channels * width));
  for (int y = rect.y0; y < rect.y1; ++y)
    append_values(bytes, std::span(image.depth).subspan(image.index(rect.x0, y), width));
}

}  // namespace

void append_pixels(Bytes& bytes, const scene::Image& image, const PixelRect& rect, bool pack) {
  if (rect.empty() || !pack) return append_raw(bytes, image, rect);
  const std::size_t begin = bytes.size(), count = bands(rect) * widths_of_band(rect);
  bytes.resize(begin + sizeof(std::uint32_t) + count + (count + 1) * word_bytes);
  auto* widths = reinterpret_cast<std::uint8_t*>(bytes.data() + begin + sizeof(std::uint32_t));
  std::byte* words = bytes.data() + begin + sizeof(std::uint32_t) + count;
  Streams<std::byte> to{words, words + count * word_bytes};
  HWY_ALIGN_MAX std::uint32_t unfinished[columns] = {};
  for (std::size_t b = 0; b < bands(rect); ++b, widths += widths_of_band(rect))
    HWY_DYNAMIC_DISPATCH(pack_band)(band_of<const float>(image, rect, b), widths, to, unfinished);
  std::memcpy(to.word(), unfinished, word_bytes);
  const std::size_t packed = count + (to.bits + 31) / 32 * word_bytes;
  if (packed >= raw_bytes(rect)) {
    bytes.resize(begin);
    return append_raw(bytes, image, rect);
  }
  const auto size = static_cast<std::uint32_t>(packed);
  std::memcpy(bytes.data() + begin, &size, sizeof size);
  bytes.resize(begin + sizeof size + packed);
}

void take_pixels(RecordReader& reader, scene::Image& image, const PixelRect& rect) {
  const auto size = reader.take<std::uint32_t>();
  if (size == 0) {
    const auto width = static_cast<std::size_t>(rect.width());
    for (int y = rect.y0; y < rect.y1; ++y)
      reader.take_values(
          std::span(image.rgba).subspan(color_channels * image.index(rect.x0, y), color_channels * width));
    for (int y = rect.y0; y < rect.y1; ++y)
      reader.take_values(std::span(image.depth).subspan(image.index(rect.x0, y), width));
    return;
  }
  const auto packed = reader.take_bytes(size);
  const std::size_t count = bands(rect) * widths_of_band(rect);
  if (count > packed.size()) reader.refuse("has fewer widths than its pixels need");
  const auto* widths = reinterpret_cast<const std::uint8_t*>(packed.data());
  std::size_t bits = 0;
  unsigned widest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    bits += widths[i];
    widest = std::max<unsigned>(widest, widths[i]);
  }
  if (widest > 32) reader.refuse("packs a pixel's value into more than 32 bits");
  if (packed.size() != count + (bits + 31) / 32 * word_bytes)
    reader.refuse("has a number of pixels that does not match its widths");
  static constexpr std::byte nothing[word_bytes] = {};  // for a rectangle whose differences are all 0
  Streams<const std::byte> from{nothing, nothing};
  if (bits > 0) from = {packed.data() + count, packed.data() + packed.size() - word_bytes};
  for (std::size_t b = 0; b < bands(rect); ++b, widths += widths_of_band(rect))
    HWY_DYNAMIC_DISPATCH(unpack_band)(widths, from, band_of<float>(image, rect, b));
}

}  // namespace tessera::exchange
#endif  // HWY_ONCE
