// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace tessera::cells {

/// A polygon of a surface, as indices of points.
using Polygon = std::vector<std::uint32_t>;

/// A planar piece of a surface: usually one polygon. In .poly files it may also have inner boundaries, lines and points
/// in the plane.
struct Facet {
  std::vector<Polygon> polygons;
  std::vector<glm::dvec3> holes;  ///< a point in each hole of the facet
};

/// A closed surface that TetGen fills. Every polygon index is < points.size().
struct Surface {
  std::vector<glm::dvec3> points;
  std::vector<Facet> facets;
  std::vector<glm::dvec3> cavities;  ///< a point in each region that stays empty
  /// Values at the points as stored in the file, one vector per attribute. May be empty.
  std::vector<std::vector<double>> attributes;
};

/// Merges coincident points and drops polygons that collapse. Needed for STL files, whose polygons cannot share points.
void merge_coincident_points(Surface& surface);

/// Cuts facets that consist of a single polygon and are not flat into triangles, like faces of polyhedra, because
/// TetGen requires planar facets.
void cut_warped_facets(Surface& surface);

/// Throws Error(bad_input) naming an edge that belongs to only one polygon. Does not check surfaces with facets of
/// several polygons; TetGen then detects open surfaces.
void require_closed(const Surface& surface, const std::string& source);

/// Returns the enclosed volume, as the sum of the polygons' signed cones. It is correct if all polygons have the same
/// orientation, otherwise too small.
double enclosed_volume(const Surface& surface);

}  // namespace tessera::cells
