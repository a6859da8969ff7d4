// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "io/mesh/plot3d_layout.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/some_cases.hpp"

namespace tessera::io {
namespace {

/// Writes binary PLOT3D in any layout.
class Writer {
 public:
  explicit Writer(const Plot3dLayout& layout) : layout_(layout) {}
  std::string bytes;

  void integer(std::int32_t n) { put(&n, 4); }
  void real(double x) {
    const auto f = static_cast<float>(x);
    layout_.double_precision ? put(&x, 8) : put(&f, 4);
  }
  template <class Body>
  void record(Body body) {
    const std::size_t start = bytes.size();
    body();
    if (!layout_.record_marks) return;
    const auto n = static_cast<std::int32_t>(bytes.size() - start);
    std::string inside = bytes.substr(start);
    bytes.resize(start);
    integer(n);
    bytes += inside;
    integer(n);
  }
  void dimensions() {
    if (layout_.multi_grid) record([&] { integer(static_cast<std::int32_t>(layout_.grids.size())); });
    record([&] {
      for (const auto& grid : layout_.grids)
        for (const std::int32_t n : grid) integer(n);
    });
  }

 private:
  void put(const void* value, std::size_t n) {
    std::string raw(static_cast<const char*>(value), n);
    if (layout_.big_endian) std::reverse(raw.begin(), raw.end());
    bytes += raw;
  }
  Plot3dLayout layout_;
};

std::string grid_bytes(const Plot3dLayout& layout, std::int32_t hidden = -1) {
  Writer w(layout);
  w.dimensions();
  for (std::size_t g = 0; g < layout.grids.size(); ++g) {
    const auto& n = layout.grids[g];
    w.record([&] {
      for (int axis = 0; axis < 3; ++axis)
        for (int k = 0; k < n[2]; ++k)
          for (int j = 0; j < n[1]; ++j)
            for (int i = 0; i < n[0]; ++i) w.real(axis == 0 ? i + 10.0 * static_cast<double>(g) : axis == 1 ? j : k);
      if (layout.iblank)
        for (int v = 0; v < n[0] * n[1] * n[2]; ++v) w.integer(v == hidden ? 0 : 1);
    });
  }
  return w.bytes;
}

/// Density i; momentum (1, 2, 2); energy constant.
std::string solution_bytes(const Plot3dLayout& layout) {
  Writer w(layout);
  w.dimensions();
  for (const auto& n : layout.grids) {
    w.record([&] {
      for (const double x : {0.5, 1.0, 1e5, 0.0}) w.real(x);
    });
    w.record([&] {
      for (int plane = 0; plane < 5; ++plane)
        for (int v = 0; v < n[0] * n[1] * n[2]; ++v) w.real(plane == 0 ? v % n[0] : plane == 1 ? 1 : plane < 4 ? 2 : 7);
    });
  }
  return w.bytes;
}

TEST(Plot3d, EveryLayoutIsFoundAndReadWithoutAnOption) {
  test::SomeCases some(5);
  for (unsigned bits = 0; bits < 32; ++bits) {
    if (!some.next()) continue;
    Plot3dLayout layout{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0, {}};
    layout.grids = {{4, 3, 5}};
    if (layout.multi_grid) layout.grids.push_back({2, 6, 3});
    SCOPED_TRACE(bits);
    const test::TemporaryFolder folder;
    const auto file = folder.write("gridxyz.bin", grid_bytes(layout));
    folder.write("gridq.bin", solution_bytes(layout));
    const Plot3dLayout found = detect_plot3d(file);
    EXPECT_EQ(found.big_endian, layout.big_endian);
    EXPECT_EQ(found.record_marks, layout.record_marks);
    EXPECT_EQ(found.multi_grid, layout.multi_grid);
    EXPECT_EQ(found.double_precision, layout.double_precision);
    EXPECT_EQ(found.iblank, layout.iblank);
    EXPECT_EQ(found.grids, layout.grids);
    const cells::MeshFile read = read_mesh(file);
    scene::validate(read.mesh, "grid");
    EXPECT_EQ(read.counts.cells_read, layout.multi_grid ? 24u + 10u : 24u);
    EXPECT_DOUBLE_EQ(testing::volume(read.mesh), layout.multi_grid ? 34 : 24);
    EXPECT_EQ(read.mesh.field_name, "Density");
    for (std::size_t v = 0; v < 60; ++v) EXPECT_EQ(read.mesh.scalars[v], read.mesh.positions[v].x);
    ReadOptions options;
    options.field = "Momentum";
    EXPECT_EQ(read_mesh(file, options).mesh.scalars.front(), 3);
  }
}

TEST(Plot3d, ReportsARecordForEachPlane) {
  const Plot3dLayout layout{false, true, false, false, false, {{4, 3, 5}}};
  Writer w(layout);
  w.dimensions();
  for (int k = 0; k < 5; ++k)
    w.record([&] {
      for (int number = 0; number < 3 * 12; ++number) w.real(number);
    });
  const test::TemporaryFolder folder;
  const auto file = folder.write("g.bin", w.bytes);
  const std::string message = testing::message_of([&] { detect_plot3d(file); });
  EXPECT_NE(message.find("it has a record for each plane of a grid (/PLANES)"), std::string::npos) << message;
}

/// Writes the same data as text, with five numbers per line.
class TextWriter {
 public:
  std::string text;
  template <class T>
  void number(T n) {
    text += fmt::format("{}{}", n, ++numbers_ % 5 == 0 ? "\n" : "  ");
  }
  void dimensions(const Plot3dLayout& layout) {
    if (layout.multi_grid) number(layout.grids.size());
    for (const auto& grid : layout.grids)
      for (const std::int32_t n : grid) number(n);
  }

 private:
  int numbers_ = 0;
};

std::string grid_text(const Plot3dLayout& layout) {
  TextWriter w;
  w.dimensions(layout);
  for (std::size_t g = 0; g < layout.grids.size(); ++g) {
    const auto& n = layout.grids[g];
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 0; k < n[2]; ++k)
        for (int j = 0; j < n[1]; ++j)
          for (int i = 0; i < n[0]; ++i)
            w.number(axis == 0 ? i + 0.1 + 10.0 * static_cast<double>(g) : axis == 1 ? j : k);
    for (int v = 0; layout.iblank && v < n[0] * n[1] * n[2]; ++v) w.number(v == 0 ? 0 : 1);
  }
  return w.text;
}

/// Density is the number of the point in its grid plus a tenth.
std::string solution_text(const Plot3dLayout& layout) {
  TextWriter w;
  w.dimensions(layout);
  for (const auto& n : layout.grids) {
    for (const double x : {0.5, 1.0, 1e5, 0.0}) w.number(x);
    for (int plane = 0; plane < 5; ++plane)
      for (int v = 0; v < n[0] * n[1] * n[2]; ++v) w.number(plane == 0 ? v + 0.1 : plane == 1 ? 1 : 2);
  }
  return w.text;
}

TEST(Plot3d, TextIsReadInEveryLayout) {
  for (unsigned bits = 0; bits < 4; ++bits) {
    Plot3dLayout layout;
    layout.multi_grid = (bits & 1) != 0, layout.iblank = (bits & 2) != 0;
    layout.grids = {{4, 3, 5}};
    if (layout.multi_grid) layout.grids.push_back({2, 6, 3});
    SCOPED_TRACE(bits);
    const test::TemporaryFolder folder;
    const auto file = folder.write("grid.xyz", grid_text(layout));
    folder.write("grid.q", solution_text(layout));
    const Plot3dLayout found = detect_plot3d(file);
    EXPECT_TRUE(found.is_text);
    EXPECT_EQ(found.multi_grid, layout.multi_grid);
    EXPECT_EQ(found.iblank, layout.iblank);
    EXPECT_EQ(found.grids, layout.grids);
    const cells::MeshFile read = read_mesh(file);
    EXPECT_EQ(read.counts.cells_read, layout.multi_grid ? 24u + 10u : 24u);
    EXPECT_EQ(read.counts.cells_hidden, layout.iblank ? layout.grids.size() : 0u);
    EXPECT_EQ(read.mesh.positions[1].x, 1.1);  // as a double
    for (std::size_t v = 0; v < 60; ++v) EXPECT_EQ(read.mesh.scalars[v], static_cast<double>(v) + 0.1);
  }
}

TEST(Plot3d, TextThatVtkWouldMisreadIsRefused) {
  Plot3dLayout layout;
  layout.grids = {{3, 3, 3}};
  const std::string grid = grid_text(layout), solution = solution_text(layout);
  const test::TemporaryFolder folder;
  const auto refuse = [&](const std::string& text, const std::vector<std::string>& parts) {
    test::expect_bad_input([&] { read_mesh(folder.write("g.xyz", text)); }, parts);
  };
  const auto with = [&](const std::string& word) {
    std::string text = grid;
    return text.replace(text.find("2.1"), 3, word);
  };
  refuse(with("2*1.0"), {"g.xyz: line 2", "'2*1.0'", "repetition"});
  refuse(with("1.0D+00"), {"g.xyz: line 2", "'1.0D+00'", "with E"});
  refuse(with("x"), {"g.xyz: line 2", "'x'", "not a number"});
  refuse(with("1 2"), {"g.xyz: ", "no layout"});
  refuse(grid.substr(0, grid.size() / 2), {"g.xyz: ", "no layout"});
  layout.iblank = true;
  std::string blanked = grid_text(layout);
  refuse(blanked.replace(blanked.rfind('1'), 1, "1.5"), {"'1.5'", "IBLANK"});
  layout.iblank = false;
  const auto file = folder.write("h.xyz", grid);
  folder.write("h.q", solution.substr(0, solution.size() / 2));
  test::expect_bad_input([&] { read_mesh(file); }, {"h.q: it has"});
  folder.write("h.q", solution_bytes(layout));
  test::expect_bad_input([&] { read_mesh(file); }, {"h.q: it is binary"});
}

TEST(Plot3d, IBlankZeroHidesTheCellsOfItsPoint) {
  Plot3dLayout layout{true, false, false, false, true, {{4, 4, 4}}};
  const test::TemporaryFolder folder;
  const cells::MeshFile read = read_mesh(folder.write("g.xyz", grid_bytes(layout, 0)));  // a corner: one cell
  EXPECT_EQ(read.counts.cells_hidden, 1u);
  EXPECT_EQ(read_mesh(folder.write("g.xyz", grid_bytes(layout, 1 + 4 * (1 + 4)))).counts.cells_hidden, 8u);
}

TEST(Plot3d, TheSolutionIsFoundByNameOrGiven) {
  const Plot3dLayout layout{true, false, false, false, false, {{3, 3, 3}}};
  const test::TemporaryFolder folder;
  const auto grid = folder.write("fin.xyz", grid_bytes(layout));
  EXPECT_TRUE(find_plot3d_solution(grid).empty());
  EXPECT_EQ(read_mesh(grid).mesh.field_name, "none");
  ReadOptions options;
  options.plot3d_q = folder.write("solution_17.bin", solution_bytes(layout));
  EXPECT_EQ(read_mesh(grid, options).mesh.field_name, "Density");
  folder.write("fin.q", solution_bytes(layout));
  EXPECT_EQ(find_plot3d_solution(grid), folder / "fin.q");
  folder.write("finxyz.bin", "");
  folder.write("finq.bin", "");
  EXPECT_EQ(find_plot3d_solution(folder / "finxyz.bin"), folder / "finq.bin");
}

TEST(Plot3d, ListsOfFilesAreReadOneTimeEach) {
  const test::TemporaryFolder folder;
  const Plot3dLayout small{true, false, false, false, false, {{2, 2, 2}}};
  const Plot3dLayout large{false, true, true, true, false, {{3, 2, 2}, {2, 2, 2}}};
  folder.write("small.bin", grid_bytes(small));
  folder.write("small_9.bin", solution_bytes(small));
  folder.write("large.bin", grid_bytes(large));
  const auto list = folder.write("a.p3d", R"({"auto-detect-format": true, "functions": [110], "filenames": [
      {"time": 4.5, "xyz": "small.bin", "q": "small_9.bin", "function": "f.bin"},
      {"time": 3.5, "xyz": "large.bin"}]})");
  const cells::MeshFile last = read_mesh(list);
  EXPECT_EQ(last.mesh.field_name, "Density");
  EXPECT_NEAR(testing::volume(last.mesh), 1, 1e-12);
  EXPECT_EQ(last.time_step.count, 2u);
  EXPECT_EQ(last.time_step.step, 1u);
  EXPECT_EQ(std::ranges::count_if(last.notes, [](const auto& n) { return n.find("functions") != n.npos; }), 1);
  ReadOptions first;
  first.time_step = 0;
  const cells::MeshFile before = read_mesh(list, first);
  EXPECT_EQ(before.mesh.field_name, "none");
  EXPECT_NEAR(testing::volume(before.mesh), 3, 1e-12);
  EXPECT_EQ(time_steps_of_mesh(identify(list)).count, 2u);
  first.time_step = 2;
  test::expect_bad_input([&] { read_mesh(list, first); }, {"a.p3d: there is no time step 2, the file has 2"});
  for (const auto& [entries, words] : std::vector<std::pair<std::string, std::string>>{
           {"[{\"xyz\": \"no.bin\"}]", "no.bin"},
           {"[{\"xyz\": 3}]", "b.p3d: entry 0 of \"filenames\" has an invalid name"},
           {"[{\"xyz\": \"small.bin\", \"time\": \"x\"}]", "has a \"time\" that is not a number"},
           {"[{\"xyz\": \"small.bin\"}, {\"q\": \"small_9.bin\"}]", "entry 1 of \"filenames\" has no \"xyz\""},
           {"[7]", "entry 0 of \"filenames\" is not an object"}})
    test::expect_bad_input(
        [&, entries = entries] {
          read_mesh(folder.write("b.p3d", "{\"filenames\": " + entries + ", \"of\": {\"xyz\": 1}}"));
        },
        {words});
}

TEST(Plot3d, ReportsDamagedFiles) {
  const Plot3dLayout layout{true, true, false, false, false, {{3, 3, 3}}};
  const std::string grid = grid_bytes(layout), solution = solution_bytes(layout);
  const test::TemporaryFolder folder;
  for (std::size_t size = 1; size < grid.size(); size += 3) {
    const auto file = folder.write("g.bin", grid.substr(0, size));
    test::expect_bad_input([&] { read_mesh(file); }, {"g.bin: "});
  }
  const auto file = folder.write("gxyz.bin", grid);
  for (std::size_t size = 1; size < solution.size(); size += 3) {
    folder.write("gq.bin", solution.substr(0, size));
    test::expect_bad_input([&] { read_mesh(file); }, {"gq.bin: "});
  }
  Plot3dLayout other = layout;
  other.grids = {{3, 3, 4}};
  folder.write("gq.bin", solution_bytes(other));
  test::expect_bad_input([&] { read_mesh(file); }, {"gq.bin: its dimensions differ from those of the grid"});
  for (const auto& n : {std::array<std::int32_t, 3>{-3, 3, 3}, {0, 3, 3}, {2000000000, 2000000000, 2000000000}}) {
    Writer w({true, false, false, false, false, {n}});
    w.dimensions();
    test::expect_bad_input([&] { read_mesh(folder.write("h.bin", w.bytes + std::string(300, '\1'))); },
                           {"h.bin: no layout"});
  }
}

}  // namespace
}  // namespace tessera::io
