// SPDX-License-Identifier: BSD-3-Clause
// SU2 meshes, written according to SU2's documentation.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/mesh/su2_file.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

/// A unit cube as two prisms, a cube above it, and a pyramid on top of that.
std::string tower(const std::string& points_last) {
  const std::string cells =
      "NELEM= 4\n13 0 1 3 4 5 7 0\n13\t1 2 3\t5 6 7 1\n12 4 5 6 7 8 9 10 11 2\n14 8 9 10 11 12 3\n";
  std::string points = "NPOIN= 13 13\n";
  for (int z = 0; z < 3; ++z)
    for (const char* xy : {"0 0", "1 0", "1.0E+00 1", "0 1"}) points += fmt::format("{} {} {}\n", xy, z, "7");
  points += "0.5 0.5 3.5 % the top\n";
  const std::string markers = "NMARK= 1\nMARKER_TAG= floor\nMARKER_ELEMS= 1\n9 0 1 2 3\n";
  return "% a tower\n\nNDIME= 3\n" + (points_last.empty() ? points + cells : cells + points) + markers;
}

TEST(Su2, AllCellsAreReadInAnyOrderOfSections) {
  const test::TemporaryFolder folder;
  for (const char* points_last : {"", "yes"}) {
    const cells::MeshFile read = read_mesh(folder.write("a.su2", tower(points_last)));
    EXPECT_EQ(read.format, "SU2");
    EXPECT_EQ(read.counts.cells_read, 4u);
    EXPECT_EQ(read.counts.points_read, 13u);
    EXPECT_NEAR(testing::volume(read.mesh), 1 + 1 + 1.5 / 3, 1e-12);
  }
}

TEST(Su2, ZonesAreBlocks) {
  const std::string one = "NDIME= 3\nNELEM= 1\n10 0 1 2 3\nNPOIN= 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const auto blocks = parse_su2("NZONE= 2\nIZONE= 1\n" + one + "IZONE= 2\n" + one, "a.su2");
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[0].name, "zone 1");
  EXPECT_EQ(blocks[1].name, "zone 2");
  EXPECT_EQ(blocks[1].positions.size(), 4u);
}

TEST(Su2, ReportsFaultsWithTheirLine) {
  const std::string points = "NPOIN= 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const auto refuse = [](const std::string& text, const std::vector<std::string>& parts) {
    test::expect_bad_input([&] { parse_su2(text, "a.su2"); }, parts);
  };
  refuse("NDIME= 2\n", {"a.su2", "line 1", "NDIME is 2"});
  refuse("NDIME= 3\nNELEM= 99999999999\n10 0 1 2 3\n" + points, {"line 2", "99999999999"});
  refuse("NDIME= 3\nNELEM= 1\n11 0 1 2 3\n" + points, {"line 3", "11 is not a cell type"});
  refuse("NDIME= 3\nNELEM= 1\n212 0 1 2 3\n" + points, {"line 3", "212 is a cell of order 3"});
  refuse("NDIME= 3\nNELEM= 1\n10 0 1 2\n" + points, {"line 3", "point number is missing"});
  refuse("NDIME= 3\nNELEM= 1\n10 0 1 2 4\n" + points, {"cell 0 uses point 4"});
  refuse("NDIME= 3\nNELEM= 1\n10 0 1 -2 3\n" + points, {"line 3", "'-2'"});
  refuse("NDIME= 3\nNELEM= 1\n10 0 1 2 3\n", {"no NPOIN"});
  refuse("NDIME= 3\nNELEM= 1\n10 0 1 2 3\nNPOIN= 4\n0 0 0\n1 0 0\n0 1 0\n", {"line 7", "point 3 of 4", "truncated"});
  refuse("NDIME= 3\nNELEM= 1\n10 0 1 2 3\nNPOIN= 4\n0 0 0\n1 x\x01 0\n0 1 0\n0 0 1\n", {"line 6", "'x?'"});
}

}  // namespace
}  // namespace tessera::io
