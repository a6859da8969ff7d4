// Polyhedra as VTK's own writers and the CGNS library write them.
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

#include VTK_CGNS(cgnslib.h)

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "io/mesh_assembly.hpp"
#include "io/mesh_checks.hpp"
#include "io/polyhedral_meshes.hpp"

namespace tessera::io {
namespace {

using testing::Faces;

MeshFile read_field(const std::filesystem::path& file) {
  MeshOptions options;
  options.field = std::string("f");
  return read_mesh(file, options);
}

void expect_like(const std::filesystem::path& file, const CellBlock& block) {
  SCOPED_TRACE(file);
  MeshOptions options;
  options.field = std::string("f");
  const MeshFile wanted = assemble_mesh({block}, options, "mesh"), read = read_field(file);
  EXPECT_EQ(read.mesh.tets.size(), wanted.mesh.tets.size());
  EXPECT_EQ(read.mesh.original_cell, wanted.mesh.original_cell);
  EXPECT_EQ(read.counts.cells_polyhedra, wanted.counts.cells_polyhedra);
  EXPECT_NEAR(testing::volume(read.mesh), 1, 1e-12);
  for (std::size_t v = 0; v < read.mesh.positions.size(); ++v) {
    const glm::dvec3& p = read.mesh.positions[v];
    EXPECT_NEAR(read.mesh.scalars[v], p.x + 2 * p.y + 3 * p.z, 1e-13);
  }
}

vtkNew<vtkUnstructuredGrid> grid_of(const CellBlock& block) {
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
  const CellBlock block = testing::agglomerates(3, 5, 0.2, 1);
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
      const MeshFile read = read_field(file);
      EXPECT_EQ(read.counts.cells_polyhedra, block.types.size());
      EXPECT_NEAR(testing::volume(read.mesh), 1, 1e-5);  // text has six digits
    }
}

/// A zone with faces as NGON_n and cells as NFACE_n, where a face whose cell is its second has a negative number.
void write_cgns(const std::filesystem::path& file, const CellBlock& block) {
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
  const CellBlock block = testing::agglomerates(3, 5, 0.2, 2);
  write_cgns(folder / "m.cgns", block);
  expect_like(folder / "m.cgns", block);
}

}  // namespace
}  // namespace tessera::io
