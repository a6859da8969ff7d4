// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>

namespace tessera {
inline namespace v0_1 {

/// Two-sided Blinn-Phong shading. The normal n is the direction of the field's gradient. In a tet of a mesh the
/// gradient is constant. In a grid it is the gradient of the trilinear field at the middle of each interval of a ray
/// inside a voxel, and constant over the interval; intervals also end at surfaces. Let l be the unit vector to the
/// light, v the unit vector to the eye along the ray, and h the unit vector halfway between them. Colour c becomes c *
/// (ambient + diffuse |n.l|) + specular |n.h|^shininess. The colour does not change in cell data and where the gradient
/// is zero (the relative difference of the values is below 1e-12). Extinction never changes.
///
/// Source  Blinn, "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977.
struct Shading {
  double ambient = 0.2, diffuse = 0.8, specular = 0.2, shininess = 32;
  glm::dvec3 to_light{0, 0, 1};  ///< direction to the light, which is infinitely far away; any length but zero
  bool camera_light = true;      ///< true: `to_light` is in the camera's frame (right, up, towards the eye); false: in
                                 ///< world coordinates
  bool operator==(const Shading&) const = default;
};

}  // namespace v0_1
}  // namespace tessera
