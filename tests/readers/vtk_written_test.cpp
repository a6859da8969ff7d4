// SPDX-License-Identifier: BSD-3-Clause
// Output of VTK's own writers, in all their encodings.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkUnsignedShortArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLRectilinearGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "api/queries/mesh_check.hpp"
#include "cells/cell_split.hpp"
#include "io/volume/plain_vtk_grid.hpp"
#include "io/volume/volume_formats.hpp"
#include "support/read_files.hpp"
#include "support/streamed_fixture.hpp"
#include "support/temporary_folder.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::io::vtk_written_test {
namespace {

/// `n` adjacent hexahedra along x, each with its own points, the second moved halfway into the first, and a copy of the
/// last.
vtkNew<vtkUnstructuredGrid> hexahedra(int n) {
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> field;
  field->SetName("f");
  for (int cell = 0; cell <= n; ++cell) {
    const double x = cell == 1 ? 0.5 : cell == n ? n - 1 : cell;
    vtkIdType corners[8];
    for (int k = 0; k < 8; ++k) {
      const int u = (k == 1 || k == 2 || k == 5 || k == 6) ? 1 : 0, v = k % 4 >= 2 ? 1 : 0, w = k / 4;
      corners[k] = points->InsertNextPoint(x + u, v, w);
      field->InsertNextValue(x + u + 2 * v + 3 * w);
    }
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, corners);
  }
  grid->SetPoints(points);
  grid->GetPointData()->AddArray(field);
  return grid;
}

/// Expects two overlaps: of cell 0 with cell 1, and of cell n - 1 with its copy.
void expect_pairs(const std::filesystem::path& file, int n) {
  const cells::MeshFile read = read_mesh(file);
  ASSERT_EQ(read.mesh.tets.size(), 6u * static_cast<std::size_t>(n + 1)) << file;
  const MeshCheck check = api::check_mesh(read.mesh);
  EXPECT_EQ(check.overlaps.count, 2u) << file;
  EXPECT_EQ(check.overlapping_cells, 4u) << file;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> pairs;
  for (const auto& place : check.overlaps.places) pairs.emplace_back(place.cell, place.other);
  std::sort(pairs.begin(), pairs.end());
  const auto last = static_cast<std::uint64_t>(n);
  EXPECT_EQ(pairs, (std::vector<std::pair<std::uint64_t, std::uint64_t>>{{0, 1}, {last - 1, last}})) << file;
}

/// All enumerators, with VTK's names and values.
constexpr std::pair<CellType, int> cell_types[] = {
    {CellType::tetra, VTK_TETRA},
    {CellType::voxel, VTK_VOXEL},
    {CellType::hexahedron, VTK_HEXAHEDRON},
    {CellType::wedge, VTK_WEDGE},
    {CellType::pyramid, VTK_PYRAMID},
    {CellType::pentagonal_prism, VTK_PENTAGONAL_PRISM},
    {CellType::hexagonal_prism, VTK_HEXAGONAL_PRISM},
    {CellType::convex_point_set, VTK_CONVEX_POINT_SET},
    {CellType::polyhedron, VTK_POLYHEDRON},
    {CellType::quadratic_tetra, VTK_QUADRATIC_TETRA},
    {CellType::quadratic_hexahedron, VTK_QUADRATIC_HEXAHEDRON},
    {CellType::quadratic_wedge, VTK_QUADRATIC_WEDGE},
    {CellType::quadratic_pyramid, VTK_QUADRATIC_PYRAMID},
    {CellType::triquadratic_hexahedron, VTK_TRIQUADRATIC_HEXAHEDRON},
    {CellType::quadratic_linear_wedge, VTK_QUADRATIC_LINEAR_WEDGE},
    {CellType::biquadratic_quadratic_wedge, VTK_BIQUADRATIC_QUADRATIC_WEDGE},
    {CellType::biquadratic_quadratic_hexahedron, VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON},
    {CellType::triquadratic_pyramid, VTK_TRIQUADRATIC_PYRAMID},
    {CellType::lagrange_tetrahedron, VTK_LAGRANGE_TETRAHEDRON},
    {CellType::lagrange_hexahedron, VTK_LAGRANGE_HEXAHEDRON},
    {CellType::lagrange_wedge, VTK_LAGRANGE_WEDGE},
    {CellType::lagrange_pyramid, VTK_LAGRANGE_PYRAMID},
    {CellType::bezier_tetrahedron, VTK_BEZIER_TETRAHEDRON},
    {CellType::bezier_hexahedron, VTK_BEZIER_HEXAHEDRON},
    {CellType::bezier_wedge, VTK_BEZIER_WEDGE},
    {CellType::bezier_pyramid, VTK_BEZIER_PYRAMID},
    {CellType::empty_cell, VTK_EMPTY_CELL},
    {CellType::vertex, VTK_VERTEX},
    {CellType::poly_vertex, VTK_POLY_VERTEX},
    {CellType::line, VTK_LINE},
    {CellType::poly_line, VTK_POLY_LINE},
    {CellType::triangle, VTK_TRIANGLE},
    {CellType::triangle_strip, VTK_TRIANGLE_STRIP},
    {CellType::polygon, VTK_POLYGON},
    {CellType::pixel, VTK_PIXEL},
    {CellType::quad, VTK_QUAD},
    {CellType::quadratic_edge, VTK_QUADRATIC_EDGE},
    {CellType::quadratic_triangle, VTK_QUADRATIC_TRIANGLE},
    {CellType::quadratic_quad, VTK_QUADRATIC_QUAD},
    {CellType::biquadratic_quad, VTK_BIQUADRATIC_QUAD},
    {CellType::quadratic_linear_quad, VTK_QUADRATIC_LINEAR_QUAD},
    {CellType::biquadratic_triangle, VTK_BIQUADRATIC_TRIANGLE},
    {CellType::cubic_line, VTK_CUBIC_LINE},
    {CellType::quadratic_polygon, VTK_QUADRATIC_POLYGON},
    {CellType::lagrange_curve, VTK_LAGRANGE_CURVE},
    {CellType::lagrange_triangle, VTK_LAGRANGE_TRIANGLE},
    {CellType::lagrange_quadrilateral, VTK_LAGRANGE_QUADRILATERAL},
    {CellType::bezier_curve, VTK_BEZIER_CURVE},
    {CellType::bezier_triangle, VTK_BEZIER_TRIANGLE},
    {CellType::bezier_quadrilateral, VTK_BEZIER_QUADRILATERAL}};

TEST(VtkWritten, CellTypesHaveTheNumbersOfVtk) {
  for (const auto& [type, number] : cell_types) EXPECT_EQ(vtk_number(type), number);
  for (int number = 0; number < 256; ++number) {
    // VTK's curves and surfaces that do not occur in files are accepted and have no name.
    const bool is_unused = (number >= 51 && number <= 54) || (number >= 60 && number <= 63);
    const bool is_accepted = cells::cell_shape(static_cast<std::uint8_t>(number)).kind != cells::CellKind::unsupported;
    const bool is_listed = std::ranges::count(cell_types, number, &std::pair<CellType, int>::second) == 1;
    EXPECT_EQ(is_listed, is_accepted && !is_unused) << number;
  }
}

TEST(VtkWritten, OverlappingHexahedraAreOnePairEachInEveryEncoding) {
  constexpr int n = 5;
  const auto grid = hexahedra(n);
  const test::TemporaryFolder folder;
  for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended})
    for (const bool compressed : {false, true})
      for (const bool base64 : {false, true}) {
        vtkNew<vtkXMLUnstructuredGridWriter> writer;
        const auto file = folder / fmt::format("{}-{}-{}.vtu", mode, compressed, base64);
        writer->SetFileName(file.c_str());
        writer->SetDataMode(mode);
        writer->SetEncodeAppendedData(base64);
        if (!compressed) writer->SetCompressorTypeToNone();
        writer->SetInputData(grid);
        ASSERT_EQ(writer->Write(), 1);
        expect_pairs(file, n);
      }
  for (const int type : {VTK_ASCII, VTK_BINARY}) {
    vtkNew<vtkUnstructuredGridWriter> writer;
    const auto file = folder / fmt::format("{}.vtk", type);
    writer->SetFileName(file.c_str());
    writer->SetFileType(type);
    writer->SetInputData(grid);
    ASSERT_EQ(writer->Write(), 1);
    expect_pairs(file, n);
  }
}

/// Uniform along z, and along x and y only if `even`; decreasing along y.
template <class Array>
vtkNew<vtkRectilinearGrid> rectilinear(bool even, bool of_cells) {
  const std::array<int, 3> n{21, 30, 47};
  vtkNew<vtkRectilinearGrid> grid;
  grid->SetExtent(2, n[0] + 1, -4, n[1] - 5, 0, n[2] - 1);
  std::array<vtkNew<Array>, 3> axes;
  for (std::size_t a = 0; a < 3; ++a)
    for (int i = 0; i < n[a]; ++i) {
      const double x = even || a == 2 ? i : i + 0.01 * i * i;
      axes[a]->InsertNextValue(static_cast<typename Array::ValueType>(a == 0 ? 0.1 * x : a == 1 ? 5 - 0.3 * x : x));
    }
  grid->SetXCoordinates(axes[0]);
  grid->SetYCoordinates(axes[1]);
  grid->SetZCoordinates(axes[2]);
  vtkNew<vtkUnsignedShortArray> field;
  field->SetName("f");
  const vtkIdType samples = of_cells ? grid->GetNumberOfCells() : grid->GetNumberOfPoints();
  for (vtkIdType k = 0; k < samples; ++k) field->InsertNextValue(static_cast<unsigned short>(k * k % 65521));
  if (of_cells)
    grid->GetCellData()->SetScalars(field);
  else
    grid->GetPointData()->SetScalars(field);
  return grid;
}

class RectilinearWritten : public test::StreamedVolumes {
 protected:
  void expect_the_same(vtkRectilinearGrid* grid, const std::string& name, bool regular) const {
    for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended})
      for (const bool compressed : {false, true})
        for (const bool base64 : {false, true}) {
          vtkNew<vtkXMLRectilinearGridWriter> writer;
          const auto file = folder / fmt::format("{}-{}-{}-{}.vtr", name, mode, compressed, base64);
          writer->SetFileName(file.c_str());
          writer->SetDataMode(mode);
          writer->SetEncodeAppendedData(base64);
          writer->SetBlockSize(4096);
          writer->SetHeaderTypeToUInt64();
          if (!compressed) writer->SetCompressorTypeToNone();
          writer->SetInputData(grid);
          ASSERT_EQ(writer->Write(), 1);
          const auto plain = read_plain_vtk_grid(file, 0);
          ASSERT_EQ(plain.has_value(), mode != vtkXMLWriter::Ascii) << file;
          EXPECT_TRUE(!plain || plain->grid.geometry.rectilinear() == !regular) << file;
          const bool in_place = mode == vtkXMLWriter::Appended && !compressed && !base64;
          EXPECT_EQ(is_the_same_streamed(file), !in_place) << file;
        }
  }
};

TEST_F(RectilinearWritten, GridsAreReadAlikeWithAndWithoutVtkInEveryEncoding) {
  for (const bool even : {false, true})
    for (const bool of_cells : {false, true}) {
      const std::string name = fmt::format("{}-{}", even, of_cells);
      expect_the_same(rectilinear<vtkFloatArray>(even, of_cells), "float-" + name, even);
      expect_the_same(rectilinear<vtkDoubleArray>(even, of_cells), "double-" + name, even);
    }
}

}  // namespace
}  // namespace tessera::io::vtk_written_test
