#include "io/helper/gmsh_cells.hpp"

#include <vtkCell.h>
#include <vtkCellType.h>
#include <vtkGenericCell.h>
#include <vtkHigherOrderHexahedron.h>
#include <vtkHigherOrderWedge.h>
#include <vtkIdList.h>
#include <vtkNonLinearCell.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>

#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <numeric>
#include <optional>

namespace tessera::io::helper {
namespace {

int linear_type(std::size_t corners) {
  switch (corners) {
    case 4:
      return VTK_TETRA;
    case 5:
      return VTK_PYRAMID;
    case 6:
      return VTK_WEDGE;
    default:
      return VTK_HEXAHEDRON;
  }
}

/// VTK's cell of so many nodes; none if it has no such.
std::optional<int> curved_type(std::size_t order, std::size_t corners, std::size_t nodes) {
  const std::size_t n = order + 1;
  if (corners == 4 && nodes == 10) return VTK_QUADRATIC_TETRA;
  if (corners == 4 && nodes == n * (n + 1) * (n + 2) / 6) return VTK_LAGRANGE_TETRAHEDRON;
  if (corners == 5 && nodes == 13) return VTK_QUADRATIC_PYRAMID;
  if (corners == 6 && nodes == 15) return VTK_QUADRATIC_WEDGE;
  if (corners == 6 && nodes == 18) return VTK_BIQUADRATIC_QUADRATIC_WEDGE;
  if (corners == 6 && nodes == n * n * (n + 1) / 2) return VTK_LAGRANGE_WEDGE;
  if (corners == 8 && nodes == 20) return VTK_QUADRATIC_HEXAHEDRON;
  if (corners == 8 && nodes == 27) return VTK_TRIQUADRATIC_HEXAHEDRON;
  if (corners == 8 && nodes == n * n * n) return VTK_LAGRANGE_HEXAHEDRON;
  return std::nullopt;
}

/// Where VTK has the nodes of a cell, in [0, 1]^3.
std::vector<glm::dvec3> vtk_places(int type, std::size_t nodes) {
  const auto cell = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(type));
  cell->Points->SetNumberOfPoints(static_cast<vtkIdType>(nodes));
  cell->PointIds->SetNumberOfIds(static_cast<vtkIdType>(nodes));
  // What Lagrange cells are not told, they print about.
  if (auto* hexahedron = vtkHigherOrderHexahedron::SafeDownCast(cell))
    hexahedron->SetUniformOrderFromNumPoints(static_cast<vtkIdType>(nodes));
  if (auto* wedge = vtkHigherOrderWedge::SafeDownCast(cell))
    wedge->SetUniformOrderFromNumPoints(static_cast<vtkIdType>(nodes));
  if (!cell->IsLinear()) cell->Initialize();
  const double* const p = cell->GetParametricCoords();
  std::vector<glm::dvec3> places;
  for (std::size_t k = 0; p != nullptr && k < nodes; ++k) places.emplace_back(p[3 * k], p[3 * k + 1], p[3 * k + 2]);
  return places;
}

/// Of pyramids VTK gives places in a cube, whose top is one point.
std::vector<glm::dvec3> pyramid_places(std::span<const glm::dvec3> corners) {
  constexpr std::array<std::array<std::size_t, 2>, 8> edges = {
      {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}};
  std::vector<glm::dvec3> places(corners.begin(), corners.end());
  for (const auto& [a, b] : edges) places.push_back((corners[a] + corners[b]) / 2.0);
  return places;
}

}  // namespace

GmshCell gmsh_cell(int order, std::size_t corners, std::span<const double> places) {
  const std::size_t nodes = places.size() / 3;
  GmshCell cell;
  cell.vtk_type = static_cast<std::uint8_t>(linear_type(corners));
  cell.nodes.resize(corners);
  std::iota(cell.nodes.begin(), cell.nodes.end(), std::size_t{0});
  if (nodes == corners) return cell;
  cell.by_corners = true;
  const std::optional<int> type = curved_type(static_cast<std::size_t>(order), corners, nodes);
  if (!type) return cell;

  std::vector<glm::dvec3> theirs;
  for (std::size_t k = 0; k < nodes; ++k) {
    glm::dvec3 p(places[3 * k], places[3 * k + 1], places[3 * k + 2]);
    if (corners == 8) p = (p + 1.0) / 2.0;
    if (corners == 6) p.z = (p.z + 1) / 2;
    theirs.push_back(p);
  }
  const std::vector<glm::dvec3> wanted =
      corners == 5 ? pyramid_places(std::span(theirs).first(5)) : vtk_places(*type, nodes);
  std::vector<std::size_t> order_of_nodes;
  for (const glm::dvec3& w : wanted)
    for (std::size_t k = 0; k < nodes; ++k) {
      const glm::dvec3 d = theirs[k] - w;
      constexpr double apart = 1e-6;  // places of order 100 are 1e-2 apart
      if (std::abs(d.x) + std::abs(d.y) + std::abs(d.z) < apart) order_of_nodes.push_back(k);
    }
  if (order_of_nodes.size() != nodes) return cell;
  cell.vtk_type = static_cast<std::uint8_t>(*type);
  cell.nodes = std::move(order_of_nodes);
  cell.by_corners = false;
  return cell;
}

}  // namespace tessera::io::helper
