#include <gtest/gtest.h>

#include <cstring>

#include "io/mesh_checks.hpp"
#include "io/mesh_reader.hpp"
#include "io/plot3d_layout.hpp"

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
  for (unsigned bits = 0; bits < 32; ++bits) {
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
    const MeshFile read = read_mesh(file);
    scene::validate(read.mesh, "grid");
    EXPECT_EQ(read.counts.cells_read, layout.multi_grid ? 24u + 10u : 24u);
    EXPECT_DOUBLE_EQ(testing::volume(read.mesh), layout.multi_grid ? 34 : 24);
    EXPECT_EQ(read.mesh.field_name, "Density");
    for (std::size_t v = 0; v < 60; ++v) EXPECT_EQ(read.mesh.scalars[v], read.mesh.positions[v].x);
    MeshOptions options;
    options.field = "Momentum";
    EXPECT_EQ(read_mesh(file, options).mesh.scalars.front(), 3);
  }
}

TEST(Plot3d, IBlankZeroHidesTheCellsOfItsPoint) {
  Plot3dLayout layout{true, false, false, false, true, {{4, 4, 4}}};
  const test::TemporaryFolder folder;
  const MeshFile read = read_mesh(folder.write("g.xyz", grid_bytes(layout, 0)));  // a corner: one cell
  EXPECT_EQ(read.counts.cells_hidden, 1u);
  EXPECT_EQ(read_mesh(folder.write("g.xyz", grid_bytes(layout, 1 + 4 * (1 + 4)))).counts.cells_hidden, 8u);
}

TEST(Plot3d, TheSolutionIsFoundByNameOrGiven) {
  const Plot3dLayout layout{true, false, false, false, false, {{3, 3, 3}}};
  const test::TemporaryFolder folder;
  const auto grid = folder.write("fin.xyz", grid_bytes(layout));
  EXPECT_TRUE(find_plot3d_solution(grid).empty());
  EXPECT_EQ(read_mesh(grid).mesh.field_name, "none");
  MeshOptions options;
  options.plot3d_q = folder.write("solution_17.bin", solution_bytes(layout));
  EXPECT_EQ(read_mesh(grid, options).mesh.field_name, "Density");
  folder.write("fin.q", solution_bytes(layout));
  EXPECT_EQ(find_plot3d_solution(grid), folder / "fin.q");
  folder.write("finxyz.bin", "");
  folder.write("finq.bin", "");
  EXPECT_EQ(find_plot3d_solution(folder / "finxyz.bin"), folder / "finq.bin");
}

TEST(Plot3d, DamagedFilesAreTold) {
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
  test::expect_bad_input([&] { read_mesh(file); }, {"gq.bin: its dimensions are not those of the grid"});
  for (const auto& n : {std::array<std::int32_t, 3>{-3, 3, 3}, {0, 3, 3}, {2000000000, 2000000000, 2000000000}}) {
    Writer w({true, false, false, false, false, {n}});
    w.dimensions();
    test::expect_bad_input([&] { read_mesh(folder.write("h.bin", w.bytes + std::string(300, '\1'))); },
                           {"h.bin: no layout"});
  }
}

}  // namespace
}  // namespace tessera::io
