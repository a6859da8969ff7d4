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

/// An iso-surface with its colour.
struct SurfaceOfValue {
  double value;
  glm::dvec3 color;  ///< linear RGB, unlit
  double opacity;
};

/// Returns all iso-surfaces, ascending by value; those of equal value keep their order.
std::vector<SurfaceOfValue> by_value(const Surfaces& surfaces, const scene::TransferFunction& function);

/// Planar depths between which a ray is kept, and whether there is a clipping plane at either of them.
struct KeptDepths {
  double nearest, farthest;
  bool nearest_cut = false, farthest_cut = false;
};

/// A crossing of a segment with a surface: the fraction of the segment's length in front of the crossing.
struct SurfaceCrossing {
  double part;
  const SurfaceOfValue* surface;
};

/// Returns the crossings of the line through pixel coordinates (x, y) with the surfaces in a tet, in order along the
/// line, between two planar depths. A surface is crossed if the scalar at one end is below the surface's value and at
/// the other end is not. For each surface, scalars are computed relative to its value, so that the comparison is
/// correct to the last place of a double. At an end that is `cut` by a clipping plane, a scalar counts as equal to the
/// value if it differs by less than a part in 1e10. (tessera/selection.hpp uses a part in 1e12, but the error of a
/// distant ray is larger.)
std::vector<SurfaceCrossing> surface_crossings(std::span<const SurfaceOfValue> surfaces,
                                               const std::array<Corner, 4>& corners, double x, double y,
                                               const KeptDepths& kept);

/// The appearance of a surface that consists of faces.
struct Paint {
  std::optional<glm::dvec3> color;  ///< linear RGB, unlit; no value: that of the transfer function at the field's value
  double opacity;
};

/// A triangle of a surface in the view.
struct ProjectedTriangle {
  std::array<Corner, 3> corners;
  glm::dvec3 normal;  ///< normal of any length
  std::size_t paint;
};

/// The intersection of a ray with a triangle.
struct TriangleCrossing {
  TriangleHit hit;
  const ProjectedTriangle* triangle;
};

/// Returns the gradient of the field in a tet of point data, of any length and either sign; 0 if there is none. In a
/// flat tet, returns the normal of the tet.
glm::dvec3 gradient_in(const scene::TetMeshView& mesh, std::size_t tet);

/// Returns the normal of the plane through three points, of any length.
glm::dvec3 normal_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

/// For each tet, returns a bit per face that no other tet of the mesh has. Bit i is that of the face opposite to corner
/// i, in the order of positions. Faces are equal if their corners are at the same positions.
std::vector<std::uint8_t> open_faces(const scene::TetMeshView& mesh);

/// Returns a colour, lit from the eye, on a surface with this normal, seen along this ray; the lengths of both vectors
/// do not matter. Without a normal, the surface is lit as if it were seen face on.
std::array<double, 3> lit(const glm::dvec3& color, const SurfaceLight& light, const glm::dvec3& ray,
                          const glm::dvec3& normal);

/// Returns the colour of a surface if the angle between the ray and the surface's normal has this cosine, 0 to 1.
std::array<double, 3> lit(const SurfaceOfValue& surface, const SurfaceLight& light, double cosine);

/// Returns the colour of a surface in a tet, lit from the eye, seen along a ray of this direction (of any length). If
/// the field has no gradient, the surface is lit as if it were seen face on.
std::array<double, 3> lit(const SurfaceOfValue& surface, const SurfaceLight& light, const glm::dvec3& ray,
                          const scene::TetMeshView& mesh, std::size_t tet);

}  // namespace tessera::reference
