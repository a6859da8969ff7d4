#include "io/helper/surface_fields.hpp"

#include <vtkCellArray.h>
#include <vtkCellLocator.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>

namespace tessera::io::helper {
namespace {

vtkNew<vtkPoints> vtk_points(const std::vector<glm::dvec3>& positions) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const glm::dvec3& p : positions) points->InsertNextPoint(p.x, p.y, p.z);
  return points;
}

}  // namespace

std::vector<double> depth_below_surface(const FilledSurface& filled) {
  const vtkNew<vtkPoints> points = vtk_points(filled.points);
  vtkNew<vtkCellArray> triangles;
  std::vector<bool> on_boundary(filled.points.size());
  for (std::size_t k = 0; k < filled.triangles.size(); k += 3) {
    const vtkIdType corner[3] = {filled.triangles[k], filled.triangles[k + 1], filled.triangles[k + 2]};
    triangles->InsertNextCell(3, corner);
    for (const vtkIdType v : corner) on_boundary[static_cast<std::size_t>(v)] = true;
  }
  vtkNew<vtkPolyData> boundary;
  boundary->SetPoints(points);
  boundary->SetPolys(triangles);
  vtkNew<vtkCellLocator> locator;
  locator->SetDataSet(boundary);
  locator->BuildLocator();
  vtkNew<vtkGenericCell> cell;
  std::vector<double> depth(filled.points.size(), 0.0);
  for (std::size_t v = 0; v < depth.size(); ++v) {
    if (on_boundary[v]) continue;
    double closest[3], squared = 0;
    vtkIdType id;
    int part;
    locator->FindClosestPoint(&filled.points[v].x, closest, cell, id, part, squared);
    depth[v] = std::sqrt(std::max(squared, 0.0));
  }
  return depth;
}

std::vector<std::vector<double>> spread_attributes(const Surface& surface, const FilledSurface& coarse,
                                                   const FilledSurface& filled) {
  std::vector<std::vector<double>> at_coarse = surface.attributes, result = surface.attributes;
  for (std::vector<double>& values : at_coarse) fill_unknown(coarse, surface.points.size(), values);
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(vtk_points(coarse.points));
  vtkNew<vtkCellArray> tets;
  for (std::size_t t = 0; t < coarse.tets.size(); t += 4) {
    const vtkIdType corner[4] = {coarse.tets[t], coarse.tets[t + 1], coarse.tets[t + 2], coarse.tets[t + 3]};
    tets->InsertNextCell(4, corner);
  }
  grid->SetCells(VTK_TETRA, tets);
  vtkNew<vtkCellLocator> locator;
  locator->SetDataSet(grid);
  locator->BuildLocator();
  vtkNew<vtkGenericCell> cell;
  for (std::size_t v = surface.points.size(); v < filled.points.size(); ++v) {
    double p[3] = {filled.points[v].x, filled.points[v].y, filled.points[v].z};
    double closest[3], natural[3], weight[4], squared;
    int part;
    vtkIdType t = locator->FindCell(p, 0.0, cell, natural, weight);
    if (t < 0) {  // outside by rounding
      locator->FindClosestPoint(p, closest, cell, t, part, squared);
      if (t >= 0) cell->EvaluatePosition(closest, nullptr, part, natural, squared, weight);
    }
    for (std::size_t a = 0; a < result.size(); ++a) {
      double value = 0;
      for (std::size_t k = 0; t >= 0 && k < 4; ++k)
        value += weight[k] * at_coarse[a][coarse.tets[4 * static_cast<std::size_t>(t) + k]];
      result[a].push_back(value);
    }
  }
  return result;
}

}  // namespace tessera::io::helper
