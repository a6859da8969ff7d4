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

/// Largest width or height accepted; beyond it, pixel coordinates would need more than 16 bits.
inline constexpr int max_image_side = 65536;

enum class ProjectionKind { orthographic, perspective };

/// Near and far planes: planar distances from `position` along the view direction, world units, near < far.
struct ClippingRange {
  double near_distance, far_distance;
  bool operator==(const ClippingRange&) const = default;
};

/// A view in VTK's terms. World units, right-handed. Pixels are square: the width of the window follows from the image.
struct Camera {
  glm::dvec3 position{0, 0, 1}, focal_point{0, 0, 0}, view_up{0, 1, 0};
  ProjectionKind projection = ProjectionKind::orthographic;
  double parallel_scale = 1;  ///< orthographic: half the window's height, world units
  double view_angle = 30;     ///< perspective: vertical field of view, degrees, in (0, 180)
  /// Without a range only the eye clips: anything at planar depth <= 0 is invisible in both projections.
  std::optional<ClippingRange> clipping_range;
  bool operator==(const Camera&) const = default;
};

/// Orthonormal axes of a view, world frame. `up` points to the top of the image, `forward` into it.
struct ViewBasis {
  glm::dvec3 right, up, forward;
};

/// Throws Error(bad_input) if the camera has no direction, a `view_up` along it, a non-finite number, a scale or an
/// angle out of range, or an empty clipping range. The message names the wrong member and states what is allowed.
TESSERA_EXPORT void validate(const Camera& camera);

/// Throws Error(bad_input) unless both sides are in [1, max_image_side].
TESSERA_EXPORT void validate(ImageSize size);

/// Axes of a valid camera. Axis-aligned views give exact unit vectors.
TESSERA_EXPORT ViewBasis view_basis(const Camera& camera);

/// Axis-aligned box, world units. Empty while low > high.
struct Box {
  glm::dvec3 low{1e300}, high{-1e300};
  [[nodiscard]] bool empty() const { return low.x > high.x; }
  bool operator==(const Box&) const = default;
};

/// Length of a box's diagonal, world units; 0 if it has no extent.
TESSERA_EXPORT double diagonal(const Box& box);

/// A view of the whole box from a fixed oblique direction, with a small margin; the longest side of the box runs across
/// the image. A flat, thin or one-point box still gives a valid camera. Perspective: 30 degrees, with the eye as near
/// as the box allows, always outside it. `turning`: wide enough for the box at every turn of orbit().
TESSERA_EXPORT Camera frame_box(const Box& box, ImageSize size,
                                ProjectionKind projection = ProjectionKind::orthographic, bool turning = false);

/// The same view turned by `turn` (0..1 is one full turn) about the axis `view_up` through the focal point: one frame
/// of an orbit.
TESSERA_EXPORT Camera orbit(const Camera& camera, double turn);

}  // namespace v0_1
}  // namespace tessera
