// SPDX-License-Identifier: BSD-3-Clause
// EnSight variable files that end too early are reported, and their fields left out; complete ones of any layout are
// read, also those of several time steps.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "cells/mesh_assembly.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/vtk_or_skip.hpp"

namespace tessera::io::ensight_values_test {
namespace {

using testing::message_of;

enum class Layout : std::uint8_t { gold_text, gold_binary, six_text, six_binary };
constexpr Layout layouts[] = {Layout::gold_text, Layout::gold_binary, Layout::six_text, Layout::six_binary};

/// The contents of an EnSight file of geometry or values, in order.
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

/// Two parts, each of one tetrahedron with its own nodes: `f` at nodes is 0 to 7, `v` a vector, `g` at cells 10 and 20.
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
      // VTK's reader expects 80 bytes after the description of a binary file: nodes that no cell uses.
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

  /// Removes its last bytes.
  void cut(const std::string& name, std::size_t bytes) const {
    const auto file = folder.path() / name;
    std::filesystem::resize_file(file, std::filesystem::file_size(file) - bytes);
  }

  cells::MeshFile read(const std::string& field = "") const {
    ReadOptions options;
    options.field = field;
    return read_mesh(folder.path() / "a.case", options);
  }

  static std::vector<std::string> left_out(const cells::MeshFile& file) {
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
    const cells::MeshFile f = read("f");
    EXPECT_EQ(*std::ranges::max_element(f.mesh.scalars), 7);
    EXPECT_EQ(read("g").mesh.scalars.back(), 20);
  }
}

TEST_F(EnsightValues, OmitsFilesThatEndInsideNumbersByName) {
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

TEST_F(EnsightValues, OmitsFilesThatEndInsideTheLastNumberByName) {
  TESSERA_VTK_OR_SKIP();
  for (const Layout layout : {Layout::gold_text, Layout::six_text})
    for (const auto& [name, variable] : {std::pair("a.f", "f"), std::pair("a.v", "v"), std::pair("a.g", "g")})
      for (const std::size_t bytes : {2u, 5u, 8u}) {  // within `e+01`, or within the digits before it
        SCOPED_TRACE(fmt::format("{} without {} bytes", name, bytes));
        write_case(layout);
        cut(name, bytes);
        const std::vector<std::string> notes = left_out(read());
        ASSERT_EQ(notes.size(), 1u);
        EXPECT_NE(notes[0].find(fmt::format("{} is left out: {} is truncated, it ends inside ", variable, name)),
                  std::string::npos)
            << notes[0];
      }
}

TEST_F(EnsightValues, NumbersNeedNoLineBreakAfterThem) {
  TESSERA_VTK_OR_SKIP();
  for (const Layout layout : {Layout::gold_text, Layout::six_text}) {
    write_case(layout);
    for (const char* name : {"a.f", "a.v", "a.g"}) cut(name, 1);
    EXPECT_TRUE(left_out(read()).empty());
  }
  write_case(Layout::gold_text);
  folder.write("a.f", "f\npart\n1\ncoordinates\n0.5\n1.5\n2.5\n3.5\npart\n2\ncoordinates\n4.5\n5.5\n6.5\n4");
  EXPECT_TRUE(left_out(read()).empty());
  EXPECT_EQ(read("f").mesh.scalars.back(), 4);
}

TEST_F(EnsightValues, OmitsFilesThatEndBeforeOrBetweenNumbersByName) {
  TESSERA_VTK_OR_SKIP();
  for (const Layout layout : layouts) {
    SCOPED_TRACE(static_cast<int>(layout));
    write_case(layout);
    for (const std::string& begun : {std::string(), Content(layout).line("g").text}) {
      folder.write("a.g", begun);
      const std::vector<std::string> notes = left_out(read());
      ASSERT_EQ(notes.size(), 1u);
      EXPECT_NE(notes[0].find("g is left out: a.g is truncated, it ends before its values"), std::string::npos)
          << notes[0];
    }
    const std::string whole = Content(layout).line("g").part(1).line("tetra4").real({10}).text;
    for (const std::string& more :
         {std::string("par"), Content(layout).part(2).text.substr(0, layout == Layout::gold_binary ? 82 : 5),
          Content(layout).part(2).line("tetra4").text.substr(0, Content(layout).part(2).text.size() + 5)}) {
      if (more.size() == 5 && !Content(layout).is_gold) continue;  // here, the number is in the part's line
      SCOPED_TRACE(more);
      folder.write("a.g", whole + more);
      const std::vector<std::string> notes = left_out(read());
      ASSERT_EQ(notes.size(), 1u) << more;
      EXPECT_TRUE(notes[0].find("it ends after part 1") != std::string::npos ||
                  notes[0].find("it ends inside part 2") != std::string::npos)
          << notes[0];
    }
  }
}

TEST_F(EnsightValues, PartsWithoutValuesAreBlankAndNamed) {
  TESSERA_VTK_OR_SKIP();
  for (const Layout layout : {Layout::gold_text, Layout::gold_binary}) {
    SCOPED_TRACE(static_cast<int>(layout));
    write_case(layout);
    folder.write("a.f", Content(layout).line("f").part(2).line("coordinates").real({4, 5, 6, 7}).text);
    const cells::MeshFile file = read("f");
    EXPECT_EQ(file.mesh.tets.size(), 1u);
    EXPECT_EQ(std::ranges::count(file.notes,
                                 "f is blank in 1 of the case's parts, such as 'p1': a.f has no values for "
                                 "them"),
              1);
  }
}

TEST_F(EnsightValues, CellsOfATypeWithoutValuesAreBlank) {
  TESSERA_VTK_OR_SKIP();
  for (const Layout layout : {Layout::gold_text, Layout::gold_binary}) {
    SCOPED_TRACE(static_cast<int>(layout));
    Content geometry(layout);
    folder.write("a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: a.geo\nVARIABLE\nscalar per element: g a.g\n");
    if (geometry.is_binary) geometry.line("C Binary");
    geometry.line("made").line("here").line("node id off").line("element id off").part(1).line("p").line("coordinates");
    geometry.whole({5}).real({0, 1, 0, 0, 1}).real({0, 0, 1, 0, 1}).real({0, 0, 0, 1, 1});
    geometry.line("tetra4").whole({1}).whole({1, 2, 3, 4}).line("pyramid5").whole({1}).whole({1, 2, 5, 3, 4});
    folder.write("a.geo", geometry.text);
    folder.write("a.g", Content(layout).line("g").part(1).line("tetra4").real({20}).text);
    const cells::MeshFile file = read("g");
    EXPECT_EQ(file.mesh.tets.size(), 1u);
    for (const float value : file.mesh.scalars) EXPECT_EQ(value, 20);
  }
}

TEST_F(EnsightValues, PartialAndUndefinedValuesCount) {
  TESSERA_VTK_OR_SKIP();
  for (const Layout layout : {Layout::gold_text, Layout::gold_binary}) {
    SCOPED_TRACE(static_cast<int>(layout));
    write_case(layout);
    Content f(layout), v(layout);
    f.line("f").part(1).line("coordinates undef").real({-9}).real({0, 1, 2, 3});
    f.part(2).line("coordinates partial").whole({2});
    for (const int node : {1, 3}) f.whole({node});
    folder.write("a.f", f.real({4, 5}).text);
    v.line("v").part(1).line("coordinates undef").real({-9}).real(std::vector<float>(12, 1));
    folder.write("a.v", v.text);
    EXPECT_TRUE(left_out(read()).empty());
    const cells::MeshFile file = read("f");
    ASSERT_EQ(file.mesh.tets.size(), 1u);
    for (const std::uint32_t v : file.mesh.tets[0]) EXPECT_LE(file.mesh.scalars[v], 3);
    for (const char* name : {"a.f", "a.v"}) cut(name, layout == Layout::gold_binary ? 4 : 13);
    EXPECT_EQ(left_out(read()).size(), 2u);
  }
}

TEST_F(EnsightValues, OptionalPartsOfGoldFilesMayBeAbsent) {
  TESSERA_VTK_OR_SKIP();
  for (const Layout layout : {Layout::gold_text, Layout::gold_binary}) {
    SCOPED_TRACE(static_cast<int>(layout));
    write_case(layout);
    // Parts in another order, a single one, and one without cells with the variable.
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

/// One of three steps, at 0, 0.7 and 2: `f` at nodes is 10 times the step plus 0 to 7.
Content at_step(Content content, const std::vector<float>& numbers, float step) {
  std::vector<float> values;
  values.reserve(numbers.size());
  for (const float number : numbers) values.push_back(number + 10 * step);
  return content.real(values);
}

/// write_case() with a file of three steps for `f`, files of one step each for `g`, and constant geometry and `v`.
class EnsightSteps : public EnsightValues {
 protected:
  void write_steps(Layout layout, const std::string& files) {
    write_case(layout);
    const bool is_gold = Content(layout).is_gold;
    folder.write("a.case",
                 fmt::format("FORMAT\ntype: ensight{}\nGEOMETRY\nmodel: a.geo\nVARIABLE\nscalar per node: 1 1 "
                             "f {}\nvector per node: v a.v\nscalar per element: 2 g a.g**\nTIME\n"
                             "time set: 1\nnumber of steps: 3\ntime values: 0 0.7 2\ntime set: 2\n"
                             "number of steps: 3\nfilename numbers: 4 5 7\ntime values: 0 0.7 2\nFILE\n"
                             "file set: 1\n{}",
                             is_gold ? " gold" : "", files.empty() ? "a.f" : "a.f*",
                             files.empty() ? "number of steps: 3\n" : files));
    for (const int step : {0, 1, 2}) {
      const auto time = static_cast<float>(step);
      steps[step] = Content(layout).line("BEGIN TIME STEP").line("f").text;
      if (is_gold)
        for (const int part : {1, 2}) {
          const float first = part == 1 ? 0 : 4;
          steps[step] +=
              at_step(Content(layout).part(part).line("coordinates"), {first, first + 1, first + 2, first + 3}, time)
                  .text;
        }
      else
        steps[step] +=
            at_step(Content(layout), {0, 1, 2, 3, 4, 5, 6, 7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, time)
                .text;
      steps[step] += Content(layout).line("END TIME STEP").text;
      folder.write(fmt::format("a.g{:02}", step == 2 ? 7 : 4 + step), Content(layout)
                                                                          .line("g")
                                                                          .part(1)
                                                                          .line("tetra4")
                                                                          .real({time})
                                                                          .part(2)
                                                                          .line("tetra4")
                                                                          .real({time + 0.5f})
                                                                          .text);
    }
  }

  float least_of_step(const std::string& field, std::size_t step) const {
    ReadOptions options;
    options.field = field;
    options.time_step = step;
    const cells::MeshFile file = read_mesh(folder.path() / "a.case", options);
    EXPECT_EQ(file.mesh.tets.size(), 2u);
    EXPECT_TRUE(left_out(file).empty());
    EXPECT_EQ(file.time_step.count, 3u);
    EXPECT_EQ(file.time_step.times, (std::vector<double>{0, 0.7f, 2}));
    return *std::ranges::min_element(file.mesh.scalars);
  }

  std::string steps[3];
};

TEST_F(EnsightSteps, StepsInOneFileGoWithGeometryThatStaysAndFilesOfOneStep) {
  TESSERA_VTK_OR_SKIP();
  for (const Layout layout : layouts) {
    SCOPED_TRACE(static_cast<int>(layout));
    write_steps(layout, "");
    folder.write("a.f", steps[0] + steps[1] + steps[2]);
    for (const std::size_t step : {0u, 1u, 2u}) {
      EXPECT_EQ(least_of_step("f", step), static_cast<float>(10 * step));
      EXPECT_EQ(least_of_step("g", step), static_cast<float>(step));
    }
  }
}

TEST_F(EnsightSteps, AFileSetMayHaveSeveralFiles) {
  TESSERA_VTK_OR_SKIP();
  for (const Layout layout : layouts) {
    SCOPED_TRACE(static_cast<int>(layout));
    write_steps(layout, "filename index: 3\nnumber of steps: 2\nfilename index: 9\nnumber of steps: 1\n");
    folder.write("a.f3", steps[0] + steps[1]);
    folder.write("a.f9", steps[2]);
    for (const std::size_t step : {0u, 1u, 2u}) EXPECT_EQ(least_of_step("f", step), static_cast<float>(10 * step));
  }
}

TEST_F(EnsightSteps, OmitsMissingAndTruncatedStepsByName) {
  TESSERA_VTK_OR_SKIP();
  for (const Layout layout : layouts) {
    SCOPED_TRACE(static_cast<int>(layout));
    write_steps(layout, "");
    const std::size_t half = steps[2].size() - Content(layout).line("END TIME STEP").text.size() - 2;
    for (const std::string& last : {std::string(), steps[2].substr(0, half)}) {
      folder.write("a.f", steps[0] + steps[1] + last);
      const std::vector<std::string> notes = left_out(read());
      ASSERT_EQ(notes.size(), 1u);
      EXPECT_NE(notes[0].find("f is left out: a.f is truncated, it ends "), std::string::npos) << notes[0];
      EXPECT_EQ(least_of_step("f", 1), 10);
    }
  }
}

TEST_F(EnsightSteps, TheFileOfAStepIsFoundByItsTimeAsFloat) {  // 0.7 rounded to float is smaller than 0.7
  TESSERA_VTK_OR_SKIP();
  write_steps(Layout::gold_text, "");
  folder.write("a.f", steps[0] + steps[1] + steps[2]);
  std::filesystem::remove(folder.path() / "a.g05");
  ReadOptions options;
  options.time_step = 1;
  const std::vector<std::string> notes = left_out(read_mesh(folder.path() / "a.case", options));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("g is left out: its file a.g05, which the case names, is missing"), std::string::npos)
      << notes[0];
}

}  // namespace
}  // namespace tessera::io::ensight_values_test
