// SPDX-License-Identifier: BSD-3-Clause
#include "api/options/argument_values.hpp"

#include <gtest/gtest.h>

#include "tessera/error.hpp"
#include "tessera/time_series.hpp"

namespace tessera::api {
namespace {

TEST(ArgumentValues, SizesInMemoryTakePowersOf1024) {
  EXPECT_EQ(parse_bytes("--memory", "1M"), 1ull << 20);
  EXPECT_EQ(parse_bytes("--memory", "2G"), 2ull << 30);
  EXPECT_EQ(parse_bytes("--memory", "2GB"), 2ull << 30);
  EXPECT_EQ(parse_bytes("--memory", "2GiB"), 2ull << 30);
  EXPECT_EQ(parse_bytes("--memory", "1.5G"), 3ull << 29);
  EXPECT_EQ(parse_bytes("--memory", "2097152"), 2ull << 20);
  for (const char* text : {"", "G", "-1G", "1X", "1k", "1 G", "1e30", "nan", "1023K"})
    EXPECT_THROW(parse_bytes("--memory", text), Error) << text;
}

TEST(ArgumentValues, ColorsAreNamesOrThreeNumbers) {
  EXPECT_EQ(parse_color("--background", "white"), glm::dvec3(1));
  EXPECT_EQ(parse_color("--background", "0.25,0,2"), glm::dvec3(0.25, 0, 2));
  // CSS's green is half of lime in sRGB.
  EXPECT_EQ(parse_color("--background", "lime"), glm::dvec3(0, 1, 0));
  EXPECT_EQ(parse_color("--background", "green"), parse_color("--background", "#008000"));
  EXPECT_EQ(parse_color("--background", "steelblue"), parse_color("--background", "#4682B4"));
  EXPECT_EQ(parse_color("--background", "#48b"), parse_color("--background", "#4488bb"));
  EXPECT_NEAR(parse_color("--background", "gray")[1], 0.215861, 1e-6);  // 128 / 255 by IEC 61966-2-1
  for (const char* text : {"#", "#12", "#1234", "#12345", "#1234567", "#12345g", "#+12345", "steelblues", "rgb"})
    EXPECT_THROW(parse_color("--background", text), Error) << text;
  for (const char* text : {"", "1", "1,2", "1,2,3,4", "1,,2", "1,2,", "inf,0,0", "1,2,x", "-0.1,0,0", "White"})
    EXPECT_THROW(parse_color("--background", text), Error) << text;
}

TEST(ArgumentValues, SizesAreTwoWholeNumbers) {
  EXPECT_EQ(parse_size("--size", "640x480"), (ImageSize{640, 480}));
  for (const char* text : {"640", "640x", "x480", "640X480", "640x480x3", "6.4x4", "-1x1", "0x1", "65537x1", " 1x1"})
    EXPECT_THROW(parse_size("--size", text), Error) << text;
}

TEST(FrameNames, OneNumberPatternIsReplacedAndOtherPercentSignsStay) {
  const auto name = [](const char* pattern, int number) { return numbered_name(pattern, number).value_or("none"); };
  EXPECT_EQ(name("f_%04d.exr", 7), "f_0007.exr");
  EXPECT_EQ(name("%d.exr", 123), "123.exr");
  EXPECT_EQ(name("f_%04d.exr", 12345), "f_12345.exr");
  EXPECT_EQ(name("100%/f%02d.exr", 3), "100%/f03.exr");
  EXPECT_EQ(name("%d_%d.exr", 3), "3_%d.exr");
  EXPECT_EQ(name("50%.png", 3), "none");
  EXPECT_EQ(name("%s%n%5d%.png", 3), "none");
  EXPECT_EQ(name("a%", 3), "none");
  EXPECT_EQ(name("a%0", 3), "none");
}

}  // namespace
}  // namespace tessera::api
