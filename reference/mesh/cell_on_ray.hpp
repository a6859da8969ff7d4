// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "reference/bernstein.hpp"

namespace tessera::reference {

/// A cell in the frame of one ray. x and y are coordinates along two unit vectors perpendicular to the ray; z is the
/// planar depth of the nearest position on the ray. So the ray is x = y = 0. Valid only during the lifetime of the
/// objects to which it refers.
struct CellOnRay {
  const BernsteinBasis* basis = nullptr;
  std::span<const glm::dvec3> control;  ///< control points in the ray's frame
  std::span<const double> field;        ///< control values; empty if the field is constant
  double size = 0;      ///< longest side of the box of `control`, or more if a distant eye makes rounding larger
  double rounding = 1;  ///< rounding error of places relative to that for a nearby eye: about distance / (4 * size)
};

/// The position of a place of the cell in the ray's frame, and its derivatives with respect to the cell's own
/// coordinates.
struct CellPoint {
  glm::dvec3 at, along_r, along_s, along_t;
};

/// Storage for the functions' values, reused between points.
struct BasisValues {
  std::vector<double> value;
  std::vector<glm::dvec3> gradient;

  void evaluate(const BernsteinBasis& basis, const glm::dvec3& place);
};

CellPoint point_of(const CellOnRay& cell, const glm::dvec3& place, BasisValues& room);

/// Returns the field at a place; the cell's field must not be empty.
double field_of(const CellOnRay& cell, const glm::dvec3& place, BasisValues& room);

/// Returns the change of place that moves the point by `wanted`, to first order. Not finite where the cell is flat.
glm::dvec3 change_of_place(const CellPoint& point, const glm::dvec3& wanted);

/// Returns the place whose point is on the ray at `depth`, found by Newton's method from `start`. The place may be
/// outside the domain. No value if the method does not converge.
std::optional<glm::dvec3> place_on_ray(const CellOnRay& cell, double depth, glm::dvec3 start, BasisValues& room);

}  // namespace tessera::reference
