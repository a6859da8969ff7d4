// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

namespace tessera {
inline namespace v0_1 {

/// Called about a hundred times during a check, with the completed fraction (0 to 1, increasing). Must not throw.
using CheckProgressFunction = std::function<void(double)>;

/// Defects of a mesh. None of them prevents rendering. Only overlapping cells make the image wrong, because every cell
/// contributes to the image.
///
/// By position   Points with the same position are treated as one point, so that seams between pieces are not reported
///               as cracks.
/// Cost          Sorting faces and points and building the trees take time in proportion to n log n. The number of
///               tested pairs grows with the mesh's surface and with the number of overlaps; at most `most_overlaps`
///               pairs of tets are examined.
struct MeshCheck {
  static constexpr std::size_t most_overlaps = 1'000'000, most_places = 5;

  /// Location of a defect. If there are many, the first defects are listed; for slivers, the worst are listed. No cell
  /// or pair of cells is listed twice.
  struct Place {
    std::uint64_t cell = 0;   ///< number of the cell in the file, counted from 0
    std::uint64_t other = 0;  ///< the second cell of a pair, never below `cell`; equal to `cell` if the defect is not
                              ///< of a pair
    glm::dvec3 at{0};         ///< centre of the tet, or the point
    double value = 0;         ///< for slivers: the aspect ratio
  };
  struct Finding {
    std::uint64_t count = 0;
    std::vector<Place> places;  ///< at most `most_places`
  };

  std::uint64_t tets = 0, points = 0;

  /// Points that are used by cells and have the position of an earlier point.
  Finding duplicate_points;
  /// Tets without volume: the determinant is zero up to rounding (1e-14 of the product of the edge lengths).
  Finding flat;
  /// Tets that are not flat and whose longest edge is more than 100 times their smallest height (aspect ratio). The
  /// next members are the numbers of slivers with an aspect ratio above 1e4 and above 1e6, and the largest aspect
  /// ratio.
  Finding slivers;
  std::uint64_t slivers_1e4 = 0, slivers_1e6 = 0;
  double worst_aspect = 0;
  /// Numbers of tets for each orientation, which is given by the order of corners. Both orientations are valid.
  /// `inverted` contains folds: pairs of tets that share a face and are on the same side of it. Both tets of a pair are
  /// counted.
  std::uint64_t left_handed = 0, right_handed = 0;
  Finding inverted;
  /// Boundary faces that overlap a boundary face on the other side of the same plane (to 1e-6 of their edges), at
  /// hanging nodes or where a quadrilateral is cut along different diagonals. The image is correct where such faces
  /// match in space. However, they do not match bit for bit, unlike a face that two cells share.
  Finding non_conforming_faces;
  /// Pairs of cells whose tets overlap along every direction by more than 1e-6 of the smaller tet's longest edge. Tets
  /// that are flat or have an aspect ratio above 1e6 are ignored. A cell so warped that its own tets overlap is a pair
  /// with itself. Overlaps are searched from the boundary: the number of cells that contain a point changes only at
  /// folds and at boundary faces, so every overlap comes with a fold or a boundary face inside another cell.
  Finding overlaps;
  bool more_overlaps = false;           ///< there were more overlaps than `most_overlaps`; not all were examined
  std::uint64_t overlapping_cells = 0;  ///< number of cells in overlapping pairs

  [[nodiscard]] bool clean() const {
    return overlaps.count == 0 && inverted.count == 0 && non_conforming_faces.count == 0;
  }
};

}  // namespace v0_1
}  // namespace tessera
