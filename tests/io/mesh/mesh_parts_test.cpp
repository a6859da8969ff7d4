// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/mesh_parts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "io/files/reader_programs.hpp"
#include "io/mesh/tets_file.hpp"
#include "scene/error.hpp"
#include "support/mesh_checks.hpp"
#include "support/parts_checks.hpp"
#include "support/vtk_or_skip.hpp"

namespace tessera::io {

namespace {

using testing::content;
using testing::expect_as_whole;
using testing::InParts;
using testing::message_of;
using testing::read_in_parts;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

class MeshParts : public ::testing::Test {
 protected:
  /// A .pvtu of these blocks as pieces.
  std::filesystem::path write_pieces(const std::vector<cells::CellBlock>& pieces) {
    std::vector<std::string> names;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      names.push_back(fmt::format("piece{}.vtu", p));
      folder.write(names.back(), testing::vtu_text(pieces[p]));
    }
    return folder.write("m.pvtu", testing::pvtu_text(pieces[0], names));
  }

  test::TemporaryFolder folder;
};

/// A mixed mesh moved along x, so that pieces are adjacent, with fields that distinguish the pieces.
cells::CellBlock piece_at(int p) {
  cells::CellBlock block = testing::mixed_mesh(2, static_cast<unsigned>(p) + 1, p % 2 == 0);
  for (glm::dvec3& x : block.positions) x.x += p;
  block.fields.clear();
  std::vector<double> constant(block.positions.size(), p), noisy;
  for (std::size_t v = 0; v < block.positions.size(); ++v)
    noisy.push_back(v == 3 ? no_number : static_cast<double>(v) - p);
  std::vector<double> cells;
  for (std::size_t c = 0; c < block.cell_count(); ++c) cells.push_back(static_cast<double>(c * c));
  block.fields.push_back(cells::field_of_values("piece", "double", scene::Association::point, 1, constant));
  block.fields.push_back(cells::field_of_values("noisy", "double", scene::Association::point, 1, noisy));
  block.fields.push_back(cells::field_of_values("cells", "double", scene::Association::cell, 1, cells));
  return block;
}

TEST_F(MeshParts, PiecesGiveTheTetsCountsAndFieldOfTheWhole) {
  TESSERA_VTK_OR_SKIP();
  std::vector<cells::CellBlock> pieces;
  for (int p = 0; p < 5; ++p) pieces.push_back(piece_at(p));
  const auto file = write_pieces(pieces);
  // "piece" is constant in each piece; only all together show that it varies, so it is chosen.
  EXPECT_EQ(read_mesh(file).mesh.field_name, "piece");
  expect_as_whole(file);
  for (const char* field : {"noisy", "cells", "point:piece"}) {
    ReadOptions options;
    options.field = field;
    expect_as_whole(file, options);
  }
}

TEST_F(MeshParts, GhostsAndEmptyPiecesAreAsInTheWhole) {
  TESSERA_VTK_OR_SKIP();
  std::vector<cells::CellBlock> pieces = {piece_at(0), piece_at(1), piece_at(2)};
  for (cells::CellBlock& piece : pieces) {
    piece.cell_ghost.assign(piece.cell_count(), 0);
    piece.cell_ghost[1] = 1;
    piece.cell_ghost[2] = 32;
  }
  cells::CellBlock empty = pieces[0];
  empty.positions.clear();
  empty.types.clear();
  empty.offsets.clear();
  empty.connectivity.clear();
  empty.cell_ghost.clear();
  for (cells::BlockField& field : empty.fields)
    field = cells::field_of_values(field.name, "double", field.association, 1, {});
  pieces.insert(pieces.begin() + 1, empty);
  const auto file = write_pieces(pieces);
  EXPECT_EQ(read_mesh(file).counts.cells_ghost, 3u);
  EXPECT_EQ(read_mesh(file).counts.cells_hidden, 3u);
  expect_as_whole(file);
}

TEST_F(MeshParts, ListsOfBlocksAreReadInParts) {
  TESSERA_VTK_OR_SKIP();
  write_pieces({piece_at(1), piece_at(2)});  // m.pvtu
  folder.write("first.vtu", testing::vtu_text(piece_at(0)));
  cells::CellBlock last = piece_at(3);
  last.fields.pop_back();  // its cells are blank if the field "cells" is drawn
  folder.write("last.vtu", testing::vtu_text(last));
  folder.write("skin.vtp", "<VTKFile type=\"PolyData\">");  // not examined further
  const auto file = folder.write("m.vtm",
                                 "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet>"
                                 "<DataSet name=\"a\" file=\"first.vtu\"/><DataSet name=\"skin\" file=\"skin.vtp\"/>"
                                 "<Block name=\"middle\"><DataSet name=\"b\" file=\"m.pvtu\"/></Block>"
                                 "<DataSet name=\"c\" file=\"last.vtu\"/></vtkMultiBlockDataSet></VTKFile>");
  const cells::MeshFile whole = read_mesh(file);
  EXPECT_EQ(whole.blocks, (std::vector<std::string>{"a", "middle/b", "c"}));
  EXPECT_GT(whole.counts.tets_made, read_mesh(folder / "m.pvtu").counts.tets_made);
  expect_as_whole(file);
  ReadOptions options;
  options.field = "cells";
  expect_as_whole(file, options);
  options.field = "piece";
  options.blocks = {"b", "c"};
  EXPECT_LT(read_mesh(file, options).counts.tets_made, whole.counts.tets_made);
  expect_as_whole(file, options);
  options.blocks = {"d"};
  EXPECT_EQ(message_of([&] { read_in_parts(file, 2, options); }), message_of([&] { read_mesh(file, options); }));
}

TEST_F(MeshParts, NeighbouringPiecesAgreeOnTheirFaces) {
  TESSERA_VTK_OR_SKIP();
  // One mesh cut into three pieces, each with its own points: only positions reveal that hexahedra touch.
  const cells::CellBlock whole = testing::mixed_mesh(3, 4, true);
  std::vector<cells::CellBlock> pieces(3);
  for (std::size_t p = 0; p < 3; ++p) {
    cells::CellBlock& piece = pieces[p];
    piece.positions = whole.positions;
    piece.offsets.push_back(0);
    for (std::size_t c = p; c < whole.cell_count(); c += 3) {
      piece.types.push_back(whole.types[c]);
      piece.connectivity.insert(piece.connectivity.end(),
                                whole.connectivity.begin() + static_cast<std::ptrdiff_t>(whole.offsets[c]),
                                whole.connectivity.begin() + static_cast<std::ptrdiff_t>(whole.offsets[c + 1]));
      piece.offsets.push_back(piece.connectivity.size());
    }
    piece.fields = whole.fields;
  }
  const InParts read = read_in_parts(write_pieces(pieces), 3);
  scene::TetMesh together;
  for (const MeshFilePart& part : read.parts) {
    const auto first = static_cast<std::uint32_t>(together.positions.size());
    together.positions.insert(together.positions.end(), part.mesh.positions.begin(), part.mesh.positions.end());
    for (const scene::Tet& t : part.mesh.tets)
      together.tets.push_back({first + t[0], first + t[1], first + t[2], first + t[3]});
  }
  for (const auto& [place, uses] : testing::count_triangles(together)) {
    bool wall = false;
    for (std::size_t a = 0; a < 3; ++a)
      for (const double at : {0.0, 1.0}) wall = wall || (place[0][a] == at && place[1][a] == at && place[2][a] == at);
    EXPECT_EQ(uses, wall ? 1 : 2);
  }
}

TEST_F(MeshParts, FaultsNameThePiece) {
  TESSERA_VTK_OR_SKIP();
  std::vector<cells::CellBlock> pieces = {piece_at(0), piece_at(1), piece_at(2)};
  pieces[1].fields.erase(pieces[1].fields.begin());
  auto file = write_pieces(pieces);
  const std::string expected = (folder / "piece1.vtu").string() + ": it lacks the point field 'piece'";
  EXPECT_EQ(message_of([&] { read_mesh(file); }).substr(0, expected.size()), expected);
  EXPECT_EQ(message_of([&] { read_in_parts(file, 2); }), message_of([&] { read_mesh(file); }));
  EXPECT_EQ(message_of([&] { read_in_parts(file, 3); }), message_of([&] { read_mesh(file); }));
  ReadOptions options;
  options.field = "noisy";  // all pieces have it
  EXPECT_NO_THROW(read_in_parts(file, 3, options));
  options.field = "absent";
  EXPECT_EQ(message_of([&] { read_in_parts(file, 3, options); }), message_of([&] { read_mesh(file, options); }));

  const std::string text = test::contents(folder / "piece2.vtu");
  folder.write("piece2.vtu", text.substr(0, text.size() / 2));
  for (const int parts : {1, 2, 3})
    EXPECT_TRUE(message_of([&] { read_in_parts(file, parts, options); }).starts_with((folder / "piece2.vtu").string()));
  std::filesystem::remove(folder / "piece2.vtu");
  EXPECT_EQ(message_of([&] { read_in_parts(file, 2); }),
            fmt::format("{}: there is no such file, but {} lists it; put the file there",
                        (folder / "piece2.vtu").string(), file.string()));
  folder.write("piece2.vtu", test::contents(file));  // a file in pieces is not a piece
  EXPECT_NE(message_of([&] { read_mesh(file); }).find("'PUnstructuredGrid'"), std::string::npos);
  options.time_step = 3;
  EXPECT_NE(message_of([&] { read_in_parts(file, 2, options); }).find("no time step 3"), std::string::npos);
}

TEST_F(MeshParts, ReportsAMalformedListOfPieces) {
  TESSERA_VTK_OR_SKIP();
  const auto file = write_pieces({piece_at(0), piece_at(1)});
  const std::string text = test::contents(file);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    return folder.write("changed.pvtu", changed);
  };
  EXPECT_NE(message_of([&] { read_mesh(with("Source=\"piece0.vtu\"", "")); }).find("piece 0 has no Source"),
            std::string::npos);
  EXPECT_NE(message_of([&] { read_mesh(with("</PUnstructuredGrid>", "")); }).find("mismatched tag"), std::string::npos);
  EXPECT_NE(message_of([&] { read_mesh(with("</VTKFile>", "")); }).find("line "), std::string::npos);
  EXPECT_EQ(
      read_mesh(with("<Piece Source=\"piece0.vtu\"/>", "<!-- <Piece Source=\"piece0.vtu\"/> -->")).counts.cells_read,
      piece_at(1).cell_count());
}

TEST_F(MeshParts, RangesOfTetsGiveTheWhole) {
  scene::TetMesh mesh;
  for (int v = 0; v < 40; ++v) {
    mesh.positions.push_back({v % 3, (v / 3) % 4, v / 12 + 0.25 * v});
    mesh.scalars.push_back(v == 11 ? no_number : v * 0.5);
  }
  // Vertices 30 and more are unused, 11 is used only by blanked tets; one tet occurs twice, one is collapsed.
  for (std::uint32_t t = 0; t < 20; ++t) mesh.tets.push_back({t, t + 2, (7 * t) % 30, (t * t + 5) % 30});
  mesh.tets.push_back(mesh.tets[3]);
  mesh.tets.push_back({4, 4, 5, 6});
  const auto file = folder / "m.tets";
  write_tets(mesh, file);
  const cells::MeshFile whole = read_mesh(file);
  EXPECT_GT(whole.counts.cells_nan, 0u);
  EXPECT_GT(whole.counts.tets_collapsed, 0u);
  EXPECT_GE(whole.counts.points_unused, 10u);
  expect_as_whole(file);
  // A part has no vertex that its tets do not use.
  const InParts read = read_in_parts(file, 7);
  for (const MeshFilePart& part : read.parts) EXPECT_LE(part.mesh.positions.size(), 4 * 4u);
}

TEST_F(MeshParts, MorePartsThanTetsLeaveSomeEmpty) {
  scene::TetMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {9, 9, 9}};
  mesh.scalars = {1, 2, 3, 4, 5};
  mesh.tets = {{0, 1, 2, 3}};
  const auto file = folder / "one.tets";
  write_tets(mesh, file);
  expect_as_whole(file);
  if (has_reader(Reader::vtk)) expect_as_whole(write_pieces({piece_at(0)}));
}

TEST_F(MeshParts, ReportsOnceForAllPartsThatNothingIsLeft) {
  scene::TetMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.scalars = {1, 2, no_number, 4};
  mesh.tets = {{0, 1, 2, 3}, {3, 2, 1, 0}};
  const auto file = folder / "nan.tets";
  write_tets(mesh, file);
  EXPECT_NE(message_of([&] { read_mesh(file); }).find("nothing is left to render: of 2 cells"), std::string::npos);
  EXPECT_EQ(message_of([&] { read_in_parts(file, 2); }), message_of([&] { read_mesh(file); }));
}

TEST_F(MeshParts, TetRangesCheckTheirIndicesAndSizes) {
  scene::TetMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.scalars = {1, 2, 3, 4};
  mesh.tets = {{0, 1, 2, 3}, {0, 1, 2, 3}};
  const auto file = folder / "bad.tets";
  write_tets(mesh, file);
  std::string bytes = test::contents(file);
  bytes[bytes.size() - 4] = 4;  // the last corner of the last tet
  folder.write("bad.tets", bytes);
  EXPECT_NE(message_of([&] { read_in_parts(file, 2); }).find("tet 1 uses vertex 4"), std::string::npos);
  EXPECT_EQ(message_of([&] { read_in_parts(file, 2); }), message_of([&] { read_mesh(file); }));
  folder.write("bad.tets", bytes.substr(0, bytes.size() - 1));
  EXPECT_EQ(message_of([&] { read_in_parts(file, 2); }), message_of([&] { read_mesh(file); }));
}

TEST_F(MeshParts, OtherFormatsAndSmoothingAreReadWhole) {
  TESSERA_VTK_OR_SKIP();
  const auto pvtu = write_pieces({piece_at(0)});
  ReadOptions smooth;
  smooth.smooth = true;
  EXPECT_TRUE(readable_in_parts(identify(pvtu), {}));
  EXPECT_FALSE(readable_in_parts(identify(pvtu), smooth));
  EXPECT_FALSE(readable_in_parts(identify(folder / "piece0.vtu"), {}));
  EXPECT_FALSE(readable_in_parts(identify(folder.write("a.pvtu", test::contents(folder / "piece0.vtu"))), {}));
}

}  // namespace
}  // namespace tessera::io
