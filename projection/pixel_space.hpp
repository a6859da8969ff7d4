#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "scene/camera.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::projection {

/// A vertex as a view sees it. (x / w, y / w) is its pixel position: x to the right, y down, pixel (0,0)'s centre at
/// (0.5, 0.5). Orthographic: w = 1. Perspective: w = depth, and a vertex behind the eye has w < 0; nothing is divided,
/// so cells that cross the eye plane need no clipping before they are rasterized. Whether a ray passes a vertex left,
/// right or through it, line_of_sight() says.
struct PixelVertex {
  double x, y, w;
  double depth;  ///< planar depth along the view direction from the eye, world units
};

/// The linear map from world to homogeneous pixel coordinates.
///
/// Orthographic pixel positions are rounded to multiples of 2^-32 pixel: a vertex meant to lie on a pixel centre does,
/// in spite of the decimal noise of camera and mesh, and the tie rule then decides in one way along a whole edge. The
/// shift is far below what a picture shows (docs/ACCURACY.md).
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
  /// Pixels per unit of x / depth in perspective; 0 in orthographic projection.
  [[nodiscard]] double pixels_per_tangent() const { return perspective_ ? pixels_per_unit_ : 0; }
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
