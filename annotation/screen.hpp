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

  /// None for points that are not in front of the eye, in either projection. May be outside the image.
  [[nodiscard]] std::optional<glm::dvec2> pixel(const glm::dvec3& world) const;

  /// The part of a world line that is in front of the eye and on the image or within `margin` pixels of it; none if
  /// there is no such part. Cut ends are at the margin, so that numbers stay small.
  [[nodiscard]] std::optional<Segment> segment(const glm::dvec3& a, const glm::dvec3& b, double margin) const;

  /// Pixels per world unit across the view, at the focal point's depth; orthographic: anywhere.
  [[nodiscard]] double pixels_per_unit() const;

  /// Whether a side of the box, at the `high` or low end of an axis, faces the eye.
  [[nodiscard]] bool faces_eye(const Box& box, int axis, bool high) const;

 private:
  /// Pixels times w. w is the depth (perspective) or 1.
  struct Homogeneous {
    double x, y, w, depth;
  };
  [[nodiscard]] Homogeneous homogeneous(const glm::dvec3& world) const;

  View view_;
  ViewBasis basis_;
  double scale_;  ///< pixels per unit across the view, perspective: at depth 1
};

/// A corner of a box by three bits; a set bit means the high end of x, y, z.
glm::dvec3 corner(const Box& box, int bits);

/// An edge of a box: the bits of the corner with the lower number, and the axis of its direction.
struct BoxEdge {
  int corner, axis;
};

/// All twelve, along x, then y, then z.
std::array<BoxEdge, 12> box_edges();

/// How many of the two faces that meet at the edge face the eye.
int faces_towards_eye(const Screen& screen, const Box& box, const BoxEdge& edge);

}  // namespace tessera::annotation
