// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <numbers>

#include "cells/surface.hpp"
#include "io/files/reader_programs.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "io/mesh/tetgen_files.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"

namespace tessera::io {
namespace {

using test::expect_bad_input;

const std::string node_text =
    "# five points\n5 3 2 1\n1 0 0 0  0 10 7\n2 1 0 0  1 10 7\n3 0 1 0  2 11 7 # y\n\n4 0 0 1  3 10 7\n5 1 1 1  5 12 "
    "7\n";
const std::string ele_text = "2 4 1\n1 1 2 3 4 1.5\n2 2 3 4 5 2.5\n";

TEST(NodeEle, EitherNameReadsPointsTetsAndAttributes) {
  const test::TemporaryFolder folder;
  const auto node = folder.write("m.1.node", node_text), ele = folder.write("m.1.ele", ele_text);
  for (const auto& file : {node, ele}) {
    const cells::MeshFile read = read_mesh(file);
    scene::validate(read.mesh, "m");
    EXPECT_EQ(read.format, "TetGen .node/.ele");
    EXPECT_EQ(read.mesh.tets, (std::vector<scene::Tet>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
    EXPECT_EQ(read.mesh.field_name, "attribute0");
    EXPECT_EQ(read.mesh.scalars, (std::vector<double>{0, 1, 2, 3, 5}));
  }
  ReadOptions options;
  options.field = "cell:attribute0";
  EXPECT_EQ(read_mesh(node, options).mesh.scalars, (std::vector<double>{1.5, 2.5}));
  options.field = "attribute1";
  EXPECT_EQ(read_mesh(node, options).mesh.scalars, (std::vector<double>{10, 10, 11, 10, 12}));
}

TEST(NodeEle, NumberingFromZeroAndSecondOrderTetsWork) {
  std::string node = "10 3 0 0\n", ele = "1 10 0\n0";
  for (int v = 0; v < 10; ++v) node += fmt::format("{} {} {} {}\n", v, v & 1, v >> 1 & 1, v >> 2);
  for (int v = 0; v < 10; ++v) ele += fmt::format(" {}", v == 3 ? 4 : v == 4 ? 3 : v);
  const cells::CellBlock block = parse_node_ele(node, ele, "m.node", "m.ele");
  EXPECT_EQ(block.types, (std::vector<std::uint8_t>{24}));
  EXPECT_EQ(block.offsets.back(), 10u);
}

TEST(NodeEle, SecondOrderNodesAreInTetGensOrder) {
  // The middles of the edges as written by TetGen 1.5 (-o2): 3-4, 1-4, 1-2, 2-3, 2-4, 1-3.
  const std::string node =
      "10 3 0 0\n1 0 0 0\n2 2 0 0\n3 0 2 0\n4 0 0 2\n5 0 1 1\n6 0 0 1\n7 1 0 0\n8 1 1 0\n9 1 0 1\n10 0 1 0\n";
  const cells::CellBlock block = parse_node_ele(node, "1 10 0\n1 1 2 3 4 5 6 7 8 9 10\n", "m.node", "m.ele");
  // VTK's: 0-1, 1-2, 2-0, 0-3, 1-3, 2-3.
  constexpr std::array<std::array<std::size_t, 2>, 6> edges = {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  const auto point = [&](std::size_t k) { return block.positions[block.connectivity[k]]; };
  for (std::size_t e = 0; e < edges.size(); ++e)
    EXPECT_EQ(point(4 + e), 0.5 * (point(edges[e][0]) + point(edges[e][1]))) << "edge " << e;
}

TEST(NodeEle, ReportsBadTextByLine) {
  const auto parse = [](const std::string& node, const std::string& ele) {
    return [=] { parse_node_ele(node, ele, "m.node", "m.ele"); };
  };
  expect_bad_input(parse("", ele_text), {"m.node: line", "number of points"});
  expect_bad_input(parse("9000000000000 3 0 0\n0 0 0 0\n", ele_text),
                   {"m.node: line 1", "more than a file of this size can contain"});
  expect_bad_input(parse("-4 3 0 0\n", ele_text), {"-4"});
  expect_bad_input(parse("99999999999999999999 3 0 0\n", ele_text), {"too large"});
  expect_bad_input(parse("1 2 0 0\n0 0 0 0\n", ele_text), {"2 coordinates"});
  expect_bad_input(parse("1 3 0 0\n5 0 0 0\n", ele_text), {"numbered from 5"});
  expect_bad_input(parse("2 3 0 0\n0 0 0 0\n2 0 0 0\n", ele_text), {"point 2 is listed where 1"});
  expect_bad_input(parse("1 3 0 0\n0 0 0\n", ele_text), {"m.node: line 2: z is missing"});
  expect_bad_input(parse("1 3 0 0\n0 0 zero 0\n", ele_text), {"'zero' is not a number"});
  expect_bad_input(parse(node_text, "2 4 0\n1 1 2 3 4\n"), {"m.ele: line", "a tet"});
  expect_bad_input(parse(node_text, "1 4 0\n1 1 2 3 6\n"),
                   {"m.ele: line 2: point 6 is used, but there are only 5 points"});
  expect_bad_input(parse(node_text, "1 4 0\n1 0 2 3 4\n"), {"point 0 is used"});
  expect_bad_input(parse(node_text, "1 8 0\n"), {"4 or 10"});
}

TEST(NodeEle, ReportsAMissingPartner) {
  const test::TemporaryFolder folder;
  expect_bad_input([&] { read_mesh(folder.write("m.node", node_text)); }, {"m.ele: there is no such file"});
}

// --- surfaces ------------------------------------------------------------------------------------------------------

/// A sphere of triangles, n slices around and n / 2 layers, as ASCII STL or PLY.
struct Sphere {
  std::vector<glm::dvec3> points;
  std::vector<std::array<int, 3>> faces;
  double volume = 0;  ///< of the polyhedron
};
Sphere sphere(int n, const glm::dvec3& centre, double radius) {
  Sphere s;
  const int layers = n / 2;
  s.points.push_back(centre + glm::dvec3(0, 0, radius));
  for (int k = 1; k < layers; ++k)
    for (int i = 0; i < n; ++i) {
      const double a = std::numbers::pi * k / layers, b = 2 * std::numbers::pi * i / n;
      s.points.push_back(centre +
                         radius * glm::dvec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
    }
  s.points.push_back(centre - glm::dvec3(0, 0, radius));
  const auto ring = [&](int k, int i) { return 1 + (k - 1) * n + i % n; };
  const int south = static_cast<int>(s.points.size()) - 1;
  for (int i = 0; i < n; ++i) {
    s.faces.push_back({0, ring(1, i), ring(1, i + 1)});
    s.faces.push_back({south, ring(layers - 1, i + 1), ring(layers - 1, i)});
    for (int k = 1; k + 1 < layers; ++k) {
      s.faces.push_back({ring(k, i), ring(k + 1, i), ring(k + 1, i + 1)});
      s.faces.push_back({ring(k, i), ring(k + 1, i + 1), ring(k, i + 1)});
    }
  }
  for (const auto& f : s.faces)
    s.volume += glm::dot(s.points[f[0]] - centre, glm::cross(s.points[f[1]] - centre, s.points[f[2]] - centre)) / 6;
  return s;
}

std::string ply(const std::vector<Sphere>& parts) {
  std::string points, faces;
  std::size_t n = 0, m = 0;
  for (const Sphere& s : parts) {
    for (const auto& f : s.faces) faces += fmt::format("3 {} {} {}\n", f[0] + n, f[1] + n, f[2] + n);
    for (const glm::dvec3& p : s.points) points += fmt::format("{:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z);
    n += s.points.size();
    m += s.faces.size();
  }
  return fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n{}{}",
      n, m, points, faces);
}

std::string stl(const Sphere& s) {
  std::string text = "solid s\n";
  for (const auto& f : s.faces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int v : f)
      text += fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", s.points[v].x, s.points[v].y, s.points[v].z);
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid s\n";
}

const std::string cube_poly = R"(# a unit cube, the attribute is x
8 3 1 0
1 0 0 0 0
2 1 0 0 1
3 1 1 0 1
4 0 1 0 0
5 0 0 1 0
6 1 0 1 1
7 1 1 1 1
8 0 1 1 0
6 0
1
4 1 2 3 4
1
4 5 6 7 8
1
4 1 2
  6 5
1
4 2 3 7 6
1
4 3 4 8 7
1
4 4 1 5 8
0
)";

class Filled : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_reader(Reader::tetgen)) GTEST_SKIP() << "tessera-read-tetgen is not installed";
  }
  test::TemporaryFolder folder;
};

TEST_F(Filled, ASphereHasThePolyhedronsVolumeAndDepth) {
  const Sphere s = sphere(24, {3, -2, 5}, 2);
  ReadOptions options;
  options.max_volume = s.volume / 5000;
  std::vector files = {folder.write("s.ply", ply({s}))};
  if (has_reader(Reader::vtk)) files.push_back(folder.write("s.stl", stl(s)));
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    const cells::MeshFile read = read_mesh(file, options);
    scene::validate(read.mesh, "s");
    EXPECT_NEAR(testing::volume(read.mesh), s.volume, 1e-6 * s.volume);  // the files store floats
    EXPECT_GE(read.mesh.tets.size(), 5000u);
    EXPECT_EQ(read.mesh.field_name, "depth");
    const auto range = scene::scalar_range(read.mesh);
    EXPECT_EQ(range[0], 0);
    EXPECT_GT(range[1], 1.6);
    // The distance to a polyhedron inscribed in the sphere differs from the distance to the sphere by up to a facet's
    // sagitta, 2 (1 - cos pi / 24).
    for (const scene::Tet& tet : read.mesh.tets)
      for (const std::uint32_t v : tet)
        EXPECT_NEAR(read.mesh.scalars[v], 2 - glm::length(read.mesh.positions[v] - glm::dvec3(3, -2, 5)), 0.035);
    for (const auto& [place, uses] : testing::count_triangles(read.mesh)) EXPECT_LE(uses, 2);
  }
}

TEST_F(Filled, SizeAndPlaceDoNotMatter) {
  const Sphere small = sphere(12, {0, 0, 0}, 1e-9), large = sphere(12, {0, 0, 0}, 1e12);
  for (const Sphere& s : {small, large}) {
    const cells::MeshFile read =
        read_mesh(has_reader(Reader::vtk) ? folder.write("s.stl", stl(s)) : folder.write("s.ply", ply({s})));
    EXPECT_NEAR(testing::volume(read.mesh), s.volume, 1e-6 * s.volume);
    EXPECT_GE(read.mesh.tets.size(), 20000u);
  }
}

TEST_F(Filled, APolyKeepsItsLinearAttribute) {
  ReadOptions options;
  options.max_volume = 1e-3;
  const cells::MeshFile read = read_mesh(folder.write("cube.poly", cube_poly), options);
  EXPECT_NEAR(testing::volume(read.mesh), 1, 1e-9);
  EXPECT_EQ(read.mesh.field_name, "attribute0");
  for (const scene::Tet& tet : read.mesh.tets)
    for (const std::uint32_t v : tet) EXPECT_NEAR(read.mesh.scalars[v], read.mesh.positions[v].x, 1e-6);
}

TEST_F(Filled, ASmeshTakesItsPointsFromTheNodeFileAndLeavesCavitiesEmpty) {
  // A cube in a cube; the hole's point is in the inner one.
  std::string node = "16 3 0 0\n";
  for (int v = 0; v < 16; ++v) {
    const double inset = v < 8 ? 0 : 0.25;
    const auto at = [&](int bit) { return (v >> bit & 1) ? 1 - inset : inset; };
    node += fmt::format("{} {} {} {}\n", v, at(0), at(1), at(2));
  }
  std::string smesh = "0 3 0 0\n12 0\n";
  for (const int first : {0, 8})
    for (const std::array<int, 4>& f : std::array<std::array<int, 4>, 6>{
             {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}})
      smesh += fmt::format("4 {} {} {} {}\n", first + f[0], first + f[1], first + f[2], first + f[3]);
  folder.write("c.node", node);
  EXPECT_NEAR(testing::volume(read_mesh(folder.write("c.smesh", smesh + "1\n1 0.5 0.5 0.5\n")).mesh), 1 - 0.125, 1e-9);
  EXPECT_NEAR(testing::volume(read_mesh(folder.write("c.smesh", smesh + "0\n")).mesh), 1, 1e-9);
}

TEST_F(Filled, ReportsOpenCuttingFlatAndEmptySurfaces) {
  const Sphere s = sphere(12, {0, 0, 0}, 1);
  Sphere open = s;
  open.faces.pop_back();
  expect_bad_input([&] { read_mesh(folder.write("o.ply", ply({open}))); },
                   {"o.ply: the surface is not closed: 3 edges"});
  expect_bad_input(
      [&] {
        read_mesh(folder.write("c.ply", ply({s, sphere(12, {0.3, 0.2, 0.1}, 1)})));
      },
      {"c.ply: TetGen cannot fill the surface", "cuts itself in ", "faces, one about ("});
  expect_bad_input([&] { read_mesh(folder.write("f.ply", ply({sphere(12, {0, 0, 0}, 0)}))); }, {"f.ply: "});
  expect_bad_input([&] { read_mesh(folder.write("e.stl", "solid e\nendsolid e\n")); }, {"e.stl: "});
  Sphere nan = s;
  nan.points[3].x = NAN;
  expect_bad_input([&] { read_mesh(folder.write("n.ply", ply({nan}))); }, {"n.ply: "});
  ReadOptions options;
  options.max_volume = -1;
  expect_bad_input([&] { read_mesh(folder.write("s.ply", ply({s})), options); }, {"give a number above 0"});
}

/// A prism whose three sides are warped quads, as in many modelled surfaces, which TetGen does not accept.
TEST_F(Filled, WarpedPolygonsAreCutIntoTriangles) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\nproperty double z\n"
      "element face 5\nproperty list uchar int vertex_indices\nend_header\n";
  constexpr double turn = 0.4;
  for (int v = 0; v < 6; ++v) {
    const double angle = 2.0943951023931953 * (v % 3) + (v < 3 ? 0 : turn);
    text += fmt::format("{} {} {}\n", std::cos(angle), std::sin(angle), v / 3);
  }
  text += "3 0 2 1\n3 3 4 5\n4 0 1 4 3\n4 1 2 5 4\n4 2 0 3 5\n";
  ReadOptions options;
  options.max_volume = 0.01;
  const cells::MeshFile read = read_mesh(folder.write("w.ply", text), options);
  // Each side is cut along one of two diagonals: the volume is between those with all cuts inward and all outward.
  const double base = 0.75 * std::sqrt(3.0);
  EXPECT_NEAR(testing::volume(read.mesh), base, 0.25 * base);
  EXPECT_GT(read.mesh.tets.size(), 100u);
}

TEST_F(Filled, ReportsOpenPolyhedra) {
  std::string text = cube_poly;
  const std::size_t at = text.find("6 0\n1\n4 1 2 3 4\n");
  text.replace(at, 16, "5 0\n");
  expect_bad_input([&] { read_mesh(folder.write("o.poly", text)); }, {"o.poly: ", "not closed"});
}

/// A box of six facets.
std::string box_poly(double x, double y, double z) {
  std::string text = "8 3 0 0\n";
  for (int v = 0; v < 8; ++v)
    text += fmt::format("{} {} {} {}\n", v + 1, v % 4 == 1 || v % 4 == 2 ? x : 0, v % 4 >= 2 ? y : 0, v >= 4 ? z : 0);
  return text + "6 0\n1\n4 1 2 3 4\n1\n4 5 6 7 8\n1\n4 1 2 6 5\n1\n4 2 3 7 6\n1\n4 3 4 8 7\n1\n4 4 1 5 8\n0\n";
}

TEST_F(Filled, RefusesExcessiveTetCountsWithARemedy) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the helper has address space without a limit, for the sanitizer's sake";
#endif
  // Well-shaped tets are at most as wide as a plate is thick, so the plate of thickness 1e-6 would need 10^12 tets. A
  // thickness of 0.005 is feasible with about 10^5.
  EXPECT_NEAR(testing::volume(read_mesh(folder.write("thick.poly", box_poly(1, 1, 0.005))).mesh), 0.005, 1e-9);
  rusage before{}, after{};
  ::getrusage(RUSAGE_CHILDREN, &before);
  expect_bad_input(
      [&] { read_mesh(folder.write("plate.poly", box_poly(1, 1, 1e-6))); },
      {"plate.poly: filling it by TetGen takes ", " should take; correct the surface, or set `max_volume`"});
  ::getrusage(RUSAGE_CHILDREN, &after);
  EXPECT_LT(after.ru_maxrss, (256 + 60) << 10) << "KiB, 60 MiB of them the program itself";
  EXPECT_LT(after.ru_utime.tv_sec - before.ru_utime.tv_sec, 20);
}

}  // namespace
}  // namespace tessera::io
