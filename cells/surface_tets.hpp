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

/// How a closed surface was filled with tets, the best method first.
enum class SurfaceFill : std::uint8_t {
  from_corner,  ///< a cone over its triangles from one of its corners
  from_inside,  ///< a cone from an inner point that sees all of them
  in_pieces,    ///< tets cut off until one of the above applies
  overlapping   ///< a cone with some inverted tets: no other method worked
};

/// Fills closed surfaces with tets whose outer faces are the surface's triangles.
class SurfaceTets {
 public:
  using LocalTet = std::array<std::uint32_t, 4>;

  /// A point of the tets inside the surface.
  struct Inside {
    glm::dvec3 place;
    std::vector<std::uint32_t> seen;  ///< the corners that it is a combination of
  };

  /// `triangles` are oriented outward, with corners `p`; every edge is used equally often in both directions. Costs
  /// about triangles times corners in difficult cases, and no more than some milliseconds.
  SurfaceFill fill(std::span<const glm::dvec3> p, std::span<const CornerTriangle> triangles);

  /// Corners, followed by the indices of `inside()`.
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

  // Of the current part.
  std::vector<std::uint32_t> corners_;
  glm::dvec3 mean_{0};
  double volume6_ = 0, noise6_ = 0, size_ = 0;
  struct Plane {
    glm::dvec3 normal;
    double offset;
  };
  std::vector<Plane> planes_;
};

/// The value at `x` of the least-squares linear fit of values at points, clamped to their range: exact for linear
/// values, whatever `x`; their mean at the mean of the points.
double fitted_value(std::span<const glm::dvec3> points, std::span<const double> values, const glm::dvec3& x);

}  // namespace tessera::cells
