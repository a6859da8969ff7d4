// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "tessera/export.hpp"

namespace tessera {
inline namespace v0_1 {

/// Width and height of the image in pixels. Pixel (0,0) is the top left; its centre is at (0.5, 0.5).
struct ImageSize {
  int width = 1024, height = 1024;
  bool operator==(const ImageSize&) const = default;
};

/// Largest accepted width or height. Pixel coordinates of larger images would need more than 16 bits.
inline constexpr int max_image_side = 65536;

enum class ProjectionKind { orthographic, perspective };

/// Near and far planes: planar distances from `position` along the view direction, world units, near < far.
struct ClippingRange {
  double near_distance, far_distance;
  bool operator==(const ClippingRange&) const = default;
};

/// A camera with the same parameters as a VTK camera. World units, right-handed coordinates. Pixels are square, so the
/// width of the view follows from its height and the image size.
struct Camera {
  glm::dvec3 position{0, 0, 1}, focal_point{0, 0, 0}, view_up{0, 1, 0};
  ProjectionKind projection = ProjectionKind::orthographic;
  double parallel_scale = 1;  ///< orthographic: half the height of the view, world units
  double view_angle = 30;     ///< perspective: vertical field of view, degrees, in (0, 180)
  /// Without a range only the eye clips: anything at planar depth <= 0 is invisible in both projections.
  std::optional<ClippingRange> clipping_range;
  bool operator==(const Camera&) const = default;
};

/// Orthonormal axes of a view, in world coordinates. `up` points to the top of the image, `forward` into it.
struct ViewBasis {
  glm::dvec3 right, up, forward;
};

/// Throws Error(bad_input) if `position` equals `focal_point`, `view_up` is along the view direction, a number is not
/// finite, the scale or the angle is out of range, or the clipping range is empty. The message contains the name of the
/// wrong member and the allowed values.
TESSERA_EXPORT void validate(const Camera& camera);

/// Throws Error(bad_input) unless both sides are in [1, max_image_side].
TESSERA_EXPORT void validate(ImageSize size);

/// Returns the axes of a valid camera. They are exact unit vectors if the view is aligned with the axes.
TESSERA_EXPORT ViewBasis view_basis(const Camera& camera);

/// Axis-aligned box, world units. The default box is empty (low > high).
struct Box {
  glm::dvec3 low{1e300}, high{-1e300};
  [[nodiscard]] bool empty() const { return low.x > high.x; }
  bool operator==(const Box&) const = default;
};

/// Length of the box's diagonal, world units; 0 if the box has no extent.
TESSERA_EXPORT double diagonal(const Box& box);

/// Returns a view of the whole box from a fixed oblique direction, with a small margin; the longest side of the box is
/// horizontal in the image. A flat, thin or one-point box also gives a valid camera. In perspective, the view angle is
/// 30 degrees and the eye is as near as the box allows, but always outside it. If `turning`, the view is wide enough
/// for the box at every turn of orbit().
TESSERA_EXPORT Camera frame_box(const Box& box, ImageSize size,
                                ProjectionKind projection = ProjectionKind::orthographic, bool turning = false);

/// Returns the camera rotated about the axis through the focal point along `view_up`: one frame of an orbit. A `turn`
/// of 1 is a full turn.
TESSERA_EXPORT Camera orbit(const Camera& camera, double turn);

}  // namespace v0_1
}  // namespace tessera
