// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "projection/ray_segments.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::projection {

/// A ray segment as Juliachs et al. 2007 (4.1) write it: four floats.
struct SegmentTuple {
  float z_back;  ///< eye depth where the ray leaves the cell, world units
  float length;  ///< over the longest edge of the data set, so 0 to 1
  float scalar_front, scalar_back;
  bool operator==(const SegmentTuple&) const = default;
};
static_assert(sizeof(SegmentTuple) == 16);

/// What RaySegments holds of a tuple: back = z_back, front = z_back - length * longest_edge.
struct SegmentDepths {
  double front, back;
};
SegmentDepths depths_of(float z_back, float length, float longest_edge);

/// The tuple of segment i of a rasterize_scanline() with this longest edge: the very floats it made, all four. (They
/// come back from front and back because a length is a difference of two float depths, never below 2^-25 of the depth
/// unless zero, where double rounds by 2^-53.)
SegmentTuple to_tuple(const RaySegments& segments, std::size_t i, float longest_edge);

/// Writes the tuple as segment i, which must exist: the inverse of to_tuple().
void from_tuple(const SegmentTuple& tuple, std::uint32_t pixel, std::uint32_t tet, float longest_edge,
                RaySegments& segments, std::size_t i);

/// The longest edge of all tets, rounded to float; 1 if all are zero. Of several meshes that are parts of one data set:
/// take the largest. Work runs in the caller's task arena (oneTBB).
float longest_edge(const scene::TetMeshView& mesh);

}  // namespace tessera::projection
