// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "scene/camera.hpp"
#include "scene/pixel_view.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::projection {

/// A projected vertex. Behind the eye, w is negative, so cells that cross the eye plane need no clipping before
/// rasterization. line_of_sight() determines on which side of a vertex a ray passes.
using PixelVertex = scene::PixelPlace;

/// The linear map from world to homogeneous pixel coordinates (scene/pixel_view.hpp), and the visible range.
///
/// Orthographic pixel positions are rounded to multiples of 2^-32 pixel. So a vertex that is meant to be on a pixel
/// centre is exactly there, in spite of the rounding errors in the decimal coordinates of camera and mesh, and the tie
/// rule then decides in the same way along a whole edge. The shift is far below what is visible in an image
/// (docs/ACCURACY.md).
class PixelSpace {
 public:
  /// Throws Error(bad_input) if camera or size is invalid.
  PixelSpace(const scene::Camera& camera, scene::ImageSize size);

  [[nodiscard]] PixelVertex project(const glm::dvec3& p_world) const;

  /// Projects many points on SIMD lanes, with the same bits: out[i] is project(p_world[i]). The spans must have equal
  /// lengths.
  void project(std::span<const glm::dvec3> p_world, std::span<PixelVertex> out) const;

  /// World length of the ray through this pixel position per unit of planar depth, as in scene::PixelView.
  [[nodiscard]] double length_per_depth(double x, double y) const { return view_.length_per_depth(x, y); }

  /// Direction of the ray through a pixel position, in world space, of any length.
  [[nodiscard]] glm::dvec3 direction(double x, double y) const { return view_.direction(x, y); }

  /// The visible range of planar depths: [max(0, near), far], or [0, inf).
  [[nodiscard]] double near_depth() const { return near_; }
  [[nodiscard]] double far_depth() const { return far_; }
  [[nodiscard]] bool perspective() const { return view_.perspective; }
  /// Pixels per unit of x / depth in perspective; 0 in orthographic projection.
  [[nodiscard]] double pixels_per_tangent() const { return view_.perspective ? view_.pixels_per_unit : 0; }
  [[nodiscard]] scene::ImageSize size() const { return size_; }

 private:
  scene::PixelView view_;
  scene::ImageSize size_;
  double near_, far_;
};

}  // namespace tessera::projection
