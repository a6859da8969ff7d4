// EnSight's variable files that end too early are named, and their fields left out; whole ones of any layout are read.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "io/mesh_assembly.hpp"
#include "io/mesh_checks.hpp"
#include "io/mesh_reader.hpp"
#include "io/temporary_folder.hpp"
#include "io/vtk_or_skip.hpp"

namespace tessera::io::ensight_values_test {
namespace {

using testing::message_of;

enum class Layout : std::uint8_t { gold_text, gold_binary, six_text, six_binary };
constexpr Layout layouts[] = {Layout::gold_text, Layout::gold_binary, Layout::six_text, Layout::six_binary};

/// What such a file has one after the other.
class Content {
 public:
  explicit Content(Layout layout)
      : is_gold(layout == Layout::gold_text || layout == Layout::gold_binary),
        is_binary(layout == Layout::gold_binary || layout == Layout::six_binary) {}

  Content& line(std::string words) {
    if (is_binary) words.resize(80);
    text += words + (is_binary ? "" : "\n");
    return *this;
  }
  Content& part(int number) { return is_gold ? line("part").whole({number}) : line(fmt::format("part {}", number)); }
  Content& whole(const std::vector<int>& numbers) {
    for (const int number : numbers) {
      if (is_binary)
        text.append(reinterpret_cast<const char*>(&number), sizeof number);
      else
        text += is_gold ? fmt::format("{:10}", number) : fmt::format("{:8}", number);
    }
    if (!is_binary) text += "\n";
    return *this;
  }
  Content& real(const std::vector<float>& numbers, std::size_t in_line = 6) {
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const bool ends = is_gold || (k + 1) % in_line == 0 || k + 1 == numbers.size();
      if (is_binary)
        text.append(reinterpret_cast<const char*>(&numbers[k]), sizeof(float));
      else
        text += fmt::format("{:12.5e}{}", numbers[k], ends ? "\n" : "");
    }
    return *this;
  }

  bool is_gold, is_binary;
  std::string text;
};

/// Two parts, each of one tetrahedron of nodes of its own: `f` of nodes is 0 to 7, `v` a vector, `g` of cells 10
/// and 20.
class EnsightValues : public ::testing::Test {
 protected:
  void write_case(Layout layout) {
    const std::vector<float> x = {0, 1, 0, 0, 2, 3, 2, 2}, y = {0, 0, 1, 0, 0, 0, 1, 0}, z = {0, 0, 0, 1, 0, 0, 0, 1};
    Content geometry(layout), f(layout), v(layout), g(layout);
    const bool is_gold = geometry.is_gold;
    folder.write("a.case", fmt::format("FORMAT\ntype: ensight{}\nGEOMETRY\nmodel: a.geo\nVARIABLE\nscalar per node: f "
                                       "a.f\nvector per node: v a.v\nscalar per element: g a.g\n",
                                       is_gold ? " gold" : ""));
    if (geometry.is_binary) geometry.line("C Binary");
    geometry.line("made").line("here").line("node id off").line("element id off");
    f.line("f"), v.line("v"), g.line("g");
    const auto some = [](const std::vector<float>& all, std::size_t first) {
      return std::vector<float>(all.begin() + static_cast<long>(first), all.begin() + static_cast<long>(first) + 4);
    };
    if (!is_gold) {
      std::vector<float> points;
      for (std::size_t k = 0; k < 8; ++k) points.insert(points.end(), {x[k], y[k], z[k]});
      std::vector<float> values = {0, 1, 2, 3, 4, 5, 6, 7};
      // VTK's reader wants 80 bytes after the description of a binary file: nodes that no cell has.
      points.resize(points.size() + 3 * 16), values.resize(24);
      geometry.line("coordinates").whole({24}).real(points, 3);
      f.real(values), v.real(points);
    }
    for (const int part : {1, 2}) {
      const std::size_t first = part == 1 ? 0 : 4;
      const int node = is_gold ? 1 : static_cast<int>(first) + 1;
      geometry.part(part).line(fmt::format("p{}", part));
      if (is_gold) {
        geometry.line("coordinates").whole({4}).real(some(x, first)).real(some(y, first)).real(some(z, first));
        const auto start = static_cast<float>(first);
        f.part(part).line("coordinates").real({start, start + 1, start + 2, start + 3});
        v.part(part).line("coordinates").real(some(x, first)).real(some(y, first)).real(some(z, first));
      }
      geometry.line("tetra4").whole({1}).whole({node, node + 1, node + 2, node + 3});
      g.part(part).line("tetra4").real({static_cast<float>(10 * part)});
    }
    folder.write("a.geo", geometry.text);
    folder.write("a.f", f.text);
    folder.write("a.v", v.text);
    folder.write("a.g", g.text);
  }

  /// Its last bytes are gone.
  void cut(const std::string& name, std::size_t bytes) const {
    const auto file = folder.path() / name;
    std::filesystem::resize_file(file, std::filesystem::file_size(file) - bytes);
  }

  MeshFile read(const std::string& field = "") const {
    MeshOptions options;
    options.field = field;
    return read_mesh(folder.path() / "a.case", options);
  }

  static std::vector<std::string> left_out(const MeshFile& file) {
    std::vector<std::string> notes = file.notes;
    std::erase_if(notes, [](const std::string& note) { return note.find("is left out") == std::string::npos; });
    return notes;
  }

  test::TemporaryFolder folder;
};

TEST_F(EnsightValues, WholeFilesAreRead) {
  TESSERA_VTK_OR_SKIP();
  for (const Layout layout : layouts) {
    SCOPED_TRACE(static_cast<int>(layout));
    write_case(layout);
    for (const char* field : {"f", "v", "g"}) EXPECT_TRUE(left_out(read(field)).empty()) << field;
    const MeshFile f = read("f");
    EXPECT_EQ(*std::ranges::max_element(f.mesh.scalars), 7);
    EXPECT_EQ(read("g").mesh.scalars.back(), 20);
  }
}

TEST_F(EnsightValues, OnesThatEndInsideTheirNumbersAreLeftOutByName) {
  TESSERA_VTK_OR_SKIP();
  for (const Layout layout : layouts) {
    SCOPED_TRACE(static_cast<int>(layout));
    const Content content(layout);
    const std::size_t number = content.is_binary ? 4 : 13;
    const std::string nodes = content.is_gold ? "part 2" : "the nodes";
    for (const auto& [name, variable, place] : {std::tuple("a.f", "f", nodes), std::tuple("a.v", "v", nodes),
                                                std::tuple("a.g", "g", std::string("part 2"))}) {
      write_case(layout);
      cut(name, number);
      const std::vector<std::string> notes = left_out(read());
      ASSERT_EQ(notes.size(), 1u) << name;
      EXPECT_NE(notes[0].find(fmt::format("{} is left out: {} is truncated, it ends inside {}", variable, name, place)),
                std::string::npos)
          << notes[0];
      const std::string message = message_of([&, field = variable] { read(field); });
      EXPECT_NE(message.find(fmt::format("is in {}, which ends inside {}; copy it there again", name, place)),
                std::string::npos)
          << message;
    }
  }
}

TEST_F(EnsightValues, WhatGoldFilesMayLeaveOutIsNotMissed) {
  TESSERA_VTK_OR_SKIP();
  for (const Layout layout : {Layout::gold_text, Layout::gold_binary}) {
    SCOPED_TRACE(static_cast<int>(layout));
    write_case(layout);
    // Parts in another order, one alone, and one without cells of the variable.
    folder.write("a.f", Content(layout)
                            .line("f")
                            .part(2)
                            .line("coordinates")
                            .real({4, 5, 6, 7})
                            .part(1)
                            .line("coordinates")
                            .real({0, 1, 2, 3})
                            .text);
    folder.write("a.v", Content(layout).line("v").part(2).line("coordinates").real(std::vector<float>(12, 1)).text);
    folder.write("a.g", Content(layout).line("g").part(1).part(2).line("tetra4").real({20}).text);
    EXPECT_TRUE(left_out(read()).empty());
  }
}

TEST_F(EnsightValues, StructuredPartsCount) {
  TESSERA_VTK_OR_SKIP();
  for (const Layout layout : {Layout::gold_text, Layout::gold_binary}) {
    SCOPED_TRACE(static_cast<int>(layout));
    Content geometry(layout), f(layout), g(layout);
    folder.write("a.case",
                 "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: a.geo\nVARIABLE\nscalar per node: f a.f\n"
                 "scalar per element: g a.g\n");
    if (geometry.is_binary) geometry.line("C Binary");
    geometry.line("made").line("here").line("node id off").line("element id off").part(1).line("grid").line("block");
    geometry.whole({3, 2, 2});
    std::vector<float> points[3], values;
    for (int k = 0; k < 12; ++k) {
      for (const auto& [axis, place] : {std::pair(0, k % 3), std::pair(1, k / 3 % 2), std::pair(2, k / 6)})
        points[axis].push_back(static_cast<float>(place));
      values.push_back(static_cast<float>(k));
    }
    for (const auto& axis : points) geometry.real(axis);
    folder.write("a.geo", geometry.text);
    folder.write("a.f", f.line("f").part(1).line("block").real(values).text);
    folder.write("a.g", g.line("g").part(1).line("block").real({1, 2}).text);
    EXPECT_TRUE(left_out(read()).empty());
    for (const char* name : {"a.f", "a.g"}) cut(name, layout == Layout::gold_binary ? 4 : 13);
    EXPECT_EQ(left_out(read()).size(), 2u);
  }
}

}  // namespace
}  // namespace tessera::io::ensight_values_test
