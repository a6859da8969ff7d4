// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/ply_file.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

const std::string header =
    "element vertex 4\nproperty float x\nproperty float y\nproperty double z\nproperty uchar red\nproperty short heat\n"
    "element face 2\nproperty list uchar int vertex_indices\nproperty uchar flag\nend_header\n";
const std::string ascii = "ply\nformat ascii 1.0\ncomment made by hand\n" + header +
                          "0 0 0 9 -1\n1 0 0 9 2\n0 1 0 9 3\n0 0 1.5 9 4\n3 0 1 2 7\n4 0 1 2 3 7\n";

/// The same surface in binary.
std::string binary(bool big_endian) {
  std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") + "_endian 1.0\n" + header;
  const auto put = [&](auto value) {
    std::string raw(sizeof value, '\0');
    std::memcpy(raw.data(), &value, sizeof value);
    if (big_endian) std::reverse(raw.begin(), raw.end());
    bytes += raw;
  };
  const float xy[4][2] = {{0, 0}, {1, 0}, {0, 1}, {0, 0}};
  const std::int16_t heat[4] = {-1, 2, 3, 4};
  for (int v = 0; v < 4; ++v) {
    put(xy[v][0]);
    put(xy[v][1]);
    put(v == 3 ? 1.5 : 0.0);
    put(std::uint8_t{9});
    put(heat[v]);
  }
  for (const int corners : {3, 4}) {
    put(static_cast<std::uint8_t>(corners));
    for (std::int32_t v = 0; v < corners; ++v) put(v);
    put(std::uint8_t{7});
  }
  return bytes;
}

TEST(PlyFile, AsciiAndEitherByteOrderAreTheSame) {
  for (const std::string& text : {ascii, binary(false), binary(true)}) {
    const PlySurface ply = parse_ply(text, "s.ply");
    EXPECT_EQ(ply.surface.points, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.5}}));
    ASSERT_EQ(ply.surface.facets.size(), 2u);
    EXPECT_EQ(ply.surface.facets[1].polygons, (std::vector<cells::Polygon>{{0, 1, 2, 3}}));
    EXPECT_EQ(ply.attribute_names, std::vector<std::string>{"heat"});  // a colour is not a quantity
    EXPECT_EQ(ply.surface.attributes, (std::vector<std::vector<double>>{{-1, 2, 3, 4}}));
  }
}

TEST(PlyFile, EveryTruncationIsRefused) {
  for (const std::string& text : {ascii, binary(false)})
    for (std::size_t size = 0; size + 3 < text.size(); ++size)
      test::expect_bad_input([&] { parse_ply(text.substr(0, size), "s.ply"); }, {"s.ply: "});
}

TEST(PlyFile, ReportsWrongCountsTypesAndIndices) {
  const auto expect = [](const std::string& from, const std::string& to, const std::string& part) {
    std::string text = ascii;
    ASSERT_NE(text.find(from), std::string::npos);
    text.replace(text.find(from), from.size(), to);
    test::expect_bad_input([&] { parse_ply(text, "s.ply"); }, {"s.ply: ", part});
  };
  expect("vertex 4", "vertex 99999999999", "its header states '99999999999'");
  expect("vertex 4", "vertex -4", "its header states '-4'");
  expect("vertex 4", "vertex 5", "ends before");  // the faces' numbers are interpreted as a vertex
  expect("face 2", "face 3", "ends before");
  expect("3 0 1 2 7", "3 0 1 4 7", "face 0 uses vertex 4");
  expect("3 0 1 2 7", "3 0 1 -2 7", "face 0 uses vertex -2");
  expect("3 0 1 2 7", "-3 0 1 2 7", "has the impossible length -3");
  expect("3 0 1 2 7", "3000000 0 1 2 7", "has the impossible length 3000000");
  expect("property float x", "property quad x", "unknown type");
  const std::string long_name(100'000, 'a');
  expect("element vertex 4\n", "element " + long_name + " 4\nproperty quad w\n", "unknown type");
  expect("element vertex 4\n", "element " + long_name + " -4\n", "its header states '-4'");
  expect("property float x", "property float a", "no x, y and z");
  expect("vertex_indices", "corners", "no vertex_indices");
  expect("format ascii 1.0", "format text 1.0", "its format is 'text'");
  expect("ply\n", "PLY\n", "begin with 'ply'");
  expect("element face 2", "element vertex 1\nproperty char x\nproperty char y\nproperty char z\nelement face 2",
         "two lists of vertices");
}

}  // namespace
}  // namespace tessera::io
