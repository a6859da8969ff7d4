// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "cells/face_triangles.hpp"
#include "cells/surface_ears.hpp"

namespace tessera::cells {

/// How a closed surface was filled with tets. Better methods have smaller values.
enum class SurfaceFill : std::uint8_t {
  from_corner,  ///< a cone over the triangles from one of their corners
  from_inside,  ///< a cone from an inner point that sees all triangles
  in_pieces,    ///< tets were cut off until one of the methods above was possible
  overlapping   ///< a cone with some inverted tets, because no other method was possible
};

/// Fills closed surfaces with tets whose outer faces are the surface's triangles.
class SurfaceTets {
 public:
  using LocalTet = std::array<std::uint32_t, 4>;

  /// A point that was added inside the surface.
  struct Inside {
    glm::dvec3 place;
    std::vector<std::uint32_t> seen;  ///< the corners whose combination is the point
  };

  /// Fills a surface. `triangles` are oriented outward, with corners `p`; every edge is used equally often in both
  /// directions. In difficult cases the time is proportional to the number of triangles times that of corners, up to a
  /// limit of some milliseconds.
  SurfaceFill fill(std::span<const glm::dvec3> p, std::span<const CornerTriangle> triangles);

  /// The tets, as indices of corners, or, after the last of these, of `inside()`.
  [[nodiscard]] const std::vector<LocalTet>& tets() const { return tets_; }
  [[nodiscard]] const std::vector<Inside>& inside() const { return inside_; }

 private:
  using Triangles = std::vector<CornerTriangle>;
  void fill_part(const Triangles& part);
  bool fill_star(const Triangles& part, bool strictly);
  bool fill_by_ears(const Triangles& part, std::uint32_t attempt);
  void fill_overlapping(const Triangles& part);
  bool split_apart(const Triangles& part);
  void take_measures(const Triangles& part);
  [[nodiscard]] double wrong_side(const Triangles& part, const glm::dvec3& apex, double enough) const;
  [[nodiscard]] bool has_flat_tets(const Triangles& part, std::uint32_t apex) const;
  bool find_kernel_point(const Triangles& part, bool soon, glm::dvec3& x);
  void add_cone(const Triangles& part, std::uint32_t apex);
  void add_cone_inside(const Triangles& part, const glm::dvec3& apex);

  std::span<const glm::dvec3> p_;
  std::vector<LocalTet> tets_;
  std::vector<Inside> inside_;
  SurfaceFill fill_ = SurfaceFill::from_corner;
  SurfaceEars ears_;

  // Corners of the part that is being filled.
  std::vector<std::uint32_t> corners_;
  glm::dvec3 mean_{0};
  double volume6_ = 0, noise6_ = 0, size_ = 0;
  struct Plane {
    glm::dvec3 normal;
    double offset;
  };
  std::vector<Plane> planes_;
};

/// Returns the value at `x` of the least-squares linear fit of values at points, clamped to the range of the values. It
/// is exact for linear values, whatever `x`; at the mean of the points it is the mean of the values.
double fitted_value(std::span<const glm::dvec3> points, std::span<const double> values, const glm::dvec3& x);

}  // namespace tessera::cells
