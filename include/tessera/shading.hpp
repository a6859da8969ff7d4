// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>

namespace tessera {
inline namespace v0_1 {

/// Blinn-Phong, two-sided. The normal n is the field's gradient: in a tet of a mesh its constant gradient; in a grid
/// the gradient of the trilinear field at the middle of each interval of a ray inside a voxel (which ends at surfaces),
/// constant over that interval. With l the unit vector to the light, v towards the eye along the ray and h halfway
/// between them, colour c becomes c * (ambient + diffuse |n.l|) + specular |n.h|^shininess. Where the gradient is zero
/// (values that differ by less than 1e-12 of themselves), and in cell data, the colour does not change. Extinction
/// never changes.
///
/// Source  Blinn, "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977.
struct Shading {
  double ambient = 0.2, diffuse = 0.8, specular = 0.2, shininess = 32;
  glm::dvec3 to_light{0, 0, 1};  ///< towards the light, infinitely far away; any length but zero
  bool camera_light = true;  ///< `to_light` is in the camera's frame (right, up, towards the eye); else in the world's
  bool operator==(const Shading&) const = default;
};

}  // namespace v0_1
}  // namespace tessera
