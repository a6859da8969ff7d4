// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scaled_source.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

namespace tessera::scene {
namespace {

Grid with_axes_scaled(Grid grid, const glm::dvec3& scale) {
  grid.geometry = scaled(std::move(grid.geometry), scale);
  return grid;
}

/// Returns the factor by which an axis of the grid becomes longer, and updates its direction, which only changes if the
/// axis is not along an axis of the world.
double stretch(glm::dvec3& direction, const glm::dvec3& scale) {
  for (int axis = 0; axis < 3; ++axis)
    if (direction[(axis + 1) % 3] == 0 && direction[(axis + 2) % 3] == 0) return scale[axis];
  const glm::dvec3 stretched = direction * scale;
  const double length = glm::length(stretched);
  direction = stretched / length;
  return length;
}

}  // namespace

GridGeometry scaled(GridGeometry geometry, const glm::dvec3& scale) {
  geometry.origin *= scale;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = stretch(geometry.direction[axis], scale);
    geometry.spacing[axis] *= length;
    for (double& coordinate : geometry.coordinates[static_cast<std::size_t>(axis)]) coordinate *= length;
  }
  return geometry;
}

ScaledSource::ScaledSource(std::unique_ptr<SampleSource> all, const glm::dvec3& scale, std::string source)
    : SampleSource(with_axes_scaled(all->grid(), scale), std::move(source)), all_(std::move(all)) {}

void ScaledSource::read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const {
  const std::int64_t elements =
      (box.extent(2) - 1) * layout.slice_pitch + (box.extent(1) - 1) * layout.row_pitch + box.extent(0);
  all_->read(box, layout, std::span(destination, static_cast<std::size_t>(elements) * size_of(layout.type)));
}

}  // namespace tessera::scene
