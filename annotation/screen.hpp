// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "tessera/camera.hpp"
#include "tessera/view.hpp"

namespace tessera::annotation {

/// A straight line on the image, in pixels.
using Segment = std::array<glm::dvec2, 2>;

/// Projects world points to an image: pixels from its top left corner, y downwards; the centre of pixel (0,0) is at
/// (0.5, 0.5).
class Screen {
 public:
  /// Throws Error(bad_input) for an invalid view.
  explicit Screen(const View& view);

  [[nodiscard]] const View& view() const { return view_; }
  [[nodiscard]] const ViewBasis& basis() const { return basis_; }

  /// Returns the place of a point, which may be outside the image. Returns none, in both projections, for a point that
  /// is not in front of the eye.
  [[nodiscard]] std::optional<glm::dvec2> pixel(const glm::dvec3& world) const;

  /// Returns the part of a world line that is in front of the eye and on the image or within `margin` pixels of it;
  /// none if there is no such part. Lines are cut at the margin, so that coordinates remain small.
  [[nodiscard]] std::optional<Segment> segment(const glm::dvec3& a, const glm::dvec3& b, double margin) const;

  /// Pixels per world unit across the view: in perspective at the depth of the focal point, in orthographic views
  /// anywhere.
  [[nodiscard]] double pixels_per_unit() const;

  /// Whether the side of the box at the high end of the axis (if `high`) or at the low end faces the eye.
  [[nodiscard]] bool faces_eye(const Box& box, int axis, bool high) const;

 private:
  /// Pixel coordinates multiplied by w, which is the depth in perspective views and otherwise 1.
  struct Homogeneous {
    double x, y, w, depth;
  };
  [[nodiscard]] Homogeneous homogeneous(const glm::dvec3& world) const;

  View view_;
  ViewBasis basis_;
  double scale_;  ///< pixels per world unit across the view; in perspective at depth 1
};

/// Returns the corner of a box given by three bits, for x, y and z. A set bit means the high end.
glm::dvec3 corner(const Box& box, int bits);

/// An edge of a box: the bits of its corner with the lower number, and the axis of its direction.
struct BoxEdge {
  int corner, axis;
};

/// Returns all twelve edges: first those along x, then y, then z.
std::array<BoxEdge, 12> box_edges();

/// Returns how many of the two faces that share the edge face the eye.
int faces_towards_eye(const Screen& screen, const Box& box, const BoxEdge& edge);

}  // namespace tessera::annotation
