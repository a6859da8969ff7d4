// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "reference/mesh/ray_tet.hpp"
#include "scene/tet_mesh.hpp"
#include "scene/transfer_function.hpp"
#include "tessera/surfaces.hpp"

namespace tessera::reference {

/// An iso-surface with the colour that it has.
struct SurfaceOfValue {
  double value;
  glm::dvec3 color;  ///< linear RGB, unlit
  double opacity;
};

/// All of them, ascending by value; equal ones as they were given.
std::vector<SurfaceOfValue> by_value(const Surfaces& surfaces, const scene::TransferFunction& function);

/// Planar depths between which a ray is kept, and whether a clip's plane is there.
struct KeptDepths {
  double nearest, farthest;
  bool nearest_cut = false, farthest_cut = false;
};

/// Where a segment crosses a surface: at this part of its length.
struct SurfaceCrossing {
  double part;
  const SurfaceOfValue* surface;
};

/// The crossings of the line through pixel coordinates (x, y) with the surfaces in a tet, in the order along it, of
/// what lies between two planar depths. A surface is crossed if the scalar at one end lies below its value and the
/// other does not. For each the scalars are counted from its value, so that the sides are right to a double's last
/// place. An end at one of the two depths, where that is `cut` by a clip, has a surface's value if that is all but a
/// part in 1e10 (tessera/selection.hpp: 1e12, which a ray from afar does not tell).
std::vector<SurfaceCrossing> surface_crossings(std::span<const SurfaceOfValue> surfaces,
                                               const std::array<Corner, 4>& corners, double x, double y,
                                               const KeptDepths& kept);

/// A surface of faces with what it looks like.
struct Paint {
  std::optional<glm::dvec3> color;  ///< linear RGB, unlit; none: the transfer function's at the field's value
  double opacity;
};

/// A triangle of a surface as the view sees it.
struct ProjectedTriangle {
  std::array<Corner, 3> corners;
  glm::dvec3 normal;  ///< of any length
  std::size_t paint;
};

/// Where a ray meets a triangle.
struct TriangleCrossing {
  TriangleHit hit;
  const ProjectedTriangle* triangle;
};

/// The field's gradient in a tet of point data, of any length and either sign; 0 where it has none. In a flat tet its
/// normal.
glm::dvec3 gradient_in(const scene::TetMeshView& mesh, std::size_t tet);

/// The normal of three points, of any length.
glm::dvec3 normal_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

/// The faces that one tet of a mesh alone has, a bit a tet's corner that is not in the face: corner i in the order of
/// positions. Faces are one whose corners are at the same places.
std::vector<std::uint8_t> open_faces(const scene::TetMeshView& mesh);

/// A colour, lit from the eye, on a surface of that normal, seen along that ray (both of any length). Without normal as
/// if seen face on.
std::array<double, 3> lit(const glm::dvec3& color, const SurfaceLight& light, const glm::dvec3& ray,
                          const glm::dvec3& normal);

/// A surface's colour where the angle between the ray and its normal has this cosine, 0 to 1.
std::array<double, 3> lit(const SurfaceOfValue& surface, const SurfaceLight& light, double cosine);

/// A surface's colour in a tet, lit from the eye, seen along a ray of that direction (of any length). Where the field
/// has no gradient it is lit as if seen face on.
std::array<double, 3> lit(const SurfaceOfValue& surface, const SurfaceLight& light, const glm::dvec3& ray,
                          const scene::TetMeshView& mesh, std::size_t tet);

}  // namespace tessera::reference
