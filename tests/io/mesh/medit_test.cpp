// SPDX-License-Identifier: BSD-3-Clause
// Medit meshes, binary and text, written according to libMeshb's documentation.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io::medit_test {
namespace {

/// Writes one version in one byte order.
class Writer {
 public:
  Writer(int version, bool is_big) : version_(version), is_big_(is_big) {
    put(std::int32_t{1}), put(std::int32_t{version});
    begin(3);
    put(std::int32_t{3});
  }

  void points(const std::vector<glm::dvec3>& points) {
    begin(4);
    whole(static_cast<std::int64_t>(points.size()));
    for (const glm::dvec3& p : points) {
      for (int a = 0; a < 3; ++a) version_ == 1 ? put(static_cast<float>(p[a])) : put(p[a]);
      whole(0);
    }
  }

  /// Cells of one kind. Each has its nodes, numbered from 1, and a reference.
  void cells(int code, const std::vector<std::vector<std::int64_t>>& cells) {
    begin(code);
    whole(static_cast<std::int64_t>(cells.size()));
    for (const auto& cell : cells)
      for (const std::int64_t number : cell) whole(number);
  }

  std::string text() {
    end_keyword();
    put(std::int32_t{54});
    place(0);
    return text_;
  }

 private:
  void begin(int code) {
    end_keyword();
    put(std::int32_t{code});
    place_at_ = text_.size();
    place(0);
  }
  void end_keyword() {
    if (place_at_ == 0) return;
    const std::size_t end = text_.size();
    const std::string rest = text_.substr(place_at_ + (version_ >= 3 ? 8 : 4));
    text_.resize(place_at_);
    place(static_cast<std::int64_t>(end));
    text_ += rest;
    place_at_ = 0;
  }
  void place(std::int64_t at) { version_ >= 3 ? put(at) : put(static_cast<std::int32_t>(at)); }
  void whole(std::int64_t number) { version_ >= 4 ? put(number) : put(static_cast<std::int32_t>(number)); }

  template <class T>
  void put(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof value);
    if (is_big_) std::ranges::reverse(bytes);
    text_.append(bytes, sizeof bytes);
  }

  int version_;
  bool is_big_;
  std::string text_;
  std::size_t place_at_ = 0;
};

/// A cube with a pyramid on top and a prism and a tetrahedron next to it.
std::string tower(int version, bool is_big) {
  Writer file(version, is_big);
  file.points({{0, 0, 0},
               {1, 0, 0},
               {1, 1, 0},
               {0, 1, 0},
               {0, 0, 1},
               {1, 0, 1},
               {1, 1, 1},
               {0, 1, 1},
               {0.5, 0.5, 4},
               {2, 0, 0},
               {2, 0, 1},
               {0, 0, -3}});
  file.cells(6, {{1, 2, 3, 9}});  // a triangle
  file.cells(8, {{1, 2, 4, 12, 5}});
  file.cells(9, {{2, 10, 3, 6, 11, 7, 5}});
  file.cells(10, {{1, 2, 3, 4, 5, 6, 7, 8, 5}});
  file.cells(49, {{5, 6, 7, 8, 9, 2}});
  return file.text();
}

TEST(MeditBinary, EveryVersionAndByteOrderIsTheSameMesh) {
  const test::TemporaryFolder folder;
  for (const int version : {1, 2, 3, 4})
    for (const bool is_big : {false, true})
      for (const char* name : {"a.meshb", "a.dat"}) {
        SCOPED_TRACE(fmt::format("{} {} {}", version, is_big, name));
        const auto file = folder.write(name, tower(version, is_big));
        const cells::MeshFile read = read_mesh(file);
        EXPECT_EQ(read.format, "Medit, binary");
        EXPECT_EQ(read.counts.cells_read, 4u);
        EXPECT_NEAR(testing::volume(read.mesh), 1 + 1 + 0.5 + 0.5, 1e-12);
        EXPECT_EQ(read.blocks, (std::vector<std::string>{"reference 2", "reference 5"}));
        EXPECT_EQ(read.mesh.field_name, "Reference");
        for (std::size_t t = 0; t < read.mesh.tets.size(); ++t) {
          const bool is_top =
              std::ranges::any_of(read.mesh.tets[t], [&](std::uint32_t v) { return read.mesh.positions[v].z > 2; });
          EXPECT_EQ(read.mesh.scalars[t], is_top ? 2 : 5);
        }
        ReadOptions options;
        options.blocks = {"reference 2"};
        EXPECT_NEAR(testing::volume(read_mesh(file, options).mesh), 1, 1e-12);
      }
}

TEST(MeditBinary, TetrahedraOfSecondOrderAreCurved) {
  const test::TemporaryFolder folder;
  Writer file(2, false);
  file.points({{0, 0, 0},
               {1, 0, 0},
               {0, 1, 0},
               {0, 0, 1},
               {0.5, 0, 0},
               {0.5, 0.5, 0},
               {0, 0.5, 0},
               {0, 0, 0.5},
               {0.5, 0, 0.5},
               {0, 0.5, 0.5}});
  file.cells(30, {{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 0}});
  const cells::MeshFile read = read_mesh(folder.write("a.meshb", file.text()));
  EXPECT_NEAR(testing::volume(read.mesh), 1.0 / 6, 1e-12);
  EXPECT_EQ(read.counts.cells_tangled, 0u);
}

TEST(MeditBinary, FaultsAreNamedWithTheirPlace) {
  const test::TemporaryFolder folder;
  const auto refuse = [&](const std::string& text, const std::vector<std::string>& parts) {
    test::expect_bad_input([&] { read_mesh(folder.write("a.meshb", text)); }, parts);
  };
  const std::string whole = tower(4, false);
  for (std::size_t length = 8; length + 20 < whole.size(); length += 13) refuse(whole.substr(0, length), {"a.meshb"});
  Writer curved(3, false);
  curved.points({{0, 0, 0}});
  curved.cells(33, {std::vector<std::int64_t>(28, 1)});
  refuse(curved.text(), {"hexahedra of order 2", "not supported"});
  Writer wild(2, false);
  wild.points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  wild.cells(8, {{1, 2, 3, 5, 0}});
  refuse(wild.text(), {"a cell uses point 5, but the file has only 4"});
  Writer flat(2, false);
  flat.points({{0, 0, 0}});
  refuse(flat.text(), {"no cells of volume"});
  std::string long_list = tower(1, false);
  long_list[28] = '\x7f';  // the number of points
  refuse(long_list, {"byte 20", "more than a file of this size can contain"});
}

/// Two tetrahedra with the references 7 and 8, on both sides of a triangle, with `gap` after each word.
std::string two_tets(const std::string& gap) {
  std::string text;
  for (const char* word : {"MeshVersionFormatted", "2", "Dimension", "3", "Vertices", "5"})
    text.append(word).append(gap);
  for (const char* word : {"0", "0", "0", "1", "1", "0", "0", "1", "0", "1.", "+0", "1", "0", "0", "1e0", "1"})
    text.append(word).append(gap);
  for (const char* word : {"0", "0", "-1", "1", "Tangents", "2", "0.5", "0.5", "0", "-1", "0", "0"})
    text.append(word).append(gap);
  for (const char* word : {"Tetrahedra", "2", "1", "2", "3", "4", "7", "1", "2", "3", "5", "8", "RequiredVertices"})
    text.append(word).append(gap);
  for (const char* word : {"1", "3", "End"}) text.append(word).append(gap);
  return text;
}

TEST(MeditText, LinesAndCommentsPartWordsAsBlanksDo) {
  const test::TemporaryFolder folder;
  for (const std::string gap : {"\n", " ", "\t\r\n\r\n", " # of 9 cells\n  \n"}) {
    SCOPED_TRACE(gap);
    const cells::MeshFile read = read_mesh(folder.write("a.mesh", two_tets(gap)));
    EXPECT_EQ(read.format, "Medit");
    EXPECT_EQ(read.counts.cells_read, 2u);
    EXPECT_NEAR(testing::volume(read.mesh), 2.0 / 6, 1e-12);
    EXPECT_EQ(read.blocks, (std::vector<std::string>{"reference 7", "reference 8"}));
  }
  // With any name.
  EXPECT_EQ(read_mesh(folder.write("a.dat", "\n" + two_tets("\n"))).counts.cells_read, 2u);
}

TEST(MeditText, AllCellsOfFirstOrderAreRead) {
  const test::TemporaryFolder folder;
  const std::string text =
      "MeshVersionFormatted 1\nDimension\n3\nVertices\n12\n0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 0 0\n0 0 1 0\n1 0 1 0\n1 1 1 "
      "0\n0 1 1 0\n.5 .5 4 0\n0 0 -1 0\n1 0 -1 0\n0 1 -1 0\nTriangles 1\n1 2 3 4\nHexahedra 1\n1 2 3 4 5 6 7 8 0\n"
      "Pyramids 1\n5 6 7 8 9 0\nPrisms 1\n10 11 12 1 2 4 0\nEnd\n";
  EXPECT_NEAR(testing::volume(read_mesh(folder.write("a.mesh", text)).mesh), 1 + 1 + 0.5, 1e-12);
}

TEST(MeditText, FaultsAreNamedWithTheirLine) {
  const test::TemporaryFolder folder;
  const std::string whole = two_tets("\n");
  const auto refuse = [&](const std::string& from, const std::string& to, const std::vector<std::string>& parts) {
    std::string text = whole;
    text.replace(text.find(from), from.size(), to);
    test::expect_bad_input([&] { read_mesh(folder.write("a.mesh", text)); }, parts);
  };
  for (std::size_t length = 30; length + 30 < whole.size(); length += 7)
    test::expect_bad_input([&] { read_mesh(folder.write("a.mesh", whole.substr(0, length))); }, {"a.mesh"});
  refuse("Dimension\n3", "Dimension\n2", {"it has 2 dimensions"});
  refuse("Tetrahedra\n2", "Tetrahedra\n900", {"line 36", "more than a file of this size can contain"});
  refuse("5\n8", "6\n8", {"a cell uses point 6, but the file has only 5"});
  refuse("5\n8", "x\n8", {"'x' is not a point of a cell"});
  for (const std::string word : {"HexahedraQ2", "TetrahedraP3", "TetrahedraP2Ordering", "Prisms9", "PolyhedraHeaders"})
    refuse("Tetrahedra", word, {fmt::format("its {} are not supported", word)});
  refuse("Tetrahedra", "Triangles", {"no cells of volume"});
  // Numbers remain: the count is too small, or cells have more nodes than their keyword allows.
  refuse("Tetrahedra\n2", "Tetrahedra\n1", {"follows the last of the Tetrahedra"});
  refuse("Vertices\n5", "Vertices\n4", {"follows the last of the Vertices"});
}

}  // namespace
}  // namespace tessera::io::medit_test
