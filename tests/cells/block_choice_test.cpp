// SPDX-License-Identifier: BSD-3-Clause
// Blocks of a file by their names.
#include "cells/block_choice.hpp"

#include <gtest/gtest.h>

#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

TEST(BlockChoice, AcceptsABlocksNameOrTheEndOfItsPath) {
  EXPECT_TRUE(cells::means_block("fluid", "fluid"));
  EXPECT_TRUE(cells::means_block("fluid", "fluid/internalMesh"));
  EXPECT_TRUE(cells::means_block("internalMesh", "fluid/internalMesh"));
  EXPECT_TRUE(cells::means_block("a/b", "a/b/c"));
  EXPECT_FALSE(cells::means_block("flu", "fluid/internalMesh"));
  EXPECT_FALSE(cells::means_block("Mesh", "fluid/internalMesh"));
  EXPECT_FALSE(cells::means_block("b", "a/b/c"));
  EXPECT_FALSE(cells::means_block("", "a"));
  EXPECT_TRUE(cells::is_chosen({}, "a"));
  EXPECT_TRUE(cells::is_chosen({"b", "a"}, "a"));
  EXPECT_FALSE(cells::is_chosen({"b"}, "a"));
}

/// A tetrahedron with a volume of 1 / 6 at `x`, as a zone.
std::string zone(int number, int x) {
  const std::string at = std::to_string(x), next = std::to_string(x + 1);
  return "IZONE= " + std::to_string(number) + "\nNDIME= 3\nNELEM= 1\n10 0 1 2 3\nNPOIN= 4\n" + at + " 0 0\n" + next +
         " 0 0\n" + at + " 1 0\n" + at + " 0 1\n";
}

TEST(BlockChoice, SurfacesAreNotedByName) {
  const std::vector<std::string> two{"inlet", "walls"}, many(23, "x");
  EXPECT_EQ(cells::note_on_surfaces("patch", two),
            "2 patches are surfaces and are left out: 'inlet', 'walls' (`surface` shows them)");
  EXPECT_EQ(cells::note_on_surfaces("side set", std::span(two).first(1)),
            "1 side set is a surface and is left out: 'inlet' (`surface` shows it)");
  EXPECT_NE(cells::note_on_surfaces("block", many).find("'x' and 3 more (`surface`"), std::string::npos);
}

TEST(BlockChoice, OnlyTheNamedBlocksAreRead) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("a.su2", "NZONE= 3\n" + zone(1, 0) + zone(2, 10) + zone(3, 20));
  ReadOptions options;
  const cells::MeshFile all = read_mesh(file);
  EXPECT_EQ(all.blocks, (std::vector<std::string>{"zone 1", "zone 2", "zone 3"}));
  EXPECT_EQ(all.counts.cells_read, 3u);
  options.blocks = {"zone 3", "zone 1"};
  const cells::MeshFile some = read_mesh(file, options);
  EXPECT_EQ(some.blocks, all.blocks);
  ASSERT_EQ(some.counts.cells_read, 2u);
  for (const glm::dvec3& p : some.mesh.positions) EXPECT_FALSE(p.x > 5 && p.x < 15);
}

TEST(BlockChoice, RefusesAnUnknownNameAndListsTheBlocks) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("a.su2", "NZONE= 2\n" + zone(1, 0) + zone(2, 10));
  ReadOptions options;
  options.blocks = {"zone 1", "wing"};
  test::expect_bad_input([&] { read_mesh(file, options); }, {"a.su2", "no block 'wing'", "'zone 1', 'zone 2'"});
  std::string many = "NZONE= 40\n";
  for (int k = 0; k < 40; ++k) many += zone(k, k);
  test::expect_bad_input([&] { read_mesh(folder.write("b.su2", many), options); }, {"'wing'", "and 28 more"});
  options.blocks = {"ZONE-37"};
  test::expect_bad_input([&] { read_mesh(folder.write("b.su2", many), options); }, {"the nearest is 'zone 37'"});
  const auto plain = folder.write("c.su2", zone(1, 0).substr(9));
  options.blocks = {"zone 1"};
  test::expect_bad_input([&] { read_mesh(plain, options); }, {"no block 'zone 1'", "leave `block` out"});
}

}  // namespace
}  // namespace tessera::io
