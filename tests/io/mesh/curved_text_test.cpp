// SPDX-License-Identifier: BSD-3-Clause
// Cells of second order in text formats, each with its nodes in the order of the format's manual.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "io/files/reader_programs.hpp"
#include "support/curved_reference.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io::curved_text_test {
namespace {

using testing::BentCell;
using testing::CellSpace;
using testing::ReferenceCell;
using Lists = std::vector<std::vector<int>>;
/// Cells, each with the name that the format gives it.
using Named = std::vector<std::pair<ReferenceCell, std::string>>;

constexpr auto tet = cells::CurvedFamily::tet, pyramid = cells::CurvedFamily::pyramid,
               wedge = cells::CurvedFamily::wedge, hexahedron = cells::CurvedFamily::hexahedron;

template <class... More>
Lists together(Lists first, const More&... more) {
  (first.insert(first.end(), more.begin(), more.end()), ...);
  return first;
}

const Lists tet_edges = {{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 4}, {3, 4}},
            pyramid_edges = {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {1, 5}, {2, 5}, {3, 5}, {4, 5}},
            wedge_base = {{1, 2}, {2, 3}, {3, 1}}, wedge_top = {{4, 5}, {5, 6}, {6, 4}},
            wedge_upright = {{1, 4}, {2, 5}, {3, 6}}, wedge_sides = {{1, 2, 5, 4}, {2, 3, 6, 5}, {1, 3, 6, 4}},
            base_edges = {{1, 2}, {2, 3}, {3, 4}, {4, 1}}, top_edges = {{5, 6}, {6, 7}, {7, 8}, {8, 5}},
            upright_edges = {{1, 5}, {2, 6}, {3, 7}, {4, 8}};

/// Nodes have the order of VTK's headers, and therefore also of XDMF and EnSight.
const ReferenceCell tet10{"10-node tetrahedron", tet, tet_edges},
    pyramid13{"13-node pyramid", pyramid, pyramid_edges, CellSpace::linear},
    wedge15{"15-node wedge", wedge, together(wedge_base, wedge_top, wedge_upright)},
    wedge18{"18-node wedge", wedge, together(wedge15.middles, wedge_sides)},
    hex20{"20-node hexahedron", hexahedron, together(base_edges, top_edges, upright_edges)},
    hex24{"24-node hexahedron", hexahedron,
          together(hex20.middles, Lists{{1, 4, 8, 5}, {2, 3, 7, 6}, {1, 2, 6, 5}, {4, 3, 7, 8}})},
    hex27{"27-node hexahedron", hexahedron,
          together(hex24.middles, Lists{{1, 2, 3, 4}, {5, 6, 7, 8}, {1, 2, 3, 4, 5, 6, 7, 8}})};

std::string numbers_to(std::size_t end, std::size_t first) {
  std::string text;
  for (std::size_t k = first; k < end + first; ++k) text += fmt::format(" {}", k);
  return text;
}

class CurvedText : public ::testing::Test {
 protected:
  cells::MeshFile read(const std::string& name, const std::string& text, const std::string& field = "f") const {
    ReadOptions options = testing::coarse_options();
    options.field = field;
    return read_mesh(folder.write(name, text), options);
  }
  test::TemporaryFolder folder;
};

TEST_F(CurvedText, LegacyVtk) {
  if (!has_reader(Reader::vtk)) GTEST_SKIP() << "tessera-read-vtk is not installed";
  for (const auto& [cell, type] : Named{{tet10, "24"},
                                        {pyramid13, "27"},
                                        {wedge15, "26"},
                                        {wedge18, "32"},
                                        {hex20, "25"},
                                        {hex24, "33"},
                                        {hex27, "29"}}) {
    SCOPED_TRACE(cell.name);
    const BentCell bent = testing::bend(cell);
    const std::size_t n = bent.positions.size();
    std::string text =
        fmt::format("# vtk DataFile Version 3.0\none\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double\n", n);
    for (const glm::dvec3& p : bent.positions) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
    text += fmt::format("CELLS 1 {}\n{}{}\nCELL_TYPES 1\n{}\nPOINT_DATA {}\nSCALARS f double 1\nLOOKUP_TABLE default\n",
                        n + 1, n, numbers_to(n, 0), type, n);
    for (const double value : bent.values) text += fmt::format("{}\n", value);
    testing::expect_same(read("a.vtk", text), bent);
  }
}

TEST_F(CurvedText, Xdmf) {
  if (!has_reader(Reader::xdmf)) GTEST_SKIP() << "tessera-read-xdmf is not installed";
  for (const auto& [cell, type] : Named{{tet10, "Tetrahedron_10"},
                                        {pyramid13, "Pyramid_13"},
                                        {wedge15, "Wedge_15"},
                                        {wedge18, "Wedge_18"},
                                        {hex20, "Hexahedron_20"},
                                        {hex24, "Hexahedron_24"},
                                        {hex27, "Hexahedron_27"}}) {
    SCOPED_TRACE(cell.name);
    const BentCell bent = testing::bend(cell);
    const std::size_t n = bent.positions.size();
    std::string points, values;
    for (const glm::dvec3& p : bent.positions) points += fmt::format("{} {} {} ", p.x, p.y, p.z);
    for (const double value : bent.values) values += fmt::format("{} ", value);
    const auto item = [](const std::string& sides, const std::string& numbers, const char* number, int bytes) {
      return fmt::format(
          "<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"{}\" Format=\"XML\">{}</DataItem>\n", sides,
          number, bytes, numbers);
    };
    const std::string text =
        "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"3.0\">\n<Domain>\n<Grid Name=\"g\" GridType=\"Uniform\">\n" +
        fmt::format("<Topology TopologyType=\"{}\" NumberOfElements=\"1\">\n", type) +
        item(fmt::format("1 {}", n), numbers_to(n, 0), "Int", 4) + "</Topology>\n<Geometry GeometryType=\"XYZ\">\n" +
        item(fmt::format("{} 3", n), points, "Float", 8) +
        "</Geometry>\n<Attribute Name=\"f\" AttributeType=\"Scalar\" Center=\"Node\">\n" +
        item(fmt::format("{}", n), values, "Float", 8) + "</Attribute>\n</Grid>\n</Domain>\n</Xdmf>\n";
    testing::expect_same(read("a.xmf", text), bent);
  }
}

TEST_F(CurvedText, EnSightGold) {
  if (!has_reader(Reader::vtk)) GTEST_SKIP() << "tessera-read-vtk is not installed";
  for (const auto& [cell, type] :
       Named{{tet10, "tetra10"}, {pyramid13, "pyramid13"}, {wedge15, "penta15"}, {hex20, "hexa20"}}) {
    SCOPED_TRACE(cell.name);
    const BentCell bent = testing::bend(cell);
    const std::size_t n = bent.positions.size();
    std::string geometry =
        fmt::format("one\ncell\nnode id off\nelement id off\npart\n{:10}\ncell\ncoordinates\n{:10}\n", 1, n);
    for (int axis = 0; axis < 3; ++axis)
      for (const glm::dvec3& p : bent.positions) geometry += fmt::format("{:12.5e}\n", p[axis]);
    geometry += fmt::format("{}\n{:10}\n", type, 1);
    for (std::size_t k = 1; k <= n; ++k) geometry += fmt::format("{:10}", k);
    std::string values = fmt::format("f\npart\n{:10}\ncoordinates\n", 1);
    for (const double value : bent.values) values += fmt::format("{:12.5e}\n", value);
    folder.write("a.geo", geometry + "\n");
    folder.write("a.f", values);
    testing::expect_same(
        read("a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: a.geo\nVARIABLE\nscalar per node: f a.f\n"), bent);
  }
}

TEST_F(CurvedText, NotesThatEnSight6CellsUseTheirCorners) {
  if (!has_reader(Reader::vtk)) GTEST_SKIP() << "tessera-read-vtk is not installed";
  for (const bool is_quadratic : {true, false}) {
    const std::vector<glm::dvec3> places = testing::places_of(hex20);
    const std::size_t n = is_quadratic ? 20 : 8;
    std::string geometry = fmt::format("one\ncell\nnode id off\nelement id off\ncoordinates\n{:8}\n", n);
    for (std::size_t k = 0; k < n; ++k)
      geometry += fmt::format("{:12.5e}{:12.5e}{:12.5e}\n", places[k].x, places[k].y, places[k].z);
    geometry += fmt::format("part 1\ncell\n{}\n{:8}\n", is_quadratic ? "hexa20" : "hexa8", 1);
    for (std::size_t k = 1; k <= n; ++k) geometry += fmt::format("{:8}", k);
    folder.write("six.geo", geometry + "\n");
    const cells::MeshFile mesh = read("six.case", "FORMAT\ntype: ensight\nGEOMETRY\nmodel: six.geo\n", "");
    EXPECT_NEAR(testing::volume(mesh.mesh), 1, 1e-12);
    const bool is_noted = std::ranges::any_of(mesh.notes, [](const std::string& note) {
      return note.find("(hexa20) are drawn as linear cells") != std::string::npos;
    });
    EXPECT_EQ(is_noted, is_quadratic);
  }
}

TEST_F(CurvedText, RefusesSecondOrderElementsOfGambit) {
  if (!has_reader(Reader::vtk)) GTEST_SKIP() << "tessera-read-vtk is not installed";
  const std::vector<glm::dvec3> places = testing::places_of(tet10);
  std::string text =
      "        CONTROL INFO 2.0.0\n** GAMBIT NEUTRAL FILE\none\nPROGRAM:  Gambit  VERSION:  2.0.0\n1 Jan 2020\n"
      "     NUMNP     NELEM     NGRPS    NBSETS     NDFCD     NDFVL\n        10         1         0         0         "
      "3  "
      "       3\nENDOFSECTION\n   NODAL COORDINATES 2.0.0\n";
  for (std::size_t k = 0; k < 10; ++k)
    text += fmt::format("{:10} {:.6e} {:.6e} {:.6e}\n", k + 1, places[k].x, places[k].y, places[k].z);
  text += "ENDOFSECTION\n      ELEMENTS/CELLS 2.0.0\n       7  6 10 1 2 3 4 5 6 7\n 8 9 10\nENDOFSECTION\n";
  test::expect_bad_input([&] { read("a.neu", text, ""); },
                         {"a.neu: element 7 is a tetrahedron of 10 nodes", "export CGNS"});
}

TEST_F(CurvedText, Gmsh) {
  if (!has_reader(Reader::gmsh)) GTEST_SKIP() << "tessera-read-gmsh is not installed";
  const Lists hexahedron_edges = {{1, 2}, {1, 4}, {1, 5}, {2, 3}, {2, 6}, {3, 4},
                                  {3, 7}, {4, 8}, {5, 6}, {5, 8}, {6, 7}, {7, 8}},
              hexahedron_rest = {{1, 4, 3, 2},
                                 {1, 2, 6, 5},
                                 {1, 5, 8, 4},
                                 {2, 3, 7, 6},
                                 {3, 4, 8, 7},
                                 {5, 6, 7, 8},
                                 {1, 2, 3, 4, 5, 6, 7, 8}},
              prism_edges = {{1, 2}, {1, 3}, {1, 4}, {2, 3}, {2, 5}, {3, 6}, {4, 5}, {4, 6}, {5, 6}},
              edges = {{1, 2}, {1, 4}, {1, 5}, {2, 3}, {2, 5}, {3, 4}, {3, 5}, {4, 5}};
  for (const auto& [cell, type] :
       Named{{{"tet 10", tet, {{1, 2}, {2, 3}, {1, 3}, {1, 4}, {3, 4}, {2, 4}}}, "11"},
             {{"hexahedron 27", hexahedron, together(hexahedron_edges, hexahedron_rest)}, "12"},
             {{"prism 18", wedge, together(prism_edges, Lists{{1, 2, 5, 4}, {1, 4, 6, 3}, {2, 3, 6, 5}})}, "13"},
             {{"pyramid 14", pyramid, together(edges, Lists{{1, 2, 3, 4}})}, "14"},
             {{"hexahedron 20", hexahedron, hexahedron_edges}, "17"},
             {{"prism 15", wedge, prism_edges}, "18"},
             {{"pyramid 13", pyramid, edges, CellSpace::linear}, "19"}}) {
    SCOPED_TRACE(cell.name);
    const BentCell bent = testing::bend(cell);
    const std::size_t n = bent.positions.size();
    std::string text = fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", n);
    for (std::size_t k = 0; k < n; ++k)
      text += fmt::format("{} {} {} {}\n", k + 1, bent.positions[k].x, bent.positions[k].y, bent.positions[k].z);
    text += fmt::format("$EndNodes\n$Elements\n1\n1 {} 2 1 1{}\n$EndElements\n", type, numbers_to(n, 1));
    text += fmt::format("$NodeData\n1\n\"f\"\n1\n0\n3\n0\n1\n{}\n", n);
    for (std::size_t k = 0; k < n; ++k) text += fmt::format("{} {}\n", k + 1, bent.values[k]);
    testing::expect_same(read("a.msh", text + "$EndNodeData\n"), bent);
  }
}

TEST_F(CurvedText, MeditHasItsVolume) {
  const BentCell bent = testing::bend(tet10);
  std::string text = "MeshVersionFormatted 2\nDimension 3\nVertices\n10\n";
  for (const glm::dvec3& p : bent.positions) text += fmt::format("{} {} {} 1\n", p.x, p.y, p.z);
  const cells::MeshFile mesh = read("a.mesh", text + "TetrahedraP2\n1\n1 2 3 4 5 6 7 8 9 10 1\nEnd\n", "");
  EXPECT_NEAR(testing::volume(mesh.mesh), bent.volume, 5e-3 * bent.volume);
  EXPECT_EQ(mesh.higher_order.by_corners, 0u);
}

/// An I-DEAS universal file of one element of a type, with points in a coordinate system.
std::string universal(const std::vector<glm::dvec3>& points, int type, const std::vector<int>& nodes, int system = 1,
                      const std::string& before = "") {
  std::string text = before + "    -1\n  2411\n";
  for (std::size_t k = 0; k < points.size(); ++k)
    text += fmt::format("{:10}{:10}{:10}{:10}\n{:25.16E}{:25.16E}{:25.16E}\n", k + 1, system, 1, 11, points[k].x,
                        points[k].y, points[k].z);
  text += fmt::format("    -1\n    -1\n  2412\n{:10}{:10}{:10}{:10}{:10}{:10}\n", 1, type, 1, 1, 7, nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k)
    text += fmt::format("{:10}{}", nodes[k], k % 8 == 7 || k + 1 == nodes.size() ? "\n" : "");
  return text + "    -1\n";
}

TEST_F(CurvedText, IdeasParabolicElementsAlternateCornersAndMidpoints) {
  if (!has_reader(Reader::gmsh)) GTEST_SKIP() << "tessera-read-gmsh is not installed";
  // Corners and middles, numbered from 1 as in VTK, in the order of I-DEAS.
  const std::vector<int> of_tet = {1, 5, 2, 6, 3, 7, 8, 9, 10, 4},
                         of_wedge = {1, 7, 2, 8, 3, 9, 13, 14, 15, 4, 10, 5, 11, 6, 12},
                         of_brick = {1, 9, 2, 10, 3, 11, 4, 12, 17, 18, 19, 20, 5, 13, 6, 14, 7, 15, 8, 16};
  for (const auto& [cell, type, nodes] :
       {std::tuple(tet10, 118, of_tet), std::tuple(wedge15, 113, of_wedge), std::tuple(wedge15, 102, of_wedge),
        std::tuple(hex20, 116, of_brick), std::tuple(hex20, 105, of_brick)}) {
    SCOPED_TRACE(type);
    const BentCell bent = testing::bend(cell);
    ReadOptions options = testing::coarse_options();
    options.field.clear();
    const cells::MeshFile read = read_mesh(folder.write("a.unv", universal(bent.positions, type, nodes)), options);
    EXPECT_NEAR(testing::volume(read.mesh), bent.volume, 5e-3 * bent.volume);
    EXPECT_EQ(read.higher_order.by_corners, 0u);
  }
}

TEST_F(CurvedText, RefusesIdeasElementsThatGmshOmitsOrMisplaces) {
  if (!has_reader(Reader::gmsh)) GTEST_SKIP() << "tessera-read-gmsh is not installed";
  const std::vector<glm::dvec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<glm::dvec3> many(32, glm::dvec3(1));
  std::vector<int> all;
  for (int k = 1; k <= 32; ++k) all.push_back(k);
  const auto refused = [&](const std::string& text, const std::vector<std::string>& parts) {
    const auto file = folder.write("a.unv", text);
    test::expect_bad_input([&] { read_mesh(file); }, parts);
  };
  refused(universal(many, 117, all), {"a.unv: element 1 is a cubic brick (type 117)", "second order"});
  const std::string axes = "  1.0 0.0 0.0\n  0.0 1.0 0.0\n  0.0 0.0 1.0\n";
  const auto systems = [&](int type, const char* origin) {
    return fmt::format(
        "    -1\n  2420\n{0:10}\nPart\n{0:10}{1:10}{2:10}\nGlobal\n{3}  0.0 0.0 0.0\n{4:10}{5:10}{2:10}"
        "\nOther\n{3}{6}\n    -1\n",
        1, 0, 8, axes, 2, type, origin);
  };
  const std::vector<int> four = {1, 2, 3, 4};
  refused(universal(corners, 111, four, 2, systems(1, "  0.0 0.0 0.0")),
          {"a.unv: point 1 is in the coordinate system 2, which is cylindrical; export"});
  refused(universal(corners, 111, four, 2, systems(0, "  0.0 0.0 4.0D+00")), {"which is rotated or moved; export"});
  for (const int system : {1, 2}) {
    const auto file =
        folder.write("a.unv", universal(corners, 111, four, system, systems(system == 1 ? 2 : 0, "  0.0 0.0 0.0")));
    EXPECT_NEAR(testing::volume(read_mesh(file).mesh), 1.0 / 6, 1e-12);
  }
  std::string old = universal(corners, 111, four);
  old.replace(old.find("  2412"), 6, "   780");
  refused(old, {"a.unv: its elements are in dataset 780", "newer version"});
}

}  // namespace
}  // namespace tessera::io::curved_text_test
