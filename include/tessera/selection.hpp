// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "tessera/camera.hpp"
#include "tessera/export.hpp"

namespace tessera {
inline namespace v0_1 {

/// All points p with dot(p - point, normal) >= 0: the plane through `point` and the side to which the normal points.
/// World units; the normal may have any length but 0.
struct HalfSpace {
  glm::dvec3 point{0}, normal{0, 0, 1};
  bool operator==(const HalfSpace&) const = default;
};

/// The inside of a box as six half-spaces.
TESSERA_EXPORT std::array<HalfSpace, 6> half_spaces_of(const Box& box);

/// The part of a data set to keep. First whole cells are kept by their values, then the parts of them inside all
/// half-spaces.
///
/// Threshold  keeps cells of the file (voxels of grids), whatever tets are made from them. A cell with cell data is
///            kept if its value is in the closed range, one with point data if the values of all its points are (for
///            cells of higher order: at the corners of the tets into which they are divided).
/// Clip       cells are cut exactly: a tet that a plane crosses becomes up to three, whose new corners have the value
///            of the linear field there. Cells that share a face cut it the same way, whatever piece of a file or rank
///            they are on, because a cut edge is always divided starting from its end that comes first by position, and
///            the remaining part is split as wedges and pyramids of files are. Corners within the rounding error of
///            their distance to a plane count as on it, so that planes through vertices leave no splinters. New corners
///            whose value equals one of `levels` up to rounding (1e-12 relative) get it exactly: an iso-surface that
///            coincides with a plane is visible over the whole cut if the remaining part is below its value, and
///            nowhere if it is above. In grids this holds for all values (to 1e-10).
/// Grids      Samples outside the threshold's range are blank, so voxels that have one are left out. Rays are cut where
///            they meet a plane; the bounds are those of the remaining part, and a plane does not change the range.
struct Selection {
  std::vector<HalfSpace> clip;
  std::optional<std::array<double, 2>> threshold{};
  std::vector<double> levels{};  ///< values of iso-surfaces, which new corners on planes reproduce exactly

  [[nodiscard]] bool all() const { return clip.empty() && !threshold; }
  bool operator==(const Selection&) const = default;
};

/// Throws Error(bad_input) for a plane that is not finite or has no normal, and for an invalid threshold range.
TESSERA_EXPORT void validate(const Selection& selection);

}  // namespace v0_1
}  // namespace tessera
