// SPDX-License-Identifier: BSD-3-Clause
#include "reference/mesh/cell_on_ray.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::reference {

void BasisValues::evaluate(const BernsteinBasis& basis, const glm::dvec3& place) {
  value.resize(basis.size());
  gradient.resize(basis.size());
  basis.evaluate(place, value, gradient);
}

CellPoint point_of(const CellOnRay& cell, const glm::dvec3& place, BasisValues& room) {
  room.evaluate(*cell.basis, place);
  CellPoint point{glm::dvec3(0), glm::dvec3(0), glm::dvec3(0), glm::dvec3(0)};
  for (std::size_t i = 0; i < cell.control.size(); ++i) {
    const glm::dvec3 &p = cell.control[i], &g = room.gradient[i];
    point.at += room.value[i] * p;
    point.along_r += g.x * p;
    point.along_s += g.y * p;
    point.along_t += g.z * p;
  }
  return point;
}

double field_of(const CellOnRay& cell, const glm::dvec3& place, BasisValues& room) {
  room.evaluate(*cell.basis, place);
  double sum = 0;
  for (std::size_t i = 0; i < cell.field.size(); ++i) sum += room.value[i] * cell.field[i];
  return sum;
}

glm::dvec3 change_of_place(const CellPoint& point, const glm::dvec3& wanted) {
  const glm::dvec3 st = glm::cross(point.along_s, point.along_t), tr = glm::cross(point.along_t, point.along_r),
                   rs = glm::cross(point.along_r, point.along_s);
  return glm::dvec3(glm::dot(wanted, st), glm::dot(wanted, tr), glm::dot(wanted, rs)) / glm::dot(point.along_r, st);
}

std::optional<glm::dvec3> place_on_ray(const CellOnRay& cell, double depth, glm::dvec3 start, BasisValues& room) {
  constexpr int most_steps = 30, few_steps = 8;
  constexpr double far_away = 10;      // in coordinates of the domain, which has size one
  constexpr double last_step = 1e-10;  // the length of the next step would be about the square of this, below rounding
  constexpr double rounding = 1e-13;   // relative to the cell's size
  for (int n = 0; n < most_steps; ++n) {
    const CellPoint point = point_of(cell, start, room);
    const glm::dvec3 missing = glm::dvec3(0, 0, depth) - point.at;
    const glm::dvec3 step = change_of_place(point, missing);
    const double length = glm::length(step);
    if (!std::isfinite(length)) return std::nullopt;
    start += step;
    if (!(glm::length(start) < far_away)) return std::nullopt;
    // In an almost flat cell, steps may never become shorter than `last_step`.
    if (length < last_step || (n > few_steps && glm::length(missing) < rounding * cell.size)) return start;
  }
  return std::nullopt;
}

}  // namespace tessera::reference
