// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "io/mesh/mesh_formats.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using testing::message_of;

/// Replaces the first occurrence; the test's own text must contain it.
std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class VtkFiles : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) { return folder.write(name, text); }
  std::string error(const std::string& name, const std::string& text) {
    const auto file = write(name, text);
    const std::string message = message_of([&] { read_mesh(file); });
    EXPECT_TRUE(message.starts_with(file.string() + ": ")) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.find("; "), std::string::npos) << "no remedy: " << message;
    return message;
  }
  test::TemporaryFolder folder;
};

TEST_F(VtkFiles, AMixedVtuKeepsItsFacesAndLinearField) {
  const cells::MeshFile file = read_mesh(write("m.vtu", testing::vtu_text(testing::mixed_mesh(3, 5, false))));
  scene::validate(file.mesh, "m.vtu");
  EXPECT_EQ(file.format, "VTK XML unstructured grid");
  EXPECT_NEAR(testing::volume(file.mesh), 1, 1e-12);
  for (std::size_t v = 0; v < file.mesh.positions.size(); ++v) {
    const glm::dvec3& p = file.mesh.positions[v];
    EXPECT_DOUBLE_EQ(file.mesh.scalars[v], p.x + 2 * p.y + 3 * p.z);
  }
}

TEST_F(VtkFiles, PiecesOfAPvtuAgreeOnTheFacesBetweenThem) {
  // Cells distributed over three pieces at random, like an unstructured partition; piece 0 has some of piece 1 as
  // ghosts.
  const cells::CellBlock whole = testing::mixed_mesh(4, 9, false);
  std::vector<cells::CellBlock> pieces(3);
  std::uint64_t ghosts = 0;
  const auto add = [&](cells::CellBlock& piece, std::size_t c, std::uint8_t ghost) {
    if (piece.offsets.empty()) piece.offsets.push_back(0);
    for (std::uint64_t k = whole.offsets[c]; k < whole.offsets[c + 1]; ++k) {
      piece.connectivity.push_back(static_cast<std::uint32_t>(piece.positions.size()));
      piece.positions.push_back(whole.positions[whole.connectivity[k]]);
    }
    piece.offsets.push_back(piece.connectivity.size());
    piece.types.push_back(whole.types[c]);
    piece.cell_ghost.push_back(ghost);
    ghosts += ghost;
  };
  for (std::size_t c = 0; c < whole.types.size(); ++c) {
    const std::size_t owner = c * 7919 % 3;
    add(pieces[owner], c, 0);
    if (owner == 1 && c % 5 == 0) add(pieces[0], c, 1);
  }
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    std::vector<double> f;
    for (const glm::dvec3& x : pieces[p].positions) f.push_back(x.x);
    pieces[p].fields.push_back(cells::field_of_values("f", "double", scene::Association::point, 1, std::move(f)));
    write(fmt::format("piece{}.vtu", p), testing::vtu_text(pieces[p]));
  }
  const auto file = write("m.pvtu", testing::pvtu_text(pieces[0], {"piece0.vtu", "piece1.vtu", "piece2.vtu"}));
  const cells::MeshFile read = read_mesh(file);
  EXPECT_EQ(read.counts.cells_ghost, ghosts);
  EXPECT_GT(ghosts, 0u);
  for (const auto& [place, uses] : testing::count_triangles(read.mesh)) {
    bool wall = false;
    for (std::size_t a = 0; a < 3; ++a)
      for (const double at : {0.0, 1.0}) wall = wall || (place[0][a] == at && place[1][a] == at && place[2][a] == at);
    EXPECT_EQ(uses, wall ? 1 : 2);
  }
  EXPECT_NEAR(testing::volume(read.mesh), 1, 1e-12);

  std::filesystem::remove(folder / "piece1.vtu");
  EXPECT_NE(message_of([&] { read_mesh(file); }), "") << "a missing piece went unnoticed";
}

TEST_F(VtkFiles, CurvilinearGridsInPiecesAreOneAndBadPiecesAreNamed) {
  const std::string head = "<VTKFile version=\"1.0\" byte_order=\"LittleEndian\" type=\"";
  const auto piece = [&](int first, const std::string& type, const std::string& values, int along = 2) {
    const std::string extent = fmt::format("\"{} {} 0 1 0 1\"", first, first + 1);
    std::string points;
    for (int n = 0; n < 4 * along; ++n)
      points += fmt::format("{} {} {} ", first + n % along, n / along % 2, n / along / 2);
    return head + "StructuredGrid\"><StructuredGrid WholeExtent=" + extent + "><Piece Extent=" + extent +
           "><PointData><DataArray Name=\"c\" format=\"ascii\" type=\"" + type + "\">" + values +
           "</DataArray></PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">" +
           points + "</DataArray></Points></Piece></StructuredGrid></VTKFile>";
  };
  const auto whole = [&](const std::string& second) {
    return head +
           "PStructuredGrid\"><PStructuredGrid WholeExtent=\"0 2 0 1 0 1\" GhostLevel=\"0\"><PPointData><PDataArray "
           "type=\"Float32\" Name=\"c\"/></PPointData><PPoints><PDataArray type=\"Float32\" "
           "NumberOfComponents=\"3\"/></PPoints><Piece Extent=\"0 1 0 1 0 1\" Source=\"first.vts\"/>" +
           (second.empty() ? second : "<Piece Extent=\"1 2 0 1 0 1\" Source=\"" + second + "\"/>") +
           "</PStructuredGrid></VTKFile>";
  };
  const std::string values = "1 2 4 5 7 8 10 11";
  write("first.vts", piece(0, "Float32", "0 1 3 4 6 7 9 10"));
  write("good.vts", piece(1, "Float32", values));
  const cells::MeshFile mesh = read_mesh(write("good.pvts", whole("good.vts")));
  EXPECT_EQ(mesh.counts.cells_read, 2u);
  ASSERT_EQ(mesh.mesh.positions.size(), 12u);
  for (std::size_t p = 0; p < 12; ++p) {
    EXPECT_EQ(mesh.mesh.positions[p].x, static_cast<double>(p % 3));
    EXPECT_EQ(mesh.mesh.scalars[p], static_cast<double>(p));
  }
  // A ghost cell of one piece belongs to the other, and to the whole.
  std::string ghosts = piece(1, "Float32", values);
  ghosts.insert(ghosts.find("<Points>"),
                "<CellData><DataArray type=\"UInt8\" Name=\"vtkGhostType\" "
                "format=\"ascii\">1</DataArray></CellData>");
  std::string plain = piece(0, "Float32", "0 1 3 4 6 7 9 10");
  write("first.vts", plain.insert(plain.find("<Points>"),
                                  "<CellData><DataArray type=\"UInt8\" Name=\"vtkGhostType\" "
                                  "format=\"ascii\">0</DataArray></CellData>"));
  write("ghosts.vts", ghosts);
  const cells::MeshFile overlapping = read_mesh(write("ghosts.pvts", whole("ghosts.vts")));
  EXPECT_EQ(overlapping.counts.cells_read, 2u);
  EXPECT_EQ(overlapping.counts.cells_ghost, 0u);
  write("first.vts", piece(0, "Float32", "0 1 3 4 6 7 9 10"));
  write("few.vts", piece(1, "Float32", "1 2"));
  write("type.vts", piece(1, "Float64", values));
  write("points.vts", piece(1, "Float32", values, 1));
  const std::pair<const char*, const char*> wrong[] = {{"few.vts", "few.vts: "},
                                                       {"type.vts", "type.vts: its array 'c' is double x 1"},
                                                       {"points.vts", "points.vts: "},
                                                       {"gone.vts", "gone.vts: there is no such file"},
                                                       {"", "1 of its 2 cells"}};
  for (const auto& [second, words] : wrong) {
    const std::string message = message_of([&, &second = second] { read_mesh(write("bad.pvts", whole(second))); });
    EXPECT_NE(message.find(words), std::string::npos) << second << ": " << message;
  }
}

TEST_F(VtkFiles, StructuredAndRectilinearGridsAreReadAsCells) {
  std::string points, f;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 5; ++i) points += fmt::format("{} {} {} ", i, j, 2 * k), f += fmt::format("{} ", i);
  const std::string head = "# vtk DataFile Version 3.0\nt\nASCII\n",
                    data = "POINT_DATA 60\nSCALARS f float 1\nLOOKUP_TABLE default\n" + f + "\n";
  const auto curvilinear =
      write("s.vtk", head + "DATASET STRUCTURED_GRID\nDIMENSIONS 5 4 3\nPOINTS 60 float\n" + points + "\n" + data);
  const auto rectilinear = write("r.vtk", head +
                                              "DATASET RECTILINEAR_GRID\nDIMENSIONS 5 4 3\nX_COORDINATES 5 float\n0 1 "
                                              "2 3 4\nY_COORDINATES 4 float\n0 1 2 3\nZ_COORDINATES 3 float\n0 2 4\n" +
                                              data);
  const auto xml = write(
      "s.vts",
      "<VTKFile type=\"StructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><StructuredGrid WholeExtent=\"0 4 "
      "0 3 0 2\">"
      "<Piece Extent=\"0 4 0 3 0 2\"><PointData><DataArray type=\"Float32\" Name=\"f\" format=\"ascii\">" +
          f + "</DataArray></PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">" +
          points + "</DataArray></Points></Piece></StructuredGrid></VTKFile>");
  const auto xml_r =
      write("r.vtr",
            "<VTKFile type=\"RectilinearGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><RectilinearGrid "
            "WholeExtent=\"0 4 0 3 0 2\">"
            "<Piece Extent=\"0 4 0 3 0 2\"><PointData><DataArray type=\"Float32\" Name=\"f\" format=\"ascii\">" +
                f +
                "</DataArray></PointData><Coordinates><DataArray type=\"Float32\" Name=\"x\" format=\"ascii\">0 1 2 3 "
                "4</DataArray>"
                "<DataArray type=\"Float32\" Name=\"y\" format=\"ascii\">0 1 2 3</DataArray><DataArray "
                "type=\"Float32\" Name=\"z\" format=\"ascii\">0 2 4</DataArray>"
                "</Coordinates></Piece></RectilinearGrid></VTKFile>");
  for (const auto& path : {curvilinear, rectilinear, xml, xml_r}) {
    SCOPED_TRACE(path);
    const cells::MeshFile file = read_mesh(path);
    EXPECT_EQ(file.counts.cells_read, 24u);
    EXPECT_EQ(file.counts.points_read, 60u);
    EXPECT_DOUBLE_EQ(testing::volume(file.mesh), 4 * 3 * 4);
    for (std::size_t v = 0; v < 60; ++v) EXPECT_EQ(file.mesh.scalars[v], file.mesh.positions[v].x);
    for (const auto& [place, uses] : testing::count_triangles(file.mesh)) EXPECT_LE(uses, 2);
  }
}

TEST_F(VtkFiles, AFlatGridHasNothingToRender) {
  const std::string message = error("f.vtk",
                                    "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_GRID\nDIMENSIONS 2 2 1\n"
                                    "POINTS 4 float\n0 0 0 1 0 0 0 1 0 1 1 0\n");
  EXPECT_NE(message.find("of 1 cells 1 are not volumes"), std::string::npos) << message;
}

TEST_F(VtkFiles, RegularGridsAreRefusedByName) {
  EXPECT_NE(error("v.vtk",
                  "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\n"
                  "SPACING 1 1 1\nPOINT_DATA 8\nSCALARS f float 1\nLOOKUP_TABLE default\n0 0 0 0 0 0 0 0\n")
                .find("regular grid"),
            std::string::npos);
  EXPECT_NE(error("v.vti", "x").find("regular grid"), std::string::npos);
  EXPECT_NE(error("v.vtu", "<VTKFile type=\"ImageData\"></VTKFile>").find("regular grid"), std::string::npos);
}

TEST_F(VtkFiles, TheLegacyVectorIsReadByComponentAndMagnitude) {
  const auto file =
      write("t.vtk",
            "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 "
            "1\nCELLS 1 5\n4 0 1 2 3\n"
            "CELL_TYPES 1\n10\nPOINT_DATA 4\nVECTORS vel double\n3 4 0 0 0 0 1 0 0 0 0 2\n"
            "SCALARS a int 1\nLOOKUP_TABLE default\n1 1 1 1\nSCALARS b int 1\nLOOKUP_TABLE default\n1 2 3 5\n");
  EXPECT_EQ(read_mesh(file).mesh.field_name, "b");
  ReadOptions options;
  options.field = "vel";
  EXPECT_EQ(read_mesh(file, options).mesh.scalars, (std::vector<double>{5, 0, 1, 2}));
  options.field = "vel:z";
  EXPECT_EQ(read_mesh(file, options).mesh.scalars, (std::vector<double>{0, 0, 0, 2}));
}

TEST_F(VtkFiles, VoxelsAreNotHexahedra) {
  cells::CellBlock block;
  for (int v = 0; v < 8; ++v) block.positions.emplace_back(v & 1, v >> 1 & 1, v >> 2);
  block.types = {11};
  block.offsets = {0, 8};
  block.connectivity = {0, 1, 2, 3, 4, 5, 6, 7};
  const cells::MeshFile file = read_mesh(write("v.vtu", testing::vtu_text(block)));
  EXPECT_DOUBLE_EQ(testing::volume(file.mesh), 1);
  EXPECT_EQ(file.counts.cells_tangled, 0u);
  EXPECT_EQ(file.mesh.field_name, "none");
}

// --- bad input -----------------------------------------------------------------------------------------------------

const std::string& good() {
  static const std::string text = testing::vtu_text(testing::mixed_mesh(2, 1, false));
  return text;
}

TEST_F(VtkFiles, AGzipFileReadsAsItsContent) {
  const cells::MeshFile plain = read_mesh(write("m.vtu", good()));
  const std::filesystem::path file = folder / "m.vtu.gz", odd = folder / "odd";
  for (const auto& name : {file, odd}) {
    gzFile out = gzopen(name.c_str(), "wb");
    ASSERT_EQ(gzwrite(out, good().data(), static_cast<unsigned>(good().size())), static_cast<int>(good().size()));
    gzclose(out);
    const cells::MeshFile read = read_mesh(name);
    EXPECT_EQ(read.mesh.positions, plain.mesh.positions);
    EXPECT_EQ(read.mesh.tets, plain.mesh.tets);
    EXPECT_EQ(read.format, plain.format + ", gzip");
    EXPECT_EQ(read.notes, plain.notes);
  }
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  const std::string message = message_of([&] { read_mesh(file); });
  EXPECT_NE(message.find("m.vtu.gz: its compressed bytes end or break"), std::string::npos) << message;
}

TEST_F(VtkFiles, ReportsMissingAndEmptyFilesAndDirectories) {
  EXPECT_NE(message_of([&] { read_mesh(folder / "none.vtu"); }).find("there is no such file"), std::string::npos);
  std::filesystem::create_directory(folder / "dir.vtu");
  EXPECT_NE(message_of([&] { read_mesh(folder / "dir.vtu"); }).find("it is a directory"), std::string::npos);
  EXPECT_NE(error("e.vtu", "").find("it is empty"), std::string::npos);
  EXPECT_NE(error("mesh.unknown", "x").find("`tessera formats` lists them"), std::string::npos);
}

TEST_F(VtkFiles, ReportsTextNamedAsMesh) {
  for (const char* name :
       {"t.vtu", "t.pvtu", "t.vts", "t.vtk", "t.ex2", "t.tets", "t.bin", "t.stl", "t.ply", "t.poly", "t.smesh"})
    error(name, "Dear reader,\nthis is not a mesh at all, only some words.\n");
  folder.write("u.node", "Dear reader,\n");
  EXPECT_NE(message_of([&] { read_mesh(folder.write("u.ele", "no tets\n")); }).find("u.node: line 1: 'Dear' is not"),
            std::string::npos);
}

TEST_F(VtkFiles, ReportsEveryTruncation) {
  const std::string& text = good();
  for (std::size_t size = 1; size < text.size() - 12; size += 1 + text.size() / 97)
    error("t.vtu", text.substr(0, size));
}

TEST_F(VtkFiles, ReportsWrongIndicesByCell) {
  cells::CellBlock block = testing::mixed_mesh(2, 1, false);
  block.connectivity[20] = 4'000'000'000u;
  EXPECT_NE(error("i.vtu", testing::vtu_text(block)).find("uses point 4000000000"), std::string::npos);
  const std::string start = "Name=\"connectivity\" NumberOfComponents=\"1\" format=\"ascii\">\n";
  EXPECT_NE(error("n.vtu", with(good(), start, start + "-7 ")).find("cell 0 uses a point with an impossible number"),
            std::string::npos);
}

TEST_F(VtkFiles, ReportsWrongOffsetsTypesAndCounts) {
  cells::CellBlock block = testing::mixed_mesh(2, 1, false);
  std::swap(block.offsets[3], block.offsets[5]);
  error("o.vtu", testing::vtu_text(block));
  block = testing::mixed_mesh(2, 1, false);
  block.offsets.back() += 1000;
  error("o2.vtu", testing::vtu_text(block));
  block = testing::mixed_mesh(2, 1, false);
  block.types[1] = 200;
  error("t.vtu", testing::vtu_text(block));
  const std::string points = fmt::format("NumberOfPoints=\"{}\"", block.positions.size());
  for (const char* count : {"-5", "5", "99999", "4000000000", "99999999999999999999", "x"})
    error("c.vtu", with(good(), points, fmt::format("NumberOfPoints=\"{}\"", count)));
  const std::string cells = fmt::format("NumberOfCells=\"{}\"", block.types.size());
  for (const char* count : {"-5", "99999", "4000000000", "99999999999999999999"})
    error("c.vtu", with(good(), cells, fmt::format("NumberOfCells=\"{}\"", count)));
}

TEST_F(VtkFiles, ReportsWrongLegacyCounts) {
  const std::string text =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 "
      "1\nCELLS 1 5\n4 0 1 2 3\n"
      "CELL_TYPES 1\n10\n";
  for (const char* points : {"POINTS -4", "POINTS 400", "POINTS 4000000000000"})
    error("p.vtk", with(text, "POINTS 4", points));
  for (const char* cells : {"CELLS -1 5", "CELLS 1 -5", "CELLS 100 500", "CELLS 1000000000000 5000000000000"})
    error("c.vtk", with(text, "CELLS 1 5", cells));
  for (const char* cell : {"4 0 1 2 9", "4 0 1 2 -1", "-4 0 1 2 3", "400 0 1 2 3"})
    error("x.vtk", with(text, "4 0 1 2 3", cell));
  for (const char* types : {"CELL_TYPES 7", "CELL_TYPES -1"}) error("t.vtk", with(text, "CELL_TYPES 1", types));
  error("k.vtk", with(text, "CELL_TYPES 1\n10", "CELL_TYPES 1\n42"));
}

TEST_F(VtkFiles, ReportsAnEmptyMeshAndAMeshOfNaN) {
  cells::CellBlock empty;
  empty.offsets = {0};
  EXPECT_NE(error("e.vtu", testing::vtu_text(empty)).find("no cells"), std::string::npos);
  cells::CellBlock nan = testing::mixed_mesh(2, 1, false);
  nan.fields = {cells::field_of_values("f", "double", scene::Association::point, 1,
                                       std::vector<double>(nan.positions.size(), NAN))};
  EXPECT_NE(error("n.vtu", testing::vtu_text(nan)).find("NaN"), std::string::npos);
}

}  // namespace
}  // namespace tessera::io
