#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace tessera {

/// How surfaces are lit: Blinn-Phong, two-sided, by a light at the eye. With n the surface's unit normal and d the unit
/// direction of the ray, colour c becomes c * (ambient + diffuse |n.d|) + specular |n.d|^shininess.
struct SurfaceLight {
  double ambient = 0.2, diffuse = 0.8, specular = 0.2, shininess = 32;
  bool operator==(const SurfaceLight&) const = default;
};

/// Where a field has a value: all places along a ray where it goes from below the value to the value or above, or back.
/// So it is the boundary of what lies at the value or above, inside the data set, whose own boundary (and that of what
/// is blank) is no part of it; where a face has the value it is met once, between cells on different sides of it. In
/// each cell it is as exact as the field, in a voxel all roots of a cubic; its normal is the field's gradient there.
struct IsoSurface {
  double value = 0;
  std::optional<glm::dvec3> color{};  ///< linear RGB; none: the transfer function's at the value
  double opacity = 1;                 ///< above 0, at most 1, whatever the angle at which it is seen
  bool operator==(const IsoSurface&) const = default;
};

/// Surfaces in the volume, composited with it in the order in which a ray meets them. The transfer function does not
/// hide them: with one that shows nothing they are all there is.
struct Surfaces {
  std::vector<IsoSurface> iso;  ///< of point data
  SurfaceLight light;
  [[nodiscard]] bool empty() const { return iso.empty(); }
};

}  // namespace tessera
