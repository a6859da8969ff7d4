// SPDX-License-Identifier: BSD-3-Clause
// Files of solvers and lists of blocks: a cube of hexahedra written in each format, with a linear field.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <map>
#include <utility>

#include "io/mesh/block_surface.hpp"
#include "support/foam_case.hpp"
#include "support/mesh_checks.hpp"
#include "support/parts_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using testing::Cubes;
using testing::message_of;
using testing::write_control;
using testing::write_foam;

double field_at(const glm::dvec3& p) { return p.x + 2 * p.y + 3 * p.z; }

std::string joined(const std::array<int, 8>& corners, int first) {
  std::string text;
  for (const int v : corners) text += fmt::format(" {}", v + first);
  return text + "\n";
}

std::string avs_ucd(const Cubes& cubes) {
  std::string text = fmt::format("{} {} 1 0 0\n", cubes.points.size(), cubes.cells.size());
  for (std::size_t v = 0; v < cubes.points.size(); ++v)
    text += fmt::format("{} {} {} {}\n", v + 1, cubes.points[v].x, cubes.points[v].y, cubes.points[v].z);
  for (std::size_t c = 0; c < cubes.cells.size(); ++c)
    text += fmt::format("{} 1 hex", c + 1) + joined(cubes.cells[c], 1);
  text += "1 1\ntemperature, K\n";
  for (std::size_t v = 0; v < cubes.points.size(); ++v)
    text += fmt::format("{} {}\n", v + 1, field_at(cubes.points[v]));
  return text;
}

std::string tecplot(const Cubes& cubes) {
  std::string text = fmt::format(
      "TITLE = \"t\"\nVARIABLES = \"X\", \"Y\", \"Z\", \"T\"\nZONE T=\"z\", N={}, E={}, F=FEPOINT, ET=BRICK\n",
      cubes.points.size(), cubes.cells.size());
  for (const glm::dvec3& p : cubes.points) text += fmt::format("{} {} {} {}\n", p.x, p.y, p.z, field_at(p));
  for (const auto& cell : cubes.cells) text += joined(cell, 1);
  return text;
}

/// Faces with the cells on both sides, as in Fluent, with all numbers from 1 and hexadecimal.
std::string fluent(const Cubes& cubes) {
  std::string text =
      fmt::format("(0 \"cubes\")\n(2 3)\n(10 (0 1 {0:x} 0 3))\n(10 (1 1 {0:x} 1 3)(\n", cubes.points.size());
  for (const glm::dvec3& p : cubes.points) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  text += fmt::format("))\n(12 (0 1 {0:x} 0))\n(12 (2 1 {0:x} 1 4))\n", cubes.cells.size());
  // The key is the sorted corners. The value has the corners in the first cell's order, outward, and the cells.
  std::map<std::array<int, 4>, std::pair<std::array<int, 4>, std::vector<std::size_t>>> faces;
  constexpr std::array<std::array<std::size_t, 4>, 6> sides = {
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}, {1, 2, 6, 5}, {0, 4, 7, 3}}};
  for (std::size_t c = 0; c < cubes.cells.size(); ++c)
    for (const auto& side : sides) {
      std::array<int, 4> corners{};
      for (std::size_t k = 0; k < 4; ++k) corners[k] = cubes.cells[c][side[k]];
      std::array<int, 4> key = corners;
      std::sort(key.begin(), key.end());
      auto& face = faces[key];
      if (face.second.empty()) face.first = corners;
      face.second.push_back(c + 1);
    }
  std::array<std::string, 2> lines;  // faces between cells, and faces of walls
  std::array<std::size_t, 2> counts{};
  for (const auto& [key, face] : faces) {
    const std::size_t wall = face.second.size() == 1 ? 1 : 0;
    // By the right-hand rule the face's normal points to its first cell.
    const auto& v = face.first;
    lines[wall] += fmt::format("{:x} {:x} {:x} {:x} {:x} {:x}\n", v[3] + 1, v[2] + 1, v[1] + 1, v[0] + 1,
                               face.second[0], wall == 1 ? 0 : face.second[1]);
    ++counts[wall];
  }
  text += fmt::format("(13 (0 1 {:x} 0))\n(13 (3 1 {:x} 2 4)(\n{}))\n", faces.size(), counts[0], lines[0]);
  text += fmt::format("(13 (4 {:x} {:x} 3 4)(\n{}))\n", counts[0] + 1, faces.size(), lines[1]);
  return text + "(45 (2 fluid fluid)())\n(45 (3 interior inside)())\n(45 (4 wall walls)())\n";
}

void expect_cube(const cells::MeshFile& file, int n) {
  scene::validate(file.mesh, "cube");
  EXPECT_NEAR(testing::volume(file.mesh), n * n * n, 1e-5 * n * n * n);
  EXPECT_EQ(file.counts.cells_read, static_cast<std::uint64_t>(n * n * n));
  if (file.mesh.association != scene::Association::point) return;
  for (std::size_t v = 0; v < file.mesh.positions.size(); ++v)
    EXPECT_NEAR(file.mesh.scalars[v], field_at(file.mesh.positions[v]), 1e-5);  // their readers convert to float
}

TEST(SolverFiles, AvsUcdAndTecplotAreReadAsTheyAre) {
  const test::TemporaryFolder folder;
  const Cubes cubes(3);
  expect_cube(read_mesh(folder.write("m.inp", avs_ucd(cubes))), 3);
  expect_cube(read_mesh(folder.write("m.tec", tecplot(cubes))), 3);
  expect_cube(read_mesh(folder.write("ucd.tec", avs_ucd(cubes))), 3);
  expect_cube(read_mesh(folder.write("tecplot.dat", tecplot(cubes))), 3);
}

/// The first cell as six pyramids around an inner point, the others as bricks, with corners in this order.
std::string gambit(const Cubes& cubes, const std::array<std::size_t, 8>& order) {
  constexpr std::array<std::array<std::size_t, 4>, 6> sides = {
      {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {3, 2, 6, 7}, {1, 5, 6, 2}, {0, 3, 7, 4}}};
  std::string text =
      "        CONTROL INFO 2.4.6\n** GAMBIT NEUTRAL FILE\ncubes\nPROGRAM: Gambit VERSION: 2.4.6\n 1 Jan 2000 "
      "00:00:00\n"
      "     NUMNP     NELEM     NGRPS    NBSETS     NDFCD     NDFVL\n" +
      fmt::format("{:10}{:10}{:10}{:10}{:10}{:10}\nENDOFSECTION\n   NODAL COORDINATES 2.4.6\n", cubes.points.size() + 1,
                  cubes.cells.size() + 5, 0, 0, 3, 3);
  for (std::size_t v = 0; v < cubes.points.size(); ++v)
    text += fmt::format("{:10}{:20.11e}{:20.11e}{:20.11e}\n", v + 1, cubes.points[v].x, cubes.points[v].y,
                        cubes.points[v].z);
  text += fmt::format("{:10}{:20.11e}{:20.11e}{:20.11e}\n", cubes.points.size() + 1, 0.5, 0.5, 0.5);
  text += "ENDOFSECTION\n      ELEMENTS/CELLS 2.4.6\n";
  std::size_t element = 0;
  for (const auto& side : sides) {
    text += fmt::format("{:8}  7  5 ", ++element);
    for (std::size_t k = 0; k < 4; ++k) text += fmt::format("{:8}", cubes.cells[0][side[order[k]]] + 1);
    text += fmt::format("{:8}\n", cubes.points.size() + 1);
  }
  for (std::size_t c = 1; c < cubes.cells.size(); ++c) {
    text += fmt::format("{:8}  4  8 ", ++element);
    for (std::size_t k = 0; k < 8; ++k)
      text += fmt::format("{}{:8}", k == 7 ? "\n               " : "", cubes.cells[c][order[k]] + 1);
    text += "\n";
  }
  return text + "ENDOFSECTION\n";
}

TEST(SolverFiles, GambitsBricksAreReadRowByRowOrRoundAsTheyAre) {
  const test::TemporaryFolder folder;
  const Cubes cubes(3);
  const std::array<std::size_t, 8> by_rows{0, 1, 3, 2, 4, 5, 7, 6}, round{0, 1, 2, 3, 4, 5, 6, 7};
  for (const auto& order : {by_rows, round}) {
    const cells::MeshFile read = read_mesh(folder.write("m.neu", gambit(cubes, order)));
    scene::validate(read.mesh, "cube");
    EXPECT_NEAR(testing::volume(read.mesh), 27, 1e-5);
    EXPECT_EQ(read.counts.cells_read, 32u);
    EXPECT_EQ(read.counts.cells_tangled, 0u);
  }
}

TEST(SolverFiles, AFluentCaseIsAMeshWithTheValuesOfItsDataFile) {
  const test::TemporaryFolder folder;
  const Cubes cubes(3);
  const auto file = folder.write("a.cas", fluent(cubes));
  const cells::MeshFile alone = read_mesh(file);
  EXPECT_NEAR(testing::volume(alone.mesh), 27, 1e-5);
  EXPECT_EQ(alone.counts.cells_read, 27u);
  EXPECT_NE(
      std::find(alone.notes.begin(), alone.notes.end(), "there is no .dat file next to the case, so it has no field"),
      alone.notes.end());
  // Temperature, one value per cell.
  std::string data = fmt::format("(0 \"values\")\n(300 (3 2 1 0 0 1 {})\n(", cubes.cells.size());
  for (std::size_t c = 0; c < cubes.cells.size(); ++c) data += fmt::format("{}\n", 300 + c);
  folder.write("a.dat", data + "))\n");
  const cells::MeshFile read = read_mesh(file);
  expect_cube(read, 3);
  EXPECT_EQ(read.mesh.field_name, "TEMPERATURE");
  for (std::size_t t = 0; t < read.mesh.tets.size(); ++t) {
    glm::dvec3 centre(0);
    for (const std::uint32_t v : read.mesh.tets[t]) centre += 0.25 * read.mesh.positions[v];
    const glm::ivec3 at(centre);
    EXPECT_EQ(read.mesh.scalars[t], 300 + at.x + 3 * (at.y + 3 * at.z));
  }
  // The same numbers in one line, with the parenthesis directly after the last, after another section.
  data.back() = ')';
  std::string line = data;
  std::replace(line.begin(), line.end(), '\n', ' ');
  std::string pressure = line + ")(33 (1 6 8))\n";
  pressure.replace(pressure.find("(300 (3"), 7, "(300 (1");
  for (const std::string& text : {data + ")\n", line + ")", pressure + line + ")\n", line + " )\n"}) {
    folder.write("a.dat", text);
    ReadOptions options;
    options.field = "TEMPERATURE";
    EXPECT_EQ(read_mesh(file, options).mesh.scalars, read.mesh.scalars) << text;
  }
  std::string close = fluent(cubes);
  for (std::size_t at = close.find("\n))"); at != std::string::npos; at = close.find("\n))")) close.erase(at, 1);
  const cells::MeshFile closed = read_mesh(folder.write("c.cas", close));
  EXPECT_EQ(closed.mesh.positions, alone.mesh.positions);
  EXPECT_EQ(closed.counts.cells_read, 27u);
  test::expect_bad_input([&] { read_mesh(folder.write("b.cas", fluent(cubes).substr(0, 900))); }, {"b.cas"});
}

TEST(SolverFiles, AnOpenFoamCaseIsReadAtItsLastTimeOrTheOneAskedFor) {
  const test::TemporaryFolder folder;
  const Cubes cubes(3);
  write_foam(folder.path(), cubes, [](int) { return true; });
  write_control(folder.path());
  const cells::MeshFile last = read_mesh(folder / "case.foam");
  expect_cube(last, 3);
  for (const auto& other :
       {folder.path(), folder / "system" / "controlDict", folder / "constant" / "polyMesh" / "points"})
    EXPECT_EQ(read_mesh(other).mesh.scalars, last.mesh.scalars) << other;
  EXPECT_EQ(last.mesh.field_name, "p");
  EXPECT_EQ(last.mesh.scalars.front(), 1000);
  ReadOptions first;
  first.time_step = 0;
  const cells::MeshFile begin = read_mesh(folder / "case.foam", first);
  for (std::size_t t = 0; t < begin.mesh.tets.size(); ++t) {
    glm::dvec3 centre(0);
    for (const std::uint32_t v : begin.mesh.tets[t]) centre += 0.25 * begin.mesh.positions[v];
    const glm::ivec3 at(centre);
    EXPECT_EQ(begin.mesh.scalars[t], at.x + 3 * (at.y + 3 * at.z)) << "a value at the wrong cell";
  }
  first.time_step = 2;
  EXPECT_NE(message_of([&] { read_mesh(folder / "case.foam", first); }).find("there is no time step 2"),
            std::string::npos);
}

/// A zero-gradient patch has the pressure of the adjacent cells, 1000.
TEST(SolverFiles, PatchesOfAnOpenFoamCaseAreReadByName) {
  const test::TemporaryFolder folder;
  write_foam(folder.path(), Cubes(3), [](int) { return true; });
  write_control(folder.path());
  const std::array files = {folder / "case.foam"};
  ReadOptions options;
  options.field = "cell:p";
  options.blocks = {"walls"};
  const BlockFaces walls = read_block_faces(files, options);
  EXPECT_FALSE(walls.has_volume);
  EXPECT_EQ(walls.mesh.triangles.size(), 2u * 6 * 9);
  for (const glm::dvec3& p : walls.mesh.points)
    EXPECT_TRUE(p.x == 0 || p.x == 3 || p.y == 0 || p.y == 3 || p.z == 0 || p.z == 3);
  ASSERT_EQ(walls.mesh.values.size(), walls.mesh.points.size());
  for (const double value : walls.mesh.values) EXPECT_EQ(value, 1000);
  EXPECT_EQ(read_mesh(folder / "case.foam").blocks, std::vector<std::string>{"internalMesh"});
}

TEST(SolverFiles, ADecomposedOpenFoamCaseIsReadWhole) {
  const test::TemporaryFolder folder;
  const Cubes cubes(4);
  for (const int part : {0, 1}) {
    const auto own = folder / ("processor" + std::to_string(part));
    write_foam(own, cubes, [&](int c) { return (c / 32) == part; });
  }
  write_control(folder.path());
  const cells::MeshFile whole = read_mesh(folder / "case.foam");
  expect_cube(whole, 4);
  EXPECT_EQ(whole.mesh.scalars.front(), 1000);
  for (const std::size_t step : {std::size_t{0}, std::size_t{1}}) {
    ReadOptions options;
    options.time_step = step;
    testing::expect_as_whole(folder / "case.foam", options);
    options.blocks = {"internalMesh"};
    testing::expect_as_whole(folder / "case.foam", options);
  }
  ReadOptions none;
  none.blocks = {"solid"};
  test::expect_bad_input([&] { testing::read_in_parts(folder / "case.foam", 2, none); },
                         {"case.foam", "there is no block", "internalMesh"});
  // Some users copy a case from a cluster without the files that the processors share.
  std::filesystem::remove_all(folder / "system");
  std::filesystem::remove(folder / "case.foam");
  expect_cube(read_mesh(folder.path()), 4);
  // An image without one of the parts would be wrong.
  std::filesystem::remove_all(folder / "processor1" / "constant");
  test::expect_bad_input([&] { read_mesh(folder.path()); }, {"of its 2 processor directories, only 1 can be read"});
}

TEST(SolverFiles, RegionsOfADecomposedOpenFoamCaseAreBlocksOfAllProcessors) {
  const test::TemporaryFolder folder;
  for (const int part : {0, 1}) {
    const auto own = folder / ("processor" + std::to_string(part));
    int side = 1;
    for (const char* region : {"fluid", "solid"}) {
      const Cubes cubes(2 * ++side);
      write_foam(folder / "made", cubes, [&](int c) { return c % 2 == part; });
      std::filesystem::create_directories(own / "constant" / region);
      std::filesystem::rename(folder / "made" / "constant" / "polyMesh", own / "constant" / region / "polyMesh");
      for (const char* time : {"0", "1"}) {
        std::filesystem::create_directories(own / time);
        std::filesystem::rename(folder / "made" / time, own / time / region);
      }
    }
  }
  write_control(folder.path());
  const cells::MeshFile all = read_mesh(folder / "case.foam");
  EXPECT_EQ(all.blocks, (std::vector<std::string>{"fluid/internalMesh", "solid/internalMesh"}));
  EXPECT_EQ(all.counts.cells_read, 64u + 216u);
  testing::expect_as_whole(folder / "case.foam");
  ReadOptions options;
  options.blocks = {"solid"};
  EXPECT_EQ(read_mesh(folder / "case.foam", options).counts.cells_read, 216u);
  testing::expect_as_whole(folder / "case.foam", options);
}

TEST(SolverFiles, RegionsOfAnOpenFoamCaseAreBlocks) {
  const test::TemporaryFolder folder;
  int side = 1;
  for (const char* region : {"fluid", "solid"}) {
    const Cubes cubes(++side);
    write_foam(folder / "made", cubes, [](int) { return true; });
    std::filesystem::create_directories(folder / "constant" / region);
    std::filesystem::rename(folder / "made" / "constant" / "polyMesh", folder / "constant" / region / "polyMesh");
    for (const char* time : {"0", "1"}) {
      std::filesystem::create_directories(folder / time);
      std::filesystem::rename(folder / "made" / time, folder / time / region);
    }
  }
  write_control(folder.path());
  const cells::MeshFile all = read_mesh(folder / "case.foam");
  EXPECT_EQ(all.blocks, (std::vector<std::string>{"fluid/internalMesh", "solid/internalMesh"}));
  EXPECT_EQ(all.counts.cells_read, 8u + 27u);
  ReadOptions options;
  options.blocks = {"solid"};
  EXPECT_EQ(read_mesh(folder / "case.foam", options).counts.cells_read, 27u);
}

TEST(SolverFiles, AMultiBlockFilesVolumesAreDrawnTogether) {
  const test::TemporaryFolder folder;
  folder.write("a.vtu", testing::vtu_text(testing::mixed_mesh(2, 1, false)));
  folder.write(
      "b.vti",
      "<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"0 1 0 1 0 "
      "1\" Origin=\"5 0 0\" Spacing=\"1 1 2\"><Piece Extent=\"0 1 0 1 0 1\"><PointData><DataArray type=\"Float64\" "
      "Name=\"f\" format=\"ascii\">5 6 7 8 11 12 13 14</DataArray></PointData></Piece></ImageData></VTKFile>");
  folder.write("s.vtp", "<VTKFile type=\"PolyData\"></VTKFile>");
  const auto list = [&](const std::string& blocks) {
    return folder.write("m.vtm", "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet>" +
                                     blocks + "</vtkMultiBlockDataSet></VTKFile>");
  };
  const std::string both =
      "<DataSet index=\"0\" name=\"fluid\" file=\"a.vtu\"/><Block index=\"1\"><DataSet index=\"0\" "
      "file=\"b.vti\"/></Block>";
  const cells::MeshFile file = read_mesh(list(both + "<DataSet index=\"2\" file=\"s.vtp\"/><DataSet index=\"3\"/>"));
  EXPECT_NEAR(testing::volume(file.mesh), 3, 1e-12);
  EXPECT_EQ(file.mesh.field_name, "f");
  for (std::size_t v = 0; v < file.mesh.positions.size(); ++v)
    EXPECT_DOUBLE_EQ(file.mesh.scalars[v], field_at(file.mesh.positions[v]));
  EXPECT_NE(
      std::find(file.notes.begin(), file.notes.end(), "1 block is a surface and is left out: '2' (`surface` shows it)"),
      file.notes.end());
  EXPECT_EQ(file.blocks, (std::vector<std::string>{"fluid", "1"}));
  EXPECT_EQ(file.surfaces, std::vector<std::string>{"2"});
  ReadOptions options;
  options.blocks = {"solid"};
  // The file of the block that is not requested does not even exist.
  const std::string nested =
      "<Block index=\"0\" name=\"fluid\"><DataSet index=\"0\" name=\"inner\" file=\"gone.vtu\"/></Block><Block "
      "index=\"1\" name=\"solid\"><DataSet index=\"0\" name=\"inner\" file=\"b.vti\"/></Block>";
  const cells::MeshFile solid = read_mesh(list(nested), options);
  EXPECT_NEAR(testing::volume(solid.mesh), 2, 1e-12);
  EXPECT_EQ(solid.blocks, (std::vector<std::string>{"fluid/inner", "solid/inner"}));
  EXPECT_NE(
      message_of([&] { read_mesh(list(both + "<DataSet index=\"2\" file=\"gone.vtu\"/>")); }).find("gone.vtu: there"),
      std::string::npos);
}

/// A square that does not belong to any volume cell.
TEST(SolverFiles, AMultiBlockFilesSurfacesAreReadByName) {
  const test::TemporaryFolder folder;
  folder.write("a.vtu", testing::vtu_text(testing::mixed_mesh(2, 1, false)));
  folder.write(
      "s.vtp",
      "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData><Piece NumberOfPoints=\"4\" "
      "NumberOfPolys=\"1\"><PointData><DataArray type=\"Float64\" Name=\"f\" format=\"ascii\">1 2 3 4</DataArray>"
      "</PointData><CellData/><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 9 2 0 "
      "9 2 "
      "2 9 0 2 9</DataArray></Points><Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 "
      "3</DataArray><DataArray type=\"Int32\" Name=\"offsets\" "
      "format=\"ascii\">4</DataArray></Polys></Piece></PolyData>"
      "</VTKFile>");
  const std::array files = {folder.write(
      "m.vtm",
      "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet><DataSet index=\"0\" "
      "name=\"fluid\" "
      "file=\"a.vtu\"/><DataSet index=\"1\" name=\"lid\" file=\"s.vtp\"/></vtkMultiBlockDataSet></VTKFile>")};
  ReadOptions options;
  options.field = "f";
  options.blocks = {"lid"};
  const BlockFaces lid = read_block_faces(files, options);
  EXPECT_FALSE(lid.has_volume);
  ASSERT_EQ(lid.mesh.triangles.size(), 2u);
  ASSERT_EQ(lid.mesh.values.size(), lid.mesh.points.size());
  for (std::size_t v = 0; v < lid.mesh.points.size(); ++v) {
    const glm::dvec3& p = lid.mesh.points[v];
    EXPECT_EQ(p.z, 9);
    EXPECT_EQ(lid.mesh.values[v], p.y == 0 ? 1 + p.x / 2 : 4 - p.x / 2);
  }
  options.field = "nothing";  // a surface need not have the field
  EXPECT_TRUE(read_block_faces(files, options).mesh.values.empty());
  options.blocks = {"fluid"};
  EXPECT_TRUE(read_block_faces(files, options).has_volume);
  options.blocks = {"lit"};
  EXPECT_NE(message_of([&] { (void)read_block_faces(files, options); }).find("it has 'fluid', 'lid'; the nearest is"),
            std::string::npos);
}

}  // namespace
}  // namespace tessera::io
