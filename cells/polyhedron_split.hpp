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

/// Splits polyhedra, one at a time, into tets that conform to those of the neighbouring cells.
///
/// Faces     are cut by face_triangles.hpp, using only the positions of their corners, and never get additional
///           points. So neighbours agree on shared faces whatever the indices, order and orientation of the corners,
///           and whatever kind of cell (cell_split.hpp, cells/amr/amr_cells.hpp) is on the other side.
/// Corners   that coincide are merged.
/// Cells     are cones from their smallest corner, which for tets, pyramids, wedges and hexahedra gives the result of
///           split_cell(). If that corner does not see the whole cell, they are cones from another corner or an inner
///           point; if no such point is found, they are cut up (surface_tets.hpp).
class PolyhedronSplitter {
 public:
  /// Splits a polyhedron. `faces` contains, for each face, the number of its corners, then the corners as indices of
  /// `positions`, which must be finite. No value if the faces do not form a closed surface.
  std::optional<SurfaceFill> split(std::span<const std::uint32_t> faces, std::span<const glm::dvec3> positions);

  /// Splits the convex hull of points. No value if there are more than most_hull_points points; no tets if the points
  /// are in one plane.
  std::optional<SurfaceFill> split_hull(std::span<const std::uint32_t> points, std::span<const glm::dvec3> positions);

  /// The tets, as indices of `positions`, or, after the last of these, of added().
  [[nodiscard]] const std::vector<scene::Tet>& tets() const { return tets_; }
  [[nodiscard]] const std::vector<glm::dvec3>& added() const { return added_; }
  /// Appends the value at each added point of a field that has `values` at `positions`. The result is exact for linear
  /// fields, and never outside the range of the values at the cell's corners.
  void add_values(std::span<const double> values, std::vector<double>& out);

  /// Whether all faces are cut from their smallest corners, like those of split_cell().
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
