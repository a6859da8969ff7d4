// Element blocks of an Exodus file, which its own library writes here.
#include <gtest/gtest.h>
#include <vtk_exodusII.h>

#include <array>
#include <vector>

#include "io/mesh_checks.hpp"
#include "io/mesh_reader.hpp"
#include "io/temporary_folder.hpp"

namespace tessera::io {
namespace {

/// Three unit cubes along x in blocks of the ids 7, 8 (without a name) and 9, each with its own number as a value.
void write_cubes(const std::string& name) {
  int word = sizeof(double), stored = sizeof(double);
  const int id = ex_create(name.c_str(), EX_CLOBBER, &word, &stored);
  ASSERT_GE(id, 0);
  ex_put_init(id, "cubes", 3, 16, 3, 3, 0, 0);
  std::vector<double> x, y, z;
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 4; ++k) x.push_back(i), y.push_back(k == 1 || k == 2), z.push_back(k / 2);
  ex_put_coord(id, x.data(), y.data(), z.data());
  ex_put_variable_param(id, EX_ELEM_BLOCK, 1);
  ex_put_variable_name(id, EX_ELEM_BLOCK, 1, "v");
  for (int b = 0; b < 3; ++b) {
    ex_put_block(id, EX_ELEM_BLOCK, 7 + b, "HEX8", 1, 8, 0, 0, 0);
    std::array<int, 8> corners{};
    for (int k = 0; k < 8; ++k) corners[static_cast<std::size_t>(k)] = 4 * b + k + 1;
    ex_put_conn(id, EX_ELEM_BLOCK, 7 + b, corners.data(), nullptr, nullptr);
  }
  ex_put_name(id, EX_ELEM_BLOCK, 7, "steel");
  ex_put_name(id, EX_ELEM_BLOCK, 9, "air");
  const double time = 0;
  ex_put_time(id, 1, &time);
  for (int b = 0; b < 3; ++b) {
    const double value = 10.0 * b;
    ex_put_var(id, 1, EX_ELEM_BLOCK, 1, 7 + b, 1, &value);
  }
  ASSERT_EQ(ex_close(id), EX_NOERR);
}

TEST(ExodusBlocks, AreReadByTheirNamesWithTheirValues) {
  const test::TemporaryFolder folder;
  write_cubes((folder / "a.exo").string());
  const MeshFile all = read_mesh(folder / "a.exo");
  EXPECT_EQ(all.blocks, (std::vector<std::string>{"steel", "block 8", "air"}));
  EXPECT_NEAR(testing::volume(all.mesh), 3, 1e-12);
  MeshOptions options;
  options.field = "v";
  const std::array<const char*, 3> names = {"steel", "block 8", "air"};
  for (std::size_t b = 0; b < 3; ++b) {
    options.blocks = {names[b]};
    const MeshFile one = read_mesh(folder / "a.exo", options);
    EXPECT_EQ(one.blocks, all.blocks);
    EXPECT_EQ(one.counts.cells_read, 1u);
    EXPECT_NEAR(testing::volume(one.mesh), 1, 1e-12);
    for (const double value : one.mesh.scalars) EXPECT_EQ(value, 10.0 * static_cast<double>(b));
  }
  options.blocks = {"block 7"};
  test::expect_bad_input([&] { read_mesh(folder / "a.exo", options); }, {"no block 'block 7'", "'steel'"});
}

}  // namespace
}  // namespace tessera::io
