// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

namespace tessera {
inline namespace v0_1 {

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

/// The boundary of a mesh: the faces that one tet alone has. Faces are one where their corners are at the same three
/// places, whatever piece of a file or rank they come from; those that a clip or threshold makes are boundary like any
/// other. Of point and of cell data.
struct BoundarySurface {
  std::optional<glm::dvec3> color{};  ///< linear RGB; none: the transfer function's at the field's value there
  double opacity = 1;                 ///< above 0, at most 1, whatever the angle at which it is seen
  bool operator==(const BoundarySurface&) const = default;
};

/// Triangles anywhere in space.
struct TriangleMesh {
  std::vector<glm::dvec3> points;                       ///< world units, finite
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< by indices of points, turned either way
  std::vector<double> values;                           ///< of the field at the points, finite; empty: none
};

/// A surface in or about a mesh, of which it needs to know nothing: a ray meets it where it goes through a triangle, in
/// cells and outside of them. Triangles that meet in an edge at the same places leave no gap.
struct TriangleSurface {
  std::shared_ptr<const TriangleMesh> mesh;
  std::optional<glm::dvec3> color{};  ///< linear RGB; none: the transfer function's at `values`, or light grey
  double opacity = 1;                 ///< above 0, at most 1, whatever the angle at which it is seen
};

/// Surfaces in the volume, composited with it in the order in which a ray meets them. The transfer function does not
/// hide them: with one that shows nothing they are all there is. At one depth a ray leaves a cell and its boundary
/// before it meets a triangle, and that before it enters the next boundary. Only those nearer than the camera's far
/// plane and beyond its near plane are seen.
struct Surfaces {
  std::vector<IsoSurface> iso;             ///< of point data
  std::vector<BoundarySurface> boundary;   ///< of meshes
  std::vector<TriangleSurface> triangles;  ///< in and about meshes
  SurfaceLight light;
  [[nodiscard]] bool empty() const { return iso.empty() && !has_faces(); }
  /// Whether there are any of triangles.
  [[nodiscard]] bool has_faces() const { return !boundary.empty() || !triangles.empty(); }
};

}  // namespace v0_1
}  // namespace tessera
