#include "io/helper/plot3d_planes.hpp"

#include <vtkDataArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <utility>
#include <vector>

namespace tessera::io::helper {
namespace {

/// Where the components of a grid's arrays are in its file.
class PlanesOfGrid {
 public:
  explicit PlanesOfGrid(vtkStructuredGrid& grid) { grid.GetDimensions(n_.data()); }

  [[nodiscard]] std::size_t points() const { return plane() * static_cast<std::size_t>(n_[2]); }

  /// Of numbers that were read as whole components after each other, those of another order: component c of `count` of
  /// point p.
  [[nodiscard]] std::size_t place(std::size_t c, std::size_t p, std::size_t count) const {
    return (count * (p / plane()) + c) * plane() + p % plane();
  }

  /// Of some cells how many turn the same way at their first corner; those without volume there do not count.
  template <class PointAt>
  std::uint64_t alike(const PointAt& at) const {
    std::array<std::uint64_t, 2> turned{};
    for_some_cells([&](std::size_t p) {
      const glm::dvec3 corner = at(p), a = at(p + 1) - corner, b = at(p + static_cast<std::size_t>(n_[0])) - corner,
                       c = at(p + plane()) - corner;
      const double volume = glm::dot(glm::cross(a, b), c);
      constexpr double least = 1e-6;  // of floats' rounding
      if (std::abs(volume) > least * glm::length(a) * glm::length(b) * glm::length(c)) ++turned[volume > 0 ? 0 : 1];
    });
    return std::max(turned[0], turned[1]);
  }

  /// Calls `use` with the first corner of every cell, or of 65,536 and more that are evenly spread.
  template <class Use>
  void for_some_cells(const Use& use) const {
    const auto size = [&](std::size_t axis) { return static_cast<std::size_t>(std::max(n_[axis] - 1, 0)); };
    const std::size_t cells = size(0) * size(1) * size(2), step = std::max<std::size_t>(1, cells / 65536);
    for (std::size_t cell = 0; cell < cells; cell += step)
      use(cell % size(0) + cell / size(0) % size(1) * static_cast<std::size_t>(n_[0]) +
          cell / (size(0) * size(1)) * plane());
  }

 private:
  [[nodiscard]] std::size_t plane() const { return static_cast<std::size_t>(n_[0]) * static_cast<std::size_t>(n_[1]); }

  std::array<int, 3> n_{};
};

/// Arrays that have the first components, the next, ... of a file's numbers.
void put_in_order(const PlanesOfGrid& numbers, std::initializer_list<vtkDataArray*> arrays) {
  std::vector<std::pair<vtkDataArray*, int>> components;
  for (vtkDataArray* array : arrays)
    for (int c = 0; c < array->GetNumberOfComponents(); ++c) components.emplace_back(array, c);
  const std::size_t points = numbers.points();
  std::vector<double> read(components.size() * points);
  for (std::size_t c = 0; c < components.size(); ++c)
    for (std::size_t p = 0; p < points; ++p)
      read[c * points + p] = components[c].first->GetComponent(static_cast<vtkIdType>(p), components[c].second);
  for (std::size_t c = 0; c < components.size(); ++c)
    for (std::size_t p = 0; p < points; ++p)
      components[c].first->SetComponent(static_cast<vtkIdType>(p), components[c].second,
                                        read[numbers.place(c, p, components.size())]);
}

void order_solution(const PlanesOfGrid& numbers, vtkPointData& fields) {
  vtkDataArray* const density = fields.GetArray("Density");
  vtkDataArray* const momentum = fields.GetArray("Momentum");
  vtkDataArray* const energy = fields.GetArray("StagnationEnergy");
  if (density != nullptr && momentum != nullptr && energy != nullptr)
    put_in_order(numbers, {density, momentum, energy});
}

}  // namespace

PlaneOrder order_planes(vtkDataObject& data) {
  std::vector<vtkStructuredGrid*> grids;
  if (auto* const blocks = vtkMultiBlockDataSet::SafeDownCast(&data))
    for (unsigned k = 0; k < blocks->GetNumberOfBlocks(); ++k)
      if (auto* const grid = vtkStructuredGrid::SafeDownCast(blocks->GetBlock(k)); grid != nullptr && grid->GetPoints())
        grids.push_back(grid);
  std::uint64_t cells = 0, whole = 0, planes = 0;
  for (vtkStructuredGrid* grid : grids) {
    const PlanesOfGrid numbers(*grid);
    const std::size_t points = numbers.points();
    if (static_cast<std::size_t>(grid->GetNumberOfPoints()) != points) return PlaneOrder::whole;
    vtkDataArray* const places = grid->GetPoints()->GetData();
    const auto number = [&](std::size_t at) {
      return places->GetComponent(static_cast<vtkIdType>(at % points), static_cast<int>(at / points));
    };
    numbers.for_some_cells([&](std::size_t) { ++cells; });
    whole +=
        numbers.alike([&](std::size_t p) { return glm::dvec3(number(p), number(points + p), number(2 * points + p)); });
    planes += numbers.alike([&](std::size_t p) {
      return glm::dvec3(number(numbers.place(0, p, 3)), number(numbers.place(1, p, 3)), number(numbers.place(2, p, 3)));
    });
  }
  if (2 * whole >= cells) return PlaneOrder::whole;
  if (10 * planes < 9 * cells) return PlaneOrder::none;
  for (vtkStructuredGrid* grid : grids) {
    const PlanesOfGrid numbers(*grid);
    put_in_order(numbers, {grid->GetPoints()->GetData()});
    order_solution(numbers, *grid->GetPointData());
  }
  return PlaneOrder::planes;
}

}  // namespace tessera::io::helper
