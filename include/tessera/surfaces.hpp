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

/// How surfaces are lit: two-sided Blinn-Phong shading with a light at the eye. Let n be the unit normal of the surface
/// and d the unit direction of the ray. Colour c becomes c * (ambient + diffuse |n.d|) + specular |n.d|^shininess.
struct SurfaceLight {
  double ambient = 0.2, diffuse = 0.8, specular = 0.2, shininess = 32;
  bool operator==(const SurfaceLight&) const = default;
};

/// A level set of the field: all places along a ray where the field changes from below the value to the value or above,
/// or back. The surface is the boundary, inside the data set, of the region where the field is at or above the value.
/// The boundary of the data set itself and of blank parts is not included. If the field has the value on a whole face,
/// a ray meets the surface once there, and only if the field is above the value in one cell of the face and below it in
/// the other. In each cell the surface is as exact as the field; in a voxel all roots of a cubic are found. The normal
/// is the field's gradient at the surface.
struct IsoSurface {
  double value = 0;
  std::optional<glm::dvec3> color{};  ///< linear RGB; none: the colour of the transfer function at the value
  double opacity = 1;                 ///< > 0, <= 1, independent of the viewing angle
  bool operator==(const IsoSurface&) const = default;
};

/// The boundary of a mesh: the faces that belong to only one tet. Two faces are the same if their corners have the same
/// three positions, even if they come from different pieces of a file or different ranks. Faces made by a clip or a
/// threshold are part of the boundary. For point and cell data.
struct BoundarySurface {
  std::optional<glm::dvec3> color{};  ///< linear RGB; none: the colour of the transfer function at the field's value
  double opacity = 1;                 ///< > 0, <= 1, independent of the viewing angle
  bool operator==(const BoundarySurface&) const = default;
};

/// Triangles anywhere in space.
struct TriangleMesh {
  std::vector<glm::dvec3> points;                       ///< world units, finite
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< three indices of points each, in either orientation
  std::vector<double> values;                           ///< values of the field at the points, finite; empty if there
                                                        ///< are none
};

/// A surface in or around a mesh. It is independent of the mesh's cells: a ray meets the surface where it crosses a
/// triangle, inside and outside cells. There is no gap between triangles whose common edge has the same positions.
struct TriangleSurface {
  std::shared_ptr<const TriangleMesh> mesh;
  std::optional<glm::dvec3> color{};  ///< linear RGB; none: the colour of the transfer function at `values` or, without
                                      ///< values, light grey
  double opacity = 1;                 ///< > 0, <= 1, independent of the viewing angle
};

/// Surfaces in the volume. Surfaces and volume are composited in the order in which a ray meets them. The transfer
/// function does not hide surfaces: if it is transparent everywhere, only surfaces are visible. At equal depth, a ray
/// first leaves a cell and its boundary, then meets triangles, then enters the next boundary. Only surfaces between the
/// camera's near and far planes are visible.
struct Surfaces {
  std::vector<IsoSurface> iso;             ///< point data only
  std::vector<BoundarySurface> boundary;   ///< meshes only
  std::vector<TriangleSurface> triangles;  ///< meshes only
  SurfaceLight light;
  [[nodiscard]] bool empty() const { return iso.empty() && !has_faces(); }
  /// Whether there are boundary or triangle surfaces.
  [[nodiscard]] bool has_faces() const { return !boundary.empty() || !triangles.empty(); }
};

}  // namespace v0_1
}  // namespace tessera
