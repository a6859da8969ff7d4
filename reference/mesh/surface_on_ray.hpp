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

/// All iso-surfaces, ascending by value; equal ones in the given order.
std::vector<SurfaceOfValue> by_value(const Surfaces& surfaces, const scene::TransferFunction& function);

/// Planar depths between which a ray is kept, and whether a clipping plane is there.
struct KeptDepths {
  double nearest, farthest;
  bool nearest_cut = false, farthest_cut = false;
};

/// A crossing of a segment with a surface: its fraction of the segment's length.
struct SurfaceCrossing {
  double part;
  const SurfaceOfValue* surface;
};

/// The crossings of the line through pixel coordinates (x, y) with the surfaces in a tet, in order along it, between
/// two planar depths. A surface is crossed if the scalar at one end is below its value and at the other is not. For
/// each surface the scalars are relative to its value, so that the sides are correct to a double's last place. An end
/// at one of the two depths, if it is `cut` by a clip, has a surface's value if it differs by less than a part in 1e10
/// (tessera/selection.hpp: 1e12, which a distant ray cannot resolve).
std::vector<SurfaceCrossing> surface_crossings(std::span<const SurfaceOfValue> surfaces,
                                               const std::array<Corner, 4>& corners, double x, double y,
                                               const KeptDepths& kept);

/// The appearance of a surface of faces.
struct Paint {
  std::optional<glm::dvec3> color;  ///< linear RGB, unlit; no value: the transfer function's at the field's value
  double opacity;
};

/// A triangle of a surface in the view.
struct ProjectedTriangle {
  std::array<Corner, 3> corners;
  glm::dvec3 normal;  ///< of any length
  std::size_t paint;
};

/// The intersection of a ray with a triangle.
struct TriangleCrossing {
  TriangleHit hit;
  const ProjectedTriangle* triangle;
};

/// The field's gradient in a tet of point data, of any length and either sign; 0 if there is none. In a flat tet its
/// normal.
glm::dvec3 gradient_in(const scene::TetMeshView& mesh, std::size_t tet);

/// The normal of three points, of any length.
glm::dvec3 normal_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

/// The faces that only one tet of a mesh has, one bit per corner of the tet, the corner opposite to the face: corner i
/// in the order of positions. Faces are equal if their corners are at the same positions.
std::vector<std::uint8_t> open_faces(const scene::TetMeshView& mesh);

/// A colour, lit from the eye, on a surface of that normal, seen along that ray (both of any length). Without a normal,
/// as if seen face on.
std::array<double, 3> lit(const glm::dvec3& color, const SurfaceLight& light, const glm::dvec3& ray,
                          const glm::dvec3& normal);

/// A surface's colour if the angle between the ray and its normal has this cosine, 0 to 1.
std::array<double, 3> lit(const SurfaceOfValue& surface, const SurfaceLight& light, double cosine);

/// A surface's colour in a tet, lit from the eye, seen along a ray of that direction (of any length). If the field has
/// no gradient it is lit as if seen face on.
std::array<double, 3> lit(const SurfaceOfValue& surface, const SurfaceLight& light, const glm::dvec3& ray,
                          const scene::TetMeshView& mesh, std::size_t tet);

}  // namespace tessera::reference
