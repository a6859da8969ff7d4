#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "scene/camera.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::projection {

/// A vertex as a view sees it. (x, y) is its pixel position: x to the right, y down, pixel (0,0)'s centre at (0.5,
/// 0.5). Orthographic: w = 1. Perspective: w = depth. A vertex behind the eye has w < 0 and the position where the line
/// through it and the eye meets the picture. A vertex beside the eye, in the plane through it that faces the view, has
/// w = 0 and no position: (x, y) tells in which direction it lies.
///
/// In homogeneous pixel coordinates the vertex is (x w, y w, w), or (x, y, 0) beside the eye: cells that cross the eye
/// plane need no clipping before they are rasterized.
struct PixelVertex {
  double x, y, w;
  double depth;  ///< planar depth along the view direction from the eye, world units
};

/// A vertex in homogeneous pixel coordinates.
struct HomogeneousVertex {
  double x, y, w;
};
/// Its products are rounded: what decides a sign exactly (edge_sign.hpp) takes those below.
inline HomogeneousVertex homogeneous(const PixelVertex& v) {
  return v.w == 0 ? HomogeneousVertex{v.x, v.y, 0} : HomogeneousVertex{v.x * v.w, v.y * v.w, v.w};
}

/// Scaled by 1 / |w|, which rounds nothing: w is 1, -1 or 0.
inline HomogeneousVertex scaled_to_sign(const PixelVertex& v) {
  if (v.w < 0) return {-v.x, -v.y, -1};
  return {v.x, v.y, v.w > 0 ? 1.0 : 0.0};
}

/// The map from world to pixel positions.
///
/// Positions are rounded: a vertex meant to lie on a pixel's centre, or in the plane of the eye and a row or column of
/// centres, does, in spite of the noise of decimals, of the camera's axes and of the projection, and the tie rule then
/// decides in one way along a whole edge, side or plane of a mesh.
///   - Orthographic: to multiples of 2^-32 pixel.
///   - Perspective: to multiples of 2^-32 pixel, or of the power of two in (2^-47, 2^-46] of what is largest of |x|,
///   |y|
///     and the pixels per unit of tangent, if that is more. It is for telephoto views and for vertices far outside of
///     the picture, close to the eye plane, whose noise is larger. It needs a vertex 2^15 pixels away.
///   - Perspective, a vertex 2^46 or more pixels away: w = 0. Of its direction (x, y) both are rounded to multiples of
///     the power of two in (2^-41, 2^-40] of the larger. So it is in the plane of a row or column that goes through it.
/// Each is rounded as nothing but a vertex, so all cells see it in one place. The shift is at most 2^-33 pixel in the
/// picture, a hundredth of a per mille of the 3e-6 pixel that DESIGN section 3 allows.
class PixelSpace {
 public:
  /// Throws Error(bad_input) if camera or size is invalid.
  PixelSpace(const scene::Camera& camera, scene::ImageSize size);

  [[nodiscard]] PixelVertex project(const glm::dvec3& p_world) const;

  /// The same of many points, on SIMD lanes, to the same bits: out[i] is project(p_world[i]). Spans of one length.
  void project(std::span<const glm::dvec3> p_world, std::span<PixelVertex> out) const;

  /// World length per unit of planar depth along the ray through a pixel position: 1 in orthographic projection.
  [[nodiscard]] double length_per_depth(double x, double y) const;

  /// Planar depths between which anything is seen: [max(0, near), far], or [0, inf).
  [[nodiscard]] double near_depth() const { return near_; }
  [[nodiscard]] double far_depth() const { return far_; }
  [[nodiscard]] bool perspective() const { return perspective_; }
  [[nodiscard]] scene::ImageSize size() const { return size_; }

 private:
  scene::ViewBasis basis_;
  glm::dvec3 position_;
  scene::ImageSize size_;
  bool perspective_;
  double pixels_per_unit_;  ///< orthographic: per world unit; perspective: per unit of tangent
  double near_, far_;
};

}  // namespace tessera::projection
