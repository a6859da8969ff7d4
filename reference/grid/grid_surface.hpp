// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "reference/mesh/surface_on_ray.hpp"

namespace tessera::reference {

/// The segment of a ray in a voxel of point data. corner[a + 2 b + 4 c] is the value at the voxel's corner (a, b, c).
/// Coordinates of places in the voxel are 0 to 1 along each axis.
struct VoxelStretch {
  std::array<double, 8> corner;
  glm::dvec3 front, back;                    ///< places where the segment begins and ends
  bool front_cut = false, back_cut = false;  ///< whether a clipping plane is at the front and back
};

/// A crossing of a segment with a surface. `part` is the fraction of the segment in front of the crossing. Crossings
/// are in order.
struct GridCrossing {
  double part;
  glm::dvec3 place;
  const SurfaceOfValue* surface;
};

/// Returns all crossings of a segment with surfaces, which are ascending by value. The field is trilinear, so it is a
/// cubic along the ray. Between two neighbouring ends or turning points of the cubic, a surface is crossed if the field
/// is below the surface's value at one of them, and not below it at the other. Values are relative to the surface's
/// value, in long double. A place within 1e-11 of a voxel's side counts as on the side, so that voxels that share a
/// side have the same values there, and the values at corners are those of the samples. The field at an end that is
/// `cut` counts as equal to the surface's value if it differs by less than a part in 1e10, as in surface_crossings().
std::vector<GridCrossing> surface_crossings(std::span<const SurfaceOfValue> surfaces, const VoxelStretch& stretch);

/// Returns the field's derivatives along the axes of a voxel at a place in the voxel. The unit of length along each
/// axis is the voxel's side.
glm::dvec3 slopes(const std::array<double, 8>& corner, const glm::dvec3& place);

}  // namespace tessera::reference
