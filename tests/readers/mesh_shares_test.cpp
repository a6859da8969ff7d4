// SPDX-License-Identifier: BSD-3-Clause
// CGNS of several zones and meshes in several Exodus files, written by their own libraries, read in shares.
#include "io/mesh/mesh_shares.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <vtk_cgns.h>
#include <vtk_exodusII.h>

#include VTK_CGNS(cgnslib.h)

#include <array>
#include <vector>

#include "support/mesh_checks.hpp"
#include "support/parts_checks.hpp"
#include "support/read_files.hpp"
#include "support/some_cases.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io::mesh_shares_test {
namespace {

/// Coordinates of a cube from x = `at` to at + 1, in the corner order of hexahedra.
std::array<std::vector<double>, 3> corners_of(int at) {
  std::array<std::vector<double>, 3> xyz;
  for (int k = 0; k < 8; ++k) {
    xyz[0].push_back(at + (k % 4 == 1 || k % 4 == 2 ? 1 : 0));
    xyz[1].push_back(k % 4 >= 2 ? 1 : 0);
    xyz[2].push_back(k / 4);
  }
  return xyz;
}

void write_exodus(const std::filesystem::path& file, int at) {
  int word = sizeof(double), stored = sizeof(double);
  const int id = ex_create(file.c_str(), EX_CLOBBER, &word, &stored);
  ASSERT_GE(id, 0);
  ex_put_init(id, "cube", 3, 8, 1, 2, 0, 0);
  const auto xyz = corners_of(at);
  ex_put_coord(id, xyz[0].data(), xyz[1].data(), xyz[2].data());
  ex_put_variable_param(id, EX_NODAL, 1);
  ex_put_variable_name(id, EX_NODAL, 1, "v");
  const std::array<int, 8> corners{1, 2, 3, 4, 5, 6, 7, 8};
  for (const int block : {1, 2}) {  // all files have all blocks
    const bool is_here = block == 1 + at % 2;
    ex_put_block(id, EX_ELEM_BLOCK, block, "HEX8", is_here ? 1 : 0, 8, 0, 0, 0);
    if (is_here) ex_put_conn(id, EX_ELEM_BLOCK, block, corners.data(), nullptr, nullptr);
  }
  for (int step = 1; step <= 2; ++step) {
    const double time = step;
    ex_put_time(id, step, &time);
    std::vector<double> values;
    for (const double x : xyz[0]) values.push_back(step * x);
    ex_put_var(id, step, EX_NODAL, 1, 1, 8, values.data());
  }
  ASSERT_EQ(ex_close(id), EX_NOERR);
}

TEST(MeshShares, AnExodusMeshInSeveralFilesIsReadByTheNameOfOne) {
  const test::TemporaryFolder folder;
  for (int k = 0; k < 12; ++k) write_exodus(folder / fmt::format("m.ex2.12.{:02}", k), k);
  const auto file = folder / "m.ex2.12.07";
  EXPECT_EQ(exodus_files(identify(file)).size(), 12u);
  const cells::MeshFile whole = read_mesh(file);
  EXPECT_NEAR(testing::volume(whole.mesh), 12, 1e-12);
  EXPECT_EQ(whole.blocks, (std::vector<std::string>{"block 1", "block 2"}));
  EXPECT_EQ(whole.format, "Exodus II in 12 files");
  ReadOptions options;
  options.field = std::string("point:v");  // GCC 12 warns of a bare literal that it overlaps itself
  for (const std::size_t step : {std::size_t{0}, std::size_t{1}}) {
    options.time_step = step;
    testing::expect_as_whole(file, options);
    const cells::MeshFile read = read_mesh(file, options);
    for (std::size_t v = 0; v < read.mesh.positions.size(); ++v)
      EXPECT_EQ(read.mesh.scalars[v], static_cast<double>(step + 1) * read.mesh.positions[v].x);
  }
  options.blocks = {"block 2"};
  EXPECT_EQ(read_mesh(file, options).counts.cells_read, 6u);
  testing::expect_as_whole(file, options);

  std::filesystem::rename(folder / "m.ex2.12.11", folder / "alone.ex2");
  test::expect_bad_input([&] { read_mesh(file); }, {"m.ex2.12.07", "m.ex2.12.11 is missing"});
  EXPECT_NEAR(testing::volume(read_mesh(folder / "alone.ex2").mesh), 1, 1e-12);
  folder.write("m.ex2.12.11", "no Exodus");
  test::expect_bad_input([&] { read_mesh(file); },
                         {"m.ex2.12.11: it states that it is one of 12 Exodus files of a mesh"});
}

TEST(MeshShares, OtherNumberedNamesAreFilesOfTheirOwn) {
  const test::TemporaryFolder folder;
  for (const char* name : {"m.4", "m.1.0", "m.2.2", "m.10.1", "m.ex2.2.x"}) {
    write_exodus(folder / name, 0);
    EXPECT_TRUE(exodus_files(identify(folder / name)).empty()) << name;
    EXPECT_NEAR(testing::volume(read_mesh(folder / name).mesh), 1, 1e-12) << name;
  }
}

void write_zones(const std::filesystem::path& file, int zones) {
  int id = 0, base = 0;
  ASSERT_EQ(cg_open(file.c_str(), CG_MODE_WRITE, &id), CG_OK) << cg_get_error();
  ASSERT_EQ(cg_base_write(id, "base", 3, 3, &base), CG_OK);
  for (int k = 0; k < zones; ++k) {
    int zone = 0, made = 0;
    const std::array<cgsize_t, 3> size{8, 1, 0};
    ASSERT_EQ(cg_zone_write(id, base, fmt::format("zone {}", k).c_str(), size.data(), CGNS_ENUMV(Unstructured), &zone),
              CG_OK);
    const auto xyz = corners_of(k);
    const std::array<const char*, 3> names{"CoordinateX", "CoordinateY", "CoordinateZ"};
    for (std::size_t a = 0; a < 3; ++a)
      ASSERT_EQ(cg_coord_write(id, base, zone, CGNS_ENUMV(RealDouble), names[a], xyz[a].data(), &made), CG_OK);
    const std::array<cgsize_t, 8> corners{1, 2, 3, 4, 5, 6, 7, 8};
    ASSERT_EQ(cg_section_write(id, base, zone, "cells", CGNS_ENUMV(HEXA_8), 1, 1, 0, corners.data(), &made), CG_OK);
    int solution = 0;
    ASSERT_EQ(cg_sol_write(id, base, zone, "values", CGNS_ENUMV(Vertex), &solution), CG_OK);
    ASSERT_EQ(cg_field_write(id, base, zone, solution, CGNS_ENUMV(RealDouble), "f", xyz[0].data(), &made), CG_OK);
  }
  ASSERT_EQ(cg_close(id), CG_OK);
}

TEST(MeshShares, ZonesOfACgnsFileAreDivided) {
  const test::TemporaryFolder folder;
  test::SomeCases some(3);
  for (const int zones : {2, 1, 5}) {
    if (!some.next()) continue;
    const auto file = folder / fmt::format("{}.cgns", zones);
    write_zones(file, zones);
    const cells::MeshFile whole = read_mesh(file);
    EXPECT_NEAR(testing::volume(whole.mesh), zones, 1e-12);
    testing::expect_as_whole(file);
    if (zones == 1) continue;
    ReadOptions options;
    options.blocks = {"zone 1"};
    EXPECT_EQ(read_mesh(file, options).counts.cells_read, 1u);
    testing::expect_as_whole(file, options);
  }
  // Named like CGNS, but not CGNS: the first share is everything.
  write_exodus(folder / "m.exo", 0);
  std::filesystem::rename(folder / "m.exo", folder / "exodus.cgns");
  EXPECT_NEAR(testing::volume(read_mesh(folder / "exodus.cgns").mesh), 1, 1e-12);
}

}  // namespace
}  // namespace tessera::io::mesh_shares_test
