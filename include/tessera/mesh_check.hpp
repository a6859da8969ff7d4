// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

namespace tessera {
inline namespace v0_1 {

/// Hears which share of a check is done, 0 to 1: some hundred times, in order. It must not throw.
using CheckProgressFunction = std::function<void(double)>;

/// What a mesh has that a mesh should not have. None of it stops a picture; overlapping cells alone make it wrong, as
/// each of them contributes.
///
/// By position   points that coincide count as one, so that seams and pieces are no cracks.
/// Cost          n log n for sorting faces and points and for the trees; the tests of pairs go with the mesh's surface
///               and with the overlaps there are, of which at most `most_overlaps` pairs of tets are followed.
struct MeshCheck {
  static constexpr std::size_t most_overlaps = 1'000'000, most_places = 5;

  /// Where the first ones are (the worst ones, of slivers); no cell or pair of cells twice.
  struct Place {
    std::uint64_t cell = 0;   ///< of the file, counted from 0
    std::uint64_t other = 0;  ///< the second cell of a pair, never below the first; else the same
    glm::dvec3 at{0};         ///< centre of the tet, or the point
    double value = 0;         ///< of slivers: the aspect ratio
  };
  struct Finding {
    std::uint64_t count = 0;
    std::vector<Place> places;  ///< at most `most_places`
  };

  std::uint64_t tets = 0, points = 0;

  /// Used points at the place of an earlier one.
  Finding duplicate_points;
  /// Tets of no volume: the determinant is zero to rounding (1e-14 of the product of its edges).
  Finding flat;
  /// Tets that are not flat and whose longest edge is more than 100 times their smallest height; of these more than
  /// 1e4 and 1e6 times; the worst.
  Finding slivers;
  std::uint64_t slivers_1e4 = 0, slivers_1e6 = 0;
  double worst_aspect = 0;
  /// Orientation by the order of corners. Either is fine; `inverted` are tets that lie on the same side of a face as
  /// the neighbour they share it with, both of the pair: folds.
  std::uint64_t left_handed = 0, right_handed = 0;
  Finding inverted;
  /// Faces of the boundary that lie in one plane (to 1e-6 of their edges) with another that faces them, and cover a
  /// part of it: hanging nodes, or a quadrilateral cut along different diagonals. The picture is right where they match
  /// in space; a face that only one cell has is not shared to the bit.
  Finding non_conforming_faces;
  /// Pairs of cells with tets, neither flat nor above an aspect of 1e6, that share more than 1e-6 of the smaller one's
  /// longest edge along every direction. A cell so warped that its own tets overlap is a pair with itself. Found from
  /// the boundary: where cells overlap but neither folds nor boundary faces lie inside other cells, there is no
  /// overlap, as the number of cells over a point changes only there.
  Finding overlaps;
  bool more_overlaps = false;           ///< than were followed
  std::uint64_t overlapping_cells = 0;  ///< cells that are in such a pair

  [[nodiscard]] bool clean() const {
    return overlaps.count == 0 && inverted.count == 0 && non_conforming_faces.count == 0;
  }
};

}  // namespace v0_1
}  // namespace tessera
