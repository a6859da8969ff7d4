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

/// How surfaces are lit: Blinn-Phong, two-sided, with a light at the eye. With n the surface's unit normal and d the
/// unit direction of the ray, colour c becomes c * (ambient + diffuse |n.d|) + specular |n.d|^shininess.
struct SurfaceLight {
  double ambient = 0.2, diffuse = 0.8, specular = 0.2, shininess = 32;
  bool operator==(const SurfaceLight&) const = default;
};

/// A level set of the field: all places along a ray where the field goes from below the value to the value or above, or
/// back. It is the boundary, inside the data set, of the region at or above the value; the boundary of the data set
/// itself (and of blank parts) does not belong to it. If a whole face has the value, the surface is met once, between
/// cells on different sides of it. In each cell it is as exact as the field, in a voxel with all roots of a cubic; its
/// normal is the field's gradient there.
struct IsoSurface {
  double value = 0;
  std::optional<glm::dvec3> color{};  ///< linear RGB; none: the transfer function's at the value
  double opacity = 1;                 ///< > 0, <= 1, independent of the viewing angle
  bool operator==(const IsoSurface&) const = default;
};

/// The boundary of a mesh: the faces that belong to only one tet. Faces are the same if their corners are at the same
/// three places, whatever piece of a file or rank they come from; faces made by a clip or threshold are boundary like
/// any other. For point and cell data.
struct BoundarySurface {
  std::optional<glm::dvec3> color{};  ///< linear RGB; none: the transfer function's at the field's value there
  double opacity = 1;                 ///< > 0, <= 1, independent of the viewing angle
  bool operator==(const BoundarySurface&) const = default;
};

/// Triangles anywhere in space.
struct TriangleMesh {
  std::vector<glm::dvec3> points;                       ///< world units, finite
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< by indices of points, in either orientation
  std::vector<double> values;                           ///< of the field at the points, finite; empty: none
};

/// A surface in or around a mesh, independent of its cells: a ray meets it where it crosses a triangle, inside and
/// outside cells. Triangles that share an edge with the same positions leave no gap.
struct TriangleSurface {
  std::shared_ptr<const TriangleMesh> mesh;
  std::optional<glm::dvec3> color{};  ///< linear RGB; none: the transfer function's at `values`, or light grey
  double opacity = 1;                 ///< > 0, <= 1, independent of the viewing angle
};

/// Surfaces in the volume, composited with it in the order in which a ray meets them. The transfer function does not
/// hide them: with one that is transparent everywhere, only surfaces are visible. At one depth a ray first leaves a
/// cell and its boundary, then meets triangles, then enters the next boundary. Only surfaces between the camera's near
/// and far planes are visible.
struct Surfaces {
  std::vector<IsoSurface> iso;             ///< point data only
  std::vector<BoundarySurface> boundary;   ///< meshes only
  std::vector<TriangleSurface> triangles;  ///< in and about meshes
  SurfaceLight light;
  [[nodiscard]] bool empty() const { return iso.empty() && !has_faces(); }
  /// Whether there are any surfaces made of triangles.
  [[nodiscard]] bool has_faces() const { return !boundary.empty() || !triangles.empty(); }
};

}  // namespace v0_1
}  // namespace tessera
