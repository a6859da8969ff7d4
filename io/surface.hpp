#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tessera::io {

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

/// Tets inside a surface. Points of the surface come first.
struct FilledSurface {
  std::vector<glm::dvec3> points;
  std::vector<std::uint32_t> tets;       ///< four a tet
  std::vector<std::uint32_t> triangles;  ///< three a boundary or facet triangle
};

/// Whether this build links TetGen (CMake option TESSERA_TETGEN).
bool can_fill_surfaces();

/// Fills a closed surface by TetGen (Si, "TetGen, a Delaunay-Based Quality Tetrahedral Mesh Generator", ACM TOMS 2015)
/// with tets of at most `max_volume` and radius-edge ratio 2, or with none but the surface's own points where that can
/// be. Throws Error(bad_input, "SOURCE: ...") if the surface is not
/// closed, cuts itself or TetGen gives up, and always without TESSERA_TETGEN.
FilledSurface fill_surface(const Surface& surface, std::optional<double> max_volume, const std::string& source);

/// Makes points at one place one point, drops polygons that this collapses. What STL has no other way to say.
void merge_coincident_points(Surface& surface);

/// Throws Error(bad_input) naming an edge that belongs to one polygon only. Facets of several polygons are TetGen's to
/// judge, with them this checks nothing.
void require_closed(const Surface& surface, const std::string& source);

/// Volume inside, from the polygons' signed cones; right if all polygons turn one way, else too small.
double enclosed_volume(const Surface& surface);

/// Gives points from number `known` on the mean of their neighbours in the tets, ring after ring.
void fill_unknown(const FilledSurface& mesh, std::size_t known, std::vector<double>& values);

}  // namespace tessera::io
