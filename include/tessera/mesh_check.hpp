// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

namespace tessera {
inline namespace v0_1 {

/// Called with the completed fraction of a check, 0 to 1: about a hundred times, in increasing order. Must not throw.
using CheckProgressFunction = std::function<void(double)>;

/// Defects of a mesh. None of them prevents rendering; only overlapping cells make the image wrong, as each of them
/// contributes.
///
/// By position   points that coincide count as one, so that seams and pieces are not cracks.
/// Cost          n log n for sorting faces and points and for the trees. The tests of pairs grow with the mesh's
///               surface and with the number of overlaps; at most `most_overlaps` pairs of tets are followed.
struct MeshCheck {
  static constexpr std::size_t most_overlaps = 1'000'000, most_places = 5;

  /// Locations of the first defects (for slivers, of the worst); no cell or pair of cells occurs twice.
  struct Place {
    std::uint64_t cell = 0;   ///< in the file, counted from 0
    std::uint64_t other = 0;  ///< the second cell of a pair, never below the first; otherwise the same
    glm::dvec3 at{0};         ///< centre of the tet, or the point
    double value = 0;         ///< for slivers: the aspect ratio
  };
  struct Finding {
    std::uint64_t count = 0;
    std::vector<Place> places;  ///< at most `most_places`
  };

  std::uint64_t tets = 0, points = 0;

  /// Used points with the position of an earlier point.
  Finding duplicate_points;
  /// Tets without volume: the determinant is zero to rounding (1e-14 of the product of its edges).
  Finding flat;
  /// Tets that are not flat and whose longest edge is more than 100 times their smallest height; how many of them
  /// exceed 1e4 and 1e6; the largest ratio.
  Finding slivers;
  std::uint64_t slivers_1e4 = 0, slivers_1e6 = 0;
  double worst_aspect = 0;
  /// Orientation by the order of corners. Either is valid. `inverted` counts tets that are on the same side of a face
  /// as the neighbour that shares it (both tets of such a pair): folds.
  std::uint64_t left_handed = 0, right_handed = 0;
  Finding inverted;
  /// Boundary faces that are in one plane (to 1e-6 of their edges) with an opposite face and overlap it: hanging nodes,
  /// or a quadrilateral cut along different diagonals. The image is correct where they match in space, but a face that
  /// only one cell has is not shared to the bit.
  Finding non_conforming_faces;
  /// Pairs of cells with tets (neither flat nor above an aspect ratio of 1e6) that overlap along every direction by
  /// more than 1e-6 of the smaller tet's longest edge. A cell so warped that its own tets overlap is a pair with
  /// itself. Overlaps are found from the boundary: the number of cells over a point only changes at folds and at
  /// boundary faces, so there is no overlap without a fold or a boundary face inside another cell.
  Finding overlaps;
  bool more_overlaps = false;           ///< not all of them were followed
  std::uint64_t overlapping_cells = 0;  ///< cells in such a pair

  [[nodiscard]] bool clean() const {
    return overlaps.count == 0 && inverted.count == 0 && non_conforming_faces.count == 0;
  }
};

}  // namespace v0_1
}  // namespace tessera
