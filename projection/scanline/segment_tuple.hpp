// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "projection/ray_segments.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::projection {

/// A ray segment in the format of Juliachs et al. 2007 (4.1): four floats.
struct SegmentTuple {
  float z_back;  ///< eye depth where the ray leaves the cell, world units
  float length;  ///< divided by the longest edge of the data set, so between 0 and 1
  float scalar_front, scalar_back;
  bool operator==(const SegmentTuple&) const = default;
};
static_assert(sizeof(SegmentTuple) == 16);

/// The depths of a tuple in RaySegments: back = z_back, front = z_back - length * longest_edge.
struct SegmentDepths {
  double front, back;
};
SegmentDepths depths_of(float z_back, float length, float longest_edge);

/// Returns the tuple of segment i, exactly the four floats that rasterize_scanline() computed with this longest edge.
/// (Front and back determine these floats because a length is a difference of two float depths, which is zero or at
/// least 2^-25 of the depth, while double rounds by 2^-53.)
SegmentTuple to_tuple(const RaySegments& segments, std::size_t i, float longest_edge);

/// Writes the tuple as segment i, which must exist. This is the inverse of to_tuple().
void from_tuple(const SegmentTuple& tuple, std::uint32_t pixel, std::uint32_t tet, float longest_edge,
                RaySegments& segments, std::size_t i);

/// Returns the longest edge of all tets, rounded to float; 1 if all edges have length zero. For several meshes that are
/// parts of one data set, use the largest of their longest edges. Runs in the caller's task arena (oneTBB).
float longest_edge(const scene::TetMeshView& mesh);

}  // namespace tessera::projection
