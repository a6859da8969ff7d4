// SPDX-License-Identifier: BSD-3-Clause
#include "scene/grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "scene/error.hpp"
#include "scene/number_type.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

using scene::bad_input;

double local_of_index(const GridGeometry& g, int axis, double index) {
  const std::vector<double>& c = g.coordinates[static_cast<std::size_t>(axis)];
  if (c.empty()) return g.spacing[axis] * index;
  const double cell = std::clamp(std::floor(index), 0.0, static_cast<double>(c.size() - 2));
  const auto i = static_cast<std::size_t>(cell);
  return c[i] + (c[i + 1] - c[i]) * (index - cell);
}

double index_of_local(const GridGeometry& g, int axis, double local) {
  const std::vector<double>& c = g.coordinates[static_cast<std::size_t>(axis)];
  if (c.empty()) return local / g.spacing[axis];
  const auto above = std::upper_bound(c.begin() + 1, c.end() - 1, local);
  const auto i = static_cast<std::size_t>(above - c.begin() - 1);
  return static_cast<double>(i) + (local - c[i]) / (c[i + 1] - c[i]);
}

}  // namespace

std::size_t size_of(SampleType type) { return scene::size_of(scene::number_type_of(type)); }
const char* name_of(SampleType type) { return scene::name_of(scene::number_type_of(type)); }
bool is_float(SampleType type) { return type == SampleType::float32 || type == SampleType::float64; }

bool fits_float(SampleType type) {
  return type != SampleType::int32 && type != SampleType::uint32 && type != SampleType::float64;
}

glm::dvec3 world_of_index(const GridGeometry& geometry, const glm::dvec3& index) {
  glm::dvec3 local;
  for (int axis = 0; axis < 3; ++axis) local[axis] = local_of_index(geometry, axis, index[axis]);
  return geometry.origin + geometry.direction * local;
}

glm::dvec3 index_of_world(const GridGeometry& geometry, const glm::dvec3& p_world) {
  const glm::dvec3 local = world_to_local(geometry) * (p_world - geometry.origin);
  glm::dvec3 index;
  for (int axis = 0; axis < 3; ++axis) index[axis] = index_of_local(geometry, axis, local[axis]);
  return index;
}

glm::dmat3 world_to_local(const GridGeometry& geometry) {
  // This avoids rounding in the most common case.
  if (geometry.direction == glm::dmat3(1.0)) return geometry.direction;
  return glm::inverse(geometry.direction);
}

Box bounds(const GridGeometry& geometry) {
  Box box;
  for (int corner = 0; corner < 8; ++corner) {
    glm::dvec3 local;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      local[axis] = geometry.lattice(a, (corner >> axis & 1) != 0 ? geometry.points[a] - 1 : 0);
    }
    const glm::dvec3 p_world = geometry.origin + geometry.direction * local;
    box.low = glm::min(box.low, p_world);
    box.high = glm::max(box.high, p_world);
  }
  return {box.low + 0.0, box.high + 0.0};
}

double mean_thickness(const GridGeometry& geometry) {
  const Box box = bounds(geometry);
  const glm::dvec3 side = box.high - box.low;
  const double longest = std::max({side.x, side.y, side.z});
  if (!(longest > 0)) return 0;
  double volume = std::abs(glm::determinant(geometry.direction));
  for (std::size_t axis = 0; axis < 3; ++axis)  // in units of the longest side: 1e150 cubed would overflow
    volume *= (geometry.lattice(axis, geometry.points[axis] - 1) - geometry.lattice(axis, 0)) / longest;
  const glm::dvec3 s = side / longest;
  return longest * volume / std::max({s.x * s.y, s.y * s.z, s.z * s.x});
}

void validate(const Grid& grid, const std::string& source) {
  const GridGeometry& g = grid.geometry;
  const auto fail = [&](const std::string& what) {
    throw bad_input(fmt::format("{}: {}; write the file again", source, what));
  };
  const auto finite = [](const glm::dvec3& v) { return std::isfinite(v.x + v.y + v.z); };
  std::int64_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const char name = "xyz"[axis];
    const std::vector<double>& c = g.coordinates[axis];
    if (g.points[axis] < 2)
      fail(fmt::format("the grid has {} point{} along {}, but a volume needs two or more along every axis",
                       g.points[axis], g.points[axis] == 1 ? "" : "s", name));
    if (__builtin_mul_overflow(count, g.points[axis], &count) || count > (std::int64_t{1} << 59))
      fail(fmt::format("the grid has {} x {} x {} points, more than can be addressed", g.points[0], g.points[1],
                       g.points[2]));
    if (c.empty() && !(g.spacing[static_cast<int>(axis)] > 0 && std::isfinite(g.spacing[static_cast<int>(axis)])))
      fail(fmt::format("the spacing along {} is {}, but must be above 0", name, g.spacing[static_cast<int>(axis)]));
    if (!c.empty() && c.size() != static_cast<std::size_t>(g.points[axis]))
      fail(fmt::format("there are {} coordinates along {}, but {} points", c.size(), name, g.points[axis]));
    for (std::size_t i = 0; i < c.size(); ++i)
      if (!std::isfinite(c[i]) || (i > 0 && !(c[i] > c[i - 1])))
        fail(fmt::format("coordinate {} along {} is {}, but coordinates must be finite and increasing", i, name, c[i]));
  }
  if (!finite(g.origin)) fail(fmt::format("the origin is {} {} {}", g.origin.x, g.origin.y, g.origin.z));
  const glm::dmat3& d = g.direction;
  for (int column = 0; column < 3; ++column)
    if (!finite(d[column]) || std::abs(glm::length(d[column]) - 1) > 1e-9)
      fail(fmt::format("axis {} has the direction {} {} {}, which is not of length one", "xyz"[column], d[column].x,
                       d[column].y, d[column].z));
  if (!(std::abs(glm::determinant(d)) > 1e-6)) fail("the directions of its axes are in one plane");
  const Box box = bounds(g);
  if (!finite(box.low) || !finite(box.high)) fail("its corners are too far away to be represented as numbers");
  if (!std::isfinite(grid.scale) || grid.scale == 0 || !std::isfinite(grid.shift))
    fail(fmt::format("samples are scaled by {} and shifted by {}", grid.scale, grid.shift));
}

}  // namespace v0_1
}  // namespace tessera

namespace tessera::scene {

void set_axes(GridGeometry& geometry, const std::array<glm::dvec3, 3>& steps) {
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3& step = steps[static_cast<std::size_t>(axis)];
    const double length = glm::length(step);
    geometry.spacing[axis] = length;
    // validate() reports the zero length. With a unit axis, it reports nothing else.
    geometry.direction[axis] = glm::dvec3(axis == 0, axis == 1, axis == 2);
    if (length > 0 && std::isfinite(length)) geometry.direction[axis] = step / length + 0.0;
  }
}

}  // namespace tessera::scene
