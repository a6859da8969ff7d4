// SPDX-License-Identifier: BSD-3-Clause
// .vtu files that this process reads, with known cells and values.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "cells/mesh_assembly.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "io/mesh/vtu_checks.hpp"
#include "io/mesh/vtu_writing.hpp"
#include "support/mesh_checks.hpp"
#include "support/polyhedral_meshes.hpp"
#include "support/read_files.hpp"
#include "support/some_cases.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using test::all_storages;
using test::sample_piece;
using test::values_of;
using test::vtu_block;
using test::vtu_file_text;
using test::VtuArray;
using test::VtuPiece;
using test::VtuStorage;
using Coding = VtuStorage::Coding;
using Codec = VtuStorage::Codec;

std::string words_of(const VtuStorage& s) {
  return fmt::format("coding {}, codec {}, {} bits, {} endian, block {}, line {}", static_cast<int>(s.coding),
                     static_cast<int>(s.codec), s.wide_numbers ? 64 : 32, s.big_endian ? "big" : "little", s.block,
                     s.line);
}

/// The numbers of a piece's array.
const std::vector<double>& numbers_of(const std::vector<VtuArray>& arrays, const std::string& name) {
  return std::ranges::find(arrays, name, &VtuArray::name)->numbers;
}

void expect_points(const cells::CellBlock& block, const std::vector<double>& numbers, std::size_t first = 0) {
  ASSERT_GE(block.positions.size(), first + numbers.size() / 3);
  for (std::size_t k = 0; k < numbers.size(); ++k)
    EXPECT_EQ(block.positions[first + k / 3][static_cast<int>(k % 3)], numbers[k]) << k;
}

/// Checks the block of sample_piece().
void expect_sample(const cells::CellBlock& block, const VtuPiece& piece) {
  ASSERT_EQ(block.positions.size(), piece.points);
  expect_points(block, piece.coordinates[0].numbers);
  const auto& uses = numbers_of(piece.topology, "connectivity");
  EXPECT_EQ(block.connectivity, std::vector<std::uint32_t>(uses.begin(), uses.end()));
  EXPECT_EQ(block.offsets, (std::vector<std::uint64_t>{0, 8, 14, 20}));
  EXPECT_EQ(block.types, (std::vector<std::uint8_t>{12, 13, 13}));
  EXPECT_TRUE(block.tets.empty() && block.faces.empty() && block.point_ghost.empty() && block.cell_ghost.empty());
  ASSERT_EQ(block.fields.size(), 3u);
  const cells::BlockField &f = block.fields[0], &v = block.fields[1], &c = block.fields[2];
  EXPECT_EQ(f.name, "f");
  EXPECT_EQ(f.type, "float");
  EXPECT_TRUE(f.active && v.active && !c.active);
  EXPECT_EQ(f.association, scene::Association::point);
  EXPECT_EQ(values_of(f, 0), piece.point_data[0].numbers);
  ASSERT_TRUE(f.tally && c.tally);
  EXPECT_EQ(f.tally->low, -0.25);
  EXPECT_EQ(f.tally->high, 2.5);
  EXPECT_EQ(v.components, 3);
  EXPECT_EQ(v.type, "double");
  for (int k = 0; k < 3; ++k)
    for (std::size_t p = 0; p < piece.points; ++p)
      EXPECT_EQ(values_of(v, k)[p], piece.point_data[1].numbers[3 * p + static_cast<std::size_t>(k)]);
  EXPECT_EQ(c.name, "c");
  EXPECT_EQ(c.type, "int16");
  EXPECT_EQ(c.association, scene::Association::cell);
  EXPECT_EQ(values_of(c, 0), (std::vector<double>{7, -3, 1000}));
  EXPECT_EQ(c.tally->high, 1000);
}

/// A tet at (8 * at, 0, 0) with the cell field `value` and the point field 10 times that plus the point's number.
VtuPiece one_tet(double at, double value) {
  return {.points = 4,
          .cells = 1,
          .point_data = {{"Int32", "p", 1, {10 * value, 10 * value + 1, 10 * value + 2, 10 * value + 3}}},
          .cell_data = {{"Float64", "c", 1, {value}}},
          .coordinates = {{"Float64", "Points", 3, {8 * at, 0, 0, 8 * at + 1, 0, 0, 8 * at, 1, 0, 8 * at, 0, 1}}},
          .topology = {
              {"Int32", "connectivity", 1, {0, 1, 2, 3}}, {"Int32", "offsets", 1, {4}}, {"UInt8", "types", 1, {10}}}};
}

class Vtu : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const { return folder.write("m.vtu", text); }
  cells::CellBlock read(const VtuStorage& storage, const std::vector<VtuPiece>& pieces) const {
    return vtu_block(write(vtu_file_text(storage, pieces)));
  }

  test::TemporaryFolder folder;
};

TEST_F(Vtu, EveryStorageHasTheSameCellsAndValues) {
  const VtuPiece piece = sample_piece();
  std::size_t tried = 0;
  for (VtuStorage storage : all_storages())
    for (const std::size_t block : {std::size_t{40}, std::size_t{48}, std::size_t{0}}) {
      storage.block = block;
      SCOPED_TRACE(words_of(storage));
      expect_sample(read(storage, {piece}), piece);
      ++tried;
    }
  EXPECT_EQ(tried, 3 * (4 + 3 * 16u));
}

TEST_F(Vtu, Base64MayBeInLinesAndItsNumberATextByItself) {
  const VtuPiece piece = sample_piece("Float32", "Int32");
  for (const Codec codec : {Codec::none, Codec::zlib})
    for (const std::size_t line : {std::size_t{1}, std::size_t{3}, std::size_t{76}}) {
      const VtuStorage storage{.coding = Coding::inline_base64, .codec = codec, .split_text = true, .line = line};
      SCOPED_TRACE(words_of(storage));
      expect_sample(read(storage, {piece}), piece);
    }
}

TEST_F(Vtu, LargeArraysInManyBlocksAreWhole) {
  constexpr std::size_t points = 200000;
  VtuPiece piece = one_tet(0, 1);
  piece.points = points;
  piece.point_data[0].numbers.resize(points);
  piece.coordinates[0].numbers.resize(3 * points);
  for (std::size_t p = 0; p < points; ++p) {
    piece.point_data[0].numbers[p] = static_cast<double>(p * 7919 % 1000003);
    for (std::size_t a = 0; a < 3; ++a) piece.coordinates[0].numbers[3 * p + a] = static_cast<double>(p % 977) / 7 - a;
  }
  for (const Coding coding : {Coding::ascii, Coding::inline_base64, Coding::appended_base64, Coding::appended_raw})
    for (const Codec codec : {Codec::none, Codec::zlib, Codec::lz4}) {
      if (coding == Coding::ascii && codec != Codec::none) continue;
      const VtuStorage storage{.coding = coding, .codec = codec, .block = 32768};
      SCOPED_TRACE(words_of(storage));
      const cells::CellBlock block = read(storage, {piece});
      expect_points(block, piece.coordinates[0].numbers);
      ASSERT_EQ(block.fields.size(), 2u);
      EXPECT_EQ(values_of(block.fields[0], 0), piece.point_data[0].numbers);
    }
}

TEST_F(Vtu, EveryTypeOfNumberKeepsItsValues) {
  const std::vector<std::pair<std::string, std::vector<double>>> types = {
      {"Int8", {-128, 0, 127, 1}},
      {"UInt8", {0, 255, 128, 1}},
      {"Int16", {-32768, 32767, 5, 0}},
      {"UInt16", {65535, 0, 1, 2}},
      {"Int32", {-2147483648.0, 2147483647, 0, 9}},
      {"UInt32", {4294967295.0, 0, 1, 2}},
      {"Int64", {-9007199254740992.0, 9007199254740992.0, 0, 1}},
      {"UInt64", {9007199254740992.0, 0, 1, 2}},
      {"Float32", {-1.5, 3.4e38f, 1e-45f, 0.1f}},
      {"Float64", {-1.5, 1.7e308, 5e-324, 0.1}}};
  test::SomeCases some(5);
  for (const auto& [type, values] : types)
    for (const VtuStorage& storage : all_storages()) {
      if (!some.next()) continue;
      SCOPED_TRACE(type + ", " + words_of(storage));
      VtuPiece piece = one_tet(0, 1);
      piece.point_data = {{type, "p", 1, values}};
      const cells::CellBlock block = read(storage, {piece});
      ASSERT_EQ(block.fields.size(), 2u);
      EXPECT_EQ(values_of(block.fields[0], 0), values);
    }
}

TEST_F(Vtu, PointsIndicesAndTypesOfCellsAreOfAnyType) {
  for (const char* points : {"Float32", "Float64", "Int16"})
    for (const char* indices : {"Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64"})
      for (const char* types : {"UInt8", "Int8", "Int32", "Int64"})
        for (const Coding coding : {Coding::ascii, Coding::appended_raw}) {
          SCOPED_TRACE(fmt::format("{} {} {}", points, indices, types));
          const VtuPiece piece = sample_piece(points, indices, types);
          expect_sample(read({.coding = coding}, {piece}), piece);
        }
}

TEST_F(Vtu, PiecesFollowEachOtherAndEmptyOnesAreSkipped) {
  const VtuPiece empty;
  VtuPiece bare = one_tet(0, 0);
  bare.points = bare.cells = 0;
  for (auto* list : {&bare.point_data, &bare.cell_data, &bare.coordinates, &bare.topology})
    for (VtuArray& array : *list) array.numbers.clear();
  for (const VtuStorage& storage : all_storages()) {
    SCOPED_TRACE(words_of(storage));
    const cells::CellBlock block =
        read(storage, {bare, one_tet(0, 1), empty, one_tet(1, 2), bare, one_tet(2, 3), empty});
    EXPECT_EQ(block.tets, (std::vector<scene::Tet>{{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}}));
    for (std::size_t k = 0; k < 3; ++k)
      expect_points(block, one_tet(static_cast<double>(k), 0).coordinates[0].numbers, 4 * k);
    ASSERT_EQ(block.fields.size(), 2u);
    EXPECT_EQ(values_of(block.fields[0], 0), (std::vector<double>{10, 11, 12, 13, 20, 21, 22, 23, 30, 31, 32, 33}));
    EXPECT_EQ(values_of(block.fields[1], 0), (std::vector<double>{1, 2, 3}));
  }
}

TEST_F(Vtu, PiecesOfSeveralKindsOfCellsKeepTheirOffsets) {
  VtuPiece tet = one_tet(3, 1), mixed = sample_piece();
  tet.point_data.clear(), tet.cell_data.clear(), mixed.point_data.clear(), mixed.cell_data.clear();
  const cells::CellBlock block = read({}, {tet, mixed});
  EXPECT_EQ(block.types, (std::vector<std::uint8_t>{10, 12, 13, 13}));
  EXPECT_EQ(block.offsets, (std::vector<std::uint64_t>{0, 4, 12, 18, 24}));
  EXPECT_EQ(block.connectivity[4], 4u);
  EXPECT_EQ(block.connectivity.back(), 14u);
}

TEST_F(Vtu, PiecesWithOtherArraysAreLeftToVtk) {
  VtuPiece other = one_tet(1, 2);
  other.point_data[0].name = "q";
  EXPECT_FALSE(open_vtk_xml(write(vtu_file_text({}, {one_tet(0, 1), other}))));
  other = one_tet(1, 2);
  other.cell_data[0].type = "Float32";
  EXPECT_FALSE(open_vtk_xml(write(vtu_file_text({}, {one_tet(0, 1), other}))));
  other = one_tet(1, 2);
  other.coordinates[0].type = "Float32";
  EXPECT_FALSE(open_vtk_xml(write(vtu_file_text({}, {one_tet(0, 1), other}))));
}

/// A cube and a tet on it, as polyhedra, next to a cell that is not a polyhedron.
VtuPiece polyhedra(bool numbered) {
  VtuPiece piece = sample_piece();
  piece.point_data.clear(), piece.cell_data.clear();
  piece.cells = 2;
  piece.topology = {{"Int64", "connectivity", 1, {1, 2, 4, 7, 8, 10, 0, 1, 4, 3, 6, 7, 10, 9}},
                    {"Int64", "offsets", 1, {6, 14}},
                    {"UInt8", "types", 1, {13, 42}}};
  if (numbered) {
    const std::vector<double> corners = {0, 3, 4, 1, 6, 7, 10, 9, 0, 1, 7, 6, 3, 9, 10, 4, 0, 6, 9, 3, 1, 4, 10, 7};
    piece.topology.push_back({"Int64", "face_connectivity", 1, corners});
    piece.topology.push_back({"Int64", "face_offsets", 1, {4, 8, 12, 16, 20, 24}});
    piece.topology.push_back({"Int32", "polyhedron_to_faces", 1, {0, 1, 2, 3, 4, 5}});
    piece.topology.push_back({"Int64", "polyhedron_offsets", 1, {0, 6}});
  } else {
    piece.topology.push_back({"Int64", "faces", 1, {6, 4, 0, 3,  4, 1, 4, 6, 7, 10, 9, 4, 0, 1,  7, 6,
                                                    4, 3, 9, 10, 4, 4, 0, 6, 9, 3,  4, 1, 4, 10, 7}});
    piece.topology.push_back({"Int64", "faceoffsets", 1, {-1, 31}});
  }
  return piece;
}

TEST_F(Vtu, PolyhedraOfBothLayoutsHaveTheSameFaces) {
  for (const bool numbered : {false, true})
    for (const Coding coding : {Coding::ascii, Coding::appended_raw}) {
      VtuPiece hexahedra = sample_piece();
      hexahedra.point_data.clear(), hexahedra.cell_data.clear();
      const cells::CellBlock block =
          read({.coding = coding, .version = numbered ? "2.3" : "2.2"}, {hexahedra, polyhedra(numbered)});
      EXPECT_EQ(block.types, (std::vector<std::uint8_t>{12, 13, 13, 13, 42}));
      EXPECT_EQ(block.face_locations, (std::vector<std::int64_t>{-1, -1, -1, -1, 0}));
      EXPECT_EQ(block.faces, (std::vector<std::uint32_t>{6, 4,  12, 15, 16, 13, 4,  18, 19, 22, 21, 4,  12, 13, 19, 18,
                                                         4, 15, 21, 22, 16, 4,  12, 18, 21, 15, 4,  13, 16, 22, 19}));
    }
}

/// Cells [first, last) of a block of polyhedra as written by VTK 9.4, with cell numbers. A face between two cells is
/// written once.
std::string numbered_polyhedra(const cells::CellBlock& block, std::size_t first, std::size_t last) {
  const std::vector<testing::Faces> cells = testing::faces_of_cells(block);
  std::map<std::vector<std::uint32_t>, std::size_t> numbers;
  std::string points, uses, ends, types, values, corners, corner_ends, faces, face_ends;
  std::size_t used = 0, of_corners = 0, of_faces = 0;
  for (const glm::dvec3& p : block.positions) points += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  for (std::size_t c = first; c < last; ++c) {
    for (std::size_t k = block.offsets[c]; k < block.offsets[c + 1]; ++k)
      uses += fmt::format("{} ", block.connectivity[k]);
    for (const auto& face : cells[c]) {
      std::vector<std::uint32_t> key(face.begin(), face.end());
      std::ranges::sort(key);
      const auto [at, is_new] = numbers.try_emplace(key, numbers.size());
      faces += fmt::format("{} ", at->second);
      ++of_faces;
      if (!is_new) continue;
      for (const std::uint32_t v : face) corners += fmt::format("{} ", v);
      corner_ends += fmt::format("{} ", of_corners += face.size());
    }
    ends += fmt::format("{} ", used += block.offsets[c + 1] - block.offsets[c]);
    face_ends += fmt::format("{} ", of_faces);
    types += "42 ";
    values += fmt::format("{} ", c);
  }
  const auto array = [](const char* name, const char* type, int components, const std::string& text) {
    return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">{}</DataArray>\n",
                       type, name, components, text);
  };
  return fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"><CellData>", block.positions.size(),
                     last - first) +
         array("n", "Float64", 1, values) + "</CellData><Points>" + array("Points", "Float64", 3, points) +
         "</Points><Cells>" + array("connectivity", "Int64", 1, uses) + array("offsets", "Int64", 1, ends) +
         array("types", "UInt8", 1, types) + array("face_connectivity", "Int64", 1, corners) +
         array("face_offsets", "Int64", 1, corner_ends) + array("polyhedron_to_faces", "Int64", 1, faces) +
         array("polyhedron_offsets", "Int64", 1, face_ends) + "</Cells></Piece>\n";
}

std::string vtk94_file(const std::string& pieces) {
  return "<VTKFile type=\"UnstructuredGrid\" version=\"2.3\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\"><UnstructuredGrid>\n" +
         pieces + "</UnstructuredGrid></VTKFile>\n";
}

TEST_F(Vtu, PolyhedraOfVtk94AreReadWholeInPiecesAndInFilesOfPieces) {
  const cells::CellBlock block = testing::agglomerates(3, 5, 0.2, 3);
  const std::size_t cells = block.types.size(), half = cells / 2;
  const std::string first = numbered_polyhedra(block, 0, half), second = numbered_polyhedra(block, half, cells);
  folder.write("one.vtu", vtk94_file(numbered_polyhedra(block, 0, cells)));
  folder.write("two.vtu", vtk94_file(first + second));
  folder.write("a.vtu", vtk94_file(first));
  folder.write("b.vtu", vtk94_file(second));
  folder.write("m.pvtu",
               "<VTKFile type=\"PUnstructuredGrid\" version=\"2.3\"><PUnstructuredGrid GhostLevel=\"0\"><PCellData>"
               "<PDataArray type=\"Float64\" Name=\"n\"/></PCellData><PPoints><PDataArray type=\"Float64\" "
               "NumberOfComponents=\"3\"/></PPoints><Piece Source=\"a.vtu\"/><Piece Source=\"b.vtu\"/>"
               "</PUnstructuredGrid></VTKFile>\n");
  const cells::MeshFile wanted = cells::assemble_mesh({block}, {}, "mesh");
  for (const char* name : {"one.vtu", "two.vtu", "m.pvtu"}) {
    SCOPED_TRACE(name);
    const cells::MeshFile read = read_mesh(folder / name);
    EXPECT_EQ(read.counts.cells_polyhedra, cells);
    EXPECT_EQ(read.mesh.tets.size(), wanted.mesh.tets.size());
    EXPECT_EQ(read.mesh.original_cell, wanted.mesh.original_cell);
    EXPECT_NEAR(testing::volume(read.mesh), 1, 1e-12);
    for (std::size_t t = 0; t < read.mesh.tets.size(); ++t)
      EXPECT_EQ(read.mesh.scalars[t], wanted.mesh.original_cell[t]);
  }
}

TEST_F(Vtu, PolyhedraWhoseFacesDoNotFitAreRefused) {
  const auto refused = [&](bool numbered, const std::string& array, std::size_t at, double number) {
    VtuPiece piece = polyhedra(numbered);
    std::ranges::find(piece.topology, array, &VtuArray::name)->numbers[at] = number;
    const auto file = write(vtu_file_text({}, {piece}));
    test::expect_bad_input([&] { vtu_block(file); }, {"m.vtu", "; "});
  };
  for (const double number : {-1.0, 0.0, 7.0, 1e15}) refused(false, "faces", 0, number);
  for (const double number : {-1.0, 3.0, 5.0, 30.0, 1e15}) refused(false, "faces", 1, number);
  for (const double number : {30.0, 32.0, 1e15, 0.0}) refused(false, "faceoffsets", 1, number);
  for (const double number : {-1.0, 6.0, 1e15}) refused(true, "polyhedron_to_faces", 2, number);
  for (const double number : {7.0, 1e15}) refused(true, "polyhedron_offsets", 1, number);
  for (const double number : {3.0, 25.0, 1e15}) refused(true, "face_offsets", 5, number);
}

TEST_F(Vtu, OldHigherOrderHexahedraComeInTheNewOrderOfNodesInEveryPiece) {
  for (const double type : {67.0, 72.0, 79.0})
    for (const std::size_t order : {std::size_t{1}, std::size_t{2}, std::size_t{3}}) {
      const std::size_t nodes = (order + 1) * (order + 1) * (order + 1), inner = order - 1;
      VtuPiece piece{.points = nodes, .cells = 1};
      piece.coordinates = {{"Float64", "Points", 3, std::vector<double>(3 * nodes)}};
      std::vector<double> uses(nodes);
      for (std::size_t k = 0; k < nodes; ++k) uses[k] = static_cast<double>(k);
      piece.topology = {{"Int64", "connectivity", 1, uses},
                        {"Int64", "offsets", 1, {static_cast<double>(nodes)}},
                        {"UInt8", "types", 1, {type}}};
      for (const char* version : {"0.1", "1.0", "2.0", "2.1", "2.2"}) {
        SCOPED_TRACE(fmt::format("order {}, version {}", order, version));
        std::vector<std::uint32_t> expected(2 * nodes);
        for (std::size_t k = 0; k < 2 * nodes; ++k) expected[k] = static_cast<std::uint32_t>(k);
        // Old versions exchange the inner nodes of the edges 10 and 11 (the last two of 12).
        for (std::size_t p = 0; p < 2 && version < std::string("2.1"); ++p)
          for (std::size_t k = 0; k < inner; ++k)
            std::swap(expected[p * nodes + 8 + 10 * inner + k], expected[p * nodes + 8 + 11 * inner + k]);
        EXPECT_EQ(read({.version = version}, {piece, piece}).connectivity, expected);
      }
    }
}

TEST_F(Vtu, GhostsAreMarkedInBothWays) {
  for (const char* name : {"vtkGhostType", "vtkGhostLevels"}) {
    const bool is_old = name == std::string("vtkGhostLevels");
    VtuPiece piece = sample_piece();
    piece.cell_data = {{"UInt8", name, 1, {0, 2, 1}}};
    piece.point_data = {{"UInt8", name, 1, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3}}};
    const cells::CellBlock block = read({.version = is_old ? "0.1" : "1.0"}, {piece});
    EXPECT_EQ(block.cell_ghost, is_old ? (std::vector<std::uint8_t>{0, 1, 1}) : (std::vector<std::uint8_t>{0, 2, 1}));
    EXPECT_EQ(block.point_ghost.back(), is_old ? 1 : 3);
    EXPECT_EQ(block.fields.front().name, "vtkGhostType");
  }
}

TEST_F(Vtu, NumbersAreReadAsStreamsSpellThem) {
  std::string text = vtu_file_text({}, {one_tet(0, 1)});
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const std::size_t at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return changed.replace(at, from.size(), to);
  };
  const std::string points = "0 0 0 1 0 0 0 1 0 0 0 1 ";
  cells::CellBlock block = vtu_block(write(replaced(points, "\t+0 .5 5.\r\n 1e3 -2.5E-3\f1.e+2 -0 1e-400 0 0 0 1")));
  EXPECT_EQ(block.positions[0], glm::dvec3(0, 0.5, 5));
  EXPECT_EQ(block.positions[1], glm::dvec3(1000, -0.0025, 100));
  EXPECT_TRUE(std::signbit(block.positions[2].x));
  EXPECT_EQ(block.positions[2].y, 0);
  block = vtu_block(write(replaced(points, "nan inf -inf NaN INF 0 0 1 0 0 0 1")));
  EXPECT_TRUE(std::isnan(block.positions[0].x) && std::isnan(block.positions[1].x));
  EXPECT_EQ(block.positions[0].y, std::numeric_limits<double>::infinity());
  EXPECT_EQ(block.positions[0].z, -std::numeric_limits<double>::infinity());
  EXPECT_NO_THROW(vtu_block(write(replaced(points, points + "and more"))));
  for (const char* wrong : {"", "0 0 0 1 0 0 0 1 0 0 0", "0 0 0 1 0 0 0 x 0 0 0 1", "0 0 0 1 0 0 1e999 1 0 0 0 1"}) {
    const auto file = write(replaced(points, wrong));
    test::expect_bad_input([&] { vtu_block(file); }, {"m.vtu", "Points", "; "});
  }
}

TEST_F(Vtu, XmlIsReadAsXml) {
  std::string text = vtu_file_text({.coding = Coding::appended_raw}, {one_tet(0, 1)});
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  replace("Name=\"p\"", "Name='a &lt;&amp;&#32;&gt; b>' RangeMin=\"-1\"");
  replace("<PointData ", "<!-- <DataArray> > --><PointData Scalars='a &lt;&amp; > b>'");
  replace("<UnstructuredGrid>",
          "<?other <DataArray> ?>\n<FieldData><DataArray type=\"String\" Name=\"s\" "
          "NumberOfTuples=\"1\" format=\"ascii\">97 0</DataArray></FieldData><UnstructuredGrid>");
  replace("<Cells>", "<![CDATA[<Points>]]><Unknown><DataArray/></Unknown><Cells>");
  const cells::CellBlock block = vtu_block(write(text));
  EXPECT_EQ(block.tets, (std::vector<scene::Tet>{{0, 1, 2, 3}}));
  ASSERT_EQ(block.fields.size(), 2u);
  EXPECT_EQ(block.fields[0].name, "a <& > b>");
  EXPECT_TRUE(block.fields[0].active);
}

TEST_F(Vtu, ArraysOfTextAreSkipped) {
  std::string text = vtu_file_text({}, {one_tet(0, 1)});
  const std::string data = "<CellData >\n";
  const std::size_t at = text.find(data);
  ASSERT_NE(at, std::string::npos);
  text.insert(at + data.size(), "<Array type=\"String\" Name=\"s\" format=\"ascii\">\n97 0 \n</Array>\n");
  const cells::CellBlock block = vtu_block(write(text));
  ASSERT_EQ(block.fields.size(), 2u);
  EXPECT_EQ(block.fields[1].name, "c");
  EXPECT_EQ(values_of(block.fields[1], 0), (std::vector<double>{1}));
}

TEST_F(Vtu, ArraysWithoutANameHaveTheirNumber) {
  std::string text = vtu_file_text({}, {one_tet(0, 1)});
  text.erase(text.find("Name=\"p\""), 8);
  const cells::CellBlock block = vtu_block(write(text));
  ASSERT_EQ(block.fields.size(), 2u);
  EXPECT_EQ(block.fields[0].name, "array 1");
  EXPECT_EQ(values_of(block.fields[0], 0), (std::vector<double>{10, 11, 12, 13}));
}

TEST_F(Vtu, ArraysOfTuplesWithoutNumbersAreSkipped) {
  VtuPiece piece = one_tet(0, 1);
  piece.point_data.insert(piece.point_data.begin(), {"Float64", "none", 0, {}});
  const cells::CellBlock block = read({}, {piece});
  ASSERT_EQ(block.fields.size(), 2u);
  EXPECT_EQ(block.fields[0].name, "p");
}

TEST_F(Vtu, TooFewBitsAreRefused) {
  std::string text = vtu_file_text({}, {one_tet(0, 1)});
  text.replace(text.find("type=\"Int32\" Name=\"p\""), 21, "type=\"Bit\" Name=\"p\"");
  for (const char* few : {"1 0 1", "2 0 1 1"}) {
    std::string changed = text;
    changed.replace(changed.find("10 11 12 13"), 11, few);
    const auto file = write(changed);
    if (few[0] == '1')
      test::expect_bad_input([&] { vtu_block(file); }, {"m.vtu", "'p'"});
    else
      EXPECT_EQ(vtu_block(file).fields[0].type, "uint8");
  }
}

TEST_F(Vtu, NamesWordsThatAreNotNumbers) {
  const std::string text = vtu_file_text({}, {one_tet(0, 1)});
  for (const char* word : {"1.5", "1.#QNAN", "3000000000"}) {
    std::string changed = text;
    const std::size_t at = changed.find("10 11 12 13");
    ASSERT_NE(at, std::string::npos);
    const auto file = write(changed.replace(at + 3, 2, word));
    test::expect_bad_input([&] { vtu_block(file); }, {"m.vtu: its array 'p' has '" + std::string(word) +
                                                      "' where a number of type int32 is required"});
  }
}

TEST_F(Vtu, LeavesUnknownContentToVtk) {
  const std::string text = vtu_file_text({}, {one_tet(0, 1)});
  const auto left = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const std::size_t at = changed.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    EXPECT_FALSE(open_vtk_xml(write(changed.replace(at, from.size(), to)))) << to;
  };
  left("Grid\" version=\"1.0\"", "Grid\" version=\"3.0\"");
  left("\"LittleEndian\"", "\"Middle\"");
  left("\"UInt32\"", "\"UInt16\"");
  left("header_type", "compressor=\"vtkOther\" header_type");
  left("<UnstructuredGrid>", "<UnstructuredGrid TimeValues=\"0 1\">");
  left("0 0 0 1 0 0 0 1 0 0 0 1 ", "0 0 0 1 0 0 <!-- here --> 0 1 0 0 0 1 ");
  left("0 0 0 1 0 0 0 1 0 0 0 1 ", "<![CDATA[0 0 0 1 0 0 0 1 0 0 0 1]]>");
  left("Name=\"p\"", "Name=\"p\" TimeStep=\"0\"");
  left("Name=\"p\" NumberOfComponents=\"1\"", "Name=\"p\" NumberOfComponents=\"-1\"");
}

TEST_F(Vtu, SkipsAByteOrderMarkAndReportsUtf16) {
  const std::string text = vtu_file_text({}, {sample_piece()});
  const std::size_t cells = read_mesh(folder.write("plain.vtu", text)).counts.cells_read;
  EXPECT_EQ(read_mesh(folder.write("mark.vtu", "\xEF\xBB\xBF" + text)).counts.cells_read, cells);
  const std::string list =
      "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece "
      "Source=\"mark.vtu\"/></PUnstructuredGrid></VTKFile>";
  EXPECT_EQ(read_mesh(folder.write("mark.pvtu", "\xEF\xBB\xBF" + list)).counts.cells_read, cells);
  std::string wide = "\xFF\xFE";
  for (const char c : text) (wide += c) += '\0';
  test::expect_bad_input([&] { read_mesh(folder.write("wide.vtu", wide)); },
                         {"it is text in UTF-16; save it in UTF-8"});
  EXPECT_NE(test::fault_of([&] { read_mesh(folder.write("wide.pvtu", wide)); }).message.find("UTF-16"),
            std::string::npos);
}

}  // namespace
}  // namespace tessera::io
