#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
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

/// A surface filled by TetGen (Si, "TetGen, a Delaunay-Based Quality Tetrahedral Mesh Generator", ACM TOMS 2015) with
/// tets of at most `max_volume` and radius-edge ratio 2, and the fields that go with it.
struct FilledMesh {
  std::vector<glm::dvec3> points;
  std::vector<std::uint32_t> tets;              ///< four a tet
  std::vector<double> depth;                    ///< at the points: distance to the surface, world units
  std::vector<std::vector<double>> attributes;  ///< the surface's, at the points
};

/// How finely a surface is filled.
struct FillSize {
  double max_volume;  ///< of a tet, world units cubed
  double tets;        ///< about how many these are: the volume inside in units of `max_volume`
  bool is_chosen =
      false;  ///< by the user, who may know that it takes long: then 40 times as long, and 8 times the memory
};

/// By tessera-read-tetgen, which links TetGen; nothing else does. Throws Error(bad_input, "SOURCE: ...") if the surface
/// is not closed, cuts itself, TetGen gives up or takes more memory or time than the facets and tets explain
/// (io/helper/limits.cpp), or missing_reader().
FilledMesh fill_surface(const Surface& surface, const FillSize& size, const std::string& source);

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

}  // namespace tessera::io
