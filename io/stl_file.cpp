#include "io/stl_file.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>
#include <vtkSmartPointer.h>

#include <utility>

#include "io/vtk_session.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

Surface surface_from_vtk(vtkPolyData& data, const std::string& source) {
  Surface surface;
  surface.points.resize(static_cast<std::size_t>(data.GetNumberOfPoints()));
  for (std::size_t v = 0; v < surface.points.size(); ++v)
    data.GetPoint(static_cast<vtkIdType>(v), &surface.points[v].x);
  vtkCellArray* polygons = data.GetPolys();
  for (vtkIdType c = 0; polygons && c < polygons->GetNumberOfCells(); ++c) {
    vtkIdType corners = 0;
    const vtkIdType* corner = nullptr;
    polygons->GetCellAtId(c, corners, corner);
    Polygon polygon;
    for (vtkIdType k = 0; k < corners; ++k) {
      if (corner[k] < 0 || corner[k] >= data.GetNumberOfPoints())
        throw scene::bad_input(fmt::format("{}: face {} uses point {}, the file holds {}; write it anew", source, c,
                                           corner[k], data.GetNumberOfPoints()));
      polygon.push_back(static_cast<std::uint32_t>(corner[k]));
    }
    surface.facets.push_back({{std::move(polygon)}, {}});
  }
  return surface;
}

}  // namespace

Surface read_stl(const std::string& source) {
  vtkSmartPointer<vtkPolyData> data;
  with_quiet_vtk(source, "the file is truncated, damaged or of another kind, write it anew", [&] {
    vtkNew<vtkSTLReader> reader;
    reader->MergingOff();  // done by merge_coincident_points
    reader->SetFileName(source.c_str());
    reader->Update();
    data = reader->GetOutput();
  });
  return surface_from_vtk(*data, source);
}

}  // namespace tessera::io
