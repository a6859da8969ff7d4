// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "cells/closed_surface.hpp"
#include "cells/surface_tets.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::cells {

/// Splits polyhedra into tets that fit those of their neighbours, one cell after the other.
///
/// Faces     are cut by face_triangles.hpp, from the positions of their corners alone, and never get points of their
///           own: neighbours agree on them whatever index, order or orientation they have, and whatever kind of cell
///           (cell_split.hpp, cells/amr/amr_cells.hpp) the other side is.
/// Corners   at one place are one.
/// Cells     are cones from their smallest corner, which for tets, pyramids, wedges and hexahedra gives what
///           split_cell() gives; where that does not see all of the cell, from another corner, or a point inside; where
///           none does, they are cut up (surface_tets.hpp).
class PolyhedronSplitter {
 public:
  /// `faces`: of each the number of its corners, then these, as indices into `positions`, which are finite. Nothing if
  /// they are no closed surface.
  std::optional<SurfaceFill> split(std::span<const std::uint32_t> faces, std::span<const glm::dvec3> positions);

  /// The convex hull of points. Nothing if they are more than most_hull_points; no tets if they lie in a plane.
  std::optional<SurfaceFill> split_hull(std::span<const std::uint32_t> points, std::span<const glm::dvec3> positions);

  /// Indices into `positions`; from their number on into added().
  [[nodiscard]] const std::vector<scene::Tet>& tets() const { return tets_; }
  [[nodiscard]] const std::vector<glm::dvec3>& added() const { return added_; }
  /// Of each added point, of a field with these values at `positions`: exact where it is linear in space, and never
  /// beyond the values of the cell's corners.
  void add_values(std::span<const double> values, std::vector<double>& out);

  /// Whether all faces are cut from their smallest corners, as those of split_cell() are.
  bool are_fans(std::span<const std::uint32_t> faces, std::span<const glm::dvec3> positions);

 private:
  SurfaceFill fill(std::span<const glm::dvec3> positions);
  bool fill_hexahedron();

  ClosedSurface surface_;
  SurfaceTets filled_;
  std::vector<scene::Tet> tets_;
  std::vector<glm::dvec3> added_, seen_places_;
  std::vector<double> seen_values_;
  std::vector<std::uint32_t> hull_;
};

}  // namespace tessera::cells
