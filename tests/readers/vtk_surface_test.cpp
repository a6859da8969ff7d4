// SPDX-License-Identifier: BSD-3-Clause
// Closed surfaces in VTK's own formats, filled.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "cells/surface.hpp"
#include "io/files/reader_programs.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/vtk_or_skip.hpp"

namespace tessera::io {
namespace {

class VtkSurfaces : public ::testing::Test {
 protected:
  void SetUp() override {
    TESSERA_VTK_OR_SKIP();
    if (!has_reader(Reader::tetgen)) GTEST_SKIP() << "tessera-read-tetgen is not installed";
  }
  test::TemporaryFolder folder;
};

constexpr const char* points = "0 0 0 2 0 0 2 2 0 0 2 0 0 0 2 2 0 2 2 2 2 0 2 2";  // of a cube with volume 8
constexpr const char* quads = "0 3 2 1 4 5 6 7 0 1 5 4 2 3 7 6 1 2 6 5 0 4 7 3";
constexpr const char* quad_ends = "4 8 12 16 20 24";
/// The walls as one strip around, bottom and top as one each.
constexpr const char* strips = "0 4 1 5 2 6 3 7 0 4 0 1 3 2 4 7 5 6";
constexpr const char* strip_ends = "10 14 18";

std::string array(const char* type, const std::string& name, const std::string& numbers) {
  return fmt::format("<DataArray type=\"{}\" Name=\"{}\" {}format=\"ascii\">{}</DataArray>", type, name,
                     name == "Points" ? "NumberOfComponents=\"3\" " : "", numbers);
}

std::string cells(const char* name, const std::string& corners, const std::string& ends) {
  return fmt::format("<{0}>{1}{2}</{0}>", name, array("Int64", "connectivity", corners),
                     array("Int64", "offsets", ends));
}

/// The field "t" is x + y + z.
std::string vtp(int polygons, const std::string& cell_lists) {
  return fmt::format(
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\"><PolyData><Piece NumberOfPoints=\"8\" "
      "NumberOfPolys=\"{}\" NumberOfStrips=\"{}\"><PointData>{}{}</PointData><Points>{}</Points>{}</Piece></PolyData>"
      "</VTKFile>",
      polygons, polygons > 0 ? 0 : 3, array("Float32", "t", "0 2 4 2 2 4 6 4"),
      "<DataArray type=\"Float32\" Name=\"Normals\" NumberOfComponents=\"3\" format=\"ascii\">0 0 1 0 0 1 0 0 1 0 0 1 "
      "0 "
      "0 1 0 0 1 0 0 1 0 0 1</DataArray>",
      array("Float32", "Points", points), cell_lists);
}

void expect_cube(const cells::MeshFile& read) {
  EXPECT_NEAR(testing::volume(read.mesh), 8, 1e-9);
  EXPECT_EQ(read.format, "surface (vtk) filled by TetGen");
  ASSERT_EQ(read.fields.size(), 2u);
  EXPECT_EQ(read.fields[0].name, "t");
  EXPECT_EQ(read.fields[1].name, "depth");
}

TEST_F(VtkSurfaces, PolygonsAndStripsAreFilledWithTheirNumbers) {
  const cells::MeshFile polygons = read_mesh(folder.write("a.vtp", vtp(6, cells("Polys", quads, quad_ends))));
  expect_cube(polygons);
  EXPECT_EQ(polygons.mesh.field_name, "t");
  // Values given at the corners of a cube are preserved.
  for (std::size_t v = 0; v < polygons.mesh.positions.size(); ++v) {
    const glm::dvec3 p = polygons.mesh.positions[v];
    if (p == glm::dvec3(2, 2, 2) || p == glm::dvec3(0, 0, 2)) {
      EXPECT_EQ(polygons.mesh.scalars[v], p.x + p.y + p.z);
    }
  }
  EXPECT_NE(std::find(polygons.notes.begin(), polygons.notes.end(),
                      "1 array of the surface is left out: only arrays with one number per point become fields"),
            polygons.notes.end());
  expect_cube(read_mesh(folder.write("b.vtp", vtp(0, cells("Strips", strips, strip_ends)))));
}

TEST_F(VtkSurfaces, FillsLegacySurfaces) {
  std::string text = "# vtk DataFile Version 3.0\ncube\nASCII\nDATASET POLYDATA\nPOINTS 8 float\n";
  text += std::string(points) + "\nPOLYGONS 6 30\n4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 0 4 7 3\n";
  text += "POINT_DATA 8\nSCALARS t float 1\nLOOKUP_TABLE default\n0 2 4 2 2 4 6 4\n";
  expect_cube(read_mesh(folder.write("a.vtk", text)));
}

TEST_F(VtkSurfaces, ReportsOpenAndDamagedSurfaces) {
  test::expect_bad_input(
      [&] {
        read_mesh(folder.write("a.vtp", vtp(5, cells("Polys", std::string(quads).substr(0, 39), "4 8 12 16 20"))));
      },
      {"a.vtp", "not closed"});
  const std::string far = fmt::format("9{}", std::string_view(quads).substr(1));
  test::expect_bad_input([&] { read_mesh(folder.write("b.vtp", vtp(6, cells("Polys", far, quad_ends)))); },
                         {"b.vtp", "face 0 uses point 9"});
  const std::string whole = vtp(6, cells("Polys", quads, quad_ends));
  test::expect_bad_input([&] { read_mesh(folder.write("c.vtp", whole.substr(0, whole.size() - 60))); },
                         {"c.vtp", "</VTKFile>"});
}

}  // namespace
}  // namespace tessera::io
