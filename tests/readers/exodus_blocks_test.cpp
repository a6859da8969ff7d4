// SPDX-License-Identifier: BSD-3-Clause
// Element blocks and sets of an Exodus file, written by the Exodus library.
#include <gtest/gtest.h>
#include <vtk_exodusII.h>

#include <array>
#include <glm/geometric.hpp>
#include <set>
#include <vector>

#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "tessera/triangle_file.hpp"

namespace tessera::io::exodus_blocks_test {
namespace {

/// The element sets `ends` (the first and the last cube) and 4 (the middle one), a side set and a node set.
void write_sets(int id) {
  const std::array<int, 2> ends = {3, 1};
  const std::array<int, 1> middle = {2}, side = {1}, nodes = {1};
  ex_put_set_param(id, EX_ELEM_SET, 3, 2, 0);
  ex_put_set(id, EX_ELEM_SET, 3, ends.data(), nullptr);
  ex_put_name(id, EX_ELEM_SET, 3, "ends");
  ex_put_set_param(id, EX_ELEM_SET, 4, 1, 0);
  ex_put_set(id, EX_ELEM_SET, 4, middle.data(), nullptr);
  ex_put_set_param(id, EX_SIDE_SET, 1, 1, 0);
  ex_put_set(id, EX_SIDE_SET, 1, middle.data(), side.data());
  ex_put_name(id, EX_SIDE_SET, 1, "inlet");
  ex_put_set_param(id, EX_NODE_SET, 5, 1, 0);
  ex_put_set(id, EX_NODE_SET, 5, nodes.data(), nullptr);
}

/// Three unit cubes along x in blocks with the ids 7, 8 (without a name) and 9, each with its own number as a value;
/// with sets, if requested, they are in one block, 7, with the values 0, 10 and 20.
void write_cubes(const std::string& name, bool with_sets = false) {
  int word = sizeof(double), stored = sizeof(double);
  const int id = ex_create(name.c_str(), EX_CLOBBER, &word, &stored);
  ASSERT_GE(id, 0);
  ex_init_params init{};
  init.num_dim = 3;
  init.num_nodes = 16;
  init.num_elem = 3;
  init.num_elem_blk = with_sets ? 1 : 3;
  if (with_sets) init.num_elem_sets = 2, init.num_side_sets = 1, init.num_node_sets = 1;
  ex_put_init_ext(id, &init);
  std::vector<double> x, y, z;
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 4; ++k) x.push_back(i), y.push_back(k == 1 || k == 2), z.push_back(k / 2);
  ex_put_coord(id, x.data(), y.data(), z.data());
  ex_put_variable_param(id, EX_ELEM_BLOCK, 1);
  ex_put_variable_name(id, EX_ELEM_BLOCK, 1, "v");
  std::array<int, 24> corners{};
  for (int b = 0; b < 3; ++b)
    for (int k = 0; k < 8; ++k) corners[static_cast<std::size_t>(8 * b + k)] = 4 * b + k + 1;
  const int blocks = with_sets ? 1 : 3, each = 3 / blocks;
  for (int b = 0; b < blocks; ++b) {
    ex_put_block(id, EX_ELEM_BLOCK, 7 + b, "HEX8", each, 8, 0, 0, 0);
    ex_put_conn(id, EX_ELEM_BLOCK, 7 + b, corners.data() + static_cast<std::ptrdiff_t>(8 * b), nullptr, nullptr);
  }
  ex_put_name(id, EX_ELEM_BLOCK, 7, "steel");
  if (!with_sets) ex_put_name(id, EX_ELEM_BLOCK, 9, "air");
  if (with_sets) write_sets(id);
  const double time = 0;
  ex_put_time(id, 1, &time);
  const std::array<double, 3> values = {0, 10, 20};
  for (int b = 0; b < blocks; ++b)
    ex_put_var(id, 1, EX_ELEM_BLOCK, 1, 7 + b, each, values.data() + static_cast<std::ptrdiff_t>(b));
  ASSERT_EQ(ex_close(id), EX_NOERR);
}

TEST(ExodusBlocks, AreReadByTheirNamesWithTheirValues) {
  const test::TemporaryFolder folder;
  write_cubes((folder / "a.exo").string());
  const cells::MeshFile all = read_mesh(folder / "a.exo");
  EXPECT_EQ(all.blocks, (std::vector<std::string>{"steel", "block 8", "air"}));
  EXPECT_NEAR(testing::volume(all.mesh), 3, 1e-12);
  ReadOptions options;
  options.field = "v";
  const std::array<const char*, 3> names = {"steel", "block 8", "air"};
  for (std::size_t b = 0; b < 3; ++b) {
    options.blocks = {names[b]};
    const cells::MeshFile one = read_mesh(folder / "a.exo", options);
    EXPECT_EQ(one.blocks, all.blocks);
    EXPECT_EQ(one.counts.cells_read, 1u);
    EXPECT_NEAR(testing::volume(one.mesh), 1, 1e-12);
    for (const double value : one.mesh.scalars) EXPECT_EQ(value, 10.0 * static_cast<double>(b));
  }
  options.blocks = {"block 7"};
  test::expect_bad_input([&] { read_mesh(folder / "a.exo", options); }, {"no block 'block 7'", "'steel'"});
}

TEST(ExodusBlocks, ElementSetsAreChosenLikeBlocks) {
  const test::TemporaryFolder folder;
  write_cubes((folder / "a.exo").string(), true);
  const cells::MeshFile all = read_mesh(folder / "a.exo");
  EXPECT_EQ(all.blocks, (std::vector<std::string>{"steel", "ends", "element set 4"}));
  EXPECT_NEAR(testing::volume(all.mesh), 3, 1e-12);  // each cube once
  ReadOptions options;
  options.field = std::string("v");
  const auto read = [&](const std::vector<std::string>& names) {
    options.blocks = names;
    return read_mesh(folder / "a.exo", options);
  };
  const cells::MeshFile ends = read({"ends"});
  EXPECT_EQ(ends.counts.cells_read, 2u);
  EXPECT_NEAR(testing::volume(ends.mesh), 2, 1e-12);
  std::set<double> values(ends.mesh.scalars.begin(), ends.mesh.scalars.end());
  EXPECT_EQ(values, (std::set<double>{0, 20}));
  const cells::MeshFile middle = read({"element set 4"});
  EXPECT_NEAR(testing::volume(middle.mesh), 1, 1e-12);
  values = {middle.mesh.scalars.begin(), middle.mesh.scalars.end()};
  EXPECT_EQ(values, std::set<double>{10});
  // A block named twice is read once.
  EXPECT_NEAR(testing::volume(read({"ends", "element set 4"}).mesh), 3, 1e-12);
  EXPECT_NEAR(testing::volume(read({"ends", "steel"}).mesh), 3, 1e-12);
  const auto notes = read({}).notes;
  EXPECT_EQ(read({}).surfaces, std::vector<std::string>{"inlet"});
  EXPECT_EQ(std::ranges::count(notes, "1 side set is a surface and is left out: 'inlet' (`surface` shows it)"), 1);
  test::expect_bad_input([&] { read({"inlet"}); }, {"'inlet' is a side set", "element sets", "`surface`"});
  test::expect_bad_input([&] { read({"node set 5"}); }, {"'node set 5' is a node set"});
  test::expect_bad_input([&] { read({"end"}); }, {"no block 'end'", "'ends'"});
}

double area(const tessera::TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const glm::dvec3 p = mesh.points[t[0]];
    sum += 0.5 * glm::length(glm::cross(mesh.points[t[1]] - p, mesh.points[t[2]] - p));
  }
  return sum;
}

/// The side set is one face of the middle cube, between x = 1 and 2.
TEST(ExodusBlocks, SideSetsAreSurfaces) {
  const test::TemporaryFolder folder;
  write_cubes((folder / "a.exo").string(), true);
  const std::array files = {folder / "a.exo"};
  const tessera::TriangleMesh inlet = read_block_surface(files, "inlet");
  EXPECT_EQ(inlet.triangles.size(), 2u);
  EXPECT_NEAR(area(inlet), 1, 1e-12);
  EXPECT_TRUE(inlet.values.empty());
  for (const glm::dvec3& p : inlet.points) EXPECT_TRUE(p.x >= 1 && p.x <= 2) << p.x;
  // The boundary of a volume block, and of an element set, with values.
  ReadOptions options;
  options.field = "v";
  const tessera::TriangleMesh steel = read_block_surface(files, "steel", options);
  EXPECT_NEAR(area(steel), 14, 1e-12);
  EXPECT_EQ(steel.values.size(), steel.points.size());
  const tessera::TriangleMesh middle = read_block_surface(files, "element set 4", options);
  EXPECT_NEAR(area(middle), 6, 1e-12);
  for (const double value : middle.values) EXPECT_EQ(value, 10);
  test::expect_bad_input([&] { (void)read_block_surface(files, "outlet"); },
                         {"a.exo: there is no block 'outlet'; it has 'steel', 'ends', 'element set 4', 'inlet'"});
  test::expect_bad_input([&] { (void)read_block_surface(files, "node set 5"); }, {"'node set 5' is a node set"});
}

}  // namespace
}  // namespace tessera::io::exodus_blocks_test
