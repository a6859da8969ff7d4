// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace tessera::cells {

/// A polygon of a surface, by point indices.
using Polygon = std::vector<std::uint32_t>;

/// A planar piece of a surface: usually one polygon; .poly files may add inner rims, lines and points in the plane.
struct Facet {
  std::vector<Polygon> polygons;
  std::vector<glm::dvec3> holes;  ///< a point in each hole of the plane
};

/// A closed surface that TetGen fills. Every polygon index is < points.size().
struct Surface {
  std::vector<glm::dvec3> points;
  std::vector<Facet> facets;
  std::vector<glm::dvec3> cavities;  ///< a point in each part of space that stays empty
  /// Values at the points as the file gives them, one vector an attribute. May be empty.
  std::vector<std::vector<double>> attributes;
};

/// Makes points at one place one point, drops polygons that this collapses. What STL has no other way to say.
void merge_coincident_points(Surface& surface);

/// Cuts facets of one polygon that are not flat into triangles, as faces of polyhedra are: to TetGen a facet is a
/// plane.
void cut_warped_facets(Surface& surface);

/// Throws Error(bad_input) naming an edge that belongs to one polygon only. Facets of several polygons are TetGen's to
/// judge, with them this checks nothing.
void require_closed(const Surface& surface, const std::string& source);

/// Volume inside, from the polygons' signed cones; right if all polygons turn one way, else too small.
double enclosed_volume(const Surface& surface);

}  // namespace tessera::cells
