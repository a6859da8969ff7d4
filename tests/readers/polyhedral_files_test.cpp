// SPDX-License-Identifier: BSD-3-Clause
// Files with polyhedra, written according to each format, compared with the same cells in memory.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "cells/mesh_assembly.hpp"
#include "support/mesh_checks.hpp"
#include "support/polyhedral_meshes.hpp"
#include "support/read_files.hpp"

namespace tessera::io {
namespace {

using testing::agglomerates;
using testing::Faces;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

cells::MeshFile read_field(const std::filesystem::path& file, const char* field) {
  ReadOptions options;
  options.field = std::string(field);
  return read_mesh(file, options);
}

cells::MeshFile in_memory(const cells::CellBlock& block, const char* field) {
  ReadOptions options;
  options.field = std::string(field);
  return cells::assemble_mesh({block}, options, "mesh");
}

void expect_same(const cells::MeshFile& read, const cells::MeshFile& wanted) {
  EXPECT_EQ(read.mesh.tets, wanted.mesh.tets);
  EXPECT_EQ(read.mesh.positions, wanted.mesh.positions);
  EXPECT_EQ(read.mesh.scalars, wanted.mesh.scalars);
  EXPECT_EQ(read.mesh.original_cell, wanted.mesh.original_cell);
  EXPECT_EQ(read.counts, wanted.counts);
}

/// A mesh in the form of face-based formats: each face once, oriented outward from its first cell, faces between cells
/// first.
struct FaceList {
  struct Face {
    std::vector<std::uint32_t> corners;
    std::vector<std::size_t> cells;
  };
  std::vector<Face> faces;
  std::size_t inner = 0;

  explicit FaceList(const std::vector<Faces>& cells) {
    std::map<std::vector<std::uint32_t>, std::size_t> numbers;
    for (std::size_t c = 0; c < cells.size(); ++c)
      for (const auto& corners : cells[c]) {
        auto key = corners;
        std::sort(key.begin(), key.end());
        const auto [at, is_new] = numbers.try_emplace(key, faces.size());
        if (is_new) faces.push_back({corners, {}});
        faces[at->second].cells.push_back(c);
      }
    std::stable_sort(faces.begin(), faces.end(),
                     [](const Face& a, const Face& b) { return a.cells.size() > b.cells.size(); });
    for (const Face& face : faces) inner += face.cells.size() - 1;
    std::sort(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(inner),
              [](const Face& a, const Face& b) { return a.cells < b.cells; });
  }
};

TEST(PolyhedralFiles, AVtuHasTheCellsThatItWasMadeOf) {
  const test::TemporaryFolder folder;
  // Other cells among the polyhedra, which have no faces.
  cells::CellBlock block = agglomerates(3, 5, 0.2, 3);
  block.types.insert(block.types.begin(), 12);
  block.connectivity.insert(block.connectivity.begin(), {0, 1, 5, 4, 16, 17, 21, 20});
  for (std::uint64_t& offset : block.offsets) offset += 8;
  block.offsets.insert(block.offsets.begin(), 0);
  block.face_locations.insert(block.face_locations.begin(), cells::CellBlock::no_faces);
  block.fields.pop_back();
  expect_same(read_field(folder.write("m.vtu", testing::vtu_text(block)), "f"), in_memory(block, "f"));
}

TEST(PolyhedralFiles, PiecesOfAPvtuAgreeOnTheFacesBetweenThem) {
  const test::TemporaryFolder folder;
  const cells::CellBlock whole = agglomerates(4, 5, 0.15, 6);
  const std::vector<Faces> all = testing::faces_of_cells(whole);
  std::mt19937 random(6);
  cells::CellBlock piece;
  for (const std::size_t first : {0, 1}) {
    std::vector<Faces> cells;
    for (std::size_t c = first; c < all.size(); c += 2) cells.push_back(all[c]);
    piece = testing::polyhedra_of(whole.positions, cells, random);
    folder.write(fmt::format("{}.vtu", first), testing::vtu_text(piece));
  }
  const cells::MeshFile read = read_field(folder.write("m.pvtu", testing::pvtu_text(piece, {"0.vtu", "1.vtu"})), "f");
  EXPECT_EQ(read.counts.cells_polyhedra, all.size());
  EXPECT_NEAR(testing::volume(read.mesh), 1, 1e-12);
  for (const auto& [place, uses] : testing::count_triangles(read.mesh)) {
    bool on_wall = false;
    for (std::size_t a = 0; a < 3; ++a)
      for (const double at : {0.0, 1.0}) on_wall |= place[0][a] == at && place[1][a] == at && place[2][a] == at;
    EXPECT_TRUE(uses == 2 || (uses == 1 && on_wall));
  }
}

TEST(PolyhedralFiles, ALegacyFileHasFacesInItsCells) {
  const test::TemporaryFolder folder;
  const cells::CellBlock block = agglomerates(2, 3, 0.2, 3);
  const std::vector<Faces> cells = testing::faces_of_cells(block);
  std::string text = fmt::format("# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double\n",
                                 block.positions.size());
  for (const glm::dvec3& p : block.positions) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  text += fmt::format("CELLS {} {}\n", cells.size(), block.faces.size() + cells.size());
  for (const Faces& cell : cells) {
    std::size_t size = 1;
    for (const auto& face : cell) size += face.size() + 1;
    text += fmt::format("{} {}", size, cell.size());
    for (const auto& face : cell) text += fmt::format(" {} {}", face.size(), fmt::join(face, " "));
    text += "\n";
  }
  text += fmt::format("CELL_TYPES {}\n", cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) text += "42\n";
  text += fmt::format("POINT_DATA {}\nSCALARS f double 1\nLOOKUP_TABLE default\n", block.positions.size());
  for (const glm::dvec3& p : block.positions) text += fmt::format("{}\n", p.x + 2 * p.y + 3 * p.z);
  expect_same(read_field(folder.write("m.vtk", text), "f"), in_memory(block, "f"));
}

TEST(PolyhedralFiles, DamagedFacesAreOneLine) {
  const test::TemporaryFolder folder;
  std::mt19937 random(1);
  const std::vector<glm::dvec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const cells::CellBlock block =
      testing::polyhedra_of(points, {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}}, random, true);
  const std::string good = testing::vtu_text(block);
  EXPECT_NEAR(testing::volume(read_mesh(folder.write("good.vtu", good)).mesh), 1.0 / 6, 1e-15);
  const std::string list = fmt::format("{} ", fmt::join(block.faces, " "));
  const auto damaged = [&](const std::string& text) {
    const auto file = folder.write("bad.vtu", text);
    test::expect_bad_input([&] { read_mesh(file); }, {"bad.vtu: ", "; "});
  };
  for (const std::string faces :
       {"", "4 ", "5 3 0 2 1 3 0 1 3 3 1 2 3 3 2 0 3 ", "4 3 0 2 1 3 0 1 3 3 1 2 3 30 2 0 3 ",
        "4 3 0 2 1 3 0 1 3 3 1 2 3 3 2 0 4 ", "4 3 0 2 1 3 0 1 3 3 1 2 3 3 2 0 -1 ",
        "-4 3 0 2 1 3 0 1 3 3 1 2 3 3 2 0 3 ", "4 3 0 2 1 3 0 1 3 3 1 2 3 -3 2 0 3 ",
        "4000000000 3 0 2 1 3 0 1 3 3 1 2 3 3 2 0 3 ", "4 3 0 2 1 3 0 1 3 3 1 2 3 99999999999 2 0 3 "})
    damaged(replaced(good, list, faces));
  for (const char* end : {"-1", "18", "0", "-17", "99999999999"})
    damaged(replaced(good, "Name=\"faceoffsets\" NumberOfComponents=\"1\" format=\"ascii\">\n17 ",
                     fmt::format("Name=\"faceoffsets\" NumberOfComponents=\"1\" format=\"ascii\">\n{} ", end)));
  // Without them.
  damaged(replaced(replaced(good, "Name=\"faces\"", "Name=\"others\""), "Name=\"faceoffsets\"", "Name=\"ends\""));
}

TEST(PolyhedralFiles, RandomNumbersAmongFacesNeverCrash) {
  const test::TemporaryFolder folder;
  const cells::CellBlock block = agglomerates(2, 4, 0.2, 1);
  std::mt19937 random(4);
  for (int round = 0; round < 60; ++round) {
    cells::CellBlock bad = block;
    for (unsigned k = 0; k <= random() % 3; ++k)
      bad.faces[random() % bad.faces.size()] = random() % 4 == 0 ? random() : random() % 30;
    const test::Fault fault = test::fault_of([&] {
      cells::require_faces(bad, "mesh");
      scene::validate(in_memory(bad, "f").mesh, "mesh");
    });
    if (!fault.code) continue;
    EXPECT_EQ(fault.code, scene::ErrorCode::bad_input) << fault.message;
    EXPECT_TRUE(fault.message.starts_with("mesh: ")) << fault.message;
  }
}

std::string foam_header(const char* kind, const std::string& object) {
  return fmt::format(
      "FoamFile\n{{\n version 2.0;\n format ascii;\n arch \"LSB;label=32;scalar=64\";\n class {};\n object {};\n}}\n",
      kind, object);
}

/// A case whose field `c` is the cell's number.
void write_case(const std::filesystem::path& folder, const cells::CellBlock& block) {
  const std::vector<Faces> cells = testing::faces_of_cells(block);
  const FaceList list(cells);
  const auto write = [&](const char* name, const std::string& text) {
    const auto file = folder / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  };
  std::string points = foam_header("vectorField", "points") + fmt::format("{}\n(\n", block.positions.size());
  for (const glm::dvec3& p : block.positions) points += fmt::format("({} {} {})\n", p.x, p.y, p.z);
  std::string faces = foam_header("faceList", "faces") + fmt::format("{}\n(\n", list.faces.size());
  std::string owners = foam_header("labelList", "owner") + fmt::format("{}\n(\n", list.faces.size());
  std::string neighbours = foam_header("labelList", "neighbour") + fmt::format("{}\n(\n", list.inner);
  for (const auto& face : list.faces) {
    faces += fmt::format("{}({})\n", face.corners.size(), fmt::join(face.corners, " "));
    owners += fmt::format("{}\n", face.cells[0]);
    if (face.cells.size() == 2) neighbours += fmt::format("{}\n", face.cells[1]);
  }
  write("constant/polyMesh/points", points + ")\n");
  write("constant/polyMesh/faces", faces + ")\n");
  write("constant/polyMesh/owner", owners + ")\n");
  write("constant/polyMesh/neighbour", neighbours + ")\n");
  write("constant/polyMesh/boundary",
        foam_header("polyBoundaryMesh", "boundary") +
            fmt::format("1\n(\nwalls\n{{\n type wall;\n nFaces {};\n startFace {};\n}}\n)\n",
                        list.faces.size() - list.inner, list.inner));
  std::string c =
      foam_header("volScalarField", "c") +
      fmt::format("dimensions [0 2 -2 0 0 0 0];\ninternalField nonuniform List<scalar> {}\n(\n", cells.size());
  for (std::size_t k = 0; k < cells.size(); ++k) c += fmt::format("{}\n", k);
  write("0/c", c + ")\n;\nboundaryField\n{\n walls\n {\n  type zeroGradient;\n }\n}\n");
  std::string f =
      foam_header("pointScalarField", "f") +
      fmt::format("dimensions [0 0 0 0 0 0 0];\ninternalField nonuniform List<scalar> {}\n(\n", block.positions.size());
  for (const glm::dvec3& p : block.positions) f += fmt::format("{}\n", p.x + 2 * p.y + 3 * p.z);
  write("0/f", f + ")\n;\nboundaryField\n{\n walls\n {\n  type calculated;\n }\n}\n");
  write("system/controlDict",
        foam_header("dictionary", "controlDict") +
            "startFrom startTime;\nstartTime 0;\nendTime 0;\ndeltaT 1;\nwriteControl timeStep;\nwriteInterval 1;\n");
  write("case.foam", "");
}

/// Compares volume, faces, cell numbers and linear point data of a mesh that was read through floats.
void expect_like(const cells::MeshFile& read, const cells::CellBlock& block, bool has_polyhedra = true) {
  scene::validate(read.mesh, "mesh");
  EXPECT_NEAR(testing::volume(read.mesh), 1, 1e-5);
  EXPECT_EQ(read.counts.cells_read, block.types.size());
  EXPECT_EQ(read.counts.cells_open + read.counts.cells_tangled, 0u);
  if (has_polyhedra) {
    EXPECT_GT(read.counts.cells_polyhedra, 0u);
  }
  std::size_t alone = 0;
  double outside = 0;
  for (const auto& [t, uses] : testing::count_triangles(read.mesh)) {
    EXPECT_LE(uses, 2);
    if (uses != 1) continue;
    ++alone;
    const glm::dvec3 a(t[0][0], t[0][1], t[0][2]), b(t[1][0], t[1][1], t[1][2]), c(t[2][0], t[2][1], t[2][2]);
    outside += glm::length(glm::cross(b - a, c - a)) / 2;
  }
  EXPECT_NEAR(outside, 6, 1e-4) << alone << " triangles of one tet alone";
  const std::vector<Faces> cells = testing::faces_of_cells(block);
  std::vector<double> volumes(cells.size(), 0), wanted(cells.size(), 0);
  const auto add = [](const scene::TetMesh& mesh, std::vector<double>& sums) {
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      const auto place = [&](std::size_t k) { return mesh.positions[mesh.tets[t][k]]; };
      const glm::dvec3 a = place(0);
      const std::size_t cell = mesh.original_cell.empty() ? t : mesh.original_cell[t];
      sums[cell] += std::abs(glm::dot(glm::cross(place(1) - a, place(2) - a), place(3) - a)) / 6;
    }
  };
  add(read.mesh, volumes);
  add(in_memory(block, "c").mesh, wanted);
  for (std::size_t c = 0; c < cells.size(); ++c) EXPECT_NEAR(volumes[c], wanted[c], 1e-5) << c;
  if (read.mesh.association == scene::Association::cell)
    for (std::size_t t = 0; t < read.mesh.tets.size(); ++t)
      EXPECT_EQ(read.mesh.scalars[t], static_cast<double>(read.mesh.original_cell[t]));
  else
    for (std::size_t v = 0; v < read.mesh.positions.size(); ++v) {
      const glm::dvec3& p = read.mesh.positions[v];
      EXPECT_NEAR(read.mesh.scalars[v], p.x + 2 * p.y + 3 * p.z, 2e-5);
    }
}

TEST(PolyhedralFiles, AnOpenFoamCaseKeepsItsCellsAndValues) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const test::TemporaryFolder folder;
    const cells::CellBlock block = agglomerates(4, 5, 0.15, seed);
    write_case(folder.path(), block);
    expect_like(read_field(folder / "case.foam", "c"), block);
    expect_like(read_field(folder / "case.foam", "f"), block);
  }
}

TEST(PolyhedralFiles, EnSightGoldHasThemAsNfaced) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const test::TemporaryFolder folder;
    const cells::CellBlock block = agglomerates(4, 5, 0.15, seed);
    const std::vector<Faces> cells = testing::faces_of_cells(block);
    std::string text = "made\nhere\nnode id off\nelement id off\npart\n         1\nbox\ncoordinates\n";
    text += fmt::format("{:10}\n", block.positions.size());
    for (int a = 0; a < 3; ++a)
      for (const glm::dvec3& p : block.positions) text += fmt::format("{:12.5e}\n", p[a]);
    text += fmt::format("nfaced\n{:10}\n", cells.size());
    std::string sizes, corners;
    for (const Faces& cell : cells) {
      text += fmt::format("{:10}\n", cell.size());
      for (const auto& face : cell) {
        sizes += fmt::format("{:10}\n", face.size());
        for (const std::uint32_t v : face) corners += fmt::format("{:10}", v + 1);
        corners += "\n";
      }
    }
    folder.write("m.geo", text + sizes + corners);
    std::string f = "f\npart\n         1\ncoordinates\n", c = "c\npart\n         1\nnfaced\n";
    for (const glm::dvec3& p : block.positions) f += fmt::format("{:12.5e}\n", p.x + 2 * p.y + 3 * p.z);
    for (std::size_t k = 0; k < cells.size(); ++k) c += fmt::format("{:12.5e}\n", static_cast<double>(k));
    folder.write("m.f", f);
    folder.write("m.c", c);
    const auto file = folder.write("m.case",
                                   "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: m.geo\nVARIABLE\nscalar per node: f "
                                   "m.f\nscalar per element: c m.c\n");
    expect_like(read_field(file, "f"), block);
    expect_like(read_field(file, "c"), block);
    const std::string server = "machine id: here\nexecutable: none\ncasefile: m.case\n";
    const auto list = [&](int servers) {
      std::string lines = fmt::format("FORMAT\ntype: master_server gold\nSERVERS\nnumber of servers: {}\n", servers);
      for (int n = 0; n < servers; ++n) lines += server;
      return folder.write(fmt::format("m{}.sos", servers), lines);
    };
    expect_like(read_field(list(1), "c"), block);
    EXPECT_EQ(read_field(list(2), "c").mesh.tets.size(), 2 * read_field(file, "c").mesh.tets.size());
  }
}

TEST(PolyhedralFiles, AnEnSightListNamesMissingFiles) {
  const test::TemporaryFolder folder;
  const auto file =
      folder.write("m.sos", "FORMAT\ntype: master_server gold\nSERVERS\nnumber of servers: 1\ncasefile: none.case\n");
  EXPECT_NE(testing::message_of([&] { read_mesh(file); }).find("it lists none.case, but there is no such file"),
            std::string::npos);
  const auto empty = folder.write("e.sos", "FORMAT\ntype: master_server gold\nSERVERS\nnumber of servers: 0\n");
  EXPECT_NE(testing::message_of([&] { read_mesh(empty); }).find("without a `casefile:`"), std::string::npos);
}

TEST(PolyhedralFiles, FluentsConvexCellsAreReadAsPolyhedra) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const test::TemporaryFolder folder;
    std::mt19937 random(seed);
    const cells::CellBlock block = testing::voronoi_mesh(30, seed);
    const std::vector<Faces> cells = testing::faces_of_cells(block);
    const FaceList list(cells);
    std::string text =
        fmt::format("(0 \"cells\")\n(2 3)\n(10 (0 1 {0:x} 0 3))\n(10 (1 1 {0:x} 1 3)(\n", block.positions.size());
    for (const glm::dvec3& p : block.positions) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
    text += fmt::format("))\n(12 (0 1 {0:x} 0))\n(12 (2 1 {0:x} 1 7))\n", cells.size());
    std::array<std::string, 2> lines;
    for (const auto& face : list.faces) {
      std::string& line = lines[face.cells.size() == 2 ? 0 : 1];
      line += fmt::format("{:x}", face.corners.size());
      for (const std::uint32_t v : face.corners) line += fmt::format(" {:x}", v + 1);
      line += fmt::format(" {:x} {:x}\n", face.cells[0] + 1, face.cells.size() == 2 ? face.cells[1] + 1 : 0);
    }
    text += fmt::format("(13 (0 1 {:x} 0))\n(13 (3 1 {:x} 2 5)(\n{}))\n", list.faces.size(), list.inner, lines[0]);
    text += fmt::format("(13 (4 {:x} {:x} 3 5)(\n{}))\n", list.inner + 1, list.faces.size(), lines[1]);
    text += "(45 (2 fluid fluid)())\n(45 (3 interior inside)())\n(45 (4 wall walls)())\n";
    const cells::MeshFile alone = read_mesh(folder.write("a.cas", text));
    EXPECT_NEAR(testing::volume(alone.mesh), 1, 1e-5);
    std::string data = fmt::format("(0 \"values\")\n(300 (3 2 1 0 0 1 {})\n(", cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c) data += fmt::format("{}\n", c);
    folder.write("a.dat", data + "))\n");
    expect_like(read_mesh(folder / "a.cas"), block);
  }
}

}  // namespace
}  // namespace tessera::io
