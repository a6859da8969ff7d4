// SPDX-License-Identifier: BSD-3-Clause
// Tecplot text files, written according to Tecplot's Data Format Guide: a cube of bricks with a linear field at its
// nodes and another at its cells.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "io/mesh/tecplot_file.hpp"
#include "support/foam_case.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io::tecplot_test {
namespace {

using testing::Cubes;

constexpr int n = 3;
const std::string variables = "TITLE = \"a # title\"\nVARIABLES = \"X\", \"Y\", \"Z\", \"p\", \"rho\"\n";

double p_at(const glm::dvec3& p, double factor = 1) { return factor * (p.x + 2 * p.y + 3 * p.z); }

glm::dvec3 centre_of(const Cubes& cubes, std::size_t cell) {
  glm::dvec3 sum(0);
  for (const int v : cubes.cells[cell]) sum += cubes.points[static_cast<std::size_t>(v)];
  return sum / 8.0;
}

std::string lines(std::size_t count, const std::function<double(std::size_t)>& value) {
  std::string text;
  for (std::size_t k = 0; k < count; ++k) text += fmt::format("{}{}", value(k), k % 5 == 4 ? "\n" : " ");
  return text + "\n";
}

std::string coordinates(const Cubes& cubes) {
  std::string text;
  for (int a = 0; a < 3; ++a) text += lines(cubes.points.size(), [&](std::size_t v) { return cubes.points[v][a]; });
  return text;
}
std::string pressures(const Cubes& cubes, double factor = 1) {
  return lines(cubes.points.size(), [&](std::size_t v) { return p_at(cubes.points[v], factor); });
}
std::string densities(const Cubes& cubes) {
  return lines(cubes.cells.size(), [&](std::size_t c) { return 10 + p_at(centre_of(cubes, c)); });
}
std::string elements(const Cubes& cubes) {
  std::string text;
  for (const auto& cell : cubes.cells) {
    for (const int v : cell) text += fmt::format(" {}", v + 1);
    text += "\n";
  }
  return text;
}

std::string zone(const std::string& more) {
  const Cubes cubes(n);
  return fmt::format("ZONE T=\"part\", NODES={}, ELEMENTS={}, ZONETYPE=FEBRICK{}\n", cubes.points.size(),
                     cubes.cells.size(), more);
}

cells::MeshFile read(const std::filesystem::path& file, const std::string& field,
                     std::optional<std::size_t> step = {}) {
  ReadOptions options;
  options.field = field;
  options.time_step = step;
  return read_mesh(file, options);
}

void expect_pressure(const cells::MeshFile& file, double factor = 1) {
  scene::validate(file.mesh, "cube");
  EXPECT_NEAR(testing::volume(file.mesh), n * n * n, 1e-9);
  EXPECT_EQ(file.counts.cells_read, static_cast<std::uint64_t>(n * n * n));
  ASSERT_EQ(file.mesh.association, scene::Association::point);
  for (std::size_t v = 0; v < file.mesh.positions.size(); ++v)
    EXPECT_NEAR(file.mesh.scalars[v], p_at(file.mesh.positions[v], factor), 1e-9);
}

void expect_density(const cells::MeshFile& file) {
  ASSERT_EQ(file.mesh.association, scene::Association::cell);
  for (std::size_t t = 0; t < file.mesh.tets.size(); ++t) {
    glm::dvec3 centre(0);
    for (const std::uint32_t v : file.mesh.tets[t]) centre += 0.25 * file.mesh.positions[v];
    EXPECT_NEAR(file.mesh.scalars[t], 10 + p_at(glm::floor(centre) + 0.5), 1e-9);
  }
}

class Tecplot : public ::testing::Test {
 protected:
  test::TemporaryFolder folder;
  const Cubes cubes{n};
};

TEST_F(Tecplot, EveryFormOfVarlocationPutsValuesAtCells) {
  for (const char* location :
       {"([5]=CELLCENTERED)", "([1-4]=NODAL,[5]=CELLCENTERED)", "([1-4]=NODAL, [5-5] = CellCentered)",
        "(NODAL,NODAL,NODAL,NODAL,CELLCENTERED)", "(NODAL NODAL NODAL NODAL CELLCENTERED)", "([5] = CELLCENTERED)"}) {
    SCOPED_TRACE(location);
    const auto file =
        folder.write("a.tec", variables +
                                  zone(fmt::format(", DATAPACKING=BLOCK\n VARLOCATION={}\nDT=(DOUBLE DOUBLE "
                                                   "DOUBLE DOUBLE SINGLE)",
                                                   location)) +
                                  coordinates(cubes) + pressures(cubes) + densities(cubes) + elements(cubes));
    expect_pressure(read(file, "p"));
    expect_density(read(file, "rho"));
  }
}

TEST_F(Tecplot, PointsAndBlocksOfValuesAreTheSameMesh) {
  std::string by_point;
  for (const glm::dvec3& p : cubes.points) by_point += fmt::format("{}, {}, {}, {}, 7\n", p.x, p.y, p.z, p_at(p));
  const std::string nodes = fmt::format("N={}, E={}", cubes.points.size(), cubes.cells.size());
  for (const std::string& head :
       {"ZONE " + nodes + ", F=FEPOINT, ET=BRICK\n", "zone t=\"a\" " + nodes + " datapacking=point zonetype=febrick\n",
        "ZONE " + nodes + ", ZONETYPE=FEBRICK\n"})
    expect_pressure(read(folder.write("a.tec", variables + head + by_point + elements(cubes)), "p"));
  const std::string blocks =
      coordinates(cubes) + pressures(cubes) + fmt::format("{}*7.5\n", cubes.points.size()) + elements(cubes);
  const auto file = folder.write("b.tec", variables + "ZONE " + nodes + ", F=FEBLOCK, ET=BRICK\n" + blocks);
  expect_pressure(read(file, "p"));
  for (const double value : read(file, "rho").mesh.scalars) EXPECT_EQ(value, 7.5);
}

TEST_F(Tecplot, NumbersAreReadAsFortranWritesThem) {
  const auto file = folder.write("a.tec",
                                 "VARIABLES=X Y Z f\nZONE N=4, E=1, DATAPACKING=BLOCK, ZONETYPE=FETETRAHEDRON\n# said\n"
                                 "0. +1.0D+00 2*0\n2*.0 1.0d0 0.0E0\n3*0 1 # four\n1.5D-1 2*-2.5E1 +3\n1 2 3 4\n");
  const TecplotMesh mesh = parse_tecplot(test::contents(file), "a.tec", std::nullopt);
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].positions, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  std::vector<double> values(4);
  mesh.blocks[0].fields.at(0).read(0, 0, values);
  EXPECT_EQ(values, (std::vector<double>{0.15, -25, -25, 3}));
}

TEST_F(Tecplot, SolutionTimesAreSteps) {
  std::string text = variables;
  for (const int step : {0, 1, 2})
    text += zone(fmt::format(", STRANDID=1, SOLUTIONTIME={}, DATAPACKING=BLOCK, VARLOCATION=([5]=CELLCENTERED)",
                             0.5 * step)) +
            coordinates(cubes) + pressures(cubes, step + 1) + densities(cubes) + elements(cubes);
  const auto file = folder.write("a.tec", text);
  for (const int step : {0, 1, 2}) {
    const cells::MeshFile at_step = read(file, "p", step);
    expect_pressure(at_step, step + 1);
    EXPECT_EQ(at_step.time_step.count, 3u);
    EXPECT_EQ(at_step.time_step.times, (std::vector<double>{0, 0.5, 1}));
  }
  expect_pressure(read(file, "p"), 3);
  expect_density(read(file, "rho", 1));
  test::expect_bad_input([&] { read(file, "p", 3); }, {"a.tec", "no time step 3", "has 3"});
}

TEST_F(Tecplot, ZonesShareVariablesAndElements) {
  const std::string first = zone(", STRANDID=1, SOLUTIONTIME=0, DATAPACKING=BLOCK, VARLOCATION=([5]=CELLCENTERED)") +
                            coordinates(cubes) + pressures(cubes) + densities(cubes) + elements(cubes);
  for (const std::string& shares :
       {std::string("VARSHARELIST=([1-3,5]=1), CONNECTIVITYSHAREZONE=1"),
        std::string("VARSHARELIST=([1-3]=1, [5]=1), CONNECTIVITYSHAREZONE=1"),
        std::string("VARSHARELIST=([1-3,5]), CONNECTIVITYSHAREZONE=1"), std::string("D=(1,2,3,5,FECONNECT)")}) {
    SCOPED_TRACE(shares);
    const std::string head =
        zone(", STRANDID=1, SOLUTIONTIME=1, DATAPACKING=BLOCK, VARLOCATION=([5]=CELLCENTERED), " + shares);
    const auto file = folder.write("a.tec", variables + first + head + pressures(cubes, 10));
    expect_pressure(read(file, "p", 0));
    expect_pressure(read(file, "p", 1), 10);
    expect_density(read(file, "rho", 1));
  }
}

TEST_F(Tecplot, ZonesOfNoStrandAreOfEveryStep) {
  const std::string tet =
      "NODES=4, ELEMENTS=1, DATAPACKING=POINT, ZONETYPE=FETETRAHEDRON\n0 0 0 {0}\n1 0 0 {0}\n0 1 0 {0}\n0 0 1 {0}\n1 2 "
      "3 4\n";
  std::string text = "VARIABLES=\"x\" \"y\" \"z\" \"f\"\n";
  text += "ZONE T=\"still\", " + fmt::format(fmt::runtime(tet), 5);
  for (const int step : {1, 2})
    text += fmt::format("ZONE T=\"moved\" STRANDID=3 SOLUTIONTIME={} ", step) + fmt::format(fmt::runtime(tet), step);
  for (const std::size_t step : {0u, 1u}) {
    const TecplotMesh mesh = parse_tecplot(text, "a.tec", step);
    ASSERT_EQ(mesh.blocks.size(), 2u);
    EXPECT_EQ(mesh.blocks[0].name, "still");
    EXPECT_EQ(mesh.blocks[1].name, "moved");
    std::vector<double> values(4);
    mesh.blocks[1].fields.at(0).read(0, 0, values);
    EXPECT_EQ(values[0], static_cast<double>(step + 1));
  }
}

TEST_F(Tecplot, OrderedZonesAreHexahedra) {
  std::string points, cells;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 2; ++i) {
        points += fmt::format("{} {} {} {}\n", i, j, k, p_at({i, j, k}));
        if (i < 1 && j < 2 && k < 3) cells += fmt::format("{} ", 10 * (i + j + 2 * k));
      }
  const cells::MeshFile by_point =
      read(folder.write("a.tec", "VARIABLES=X,Y,Z,f\nZONE I=2, J=3, K=4, F=POINT\n" + points), "f");
  EXPECT_NEAR(testing::volume(by_point.mesh), 6, 1e-12);
  EXPECT_EQ(by_point.counts.cells_read, 6u);
  for (std::size_t v = 0; v < by_point.mesh.positions.size(); ++v)
    EXPECT_NEAR(by_point.mesh.scalars[v], p_at(by_point.mesh.positions[v]), 1e-12);
  std::string blocks;
  for (int a = 0; a < 3; ++a)
    for (int v = 0; v < 24; ++v) blocks += fmt::format("{} ", a == 0 ? v % 2 : a == 1 ? v / 2 % 3 : v / 6);
  const cells::MeshFile of_cells = read(folder.write("b.tec",
                                                     "VARIABLES=X,Y,Z,f\nZONE I=2, J=3, K=4, DATAPACKING=BLOCK, "
                                                     "VARLOCATION=([4]=CELLCENTERED)\n" +
                                                         blocks + "\n" + cells + "\n"),
                                        "f");
  for (std::size_t t = 0; t < of_cells.mesh.tets.size(); ++t) {
    glm::dvec3 centre(0);
    for (const std::uint32_t v : of_cells.mesh.tets[t]) centre += 0.25 * of_cells.mesh.positions[v];
    const glm::ivec3 cell(centre);
    EXPECT_EQ(of_cells.mesh.scalars[t], 10 * (cell.x + cell.y + 2 * cell.z));
  }
}

TEST_F(Tecplot, BricksWithRepeatedNodesAreWedgesPyramidsAndTetrahedra) {
  const std::string text =
      "VARIABLES=X,Y,Z,f\nZONE N=12, E=4, DATAPACKING=POINT, ZONETYPE=FEBRICK\n"
      "0 0 0 1\n1 0 0 1\n1 1 0 1\n0 1 0 1\n0 0 1 1\n1 0 1 1\n1 1 1 1\n0 1 1 1\n.5 .5 2 1\n5 0 0 1\n6 0 0 1\n5 1 0 1\n"
      "1 2 3 3 5 6 7 7\n1 3 4 4 5 7 8 8\n5 6 7 8 9 9 9 9\n10 11 12 12 1 1 1 1\n";
  const TecplotMesh mesh = parse_tecplot(text, "a.tec", std::nullopt);
  EXPECT_EQ(mesh.blocks.at(0).types, (std::vector<std::uint8_t>{13, 13, 14, 10}));
  ReadOptions options;
  EXPECT_EQ(read_mesh(folder.write("a.tec", text), options).counts.cells_tangled, 0u);
}

TEST_F(Tecplot, PolyhedraHaveTheirAdjacentFaces) {
  // Two cubes; one is on each side of their common face.
  const std::string text =
      "VARIABLES=X,Y,Z,f\nZONE NODES=12 ELEMENTS=2 FACES=11 TOTALNUMFACENODES=44 NUMCONNECTEDBOUNDARYFACES=0 "
      "TOTALNUMBOUNDARYCONNECTIONS=0 DATAPACKING=BLOCK ZONETYPE=FEPOLYHEDRON VARLOCATION=([4]=CELLCENTERED)\n"
      "0 1 2 0 1 2 0 1 2 0 1 2\n0 0 0 1 1 1 0 0 0 1 1 1\n6*0 6*1\n3 4\n11*4\n"
      "1 2 5 4\n7 8 11 10\n1 2 8 7\n4 5 11 10\n1 4 10 7\n2 5 11 8\n2 3 6 5\n8 9 12 11\n2 3 9 8\n5 6 12 11\n3 6 12 9\n"
      "6*1 5*2\n5*0 2 5*0\n";
  const cells::MeshFile mesh = read(folder.write("a.tec", text), "f");
  EXPECT_NEAR(testing::volume(mesh.mesh), 2, 1e-12);
  EXPECT_EQ(mesh.counts.cells_polyhedra, 2u);
  for (std::size_t t = 0; t < mesh.mesh.tets.size(); ++t) {
    double x = 0;
    for (const std::uint32_t v : mesh.mesh.tets[t]) x += 0.25 * mesh.mesh.positions[v].x;
    EXPECT_EQ(mesh.mesh.scalars[t], x < 1 ? 3 : 4);
  }
}

TEST_F(Tecplot, FacesAndOtherRecordsAreLeftOut) {
  const std::string face = "ZONE T=\"wall\" N=3 E=1 DATAPACKING=POINT ZONETYPE=FETRIANGLE AUXDATA side=\"left\"\n";
  const std::string points = "0 0 0 0 0\n1 0 0 0 0\n0 1 0 0 0\n1 2 3\n";
  const std::string text = "DATASETAUXDATA by=\"hand\"\n" + variables + face + points +
                           "TEXT X=50, Y=50, T=\"words\"\nGEOMETRY X=1 Y=1 T=LINE\n1\n2\n0 0\n1 1\n" +
                           zone(", DATAPACKING=BLOCK, PASSIVEVARLIST=([5])") + coordinates(cubes) + pressures(cubes) +
                           elements(cubes);
  const cells::MeshFile mesh = read(folder.write("a.tec", text), "p");
  expect_pressure(mesh);
  EXPECT_NE(std::ranges::find(mesh.notes, "1 of 2 zones are lines or faces, which are left out"), mesh.notes.end());
  test::expect_bad_input([&] { read_mesh(folder.write("b.tec", variables + face + points)); },
                         {"b.tec", "1 zones contain no volume"});
}

TEST_F(Tecplot, FaultsAreNamedWithTheirLine) {
  const auto refuse = [](const std::string& text, const std::vector<std::string>& parts) {
    test::expect_bad_input([&] { parse_tecplot(text, "a.tec", std::nullopt); }, parts);
  };
  const std::string head = "VARIABLES=X,Y,Z\nZONE N=4, E=1, DATAPACKING=POINT, ";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const std::string tet = head + "ZONETYPE=FETETRAHEDRON\n";
  EXPECT_EQ(parse_tecplot(tet + points + "1 2 3 4\n", "a.tec", std::nullopt).blocks.size(), 1u);
  const std::string one = tet + points + "1 2 3 4\n";
  EXPECT_EQ(parse_tecplot(one + "TITLE=\"b\"\n" + one, "a.tec", std::nullopt).blocks.size(), 2u);  // concatenated
  refuse(one + "VARIABLES=X,Y,Z,p\n" + one, {"line 8", "VARIABLES differs from the list"});
  refuse(tet + points + "1 2 3\n", {"a.tec", "line 8", "nodes of elements", "truncated"});
  refuse(tet + points + "1 2 3 5\n", {"line 2", "uses node 5, but the zone has 4 nodes"});
  refuse(tet + points + "1 2 x 4\n", {"line 7", "'x'", "not a number"});
  refuse(tet + "0 0 0\n1 0 zero\n", {"line 4", "'zero'"});
  refuse(head + "ZONETYPE=FEMIXED\n" + points, {"line 2", "'FEMIXED'", "not supported"});
  refuse(head + "ZONETYPE=FEBRICK, VARSHARELIST=([1-4]=1)\n" + points,
         {"line 2", "zone 1, but only 0 zones come before"});
  refuse(head + "ZONETYPE=FEBRICK, VARLOCATION=([9]=CELLCENTERED)\n", {"line 2", "'[9]'", "1 to 3"});
  refuse("VARIABLES=X,Y,Z\nZONE N=99999999999, E=1, ZONETYPE=FEBRICK\n" + points, {"line 2", "more than a file"});
  refuse("VARIABLES=X,Y\nZONE I=2, J=2, K=2\n0 0\n", {"a.tec", "2 variables"});
  refuse("FILETYPE=SOLUTION\nVARIABLES=p\nZONE I=2,J=2,K=2\n1\n", {"line 1", "without its grid"});
  const std::string whole = variables + zone(", DATAPACKING=BLOCK") + coordinates(Cubes(n)) + pressures(Cubes(n)) +
                            pressures(Cubes(n)) + elements(Cubes(n));
  for (std::size_t length = 0; length < whole.size() - 3; length += 41) refuse(whole.substr(0, length), {"a.tec"});
}

}  // namespace
}  // namespace tessera::io::tecplot_test
