// SPDX-License-Identifier: BSD-3-Clause
// Polyhedra as written by VTK's own writers and the CGNS library.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>
#include <vtk_cgns.h>
#include <vtk_exodusII.h>

#include VTK_CGNS(cgnslib.h)

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "cells/mesh_assembly.hpp"
#include "support/mesh_checks.hpp"
#include "support/polyhedral_meshes.hpp"
#include "support/read_files.hpp"

namespace tessera::io::polyhedra_written_test {
namespace {

using testing::Faces;

cells::MeshFile read_field(const std::filesystem::path& file) {
  ReadOptions options;
  options.field = std::string("f");
  return read_mesh(file, options);
}

void expect_like(const std::filesystem::path& file, const cells::CellBlock& block) {
  SCOPED_TRACE(file);
  ReadOptions options;
  options.field = std::string("f");
  const cells::MeshFile wanted = cells::assemble_mesh({block}, options, "mesh"), read = read_field(file);
  EXPECT_EQ(read.mesh.tets.size(), wanted.mesh.tets.size());
  EXPECT_EQ(read.mesh.original_cell, wanted.mesh.original_cell);
  EXPECT_EQ(read.counts.cells_polyhedra, wanted.counts.cells_polyhedra);
  EXPECT_NEAR(testing::volume(read.mesh), 1, 1e-12);
  for (std::size_t v = 0; v < read.mesh.positions.size(); ++v) {
    const glm::dvec3& p = read.mesh.positions[v];
    EXPECT_NEAR(read.mesh.scalars[v], p.x + 2 * p.y + 3 * p.z, 1e-13);
  }
}

vtkNew<vtkUnstructuredGrid> grid_of(const cells::CellBlock& block) {
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> field;
  field->SetName("f");
  for (const glm::dvec3& p : block.positions) {
    points->InsertNextPoint(p.x, p.y, p.z);
    field->InsertNextValue(p.x + 2 * p.y + 3 * p.z);
  }
  grid->SetPoints(points);
  for (const Faces& cell : testing::faces_of_cells(block)) {
    std::vector<vtkIdType> stream;
    for (const auto& face : cell) {
      stream.push_back(static_cast<vtkIdType>(face.size()));
      stream.insert(stream.end(), face.begin(), face.end());
    }
    grid->InsertNextCell(VTK_POLYHEDRON, static_cast<vtkIdType>(cell.size()), stream.data());
  }
  grid->GetPointData()->AddArray(field);
  return grid;
}

TEST(PolyhedraWritten, ByVtkAreReadInEveryEncoding) {
  const cells::CellBlock block = testing::agglomerates(3, 5, 0.2, 1);
  const auto grid = grid_of(block);
  const test::TemporaryFolder folder;
  for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended})
    for (const bool compressed : {false, true}) {
      vtkNew<vtkXMLUnstructuredGridWriter> writer;
      const auto file = folder / fmt::format("{}-{}.vtu", mode, compressed);
      writer->SetFileName(file.c_str());
      writer->SetDataMode(mode);
      if (!compressed) writer->SetCompressorTypeToNone();
      writer->SetInputData(grid);
      ASSERT_EQ(writer->Write(), 1);
      expect_like(file, block);
    }
  for (const int type : {VTK_ASCII, VTK_BINARY})
    for (const int version : {vtkUnstructuredGridWriter::VTK_LEGACY_READER_VERSION_4_2,
                              vtkUnstructuredGridWriter::VTK_LEGACY_READER_VERSION_5_1}) {
      vtkNew<vtkUnstructuredGridWriter> writer;
      const auto file = folder / fmt::format("{}-{}.vtk", type, version);
      writer->SetFileName(file.c_str());
      writer->SetFileType(type);
      writer->SetFileVersion(version);
      writer->SetInputData(grid);
      ASSERT_EQ(writer->Write(), 1);
      const cells::MeshFile read = read_field(file);
      EXPECT_EQ(read.counts.cells_polyhedra, block.types.size());
      EXPECT_NEAR(testing::volume(read.mesh), 1, 1e-5);  // text has six digits
    }
}

/// A zone with faces as NGON_n and cells as NFACE_n. The second of two cells that share a face refers to the face by a
/// negative number.
void write_cgns(const std::filesystem::path& file, const cells::CellBlock& block) {
  const std::vector<Faces> cells = testing::faces_of_cells(block);
  std::map<std::vector<std::uint32_t>, cgsize_t> numbers;
  std::vector<cgsize_t> corners, corner_offsets{0}, faces, face_offsets{0};
  for (const Faces& cell : cells) {
    for (const auto& face : cell) {
      auto key = face;
      std::sort(key.begin(), key.end());
      const auto [at, is_new] = numbers.try_emplace(key, static_cast<cgsize_t>(corner_offsets.size()));
      faces.push_back(is_new ? at->second : -at->second);
      if (!is_new) continue;
      for (const std::uint32_t v : face) corners.push_back(static_cast<cgsize_t>(v) + 1);
      corner_offsets.push_back(static_cast<cgsize_t>(corners.size()));
    }
    face_offsets.push_back(static_cast<cgsize_t>(faces.size()));
  }
  int id = 0, base = 0, zone = 0, section = 0, coordinate = 0, solution = 0, field = 0;
  std::array<cgsize_t, 3> size{static_cast<cgsize_t>(block.positions.size()), static_cast<cgsize_t>(cells.size()), 0};
  ASSERT_EQ(cg_open(file.c_str(), CG_MODE_WRITE, &id), CG_OK) << cg_get_error();
  ASSERT_EQ(cg_base_write(id, "base", 3, 3, &base), CG_OK);
  ASSERT_EQ(cg_zone_write(id, base, "zone", size.data(), CGNS_ENUMV(Unstructured), &zone), CG_OK);
  std::vector<double> numbers_of(block.positions.size());
  for (int a = 0; a < 3; ++a) {
    for (std::size_t v = 0; v < numbers_of.size(); ++v) numbers_of[v] = block.positions[v][a];
    const std::array<const char*, 3> names = {"CoordinateX", "CoordinateY", "CoordinateZ"};
    ASSERT_EQ(cg_coord_write(id, base, zone, CGNS_ENUMV(RealDouble), names[static_cast<std::size_t>(a)],
                             numbers_of.data(), &coordinate),
              CG_OK);
  }
  const auto face_count = static_cast<cgsize_t>(corner_offsets.size() - 1);
  ASSERT_EQ(cg_poly_section_write(id, base, zone, "faces", CGNS_ENUMV(NGON_n), 1, face_count, 0, corners.data(),
                                  corner_offsets.data(), &section),
            CG_OK)
      << cg_get_error();
  ASSERT_EQ(cg_poly_section_write(id, base, zone, "cells", CGNS_ENUMV(NFACE_n), face_count + 1,
                                  face_count + static_cast<cgsize_t>(cells.size()), 0, faces.data(),
                                  face_offsets.data(), &section),
            CG_OK)
      << cg_get_error();
  ASSERT_EQ(cg_sol_write(id, base, zone, "values", CGNS_ENUMV(Vertex), &solution), CG_OK);
  for (std::size_t v = 0; v < numbers_of.size(); ++v) numbers_of[v] = glm::dot(block.positions[v], glm::dvec3(1, 2, 3));
  ASSERT_EQ(cg_field_write(id, base, zone, solution, CGNS_ENUMV(RealDouble), "f", numbers_of.data(), &field), CG_OK);
  ASSERT_EQ(cg_close(id), CG_OK);
}

TEST(PolyhedraWritten, OfCgnsAreFacesOfNgonAndNface) {
  const test::TemporaryFolder folder;
  const cells::CellBlock block = testing::agglomerates(3, 5, 0.2, 2);
  write_cgns(folder / "m.cgns", block);
  expect_like(folder / "m.cgns", block);
}

/// A block of cubes before one of polyhedra, whose faces are in two face blocks; the value of each cell is its number.
void write_exodus(const std::filesystem::path& file, const cells::CellBlock& block, int damage = 0) {
  const std::vector<Faces> cells = testing::faces_of_cells(block);
  std::map<std::vector<std::uint32_t>, int> numbers;
  std::array<std::vector<int>, 2> corners, sizes;
  std::vector<int> faces, cell_sizes;
  std::size_t face_count = 0;
  for (const Faces& cell : cells) face_count += cell.size();
  for (const Faces& cell : cells) {
    cell_sizes.push_back(static_cast<int>(cell.size()));
    for (const auto& face : cell) {
      auto key = face;
      std::sort(key.begin(), key.end());
      const auto [at, is_new] = numbers.try_emplace(key, static_cast<int>(numbers.size()) + 1);
      faces.push_back(at->second);
      if (!is_new) continue;
      const std::size_t half = 4 * numbers.size() < face_count ? 0 : 1;
      sizes[half].push_back(static_cast<int>(face.size()));
      for (const std::uint32_t v : face) corners[half].push_back(static_cast<int>(v) + 1);
    }
  }
  if (damage == 1) faces.back() = static_cast<int>(numbers.size()) + 1;
  if (damage == 2) faces.assign(faces.size(), 1);
  if (damage == 3) corners[1].back() = static_cast<int>(block.positions.size()) + 1;
  if (damage == 4) ++sizes[0].front();
  if (damage == 5) cell_sizes.front() = -1;
  int word = sizeof(double), stored = sizeof(double);
  const int id = ex_create(file.c_str(), EX_CLOBBER | EX_NETCDF4, &word, &stored);
  ASSERT_GE(id, 0);
  ex_init_params init{};
  init.num_dim = 3;
  init.num_nodes = static_cast<std::int64_t>(block.positions.size());
  init.num_elem = static_cast<std::int64_t>(cells.size()) + 1;
  init.num_elem_blk = 2;
  init.num_face = static_cast<std::int64_t>(numbers.size());
  init.num_face_blk = 2;
  ASSERT_EQ(ex_put_init_ext(id, &init), EX_NOERR);
  for (int half = 0; half < 2; ++half) {
    const auto& of = sizes[static_cast<std::size_t>(half)];
    const auto& nodes = corners[static_cast<std::size_t>(half)];
    ASSERT_EQ(ex_put_block(id, EX_FACE_BLOCK, 10 + half, "nsided", static_cast<std::int64_t>(of.size()),
                           static_cast<std::int64_t>(nodes.size()), 0, 0, 0),
              EX_NOERR);
    ASSERT_EQ(ex_put_entity_count_per_polyhedra(id, EX_FACE_BLOCK, 10 + half, of.data()), EX_NOERR);
    ASSERT_EQ(ex_put_conn(id, EX_FACE_BLOCK, 10 + half, nodes.data(), nullptr, nullptr), EX_NOERR);
  }
  const std::array<int, 8> cube = {1, 2, 6, 5, 17, 18, 22, 21};
  ex_put_block(id, EX_ELEM_BLOCK, 1, "HEX8", 1, 8, 0, 0, 0);
  ex_put_conn(id, EX_ELEM_BLOCK, 1, cube.data(), nullptr, nullptr);
  ASSERT_EQ(ex_put_block(id, EX_ELEM_BLOCK, 2, "nfaced", static_cast<std::int64_t>(cells.size()), 0, 0,
                         static_cast<std::int64_t>(faces.size()), 0),
            EX_NOERR);
  ASSERT_EQ(ex_put_entity_count_per_polyhedra(id, EX_ELEM_BLOCK, 2, cell_sizes.data()), EX_NOERR);
  ASSERT_EQ(ex_put_conn(id, EX_ELEM_BLOCK, 2, nullptr, nullptr, faces.data()), EX_NOERR);
  std::array<std::vector<double>, 3> xyz;
  std::vector<double> f;
  for (const glm::dvec3& p : block.positions) {
    for (int a = 0; a < 3; ++a) xyz[static_cast<std::size_t>(a)].push_back(p[a]);
    f.push_back(p.x + 2 * p.y + 3 * p.z);
  }
  ex_put_coord(id, xyz[0].data(), xyz[1].data(), xyz[2].data());
  const double time = 0;
  ex_put_time(id, 1, &time);
  ex_put_variable_param(id, EX_NODAL, 1);
  ex_put_variable_name(id, EX_NODAL, 1, "f");
  ex_put_var(id, 1, EX_NODAL, 1, 1, static_cast<std::int64_t>(f.size()), f.data());
  ASSERT_EQ(ex_close(id), EX_NOERR);
}

TEST(PolyhedraWritten, OfExodusAreFacesOfNsidedAndNfaced) {
  const test::TemporaryFolder folder;
  const cells::CellBlock block = testing::agglomerates(3, 5, 0.2, 2);
  write_exodus(folder / "m.exo", block);
  // Only the cube overlaps others.
  ReadOptions options;
  options.field = std::string("f");
  const cells::MeshFile both = read_mesh(folder / "m.exo", options);
  EXPECT_EQ(both.counts.cells_read, block.types.size() + 1);
  EXPECT_EQ(both.counts.cells_polyhedra, block.types.size());
  options.blocks = {"block 2"};
  const cells::MeshFile read = read_mesh(folder / "m.exo", options);
  EXPECT_NEAR(testing::volume(read.mesh), 1, 1e-12);
  EXPECT_LT(testing::volume(both.mesh), 1.1);
  for (std::size_t v = 0; v < read.mesh.positions.size(); ++v) {
    const glm::dvec3& p = read.mesh.positions[v];
    EXPECT_NEAR(read.mesh.scalars[v], p.x + 2 * p.y + 3 * p.z, 1e-13);
  }
  for (int damage = 1; damage <= 5; ++damage) {
    write_exodus(folder / "bad.exo", block, damage);
    test::expect_bad_input([&] { read_mesh(folder / "bad.exo"); }, {"bad.exo: ", "; the file is truncated or damaged"});
  }
}

}  // namespace
}  // namespace tessera::io::polyhedra_written_test
