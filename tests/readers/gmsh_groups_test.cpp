// SPDX-License-Identifier: BSD-3-Clause
// Physical groups, partitions and names of views in Gmsh's files, written according to its reference manual.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "io/files/reader_programs.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io::gmsh_groups_test {
namespace {

class GmshGroups : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_reader(Reader::gmsh)) GTEST_SKIP() << "tessera-read-gmsh is not installed";
  }
  cells::MeshFile read(const std::string& text, const std::vector<std::string>& blocks = {},
                       const std::string& field = "") const {
    ReadOptions options;
    options.blocks = blocks;
    options.field = field;
    return read_mesh(folder.write("a.msh", text), options);
  }
  [[nodiscard]] double volume_of(const std::string& text, const std::vector<std::string>& blocks) const {
    return testing::volume(read(text, blocks).mesh);
  }
  test::TemporaryFolder folder;
};

/// The corner tet of the unit cube, and the one between it and the opposite corner, twice as large.
constexpr double corner = 1.0 / 6, middle = 1.0 / 3;
constexpr int points[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
constexpr const char* corner_nodes = "1 2 3 4";
constexpr const char* middle_nodes = "2 3 4 5";

std::string nodes() {
  std::string text = "5\n";
  for (int v = 0; v < 5; ++v) text += fmt::format("{} {} {} {}\n", v + 1, points[v][0], points[v][1], points[v][2]);
  return text;
}

const std::string names = "$PhysicalNames\n3\n3 1 \"left\"\n3 2 \"right\"\n3 3 \"all\"\n$EndPhysicalNames\n";

std::string msh2(const std::vector<std::string>& elements, const std::string& more = "") {
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names + "$Nodes\n" + nodes() + "$EndNodes\n$Elements\n";
  text += fmt::format("{}\n", elements.size());
  for (const std::string& element : elements) text += element + "\n";
  return text + "$EndElements\n" + more;
}

/// Tet `number` with `tags` between its type and its nodes.
std::string tet(int number, const std::string& tags, const char* of) {
  return fmt::format("{} 4 {} {}", number, tags, of);
}

/// Each of the two tets is in a separate group and in the group `all`. It is listed once for each group, as Gmsh writes
/// it.
std::vector<std::string> listed_twice(const char* left_entity, const char* right_entity) {
  const auto tags = [](int group, const char* entity) { return fmt::format("2 {} {}", group, entity); };
  return {tet(1, tags(1, left_entity), corner_nodes), tet(2, tags(3, left_entity), corner_nodes),
          tet(3, tags(2, right_entity), middle_nodes), tet(4, tags(3, right_entity), "5 4 3 2")};
}

/// The same tets as binary numbers. If partitioned, each tet is in a separate partition and a ghost of the other
/// partition.
std::string binary_msh2(bool is_partitioned = false) {
  const auto put = [](std::string& bytes, auto number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  };
  std::string text = "$MeshFormat\n2.2 1 8\n";
  put(text, 1);
  text += "\n$EndMeshFormat\n" + names + "$Nodes\n5\n";
  for (int v = 0; v < 5; ++v) {
    put(text, v + 1);
    for (const int x : points[v]) put(text, static_cast<double>(x));
  }
  text += "\n$EndNodes\n$Elements\n";
  if (is_partitioned) {
    text += "2\n";
    const int numbers[2][13] = {{4, 1, 5, 1, 1, 1, 2, 1, -2, 1, 2, 3, 4}, {4, 1, 5, 2, 2, 2, 2, 2, -1, 2, 3, 4, 5}};
    for (const auto& element : numbers)
      for (const int number : element) put(text, number);
    return text + "\n$EndElements\n";
  }
  text += "4\n";
  put(text, 4), put(text, 4), put(text, 2);
  const int numbers[4][7] = {
      {1, 1, 1, 1, 2, 3, 4}, {2, 3, 1, 1, 2, 3, 4}, {3, 2, 2, 2, 3, 4, 5}, {4, 3, 2, 2, 3, 4, 5}};
  for (const auto& element : numbers)
    for (const int number : element) put(text, number);
  return text + "\n$EndElements\n";
}

std::string msh1() {
  return "$NOD\n" + nodes() +
         "$ENDNOD\n$ELM\n4\n1 4 1 1 4 1 2 3 4\n2 4 3 1 4 1 2 3 4\n3 4 2 2 4 2 3 4 5\n4 4 3 2 4 2 3 4 5\n$ENDELM\n";
}

TEST_F(GmshGroups, AnElementOfSeveralIsOneCellAndEachCanBeChosen) {
  for (const std::string& text : {msh2(listed_twice("1", "2")), binary_msh2()}) {
    const cells::MeshFile all = read(text);
    EXPECT_EQ(all.counts.cells_read, 2u);
    EXPECT_NEAR(testing::volume(all.mesh), corner + middle, 1e-12);
    EXPECT_EQ(all.blocks, (std::vector<std::string>{"left", "right", "all"}));
    EXPECT_NEAR(volume_of(text, {"left"}), corner, 1e-12);
    EXPECT_NEAR(volume_of(text, {"right"}), middle, 1e-12);
    EXPECT_NEAR(volume_of(text, {"all"}), corner + middle, 1e-12);
    EXPECT_NEAR(volume_of(text, {"right", "all"}), corner + middle, 1e-12);
    test::expect_bad_input([&] { read(text, {"none"}); }, {"no block 'none'", "'left', 'right', 'all'"});
  }
  const cells::MeshFile first_version = read(msh1());
  EXPECT_EQ(first_version.counts.cells_read, 2u);
  EXPECT_EQ(first_version.blocks, (std::vector<std::string>{"group 1", "group 2", "group 3"}));
  EXPECT_NEAR(volume_of(msh1(), {"group 2"}), middle, 1e-12);
}

TEST_F(GmshGroups, AreTheElementsOwnWhereOneEntityHasAll) {
  const std::string text = msh2(listed_twice("1", "1"));
  EXPECT_EQ(read(text).counts.cells_read, 2u);
  EXPECT_NEAR(volume_of(text, {"left"}), corner, 1e-12);
  EXPECT_NEAR(volume_of(text, {"right"}), middle, 1e-12);
  // A cell has the number of its group with the fewest cells, regardless of the order of the groups' numbers.
  const cells::MeshFile mesh = read(text, {}, "PhysicalGroupId");
  ASSERT_EQ(mesh.mesh.scalars.size(), 2u);
  EXPECT_EQ(std::min(mesh.mesh.scalars[0], mesh.mesh.scalars[1]), 1);
  EXPECT_EQ(std::max(mesh.mesh.scalars[0], mesh.mesh.scalars[1]), 2);
}

TEST_F(GmshGroups, CellsListedTwiceByAGroupStayTwice) {
  const std::string text = msh2({tet(1, "2 1 1", corner_nodes), tet(2, "2 1 1", corner_nodes)});
  EXPECT_EQ(read(text).counts.cells_read, 2u);
}

TEST_F(GmshGroups, CellsWithoutAGroupAreRead) {
  const std::string text = msh2({tet(1, "2 1 1", corner_nodes), tet(2, "2 0 2", middle_nodes)});
  const cells::MeshFile mesh = read(text);
  EXPECT_NEAR(testing::volume(mesh.mesh), corner + middle, 1e-12);
  EXPECT_EQ(mesh.counts.cells_nan, 0u);
  EXPECT_EQ(mesh.blocks, (std::vector<std::string>{"left", "no group"}));
  EXPECT_NEAR(volume_of(text, {"no group"}), middle, 1e-12);
}

TEST_F(GmshGroups, AViewHasTheValueOfAnElementUnderAnyOfItsNumbers) {
  const std::string text =
      msh2(listed_twice("1", "2"), "$ElementData\n1\n\"c\"\n1\n0\n3\n0\n1\n2\n2 7\n3 9\n$EndElementData\n");
  const cells::MeshFile mesh = read(text, {}, "c");
  EXPECT_EQ(mesh.counts.cells_nan, 0u);
  std::vector<double> values = mesh.mesh.scalars;
  std::ranges::sort(values);
  EXPECT_EQ(values, (std::vector<double>{7, 9}));
}

TEST_F(GmshGroups, PartitionsAreBlocksAndTheirGhostsAreNotDrawn) {
  // 2.2: the first partition owns the element, negative ones have it as a ghost.
  for (const std::string& text :
       {msh2({tet(1, "5 1 1 2 1 -2", corner_nodes), tet(2, "5 2 2 2 2 -1", middle_nodes)}), binary_msh2(true)}) {
    const cells::MeshFile mesh = read(text);
    EXPECT_EQ(mesh.counts.cells_read, 2u);
    EXPECT_EQ(mesh.blocks, (std::vector<std::string>{"left", "right", "partition 1", "partition 2"}));
    EXPECT_NEAR(volume_of(text, {"partition 2"}), middle, 1e-12);
    EXPECT_NEAR(volume_of(text, {"left", "partition 1"}), corner, 1e-12);
  }
  // 4.1: ghost entities 4 and 5 contain elements of the other partition.
  std::string later =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 0 0\n$EndEntities\n"
      "$PartitionedEntities\n2\n2\n4 1\n5 2\n0 0 0 2\n2 3 1 1 1 0 0 0 1 1 1 0 0\n3 3 1 1 2 0 0 0 1 1 1 0 0\n"
      "$EndPartitionedEntities\n$Nodes\n1 5 1 5\n3 2 0 5\n1\n2\n3\n4\n5\n";
  for (const auto& p : points) later += fmt::format("{} {} {}\n", p[0], p[1], p[2]);
  later +=
      "$EndNodes\n$Elements\n2 2 1 2\n3 2 4 1\n1 1 2 3 4\n3 3 4 1\n2 2 3 4 5\n$EndElements\n"
      "$GhostElements\n2\n1 1 1 2\n2 2 1 1\n$EndGhostElements\n";
  const cells::MeshFile partitioned = read(later);
  EXPECT_EQ(partitioned.counts.cells_read, 2u);
  EXPECT_NEAR(testing::volume(partitioned.mesh), corner + middle, 1e-12);
  EXPECT_EQ(partitioned.blocks, (std::vector<std::string>{"partition 1", "partition 2"}));
  EXPECT_NEAR(volume_of(later, {"partition 2"}), middle, 1e-12);
  EXPECT_EQ(partitioned.mesh.field_name, "PartitionId");
}

TEST_F(GmshGroups, ViewsHaveNamesWithoutQuotesToo) {
  const std::vector<std::string> elements = {tet(1, "2 1 1", corner_nodes), tet(2, "2 1 1", middle_nodes)};
  const auto view = [](const std::string& name, int value) {
    return fmt::format("$ElementData\n1\n{}\n1\n0.0\n3\n0\n1\n2\n1 {}\n2 {}\n$EndElementData\n", name, value,
                       value + 1);
  };
  const std::string text = msh2(elements, view("centre", 10) + view(" my field\t", 20) + view("\"quoted\"", 30));
  for (const auto& [name, low] : {std::pair("centre", 10), std::pair("my field", 20), std::pair("quoted", 30)}) {
    const cells::MeshFile mesh = read(text, {}, name);
    EXPECT_EQ(*std::ranges::min_element(mesh.mesh.scalars), low) << name;
    EXPECT_EQ(*std::ranges::max_element(mesh.mesh.scalars), low + 1) << name;
  }
  const cells::MeshFile nameless = read(msh2(elements, view("\"\"", 40)));
  EXPECT_EQ(nameless.mesh.field_name, "view 1");
  EXPECT_EQ(*std::ranges::max_element(nameless.mesh.scalars), 41);
}

}  // namespace
}  // namespace tessera::io::gmsh_groups_test
