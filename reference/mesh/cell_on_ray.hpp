// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "reference/bernstein.hpp"

namespace tessera::reference {

/// A cell in the frame of one ray: the point at x and y along two unit vectors across the ray, and at z as the planar
/// depth of the ray's place beside it. So the ray is x = y = 0. Only valid while what it refers to lives.
struct CellOnRay {
  const BernsteinBasis* basis = nullptr;
  std::span<const glm::dvec3> control;  ///< control points in that frame
  std::span<const double> field;        ///< control values; empty if the field is constant
  double size = 0;      ///< longest side of the box of `control`; more where the eye is so far that rounding is
  double rounding = 1;  ///< how much coarser places are than from nearby: about the distance in sizes, by four
};

/// Where a place of the cell's own coordinates is in the ray's frame, and how it moves with them.
struct CellPoint {
  glm::dvec3 at, along_r, along_s, along_t;
};

/// Room for the functions' values, so that it need not be asked for at every point.
struct BasisValues {
  std::vector<double> value;
  std::vector<glm::dvec3> gradient;

  void evaluate(const BernsteinBasis& basis, const glm::dvec3& place);
};

CellPoint point_of(const CellOnRay& cell, const glm::dvec3& place, BasisValues& room);

/// The field there; the cell's must not be empty.
double field_of(const CellOnRay& cell, const glm::dvec3& place, BasisValues& room);

/// The change of place that moves the point by `wanted`, to first order; not finite where the cell is flat.
glm::dvec3 change_of_place(const CellPoint& point, const glm::dvec3& wanted);

/// The place whose point is on the ray at `depth`, by Newton's method from `start`. It may lie outside of the domain.
/// Nothing if that does not converge.
std::optional<glm::dvec3> place_on_ray(const CellOnRay& cell, double depth, glm::dvec3 start, BasisValues& room);

}  // namespace tessera::reference
