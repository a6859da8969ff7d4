#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <cstdint>

#include "io/atomic_file.hpp"
#include "io/mesh_reader.hpp"
#include "io/vtk_session.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

vtkNew<vtkUnstructuredGrid> grid_of(const scene::TetMeshView& mesh) {
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkDoubleArray> xyz;
  xyz->SetNumberOfComponents(3);
  xyz->SetNumberOfTuples(static_cast<vtkIdType>(mesh.positions.size()));
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    for (int k = 0; k < 3; ++k) xyz->SetTypedComponent(static_cast<vtkIdType>(v), k, mesh.positions[v][k]);
  vtkNew<vtkPoints> points;
  points->SetData(xyz);
  grid->SetPoints(points);

  const auto tets = static_cast<vtkIdType>(mesh.tets.size());
  vtkNew<vtkTypeInt64Array> offsets, connectivity;
  offsets->SetNumberOfValues(tets + 1);
  connectivity->SetNumberOfValues(4 * tets);
  for (vtkIdType t = 0; t <= tets; ++t) offsets->SetValue(t, 4 * t);
  for (vtkIdType t = 0; t < tets; ++t)
    for (int k = 0; k < 4; ++k) connectivity->SetValue(4 * t + k, mesh.tets[static_cast<std::size_t>(t)][k]);
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, connectivity);
  grid->SetCells(VTK_TETRA, cells);

  vtkNew<vtkDoubleArray> scalars;
  scalars->SetName(mesh.field_name.empty() ? "scalar" : std::string(mesh.field_name).c_str());
  scalars->SetNumberOfValues(static_cast<vtkIdType>(mesh.scalars.size()));
  std::copy(mesh.scalars.begin(), mesh.scalars.end(), scalars->GetPointer(0));
  if (mesh.association == scene::Association::point)
    grid->GetPointData()->SetScalars(scalars);
  else
    grid->GetCellData()->SetScalars(scalars);
  if (!mesh.original_cell.empty()) {
    vtkNew<vtkTypeInt64Array> original;
    original->SetName("OriginalCellId");
    original->SetNumberOfValues(tets);
    std::copy(mesh.original_cell.begin(), mesh.original_cell.end(), original->GetPointer(0));
    grid->GetCellData()->AddArray(original);
  }
  return grid;
}

}  // namespace

void write_vtu(const scene::TetMeshView& mesh, const std::filesystem::path& file) {
  AtomicFile out(file);
  const std::string part = out.named_part().string();
  const vtkNew<vtkUnstructuredGrid> grid = grid_of(mesh);
  try {
    with_quiet_vtk(file.string(), "check the disk", [&] {
      vtkNew<vtkXMLUnstructuredGridWriter> writer;
      writer->SetFileName(part.c_str());
      writer->SetInputData(grid);
      writer->SetDataModeToAppended();
      writer->EncodeAppendedDataOff();
      writer->SetCompressorTypeToZLib();
      if (writer->Write() == 0)
        throw scene::bad_input(fmt::format("{}: it cannot be written; check the disk", file.string()));
    });
  } catch (const scene::Error& e) {  // what cannot be written is the system's fault, not the mesh's
    throw scene::Error(scene::ErrorCode::system_failure, e.what());
  }
  out.commit();
}

}  // namespace tessera::io
