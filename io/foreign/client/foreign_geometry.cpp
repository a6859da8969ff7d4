// SPDX-License-Identifier: BSD-3-Clause
#include "io/foreign/client/foreign_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/vec3.hpp>
#include <utility>

namespace tessera::io {
namespace {

/// Largest relative rounding error of a stored number of this type (half a unit in the last place); 0 for integers.
double rounding_of(NumberType type) {
  if (type == NumberType::float32) return 0x1p-24;
  return type == NumberType::float64 ? 0x1p-53 : 0;
}

void make_regular_if_even(const std::array<double, 3>& roundings, scene::GridGeometry& g) {
  glm::dvec3 first(0), spacing(1);
  for (std::size_t a = 0; a < 3; ++a) {
    const std::vector<double>& c = g.coordinates[a];
    if (c.size() < 2 || !(c.back() > c.front())) return;
    const double step = (c.back() - c.front()) / static_cast<double>(c.size() - 1);
    // Both ends of the axis are rounded; sums and products in the writer and here add a few units in the last place of
    // a double.
    const double rounding = 2 * roundings[a] + 0x1p-50;
    const double most = std::min(rounding * std::max(std::abs(c.front()), std::abs(c.back())), 1e-3 * step);
    for (std::size_t i = 0; i < c.size(); ++i)
      if (!(std::abs(c[i] - (c.front() + step * static_cast<double>(i))) <= most)) return;
    first[static_cast<int>(a)] = c.front(), spacing[static_cast<int>(a)] = step;
  }
  g.origin += g.direction * first;
  g.spacing = spacing;
  g.coordinates = {};
}

}  // namespace

void set_image_geometry(const ForeignPart& image, scene::GridGeometry& g) {
  std::array<glm::dvec3, 3> steps;
  for (std::size_t axis = 0; axis < 3; ++axis)
    steps[axis] =
        glm::dvec3(image.direction[axis], image.direction[3 + axis], image.direction[6 + axis]) * image.spacing[axis];
  scene::set_axes(g, steps);
  g.origin = {image.origin[0], image.origin[1], image.origin[2]};
  for (std::size_t axis = 0; axis < 3; ++axis)  // the file's origin is that of index 0, which may be outside the extent
    if (image.extent[2 * axis] != 0) g.origin += steps[axis] * static_cast<double>(image.extent[2 * axis]);
}

void set_rectilinear_geometry(std::array<AxisCoordinates, 3> axes, scene::GridGeometry& g) {
  std::array<double, 3> roundings{};
  for (std::size_t a = 0; a < 3; ++a) {
    std::vector<double>& c = axes[a].values;
    if (c.size() > 1 && c.back() < c.front()) {
      for (double& x : c) x = -x;
      g.direction[static_cast<int>(a)] = -g.direction[static_cast<int>(a)];
    }
    roundings[a] = rounding_of(axes[a].type);
    g.coordinates[a] = std::move(c);
  }
  make_regular_if_even(roundings, g);
}

}  // namespace tessera::io
