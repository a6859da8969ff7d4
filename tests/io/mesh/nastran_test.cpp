// SPDX-License-Identifier: BSD-3-Clause
// Nastran decks, written according to MSC's Quick Reference Guide.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "io/mesh/nastran_file.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io::nastran_test {
namespace {

using Points = std::vector<glm::dvec3>;

/// An entry in fields of 8 characters, with a continuation line after every eight fields.
std::string small(const std::vector<std::string>& fields) {
  std::string text = fmt::format("{:8}", fields[0]);
  for (std::size_t k = 1; k < fields.size(); ++k) {
    if (k > 1 && k % 8 == 1) text += "+\n+       ";
    text += fmt::format("{:>8}", fields[k]);
  }
  return text + "\n";
}
std::string large(const std::vector<std::string>& fields) {
  std::string text = fmt::format("{:8}", fields[0] + "*");
  for (std::size_t k = 1; k < fields.size(); ++k) {
    if (k > 1 && k % 4 == 1) text += "*\n*       ";
    text += fmt::format("{:>16}", fields[k]);
  }
  return text + "\n";
}
std::string free_form(const std::vector<std::string>& fields) {
  std::string text = fields[0];
  for (std::size_t k = 1; k < fields.size(); ++k) {
    if (k > 1 && k % 8 == 1) text += ",+\n+";
    text += "," + fields[k];
  }
  return text + "\n";
}

const Points cube = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

std::vector<std::string> grid(int id, const std::string& system, const glm::dvec3& p) {
  return {"GRID",
          fmt::format("{}", id),
          system,
          fmt::format("{:#.6g}", p.x).substr(0, 8),
          fmt::format("{:#.6g}", p.y).substr(0, 8),
          fmt::format("{:#.6g}", p.z).substr(0, 8)};
}
std::vector<std::string> hexahedron(int id, int property) {
  return {"CHEXA", fmt::format("{}", id), fmt::format("{}", property), "1", "2", "3", "4", "5", "6", "7", "8"};
}

std::string deck(const std::string& bulk) { return "SOL 101\nCEND\nBEGIN BULK\n" + bulk + "ENDDATA\n"; }

/// A hexahedron between the radii 1 and 2 and over a quarter turn about z, in a system that `system` defines.
std::string quarter(const std::string& system, const std::string& id = "7") {
  std::string text = system;
  const Points corners = {{1, 0, 0}, {2, 0, 0}, {2, 90, 0}, {1, 90, 0}, {1, 0, 1}, {2, 0, 1}, {2, 90, 1}, {1, 90, 1}};
  for (int k = 0; k < 8; ++k) text += small(grid(k + 1, id, corners[static_cast<std::size_t>(k)]));
  return deck(text + small(hexahedron(1, 1)));
}

class Nastran : public ::testing::Test {
 protected:
  Points points_of(const std::string& text) {
    const auto blocks = read_nastran(folder.write("a.bdf", text));
    return blocks.at(0).positions;
  }
  void expect_points(const std::string& text, const Points& wanted) {
    const Points points = points_of(text);
    ASSERT_EQ(points.size(), wanted.size());
    for (std::size_t v = 0; v < wanted.size(); ++v)
      EXPECT_LT(glm::distance(points[v], wanted[v]), 1e-5)
          << v << ": " << points[v].x << " " << points[v].y << " " << points[v].z;
  }

  test::TemporaryFolder folder;
};

TEST_F(Nastran, EveryFormOfFieldsIsTheSameMesh) {
  for (const auto& form : {small, large, free_form}) {
    std::string bulk = "$ a comment\n";
    for (int k = 0; k < 8; ++k) bulk += form(grid(k + 1, "", cube[static_cast<std::size_t>(k)]));
    bulk += form(hexahedron(1, 1)) + form({"CQUAD4", "2", "1", "1", "2", "3", "4"});
    for (const std::string& text : {deck(bulk), bulk}) {
      const cells::MeshFile read = read_mesh(folder.write("a.bdf", text));
      EXPECT_NEAR(testing::volume(read.mesh), 1, 1e-12) << text;
      EXPECT_EQ(read.counts.cells_read, 1u);
      EXPECT_EQ(read.format, "Nastran");
    }
  }
  expect_points(deck("GRID\t1\t\t0.\t1.5\t-2.\ngrid,2,,1.5-1,+2.5+1,1.D0\nGRID,3,,0.,1.,0.\nGRID,4,,0.,0.,1.\n"
                     "CTETRA,1,1,1,2,3,4\n"),
                {{0, 1.5, -2}, {0.15, 25, 1}, {0, 1, 0}, {0, 0, 1}});
}

TEST_F(Nastran, PointsAreInTheSystemsOfTheirGrids) {
  const Points turned = {{1, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 1, 0}, {1, 0, 1}, {2, 0, 1}, {0, 2, 1}, {0, 1, 1}};
  const std::vector<std::string> axes = {"0.", "0.", "0.", "0.", "0.", "1.", "1.", "0.", "0."};
  const auto cord = [&](const char* kind, const std::string& id, const std::string& reference,
                        std::vector<std::string> corners) {
    corners.insert(corners.begin(), {kind, id, reference});
    return small(corners);
  };
  expect_points(quarter(cord("CORD2C", "7", "", axes)), turned);
  // A system with another axis and another origin: z becomes x, and x becomes y.
  Points moved;
  for (const glm::dvec3& p : turned) moved.emplace_back(5 + p.z, p.x, p.y);
  const std::string other = cord("CORD2C", "7", "0", {"5.", "0.", "0.", "6.", "0.", "0.", "5.", "1.", "0."});
  expect_points(quarter(other), moved);
  // A system that is defined in another system, and one that is defined by three points.
  expect_points(quarter(cord("CORD2R", "3", "0", {"5.", "0.", "0.", "6.", "0.", "0.", "5.", "1.", "0."}) +
                        cord("CORD2C", "7", "3", axes)),
                moved);
  expect_points(quarter("GRID,101,,5.,0.,0.\nGRID,102,,9.,0.,0.\nGRID,103,,7.,3.,0.\nCORD1C,6,1,2,3,7,101,102,103\n"),
                moved);
  // The system is the default of all points that state none; points that state 0 do not use it.
  expect_points(quarter(other + "GRDSET,,7\nGRID,20,0,9.,9.,9.\nCTETRA,5,1,1,2,3,20\n", ""), [&] {
    Points with = moved;
    with.insert(with.begin() + 3, {9, 9, 9});
    return Points{moved[0], moved[1], moved[2], {9, 9, 9}, moved[3], moved[4], moved[5], moved[6], moved[7]};
  }());
}

TEST_F(Nastran, SphericalSystemsHaveTheAngleFromTheAxisFirst) {
  const double r = 2, half = std::sqrt(0.5);
  expect_points(deck("CORD2S,1,0,0.,0.,0.,0.,0.,1.,+\n+,1.,0.,0.\nGRID,1,1,2.,0.,33.\nGRID,2,1,2.,90.,0.\n"
                     "GRID,3,1,2.,90.,90.\nGRID,4,1,2.,45.,180.\nCTETRA,1,1,1,2,3,4\n"),
                {{0, 0, r}, {r, 0, 0}, {0, r, 0}, {-r * half, 0, r * half}});
}

TEST_F(Nastran, BlankNodesInTheMiddleOfEdgesAreTheMiddle) {
  const std::string grids = "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,0.,2.,0.\nGRID,4,,0.,0.,2.\n";
  const auto blocks = read_nastran(folder.write(
      "a.bdf", deck(grids + "GRID,5,,1.,-.5,0.\n" + small({"CTETRA", "1", "1", "1", "2", "3", "4", "5", ""}) +
                    "+       \nCTETRA,2,1,1,2,3,4\n")));
  EXPECT_EQ(blocks.at(0).types, (std::vector<std::uint8_t>{24, 10}));
  Points nodes;
  for (std::size_t k = 0; k < 10; ++k) nodes.push_back(blocks[0].positions[blocks[0].connectivity[k]]);
  EXPECT_EQ(nodes, (Points{{0, 0, 0},
                           {2, 0, 0},
                           {0, 2, 0},
                           {0, 0, 2},
                           {1, -.5, 0},
                           {1, 1, 0},
                           {0, 1, 0},
                           {0, 0, 1},
                           {1, 0, 1},
                           {0, 1, 1}}));
  const cells::MeshFile straight = read_mesh(folder.write("b.bdf", deck(grids + "CTETRA,1,1,1,2,3,4,,\n+,,,,\n")));
  EXPECT_EQ(straight.mesh.tets.size(), 1u);
  EXPECT_NEAR(testing::volume(straight.mesh), 8.0 / 6, 1e-12);
}

/// A cell of corners and the middles of `edges`, in Nastran's order, compared with VTK's.
TEST_F(Nastran, CellsOfSecondOrderHaveTheirNodesInVtksOrder) {
  using Edges = std::vector<std::array<std::size_t, 2>>;
  struct Case {
    const char* name;
    std::uint8_t type;
    Points corners;
    Edges theirs, vtks;
  };
  const Points prism = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 5}, {2, 0, 6}, {0, 3, 7}};
  const Points pyramid = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}, {1, 1, 5}};
  const Edges of_pyramid = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}};
  const std::vector<Case> cases = {
      {"CHEXA",
       25,
       cube,
       {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5}, {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}},
       {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}},
      {"CPENTA",
       26,
       prism,
       {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 4}, {2, 5}, {3, 4}, {4, 5}, {5, 3}},
       {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}},
      {"CPYRAM", 27, pyramid, of_pyramid, of_pyramid}};
  for (const Case& c : cases) {
    Points given = c.corners, wanted = c.corners;
    for (const auto& [a, b] : c.theirs) given.push_back((c.corners[a] + c.corners[b]) / 2.0);
    for (const auto& [a, b] : c.vtks) wanted.push_back((c.corners[a] + c.corners[b]) / 2.0);
    std::string bulk;
    std::vector<std::string> cell = {c.name, "1", "1"};
    for (std::size_t v = 0; v < given.size(); ++v) {
      bulk += free_form(grid(static_cast<int>(v) + 1, "", given[v]));
      cell.push_back(fmt::format("{}", v + 1));
    }
    const auto blocks = read_nastran(folder.write("a.bdf", deck(bulk + small(cell))));
    EXPECT_EQ(blocks.at(0).types, (std::vector<std::uint8_t>{c.type}));
    Points nodes;
    for (const std::uint32_t v : blocks[0].connectivity) nodes.push_back(blocks[0].positions[v]);
    EXPECT_EQ(nodes, wanted) << c.name;
  }
}

TEST_F(Nastran, IncludedFilesAreReadInTheirPlaces) {
  std::string grids;
  for (int k = 0; k < 8; ++k) grids += small(grid(k + 1, "", cube[static_cast<std::size_t>(k)]));
  std::filesystem::create_directory(folder / "parts");
  folder.write("parts/grids.bdf", grids + "INCLUDE 'again.bdf'\n");
  folder.write("parts/again.bdf", "INCLUDE 'grids.bdf'\n$ once more\n");
  for (const char* include : {"INCLUDE 'parts/grids.bdf'\n", "include \"parts/\n   grids.bdf\"\n",
                              "INCLUDE parts/grids.bdf\nINCLUDE 'parts/grids.bdf' $ twice\n"}) {
    const cells::MeshFile read = read_mesh(folder.write("a.bdf", deck(include + small(hexahedron(1, 1)))));
    EXPECT_NEAR(testing::volume(read.mesh), 1, 1e-12) << include;
    EXPECT_EQ(read.counts.cells_read, 1u);
  }
  // The sections before the bulk data contain no mesh.
  const std::string control = "INCLUDE 'modes.v2005'\n" + deck("INCLUDE 'parts/grids.bdf'\n" + small(hexahedron(1, 1)));
  EXPECT_NEAR(testing::volume(read_mesh(folder.write("d.bdf", control)).mesh), 1, 1e-12);
  test::expect_bad_input([&] { read_mesh(folder.write("b.bdf", deck("INCLUDE 'none.bdf'\n"))); },
                         {"b.bdf", "line 4", "'none.bdf'", "no such file"});
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  test::expect_bad_input([&] { read_mesh(folder.write("c.bdf", deck("INCLUDE 'pipe'\n"))); }, {"c.bdf", "'pipe'"});
}

TEST_F(Nastran, PropertiesAreBlocksAndAField) {
  std::string bulk;
  for (int k = 0; k < 8; ++k) {
    bulk += small(grid(k + 1, "", cube[static_cast<std::size_t>(k)]));
    bulk += small(grid(k + 11, "", cube[static_cast<std::size_t>(k)] + glm::dvec3(3, 0, 0)));
  }
  const auto file =
      folder.write("a.nas", deck(bulk + "CHEXA,1,30,11,12,13,14,15,16\n,17,18\n" + small(hexahedron(2, 4))));
  const cells::MeshFile read = read_mesh(file);
  EXPECT_EQ(read.blocks, (std::vector<std::string>{"property 4", "property 30"}));
  EXPECT_EQ(read.mesh.field_name, "PropertyId");
  for (std::size_t t = 0; t < read.mesh.tets.size(); ++t)
    EXPECT_EQ(read.mesh.scalars[t], read.mesh.positions[read.mesh.tets[t][0]].x < 2 ? 4 : 30);
  ReadOptions options;
  options.blocks = {"property 30"};
  EXPECT_NEAR(testing::volume(read_mesh(file, options).mesh), 1, 1e-12);
}

TEST_F(Nastran, ReplicationsCopyAndAddToTheEntryBefore) {
  const std::string grids = "GRID,1,,0.,0.,0.\n=,*1,=,*(1.5),==\n=(2)\nGRID,5,,2,0.25,-1.\n=,*(1),=,=,*-1,*(.5)\n";
  expect_points(deck(grids + "CTETRA,1,1,1,2,3,4\nCTETRA,2,1,3,4,5,6\n"),
                {{0, 0, 0}, {1.5, 0, 0}, {3, 0, 0}, {4.5, 0, 0}, {2, 0.25, -1}, {2, -0.75, -0.5}});
  const auto cells_of = [&](const std::string& elements) {
    std::string bulk;
    for (int k = 0; k < 40; ++k) bulk += fmt::format("GRID,{},,{}.,{}.,{}.\n", k + 1, k % 3, k * k % 7, k * k * k % 11);
    std::vector<std::vector<std::uint32_t>> cells;
    for (const cells::CellBlock& block : read_nastran(folder.write("a.bdf", deck(bulk + elements))))
      for (std::size_t c = 0; c < block.types.size(); ++c) {
        const auto first = block.connectivity.begin() + static_cast<std::ptrdiff_t>(block.offsets[c]);
        cells.emplace_back(first, first + static_cast<std::ptrdiff_t>(block.offsets[c + 1] - block.offsets[c]));
        for (std::uint32_t& node : cells.back()) ++node;
      }
    return cells;
  };
  using Cells = std::vector<std::vector<std::uint32_t>>;
  const Cells tets = {{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}};
  EXPECT_EQ(cells_of("CTETRA,1,1,1,2,3,4\n=,*1,=,*4,*4,*4,*4\n=,*1,=,*4,*4,*4,*4\n"), tets);
  EXPECT_EQ(cells_of("CTETRA,1,1,1,2,3,4\n$ a comment\n=(2),*1,=,*4,*4,*4,*4\n"), tets);
  EXPECT_EQ(cells_of("CTETRA,1,1,1,2,3,4\n=,*1,=,*4,*4,*4,*4\n=1\n"), tets);
  EXPECT_EQ(cells_of("CTETRA  1       1       1       2       3       4\n"
                     "=(2)    *(1)    =       *(4)    *(4)    *(4)    *(4)\n"),
            tets);
  EXPECT_EQ(cells_of("CTETRA,1,1,1,2,3,4\nCTETRA,*1,=,5,6,7,8\n=,*1,==\n"),
            (Cells{{1, 2, 3, 4}, {5, 6, 7, 8}, {5, 6, 7, 8}}));
  // Entries with continuations. `==` copies the remaining fields of the entry before, including those of its
  // continuation.
  const Cells hexahedra = {{1, 2, 3, 4, 5, 6, 7, 8}, {9, 10, 11, 12, 13, 14, 15, 16}};
  EXPECT_EQ(cells_of("CHEXA,1,1,1,2,3,4,5,6,+\n+,7,8\n=,*1,=,*8,*8,*8,*8,*8,*8,+\n+,*8,*8\n"), hexahedra);
  EXPECT_EQ(cells_of("CHEXA,1,1,1,2,3,4,5,6,+\n+,7,8\n=,*1,=,3,4,5,6,==\n"),
            (Cells{hexahedra[0], {3, 4, 5, 6, 5, 6, 7, 8}}));
  // If an entry is not read, its replications are not read either.
  EXPECT_EQ(cells_of("CTETRA,1,1,1,2,3,4\nCQUAD4,2,1,1,2,3,4\n=,*1,=,*4,*4,*4,*4\n").size(), 1u);
}

TEST_F(Nastran, FaultsAreNamed) {
  const auto refuse = [&](const std::string& bulk, const std::vector<std::string>& parts) {
    test::expect_bad_input([&] { read_nastran(folder.write("a.bdf", deck(bulk))); }, parts);
  };
  const std::string grids = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\n", tet = "CTETRA,9,1,1,2,3,4\n";
  refuse(grids, {"a.bdf", "no elements"});
  refuse(grids + tet, {"a.bdf", "element 9 uses GRID 4"});
  refuse(grids + "GRID,4,5,0.,0.,1.\n" + tet, {"GRID 4 is in the coordinate system 5, which the file does not have"});
  refuse(grids + "GRID,4,5,0.,0.,1.\nCORD3G,5,1,2,3\n" + tet, {"system 5, a 'CORD3G', which is not supported"});
  refuse(grids +
             "GRID,4,5,0.,0.,1.\nCORD2R,5,6,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,6,5,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n" +
             tet,
         {"refers back to itself"});
  refuse(grids + "GRID,4,5,0.,0.,1.\nCORD1R,5,1,2,4\n" + tet,
         {"GRID 4 is in a coordinate system that it defines itself"});
  refuse(grids + "GRID,4,5,0.,0.,1.\nCORD2R,5,0,0.,0.,0.,0.,0.,1.\n,0.,0.,2.\n" + tet, {"on one line"});
  refuse(grids + "GRID,4,,0.,zero,1.\n" + tet, {"line 7", "'zero' of GRID is not a number"});
  refuse(grids + "GRID,1,,5.,0.,1.\n" + tet, {"GRID 1 is given twice"});
  refuse(grids + "CTETRA,9,1,1,2,,4\n", {"line 7", "corner 3 is blank"});
  refuse(grids + "GRID,4,,0.,0.,1.\n=,*x,==\n" + tet, {"line 8", "'x' of GRID is not a number"});
  refuse(grids + "GRID,4,,0.,0.,1.\n=,=3,==\n" + tet, {"line 8", "'=3' of GRID is not a valid replication"});
  refuse(grids + "GRID,4,,0.,0.,1.\n=(many)\n" + tet, {"line 8", "'=(MANY)' is not a number of replications"});
  refuse(grids + "GRID,4,,0.,0.,1.\n=,*1,==\n=(4000000000)\n" + tet, {"line 9", "replicates more than 10000000"});
  refuse(grids + "GRID,9223372036854775807,,0.,0.,1.\n=,*1,==\n" + tet, {"line 8", "'*1' of GRID", "2^63"});
  refuse(grids + "CTETRA,=,1,1,2,3,4\n", {"line 7", "'=' of CTETRA has no CTETRA before it"});
  for (const char* part : {"BEGIN SUPER=1\n", "begin bulk super = 1\n"})
    refuse(grids + part + "GRID,1,,5.,0.,0.\n" + tet, {"line 7", "BEGIN SUPER", "give each part as a file"});
}

}  // namespace
}  // namespace tessera::io::nastran_test
