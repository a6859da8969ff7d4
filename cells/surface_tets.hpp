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

/// How a closed surface was filled with tets, the best way first.
enum class SurfaceFill : std::uint8_t {
  from_corner,  ///< a cone over its triangles from one of its corners
  from_inside,  ///< from a point inside that sees all of them
  in_pieces,    ///< tets cut off until what is left is one of the above
  overlapping   ///< a cone some of whose tets turn the other way: no way was found
};

/// Fills closed surfaces with tets that have the surface's triangles as their outer faces.
class SurfaceTets {
 public:
  using LocalTet = std::array<std::uint32_t, 4>;

  /// A point that tets have inside the surface.
  struct Inside {
    glm::dvec3 place;
    std::vector<std::uint32_t> seen;  ///< corners that it is a combination of
  };

  /// `triangles` turn outward over corners `p`, on every edge as many one way as the other. Costs about triangles times
  /// corners where it is hard, and no more than some milliseconds.
  SurfaceFill fill(std::span<const glm::dvec3> p, std::span<const CornerTriangle> triangles);

  /// Corners; from p.size() on `inside()`.
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

  // Of the part at hand.
  std::vector<std::uint32_t> corners_;
  glm::dvec3 mean_{0};
  double volume6_ = 0, noise6_ = 0, size_ = 0;
  struct Plane {
    glm::dvec3 normal;
    double offset;
  };
  std::vector<Plane> planes_;
};

/// The value at `x` of the linear function that fits values at points best, kept between their smallest and largest:
/// exact for values that are linear in space, whatever `x`; their mean at the points' mean.
double fitted_value(std::span<const glm::dvec3> points, std::span<const double> values, const glm::dvec3& x);

}  // namespace tessera::cells
