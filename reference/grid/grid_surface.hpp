// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "reference/mesh/surface_on_ray.hpp"

namespace tessera::reference {

/// The segment of a ray in a voxel of point data. `corner` a + 2 b + 4 c is the value at the voxel's corner (a, b, c);
/// places in it are 0 to 1 along each axis.
struct VoxelStretch {
  std::array<double, 8> corner;
  glm::dvec3 front, back;                    ///< places where the segment begins and ends
  bool front_cut = false, back_cut = false;  ///< whether a clipping plane is there
};

/// A crossing of a segment with a surface: its fraction of the segment, in order.
struct GridCrossing {
  double part;
  glm::dvec3 place;
  const SurfaceOfValue* surface;
};

/// All crossings of a segment with surfaces, which are ascending by value. The field is trilinear, so a cubic along the
/// ray; between its ends and its turning points, a surface is crossed if the field at one of them is below its value
/// and at the other is not. Values are relative to the surface's, in long double. A place within 1e-11 of a voxel's
/// side counts as on it: so voxels that share a side have the same values there, and those of the samples at corners.
/// An end that is `cut` has a surface's value if it differs by less than a part in 1e10, as in surface_crossings().
std::vector<GridCrossing> surface_crossings(std::span<const SurfaceOfValue> surfaces, const VoxelStretch& stretch);

/// The field's derivatives along the voxel's axes at a place in it, per voxel.
glm::dvec3 slopes(const std::array<double, 8>& corner, const glm::dvec3& place);

}  // namespace tessera::reference
