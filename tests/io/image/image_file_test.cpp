// SPDX-License-Identifier: BSD-3-Clause
#include "io/image/image_file.hpp"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>
#include <png.h>
#include <tiffio.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "colormaps/color_spaces.hpp"
#include "io/image/display_rows.hpp"
#include "io/image/image_formats.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using test::contents;
using test::expect_bad_input;
using test::fault_of;
using test::TemporaryFolder;

constexpr float inf = std::numeric_limits<float>::infinity();

/// Odd side lengths, every pixel different; some are empty.
scene::Image picture(int width = 37, int height = 21) {
  scene::Image image({width, height});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t i = image.index(x, y);
      if ((x + y) % 5 == 0) continue;
      const float a = static_cast<float>(x + 1) / static_cast<float>(width);
      image.rgba[4 * i] = a * static_cast<float>(y) / static_cast<float>(height);
      image.rgba[4 * i + 1] = a * 0.25f;
      image.rgba[4 * i + 2] = a * 1e-3f * static_cast<float>(x);
      image.rgba[4 * i + 3] = a;
      image.depth[i] = 1000.0f + static_cast<float>(i);
    }
  return image;
}

/// A .png as read by libpng: channels and bits as in the file, 16-bit numbers in native order.
struct Png {
  png_uint_32 width = 0, height = 0;
  int channels = 0, bits = 0, intent = -1;
  std::vector<unsigned> samples;
  [[nodiscard]] unsigned at(int x, int y, int k) const {
    return samples[(static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) *
                       static_cast<std::size_t>(channels) +
                   static_cast<std::size_t>(k)];
  }
};

Png read_png(const std::filesystem::path& file) {
  Png out;
  std::FILE* stream = std::fopen(file.c_str(), "rb");
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  if (setjmp(png_jmpbuf(png)) != 0) {
    ADD_FAILURE() << "libpng refuses " << file;
    return out;
  }
  png_init_io(png, stream);
  png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  out.width = png_get_image_width(png, info);
  out.height = png_get_image_height(png, info);
  out.channels = png_get_channels(png, info);
  out.bits = png_get_bit_depth(png, info);
  png_get_sRGB(png, info, &out.intent);
  png_bytepp rows = png_get_rows(png, info);
  for (png_uint_32 y = 0; y < out.height; ++y)
    for (png_uint_32 i = 0; i < out.width * static_cast<png_uint_32>(out.channels); ++i)
      out.samples.push_back(out.bits == 16 ? rows[y][2 * i] * 256u + rows[y][2 * i + 1] : rows[y][i]);
  png_destroy_read_struct(&png, &info, nullptr);
  std::fclose(stream);
  return out;
}

TEST(ImageFile, ExrKeepsEveryFloatAndDepth) {
  const TemporaryFolder folder;
  const scene::Image image = picture();
  write_image(image, folder / "a.exr", {});
  const scene::Image back = read_image(folder / "a.exr");
  EXPECT_EQ(back.size, image.size);
  EXPECT_EQ(back.rgba, image.rgba);
  EXPECT_EQ(back.depth, image.depth);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.exr"});
}

TEST(ImageFile, ExrInHalfRoundsColoursButNotDepth) {
  const TemporaryFolder folder;
  const scene::Image image = picture();
  write_image(image, folder / "a.EXR", {.half = true});
  const scene::Image back = read_image(folder / "a.EXR");
  EXPECT_EQ(back.depth, image.depth);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    EXPECT_NEAR(back.rgba[i], image.rgba[i], std::max(image.rgba[i] * 0x1p-11f, 0x1p-25f));  // rounding of half
  const Imf::InputFile file((folder / "a.EXR").c_str(), 0);
  EXPECT_EQ(file.header().channels().findChannel("R")->type, Imf::HALF);
  EXPECT_EQ(file.header().channels().findChannel("Z")->type, Imf::FLOAT);
}

TEST(ImageFile, HalfRefusesWhatItCannotHold) {
  const TemporaryFolder folder;
  scene::Image image = picture();
  image.rgba[4 * image.index(3, 2)] = 1e6f;
  expect_bad_input([&] { write_image(image, folder / "a.exr", {.half = true}); },
                   {"pixel (3, 2)", "write 32-bit floats"});
  EXPECT_TRUE(folder.names().empty());
  write_image(image, folder / "a.exr", {});
}

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(ImageFile, MemoryHoldsTheFilesBytes) {
  const TemporaryFolder folder;
  const scene::Image image = picture(301, 170);
  ImageFileOptions options;
  for (const bool half : {false, true})
    for (const int threads : {1, 3}) {
      options.half = half, options.threads = threads;
      write_image(image, folder / "a.exr", options);
      EXPECT_EQ(text_of(checked_exr_bytes(image, options)), contents(folder / "a.exr"));
    }
  write_image(image, folder / "a.png", options);
  EXPECT_EQ(text_of(checked_png_bytes(image, options)), contents(folder / "a.png"));
  if (!has_jpeg()) return;
  std::size_t last = 0;
  for (const int quality : {20, 60, 92}) {
    options.jpeg_quality = quality;
    write_image(image, folder / "a.jpg", options);
    const std::string bytes = text_of(checked_jpeg_bytes(image, options));
    EXPECT_EQ(bytes, contents(folder / "a.jpg"));
    EXPECT_GT(bytes.size(), last);
    last = bytes.size();
  }
}

TEST(ImageFile, MemoryRefusesWhatFilesDo) {
  scene::Image image = picture();
  if (has_jpeg())
    expect_bad_input([&] { checked_jpeg_bytes(image, {.jpeg_quality = 101}); },
                     {"image: the quality is 101, but must be 1 to 100"});
  image.rgba[4 * image.index(3, 2)] = 1e6f;
  expect_bad_input([&] { checked_exr_bytes(image, {.half = true}); }, {"image: pixel (3, 2)"});
  image.size.width = 0;
  expect_bad_input([&] { checked_exr_bytes(image, {}); }, {"size"});
}

TEST(ImageFile, PfmIsThreeFloatsFromTheBottomRowUp) {
  const TemporaryFolder folder;
  const scene::Image image = picture();
  write_image(image, folder / "a.pfm", {});
  const std::string bytes = contents(folder / "a.pfm"), header = "PF\n37 21\n-1.0\n";
  ASSERT_EQ(bytes.size(), header.size() + 37 * 21 * 12);
  EXPECT_EQ(bytes.substr(0, header.size()), header);
  float first[3];
  std::memcpy(first, bytes.data() + header.size(), sizeof(first));
  const std::size_t bottom_left = 4 * image.index(0, 20);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(first[k], image.rgba[bottom_left + k]);

  const scene::Image back = read_image(folder / "a.pfm");
  EXPECT_EQ(back.size, image.size);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) EXPECT_EQ(back.rgba[i], i % 4 == 3 ? 1 : image.rgba[i]);
}

TEST(ImageFile, PfmOfTheOtherByteOrderIsRead) {
  const TemporaryFolder folder;
  const auto file = folder.write("a.pfm", std::string("PF\n1 1\n1.0\n\x3f\x80\0\0\x40\0\0\0\xbf\x80\0\0", 23));
  const scene::Image image = read_image(file);
  EXPECT_EQ(image.rgba, (std::vector<float>{1, 2, -1, 1}));
}

TEST(ImageFile, PngHoldsStraightAlphaInSrgb) {
  const TemporaryFolder folder;
  const scene::Image image = picture();
  for (const int bits : {8, 16}) {
    write_image(image, folder / "a.png", {.png_bits = bits});
    const Png png = read_png(folder / "a.png");
    ASSERT_EQ(png.width, 37u);
    ASSERT_EQ(png.height, 21u);
    EXPECT_EQ(png.channels, 4);
    EXPECT_EQ(png.bits, bits);
    EXPECT_EQ(png.intent, PNG_sRGB_INTENT_PERCEPTUAL);
    const double full = bits == 8 ? 255 : 65535;
    for (int y = 0; y < 21; ++y)
      for (int x = 0; x < 37; ++x) {
        const float* in = &image.rgba[4 * image.index(x, y)];
        for (int k = 0; k < 3; ++k) {
          const double straight = in[3] > 0 ? in[k] / static_cast<double>(in[3]) : 0;
          EXPECT_EQ(png.at(x, y, k), std::lround(colormaps::encode_srgb(straight) * full)) << x << ' ' << y;
        }
        EXPECT_EQ(png.at(x, y, 3), std::lround(in[3] * full));
      }
  }
}

TEST(ImageFile, PngOfManyStripsHasTheSameBytesOnAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const scene::Image image = picture(700, 900);  // 2.5 MB of rows, about ten strips
  for (const int bits : {8, 16}) {
    write_image(image, folder / "one.png", {.png_bits = bits, .threads = 1});
    for (const int threads : {2, 3, 0}) {
      write_image(image, folder / "many.png", {.png_bits = bits, .threads = threads});
      EXPECT_EQ(contents(folder / "many.png"), contents(folder / "one.png")) << threads;
    }
    const Png png = read_png(folder / "one.png");
    ASSERT_EQ(png.samples.size(), image.rgba.size());
    for (std::size_t i = 3; i < image.rgba.size(); i += 4)
      ASSERT_EQ(png.samples[i], std::lround(image.rgba[i] * (bits == 8 ? 255.0 : 65535.0))) << i / 4;
  }
}

TEST(ImageFile, TiffHoldsWhatPngHolds) {
  if (!has_tiff()) GTEST_SKIP() << "built without libtiff";
  const TemporaryFolder folder;
  const scene::Image image = picture(700, 301);
  for (const int bits : {8, 16})
    for (const bool opaque : {false, true}) {
      ImageFileOptions options{.png_bits = bits};
      if (opaque) options.background = glm::dvec3(0.1, 0.5, 0.9);
      write_image(image, folder / "a.png", options);
      write_image(image, folder / "a.tif", options);
      const Png png = read_png(folder / "a.png");
      TIFF* const tiff = TIFFOpen((folder / "a.tif").c_str(), "r");
      ASSERT_NE(tiff, nullptr);
      std::uint32_t width = 0, height = 0;
      std::uint16_t channels = 0, bits_there = 0, count = 0, *extra = nullptr;
      TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
      TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
      TIFFGetField(tiff, TIFFTAG_SAMPLESPERPIXEL, &channels);
      TIFFGetField(tiff, TIFFTAG_BITSPERSAMPLE, &bits_there);
      ASSERT_EQ(width, png.width);
      ASSERT_EQ(height, png.height);
      ASSERT_EQ(channels, png.channels);
      ASSERT_EQ(bits_there, bits);
      if (!opaque) {
        ASSERT_EQ(TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &count, &extra), 1);
        EXPECT_EQ(*extra, EXTRASAMPLE_UNASSALPHA);
      }
      std::vector<unsigned char> row(static_cast<std::size_t>(TIFFScanlineSize(tiff)));
      for (std::uint32_t y = 0; y < height; ++y) {
        ASSERT_EQ(TIFFReadScanline(tiff, row.data(), y), 1) << y;
        for (std::size_t i = 0; i < std::size_t{width} * channels; ++i) {
          std::uint16_t sample = row[bits == 8 ? i : 0];
          if (bits == 16) std::memcpy(&sample, row.data() + 2 * i, 2);
          ASSERT_EQ(sample, png.samples[y * std::size_t{width} * channels + i]) << y << ' ' << i;
        }
      }
      TIFFClose(tiff);
    }
}

TEST(ImageFile, APngInMemoryEqualsTheFile) {
  const TemporaryFolder folder;
  write_image(picture(), folder / "a.png", {});
  const std::vector<std::byte> bytes = checked_png_bytes(picture(), {});
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), contents(folder / "a.png"));
}

TEST(ImageFile, JpegIsOnBlackUnlessThereIsABackground) {
  if (!has_jpeg()) GTEST_SKIP() << "built without libjpeg";
  const TemporaryFolder folder;
  scene::Image image({16, 16});
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) image.rgba[i] = 0.2f, image.rgba[i + 3] = 0.4f;
  // Checking the colours would need a decoder. A flat colour is stored as its first coefficient, so files of different
  // colours differ.
  write_image(image, folder / "black.jpg", {});
  write_image(image, folder / "background.jpg", {.background = glm::dvec3(0)});
  write_image(image, folder / "white.jpg", {.background = glm::dvec3(1)});
  EXPECT_EQ(contents(folder / "black.jpg"), contents(folder / "background.jpg"));
  EXPECT_NE(contents(folder / "black.jpg"), contents(folder / "white.jpg"));
  EXPECT_TRUE(contents(folder / "white.jpg").starts_with("\xff\xd8\xff"));
}

TEST(ImageFile, ExrHasTheSameBytesOnAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const scene::Image image = picture(300, 203);
  write_image(image, folder / "one.exr", {.threads = 1});
  write_image(image, folder / "many.exr", {.threads = 3});
  EXPECT_EQ(contents(folder / "many.exr"), contents(folder / "one.exr"));
  EXPECT_EQ(read_image(folder / "many.exr").rgba, image.rgba);
}

TEST(ImageFile, DisplayCodesAreTheFormulas) {
  const auto formula = [](double linear) { return std::lround(255 * colormaps::encode_srgb(linear)); };
  for (int i = 0; i <= 1'000'000; ++i) ASSERT_EQ(srgb_code(i * 1e-6), formula(i * 1e-6)) << i;
  // Values at the boundaries between codes, where a table would be wrong first.
  for (int code = 0; code < 255; ++code) {
    double edge = colormaps::decode_srgb((code + 0.5) / 255);
    for (int i = 0; i < 20; ++i) edge = std::nextafter(edge, 0.0);
    for (int i = 0; i < 40; ++i, edge = std::nextafter(edge, 1.0)) ASSERT_EQ(srgb_code(edge), formula(edge)) << code;
  }
  EXPECT_EQ(srgb_code(-1), 0);
  EXPECT_EQ(srgb_code(2), 255);
}

TEST(ImageFile, DisplayColoursAreNotEncodedAgain) {
  const TemporaryFolder folder;
  scene::Image image({1, 1});
  image.rgba = {0.25f, 0.5f, 0, 0.5f};
  write_image(image, folder / "a.png", {.encode_srgb = false});
  const Png png = read_png(folder / "a.png");
  EXPECT_EQ(png.samples, (std::vector<unsigned>{128, 255, 0, 128}));
}

TEST(ImageFile, BackgroundIsCompositedOnRequestInEveryFormat) {
  const TemporaryFolder folder;
  scene::Image image({2, 1});
  image.rgba = {0.25f, 0, 0, 0.75f, 0, 0, 0, 0};
  const ImageFileOptions options{.background = glm::dvec3(1, 0.5, 0)};
  const std::vector<float> expected{0.5f, 0.125f, 0, 1, 1, 0.5f, 0, 1};
  for (const char* name : {"a.exr", "a.pfm"}) {
    write_image(image, folder / name, options);
    EXPECT_EQ(read_image(folder / name).rgba, expected) << name;
  }
  EXPECT_EQ(read_image(folder / "a.exr").depth[1], inf);
  write_image(image, folder / "a.png", options);
  const Png png = read_png(folder / "a.png");
  EXPECT_EQ(png.channels, 3);
  EXPECT_EQ(png.at(1, 0, 1), std::lround(colormaps::encode_srgb(0.5) * 255));
  EXPECT_EQ(png.at(0, 0, 0), std::lround(colormaps::encode_srgb(0.5) * 255));
}

TEST(ImageFile, LightBeyondAlphaIsClampedInPng) {
  const TemporaryFolder folder;
  scene::Image image({2, 1});
  image.rgba = {3, 0.1f, 0, 0.5f, 1, 1, 1, 0};
  write_image(image, folder / "a.png", {});
  const Png png = read_png(folder / "a.png");
  EXPECT_EQ(png.at(0, 0, 0), 255u);
  EXPECT_EQ(png.at(1, 0, 3), 0u);
}

TEST(ImageFile, NeverWritesNaNSilently) {
  const TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const std::string name : {"a.exr", "a.png", "a.tif", "a.pfm"}) {
    if (name == "a.tif" && !has_tiff()) continue;
    for (const float broken : {nan, inf, -inf}) {
      scene::Image image = picture();
      image.rgba[4 * image.index(7, 20) + 1] = broken;
      const auto fault = fault_of([&] { write_image(image, folder / name, {}); });
      EXPECT_EQ(fault.code, scene::ErrorCode::system_failure) << name;
      EXPECT_NE(fault.message.find("pixel (7, 20)"), std::string::npos) << fault.message;
    }
    scene::Image image = picture();
    image.depth[image.index(1, 2)] = nan;
    EXPECT_EQ(fault_of([&] { write_image(image, folder / name, {}); }).code, scene::ErrorCode::system_failure);
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(ImageFile, PathsAreCheckedBeforeRendering) {
  const TemporaryFolder folder;
  check_image_path(folder / "a.exr");
  check_image_path(folder / "a.Png");
  EXPECT_TRUE(folder.names().empty());
  expect_bad_input([&] { check_image_path(folder / "a.bmp"); }, {"a.bmp: ", ".exr, .png, .jpg, .tif or .pfm"});
  expect_bad_input([&] { check_image_path(folder / "exr"); }, {".exr, .png, .jpg, .tif or .pfm"});
  expect_bad_input([&] { check_image_path(folder / "none/a.exr"); }, {"none/a.exr: ", "make the directory first"});
  std::filesystem::create_directory(folder / "b.exr");
  expect_bad_input([&] { check_image_path(folder / "b.exr"); }, {"name a file, not a directory"});
  expect_bad_input([&] { check_image_path("/proc/a.exr"); }, {"/proc/a.exr: "});
}

TEST(ImageFile, RefusesSettingsThatMakeNoFile) {
  const TemporaryFolder folder;
  expect_bad_input([&] { write_image(picture(), folder / "a.png", {.png_bits = 12}); }, {"12 bits", "8 or 16"});
  expect_bad_input([&] { write_image(picture(), folder / "a.bmp", {}); }, {".exr, .png, .jpg, .tif or .pfm"});
  expect_bad_input([&] { write_image(scene::Image{}, folder / "a.png", {}); }, {"image size 0x0"});
  expect_bad_input([&] { write_image(picture(), folder / "a.png", {.background = glm::dvec3(-1, 0, 0)}); },
                   {"background -1"});
  EXPECT_TRUE(folder.names().empty());
}

TEST(ImageFile, RefusesBrokenFilesWhenReading) {
  const TemporaryFolder folder;
  write_image(picture(), folder / "good.exr", {});
  const std::string good = contents(folder / "good.exr");
  expect_bad_input([&] { read_image(folder.write("cut.exr", good.substr(0, good.size() / 2))); }, {"cut.exr: "});
  expect_bad_input([&] { read_image(folder.write("text.exr", "hello")); }, {"text.exr: "});
  expect_bad_input([&] { read_image(folder.write("empty.exr", "")); }, {"empty.exr: "});
  expect_bad_input([&] { read_image(folder / "none.exr"); }, {"no such file"});
  expect_bad_input([&] { read_image(folder.write("a.png", "")); }, {"a.png: ", "give an .exr or a .pfm"});
  for (const char* text : {"", "P6\n1 1\n-1\n", "PF\n", "PF\n0 1\n-1\n", "PF\n1 1e9\n-1\n", "PF\n1.5 1\n-1\n",
                           "PF\n1 1\n0\n", "PF\n1 1\n-1\nabc", "PF\n65536 65536\n-1\n", "PF\nnan nan\nnan\n"})
    expect_bad_input([&] { read_image(folder.write("bad.pfm", text)); }, {"bad.pfm: "});
}

TEST(ImageFile, OnePixelAndOneRowWork) {
  const TemporaryFolder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1000, 1}, std::pair{1, 1000}, std::pair{16, 16}}) {
    const scene::Image image = picture(width, height);
    write_image(image, folder / "a.exr", {});
    EXPECT_EQ(read_image(folder / "a.exr").rgba, image.rgba);
    write_image(image, folder / "a.png", {});
    EXPECT_EQ(read_png(folder / "a.png").samples.size(), image.rgba.size());
  }
}

}  // namespace
}  // namespace tessera::io
