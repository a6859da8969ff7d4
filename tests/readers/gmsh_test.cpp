// SPDX-License-Identifier: BSD-3-Clause
// Gmsh's files and others that its library reads, written by hand according to its reference manual.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <map>

#include "io/files/reader_programs.hpp"
#include "io/foreign/foreign_formats.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

#define TESSERA_GMSH_OR_SKIP() \
  if (!has_reader(Reader::gmsh)) GTEST_SKIP() << "tessera-read-gmsh is not installed"

using Points = std::vector<glm::dvec3>;

/// Two adjacent cubes along x, points at even positions: 12 points, x fastest.
Points two_cubes() {
  Points points;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 3; ++i) points.emplace_back(i, j, k);
  return points;
}
constexpr std::array<std::array<int, 8>, 2> cube_corners = {{{0, 1, 4, 3, 6, 7, 10, 9}, {1, 2, 5, 4, 7, 8, 11, 10}}};

/// Tags have gaps and decrease.
int tag_of(int point) { return 1000 - 7 * point; }

double field_at(const glm::dvec3& p) { return p.x + 2 * p.y + 3 * p.z; }

std::string names() { return "$PhysicalNames\n2\n3 5 \"left\"\n3 9 \"right\"\n$EndPhysicalNames\n"; }

std::string corners_text(int cell) {
  std::string text;
  for (const int v : cube_corners[static_cast<std::size_t>(cell)]) text += fmt::format(" {}", tag_of(v));
  return text + "\n";
}

/// Fields in the format of all MSH versions: several sections of one name for time steps.
std::string node_data(const std::string& name, int step, double factor) {
  std::string text = fmt::format("$NodeData\n1\n\"{}\"\n1\n{}\n3\n{}\n1\n12\n", name, 0.5 * step, step);
  const Points points = two_cubes();
  for (int v = 0; v < 12; ++v) text += fmt::format("{} {}\n", tag_of(v), factor * field_at(points[std::size_t(v)]));
  return text + "$EndNodeData\n";
}

std::string msh2(const std::string& more) {
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names() + "$Nodes\n12\n";
  const Points points = two_cubes();
  for (int v = 0; v < 12; ++v) {
    const glm::dvec3& p = points[static_cast<std::size_t>(v)];
    text += fmt::format("{} {} {} {}\n", tag_of(v), p.x, p.y, p.z);
  }
  text += "$EndNodes\n$Elements\n3\n";
  text += fmt::format("40 5 2 5 1{}30 5 2 9 2{}", corners_text(0), corners_text(1));
  text += fmt::format("20 3 2 1 7 {} {} {} {}\n$EndElements\n", tag_of(0), tag_of(1), tag_of(4), tag_of(3));
  return text + more;
}

std::string msh4(const std::string& more) {
  std::string text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + names() +
                     "$Entities\n0 0 0 2\n1 0 0 0 1 1 1 1 5 0\n2 1 0 0 2 1 1 1 9 0\n$EndEntities\n$Nodes\n1 12 916 "
                     "1000\n3 1 0 12\n";
  const Points points = two_cubes();
  for (int v = 0; v < 12; ++v) text += fmt::format("{}\n", tag_of(v));
  for (const glm::dvec3& p : points) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  return text + "$EndNodes\n$Elements\n2 2 30 40\n3 1 5 1\n40" + corners_text(0) + "3 2 5 1\n30" + corners_text(1) +
         "$EndElements\n" + more;
}

template <class T>
void put(std::string& bytes, T number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string binary_node_data() {
  std::string text = "$NodeData\n1\n\"f\"\n1\n0\n3\n0\n1\n12\n";
  for (int v = 0; v < 12; ++v) {
    put(text, tag_of(v));
    put(text, field_at(two_cubes()[static_cast<std::size_t>(v)]));
  }
  return text + "\n$EndNodeData\n";
}

std::string binary_msh2() {
  std::string text = "$MeshFormat\n2.2 1 8\n";
  put(text, 1);
  text += "\n$EndMeshFormat\n" + names() + "$Nodes\n12\n";
  const Points points = two_cubes();
  for (int v = 0; v < 12; ++v) {
    put(text, tag_of(v));
    const glm::dvec3& p = points[static_cast<std::size_t>(v)];
    put(text, p.x), put(text, p.y), put(text, p.z);
  }
  text += "\n$EndNodes\n$Elements\n2\n";
  put(text, 5), put(text, 2), put(text, 2);
  for (const int cell : {0, 1}) {
    put(text, cell == 0 ? 40 : 30), put(text, cell == 0 ? 5 : 9), put(text, cell + 1);
    for (const int v : cube_corners[static_cast<std::size_t>(cell)]) put(text, tag_of(v));
  }
  return text + "\n$EndElements\n" + binary_node_data();
}

std::string binary_msh4() {
  using Size = std::size_t;
  std::string text = "$MeshFormat\n4.1 1 8\n";
  put(text, 1);
  text += "\n$EndMeshFormat\n" + names() + "$Entities\n";
  put(text, Size{0}), put(text, Size{0}), put(text, Size{0}), put(text, Size{2});
  for (const int entity : {1, 2}) {
    put(text, entity);
    for (const double bound : {entity - 1.0, 0.0, 0.0, entity * 1.0, 1.0, 1.0}) put(text, bound);
    put(text, Size{1}), put(text, entity == 1 ? 5 : 9), put(text, Size{0});
  }
  text += "\n$EndEntities\n$Nodes\n";
  put(text, Size{1}), put(text, Size{12}), put(text, Size{923}), put(text, Size{1000});
  put(text, 3), put(text, 1), put(text, 0), put(text, Size{12});
  for (int v = 0; v < 12; ++v) put(text, static_cast<Size>(tag_of(v)));
  for (const glm::dvec3& p : two_cubes()) put(text, p.x), put(text, p.y), put(text, p.z);
  text += "\n$EndNodes\n$Elements\n";
  put(text, Size{2}), put(text, Size{2}), put(text, Size{30}), put(text, Size{40});
  for (const int cell : {0, 1}) {
    put(text, 3), put(text, cell + 1), put(text, 5), put(text, Size{1}), put(text, Size(cell == 0 ? 40 : 30));
    for (const int v : cube_corners[static_cast<std::size_t>(cell)]) put(text, static_cast<Size>(tag_of(v)));
  }
  return text + "\n$EndElements\n" + binary_node_data();
}

class Gmsh : public ::testing::Test {
 protected:
  void SetUp() override { TESSERA_GMSH_OR_SKIP(); }
  test::TemporaryFolder folder;
};

/// Both cubes with the field unchanged.
void expect_cubes(const cells::MeshFile& read, double factor) {
  EXPECT_NEAR(testing::volume(read.mesh), 2, 1e-12);
  EXPECT_EQ(read.counts.cells_read, 2u);
  ASSERT_EQ(read.mesh.scalars.size(), read.mesh.positions.size());
  for (std::size_t v = 0; v < read.mesh.positions.size(); ++v)
    EXPECT_EQ(read.mesh.scalars[v], factor * field_at(read.mesh.positions[v]));
}

TEST_F(Gmsh, EveryVersionGivesTheSameCellsAndField) {
  expect_cubes(read_mesh(folder.write("a.msh", msh2(node_data("f", 0, 1)))), 1);
  expect_cubes(read_mesh(folder.write("b.msh", msh4(node_data("f", 0, 1)))), 1);
  expect_cubes(read_mesh(folder.write("c.msh", binary_msh2())), 1);
  expect_cubes(read_mesh(folder.write("d.msh", binary_msh4())), 1);
}

TEST_F(Gmsh, PhysicalGroupsAreBlocksAndAField) {
  for (const std::string& text : {msh2(""), msh4("")}) {
    const cells::MeshBlocks read = read_foreign_mesh(identify(folder.write("a.msh", text)), {Reader::gmsh, "gmsh"}, {});
    ASSERT_EQ(read.blocks.size(), 2u);
    EXPECT_EQ(read.blocks[0].name, "left");
    EXPECT_EQ(read.blocks[1].name, "right");
    EXPECT_EQ(read.blocks[1].positions.size(), 8u);
    ReadOptions options;
    options.blocks = {"right"};
    EXPECT_NEAR(testing::volume(read_mesh(folder / "a.msh", options).mesh), 1, 1e-12);
    const cells::MeshFile mesh = read_mesh(folder / "a.msh");
    EXPECT_EQ(mesh.mesh.field_name, "PhysicalGroupId");
    for (std::size_t t = 0; t < mesh.mesh.tets.size(); ++t) {
      const bool right =
          std::ranges::any_of(mesh.mesh.tets[t], [&](std::uint32_t v) { return mesh.mesh.positions[v].x > 1.5; });
      EXPECT_EQ(mesh.mesh.scalars[t], right ? 9 : 5);
    }
  }
}

TEST_F(Gmsh, TimeStepsOfAFieldCountFrom0WhateverTheFileCountsFrom) {
  const auto file = folder.write("a.msh", msh2(node_data("f", 1, 1) + node_data("f", 2, 10) + node_data("f", 3, 100)));
  ReadOptions options;
  expect_cubes(read_mesh(file), 100);
  options.time_step = 1;
  expect_cubes(read_mesh(file, options), 10);
  options.time_step = 3;
  test::expect_bad_input([&] { read_mesh(file, options); }, {"no time step 3", "the file has 3"});
}

TEST_F(Gmsh, FieldsOfCellsAndOfCellsNodesKeepTheirJumps) {
  std::string data = "$ElementData\n1\n\"c\"\n1\n0\n3\n0\n1\n2\n40 4.5\n30 -1\n$EndElementData\n";
  data += "$ElementNodeData\n1\n\"jump\"\n1\n0\n3\n0\n1\n2\n";
  for (const int cell : {0, 1}) {
    data += fmt::format("{} 8", cell == 0 ? 40 : 30);
    for (const int v : cube_corners[static_cast<std::size_t>(cell)])
      data += fmt::format(" {}", 100 * cell + field_at(two_cubes()[static_cast<std::size_t>(v)]));
    data += "\n";
  }
  const auto file = folder.write("a.msh", msh4(data + "$EndElementNodeData\n"));
  ReadOptions options;
  options.field = "c";
  const cells::MeshFile cells = read_mesh(file, options);
  EXPECT_EQ(*std::ranges::max_element(cells.mesh.scalars), 4.5);
  EXPECT_EQ(*std::ranges::min_element(cells.mesh.scalars), -1);
  options.field = "jump";
  const cells::MeshFile jump = read_mesh(file, options);
  std::size_t on_face = 0;
  for (const scene::Tet& tet : jump.mesh.tets) {
    const bool right = std::ranges::any_of(tet, [&](std::uint32_t v) { return jump.mesh.positions[v].x > 1.5; });
    for (const std::uint32_t v : tet) {
      const glm::dvec3& p = jump.mesh.positions[v];
      EXPECT_EQ(jump.mesh.scalars[v], field_at(p) + (right ? 100 : 0));
      if (p.x == 1) ++on_face;
    }
  }
  EXPECT_GT(on_face, 0u);
}

TEST_F(Gmsh, AFieldOfSomeNodesLeavesTheOtherCellsBlank) {
  std::string data = "$NodeData\n1\n\"f\"\n1\n0\n3\n0\n1\n8\n";
  for (const int v : cube_corners[0]) data += fmt::format("{} {}\n", tag_of(v), v);
  const cells::MeshFile read = read_mesh(folder.write("a.msh", msh2(data + "$EndNodeData\n")));
  EXPECT_EQ(read.mesh.field_name, "f");
  EXPECT_NEAR(testing::volume(read.mesh), 1, 1e-12);
  EXPECT_EQ(read.counts.cells_nan, 1u);
}

/// One cell of MSH 2.2, with its nodes at `places` numbered from 1.
std::string one_cell(int type, const Points& places) {
  std::string text = fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", places.size());
  std::string nodes;
  for (std::size_t v = 0; v < places.size(); ++v) {
    text += fmt::format("{} {} {} {}\n", v + 1, places[v].x, places[v].y, places[v].z);
    nodes += fmt::format(" {}", v + 1);
  }
  return text + fmt::format("$EndNodes\n$Elements\n1\n1 {} 2 0 1{}\n$EndElements\n", type, nodes);
}

/// The points of a block's first cell, in its order.
Points cell_points(const cells::CellBlock& block) {
  Points points;
  for (const std::uint32_t v : block.connectivity) points.push_back(block.positions[v]);
  return points;
}

using Edges = std::vector<std::array<std::size_t, 2>>;

Points with_middles(Points corners, const Edges& edges) {
  for (const auto& [a, b] : edges) corners.push_back((corners[a] + corners[b]) / 2.0);
  return corners;
}

TEST_F(Gmsh, SecondOrderNodesComeInVtksOrder) {
  // Gmsh's reference manual, "Node ordering", and VTK's headers of the cells.
  const Points tet = {{0, 0, 0}, {4, 0, 0}, {1, 3, 0}, {0, 1, 5}};
  const Points hexahedron = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}, {0, 0, 5}, {2, 0, 6}, {2, 3, 7}, {0, 3, 8}};
  const Points prism = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 5}, {2, 0, 6}, {0, 3, 7}};
  const Points pyramid = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}, {1, 1, 5}};
  struct Case {
    int gmsh, vtk;
    Points corners;
    Edges theirs, vtks;
  };
  const Case cases[] = {
      {11, 24, tet, {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}}, {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}},
      {17,
       25,
       hexahedron,
       {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}},
       {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}},
      {18,
       26,
       prism,
       {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}},
       {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}},
      {19,
       27,
       pyramid,
       {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 4}, {2, 3}, {2, 4}, {3, 4}},
       {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}},
  };
  for (const Case& c : cases) {
    const auto file = folder.write("a.msh", one_cell(c.gmsh, with_middles(c.corners, c.theirs)));
    const cells::MeshBlocks read = read_foreign_mesh(identify(file), {Reader::gmsh, "gmsh"}, {});
    ASSERT_EQ(read.blocks.size(), 1u);
    ASSERT_EQ(read.blocks[0].types.size(), 1u);
    EXPECT_EQ(read.blocks[0].types[0], c.vtk);
    EXPECT_EQ(cell_points(read.blocks[0]), with_middles(c.corners, c.vtks)) << c.gmsh;
  }
}

TEST_F(Gmsh, ThirdOrderTetrahedraComeInVtksOrder) {
  // Edges in thirds, then the middles of faces.
  const Points corners = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}};
  const auto with_thirds = [&](const Edges& edges, const std::vector<std::array<std::size_t, 3>>& faces) {
    Points points = corners;
    for (const auto& [a, b] : edges)
      for (const double t : {1.0, 2.0}) points.push_back(((3 - t) * corners[a] + t * corners[b]) / 3.0);
    for (const auto& [a, b, c] : faces) points.push_back((corners[a] + corners[b] + corners[c]) / 3.0);
    return points;
  };
  const Points theirs =
      with_thirds({{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {3, 1, 2}});
  const Points vtks =
      with_thirds({{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}, {{0, 1, 3}, {1, 2, 3}, {0, 2, 3}, {0, 1, 2}});
  const cells::MeshBlocks read =
      read_foreign_mesh(identify(folder.write("a.msh", one_cell(29, theirs))), {Reader::gmsh, "gmsh"}, {});
  ASSERT_EQ(read.blocks.size(), 1u);
  EXPECT_EQ(read.blocks[0].types[0], 71);
  EXPECT_EQ(cell_points(read.blocks[0]), vtks);
}

TEST_F(Gmsh, ThirdOrderHexahedraComeInVtksOrder) {
  // Both formats have nodes at thirds of the edges, in different orders. The nodes on faces and inside differ as well.
  const Points corners = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 3}, {3, 0, 3}, {3, 3, 3}, {0, 3, 3}};
  const auto thirds = [&](Points& points, const Edges& edges) {
    for (const auto& [a, b] : edges)
      for (const double t : {1.0, 2.0}) points.push_back(((3 - t) * corners[a] + t * corners[b]) / 3.0);
  };
  Points theirs = corners, vtks = corners;
  thirds(theirs, {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}});
  thirds(vtks, {{0, 1}, {1, 2}, {3, 2}, {0, 3}, {4, 5}, {5, 6}, {7, 6}, {4, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}});
  // Only the order of the edges' nodes is checked here: those of faces and inside may be anywhere.
  for (int k = 0; k < 32; ++k) theirs.emplace_back(1.5, 1.5, 1.5 + 0.01 * k);
  const cells::MeshBlocks read =
      read_foreign_mesh(identify(folder.write("a.msh", one_cell(92, theirs))), {Reader::gmsh, "gmsh"}, {});
  ASSERT_EQ(read.blocks.size(), 1u);
  EXPECT_EQ(read.blocks[0].types[0], 72);
  Points points = cell_points(read.blocks[0]);
  ASSERT_EQ(points.size(), 64u);
  points.resize(32);
  EXPECT_EQ(points, vtks);
}

TEST_F(Gmsh, CompleteQuadraticPyramidsComeInLagrangesOrder) {
  const Points corners = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}, {1, 1, 5}};
  Points theirs = with_middles(corners, {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 4}, {2, 3}, {2, 4}, {3, 4}});
  Points ours = with_middles(corners, {{0, 1}, {1, 2}, {3, 2}, {0, 3}, {0, 4}, {1, 4}, {2, 4}, {3, 4}});
  theirs.emplace_back(1, 1.5, 0.25), ours.emplace_back(1, 1.5, 0.25);
  const cells::MeshBlocks read =
      read_foreign_mesh(identify(folder.write("a.msh", one_cell(14, theirs))), {Reader::gmsh, "gmsh"}, {});
  ASSERT_EQ(read.blocks.size(), 1u);
  EXPECT_EQ(read.blocks[0].types[0], 74);
  EXPECT_EQ(cell_points(read.blocks[0]), ours);
}

TEST_F(Gmsh, ThirdOrderPrismsComeInVtksOrder) {
  // Nodes in thirds, as Gmsh 4.8 numbers those of a prism that it creates (Mesh.ElementOrder 3), and as VTK's
  // vtkHigherOrderWedge does.
  const Points theirs = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 3}, {3, 0, 3}, {0, 3, 3}, {1, 0, 0}, {2, 0, 0},
                         {0, 1, 0}, {0, 2, 0}, {0, 0, 1}, {0, 0, 2}, {2, 1, 0}, {1, 2, 0}, {3, 0, 1}, {3, 0, 2},
                         {0, 3, 1}, {0, 3, 2}, {1, 0, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 3}, {2, 1, 3}, {1, 2, 3},
                         {1, 1, 0}, {1, 1, 3}, {1, 0, 1}, {2, 0, 1}, {2, 0, 2}, {1, 0, 2}, {0, 1, 1}, {0, 1, 2},
                         {0, 2, 2}, {0, 2, 1}, {2, 1, 1}, {1, 2, 1}, {1, 2, 2}, {2, 1, 2}, {1, 1, 1}, {1, 1, 2}};
  const Points vtks = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 3}, {3, 0, 3}, {0, 3, 3}, {1, 0, 0}, {2, 0, 0},
                       {2, 1, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}, {1, 0, 3}, {2, 0, 3}, {2, 1, 3}, {1, 2, 3},
                       {0, 2, 3}, {0, 1, 3}, {0, 0, 1}, {0, 0, 2}, {3, 0, 1}, {3, 0, 2}, {0, 3, 1}, {0, 3, 2},
                       {1, 1, 0}, {1, 1, 3}, {1, 0, 1}, {2, 0, 1}, {1, 0, 2}, {2, 0, 2}, {2, 1, 1}, {1, 2, 1},
                       {2, 1, 2}, {1, 2, 2}, {0, 2, 1}, {0, 1, 1}, {0, 2, 2}, {0, 1, 2}, {1, 1, 1}, {1, 1, 2}};
  const cells::MeshBlocks read =
      read_foreign_mesh(identify(folder.write("a.msh", one_cell(90, theirs))), {Reader::gmsh, "gmsh"}, {});
  ASSERT_EQ(read.blocks.size(), 1u);
  EXPECT_EQ(read.blocks[0].types[0], 73);
  EXPECT_EQ(cell_points(read.blocks[0]), vtks);
}

TEST_F(Gmsh, ReportsTruncatedAndMissingFiles) {
  const std::string whole = msh2(node_data("f", 0, 1));
  for (std::size_t length = 40; length + 14 < whole.size(); length += 97)
    test::expect_bad_input([&] { read_mesh(folder.write("a.msh", whole.substr(0, length))); }, {"a.msh"});
  std::string other = whole;
  other.replace(other.find(" 1000 "), 6, " 1001 ");
  test::expect_bad_input([&] { read_mesh(folder.write("b.msh", other)); }, {"b.msh"});
  const std::string flat =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n1\n1 2 2 0 1 "
      "1 2 "
      "3\n$EndElements\n";
  test::expect_bad_input([&] { read_mesh(folder.write("c.msh", flat)); }, {"c.msh", "no cells of volume"});
}

TEST_F(Gmsh, ScriptsAreNotRun) {
  const std::string ran = (folder / "ran").string();
  const std::string script = "SystemCall \"touch " + ran + "\";\n";
  for (const char* name : {"a.geo", "a.msh", "a", "a.pos"})
    for (const std::string& before : {std::string(), std::string("\n"), std::string("$MeshFormat\n"),
                                      std::string("\n$MeshFormat\n2.2 0 8\n$EndMeshFormat\n")}) {
      test::fault_of([&] { read_mesh(folder.write(name, before + script + "//\n$End\n")); });
      EXPECT_FALSE(std::filesystem::exists(ran)) << name << before;
    }
  // The options file that Gmsh reads together with a mesh.
  folder.write("b.msh", msh2(""));
  folder.write("b.msh.opt", script);
  read_mesh(folder / "b.msh");
  EXPECT_FALSE(std::filesystem::exists(ran));
}

}  // namespace
}  // namespace tessera::io
