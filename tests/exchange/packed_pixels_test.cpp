// SPDX-License-Identifier: BSD-3-Clause
// Pixels that are sent in fewer bytes keep their bits.
#include "exchange/packed_pixels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "scene/error.hpp"
#include "support/instruction_sets.hpp"

namespace tessera::exchange {
namespace {

constexpr std::size_t raw_pixel = 20, size_bytes = 4;

struct Kind {
  const char* name;
  std::function<void(scene::Image&, std::mt19937&)> fill;
  bool packs;  ///< whether a large image takes fewer bytes
};

void smooth(scene::Image& image, std::mt19937&) {
  for (int y = 0; y < image.size.height; ++y)
    for (int x = 0; x < image.size.width; ++x) {
      const std::size_t at = image.index(x, y);
      for (std::size_t k = 0; k < 4; ++k)
        image.rgba[4 * at + k] = 0.5f + 0.3f * std::sin(0.03f * static_cast<float>(x + 2 * y) + static_cast<float>(k));
      image.depth[at] = 10 + 0.01f * static_cast<float>(x) - 0.02f * static_cast<float>(y);
    }
}

/// Clears half of an image, up to a slanting edge.
void half_empty(scene::Image& image, std::mt19937& random) {
  smooth(image, random);
  for (int y = 0; y < image.size.height; ++y)
    for (int x = 0; x < image.size.width; ++x) {
      if (x > 2 * y) continue;
      const std::size_t at = image.index(x, y);
      for (std::size_t k = 0; k < 4; ++k) image.rgba[4 * at + k] = 0;
      image.depth[at] = std::numeric_limits<float>::infinity();
    }
}

/// Values that differ in a random number of bits, so the word boundaries are random too.
void slightly_noisy(scene::Image& image, std::mt19937& random) {
  const float noise = std::ldexp(1.0f, -10 - static_cast<int>(random() % 13));
  std::uniform_real_distribution<float> uniform(0.5f, 0.5f + noise);
  for (auto* values : {&image.rgba, &image.depth})
    for (float& value : *values) value = uniform(random);
}

/// Arbitrary bits: NaN, infinite and denormal numbers, and -0.
void any_bits(scene::Image& image, std::mt19937& random) {
  for (auto* values : {&image.rgba, &image.depth})
    for (float& value : *values) value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
}

const Kind kinds[] = {{"empty", [](scene::Image&, std::mt19937&) {}, true},
                      {"smooth", smooth, true},
                      {"half empty", half_empty, true},
                      {"slightly noisy", slightly_noisy, true},
                      {"any bits", any_bits, false}};

constexpr PixelRect rects[] = {{0, 0, 1, 1},   {3, 2, 18, 5},  {16, 16, 32, 32},
                               {7, 1, 24, 60}, {0, 0, 70, 60}, {38, 28, 70, 60}};

bool same_bits(const scene::Image& a, const scene::Image& b) {
  const auto same = [](const std::vector<float>& x, const std::vector<float>& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0;
  };
  return same(a.rgba, b.rgba) && same(a.depth, b.depth);
}

/// `of` inside the rectangle, `rest` elsewhere.
scene::Image with_rect(const scene::Image& of, const PixelRect& rect, scene::Image rest) {
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) {
      const std::size_t at = of.index(x, y);
      std::copy_n(&of.rgba[4 * at], 4, &rest.rgba[4 * at]);
      rest.depth[at] = of.depth[at];
    }
  return rest;
}

TEST(PackedPixels, ComeOutAsTheyWentInAndTouchNothingElse) {
  std::mt19937 random(1);
  for (int seed = 0; seed < 20; ++seed)
    for (const Kind& kind : kinds) {
      scene::Image image({70, 60}), before({70, 60});
      kind.fill(image, random);
      any_bits(before, random);
      for (const PixelRect& rect : rects) {
        const scene::Image expected = with_rect(image, rect, before);
        Bytes first;
        tests::for_each_instruction_set([&](const char* name) {
          for (const bool pack : {true, false}) {
            Bytes bytes(3);  // no alignment is required
            append_pixels(bytes, image, rect, pack);
            append(bytes, std::uint8_t{77});
            const std::size_t raw = raw_pixel * static_cast<std::size_t>(rect.area());
            EXPECT_LE(bytes.size(), 3 + size_bytes + raw + 1) << kind.name;
            if (!pack) {
              EXPECT_EQ(bytes.size(), 3 + size_bytes + raw + 1);
            } else if (rect.area() >= 1024) {
              EXPECT_EQ(bytes.size() < size_bytes + raw / 4 * 3, kind.packs) << kind.name << ": " << bytes.size();
            }
            if (pack && first.empty()) first = bytes;
            if (pack) {
              EXPECT_EQ(bytes, first) << name << " packs " << kind.name << " otherwise";
            }
            RecordReader reader(std::span<const std::byte>(bytes).subspan(3));
            scene::Image taken = before;
            take_pixels(reader, taken, rect);
            EXPECT_EQ(reader.take<std::uint8_t>(), 77);
            reader.finish();
            EXPECT_TRUE(same_bits(taken, expected)) << kind.name << " at " << rect.x0 << " on " << name;
          }
        });
      }
    }
}

/// The message with which these bytes are refused, "" if they are accepted.
std::string refusal(const Bytes& bytes, const PixelRect& rect) {
  scene::Image image({70, 60});
  RecordReader reader(bytes);
  try {
    take_pixels(reader, image, rect);
    return "";
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
    return error.what();
  }
}

TEST(PackedPixels, RefuseInvalidMessages) {
  std::mt19937 random(2);
  scene::Image image({70, 60});
  half_empty(image, random);
  const PixelRect rect{7, 1, 39, 60};
  Bytes bytes;
  append_pixels(bytes, image, rect, true);
  ASSERT_EQ(refusal(bytes, rect), "");
  for (std::size_t cut = 0; cut < bytes.size(); cut += cut < 700 ? 1 : 61)
    EXPECT_NE(refusal(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(cut)), rect), "") << cut;

  Bytes wide = bytes;
  wide[size_bytes + 5] = std::byte{33};
  EXPECT_NE(refusal(wide, rect).find("more than 32 bits"), std::string::npos) << refusal(wide, rect);
  Bytes wider = bytes;  // ends in another word
  for (std::size_t k = 0; k < 4; ++k) wider[size_bytes + 10 + k] = std::byte{32};
  EXPECT_NE(refusal(wider, rect).find("a number of pixels that does not match its widths"), std::string::npos)
      << refusal(wider, rect);
  Bytes few;
  append(few, std::uint32_t{3});
  few.resize(7);
  EXPECT_NE(refusal(few, rect).find("fewer widths"), std::string::npos) << refusal(few, rect);
  Bytes endless = bytes;
  endless[3] = std::byte{0xff};
  EXPECT_NE(refusal(endless, rect).find("shorter than it states"), std::string::npos) << refusal(endless, rect);
  // For another rectangle.
  EXPECT_NE(refusal(bytes, {7, 1, 39, 59}), "");
  EXPECT_NE(refusal(bytes, {7, 0, 39, 60}), "");
}

TEST(PackedPixels, DamagedBytesNeverReachBeyondTheirPixels) {
  std::mt19937 random(3);
  scene::Image image({70, 60});
  half_empty(image, random);
  const PixelRect rect{7, 1, 39, 33};
  Bytes whole;
  append_pixels(whole, image, rect, true);
  const scene::Image empty({70, 60});
  int taken = 0;
  for (int k = 0; k < 3000; ++k) {
    Bytes bytes = whole;
    for (unsigned changes = 1 + random() % 4; changes > 0; --changes)
      bytes[random() % (changes % 2 == 0 ? bytes.size() : 700)] = static_cast<std::byte>(random());
    scene::Image got = empty;
    RecordReader reader(bytes);
    try {
      take_pixels(reader, got, rect);
      ++taken;
    } catch (const scene::Error&) {
    }
    EXPECT_TRUE(same_bits(got, with_rect(got, rect, empty)));
  }
  EXPECT_GT(taken, 0);
}

}  // namespace
}  // namespace tessera::exchange
