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

/// All points p with dot(p - point, normal) >= 0: the plane through `point` and the half of space into which `normal`
/// points. World units. The normal may have any length but 0.
struct HalfSpace {
  glm::dvec3 point{0}, normal{0, 0, 1};
  bool operator==(const HalfSpace&) const = default;
};

/// Returns the six half-spaces whose intersection is the box.
TESSERA_EXPORT std::array<HalfSpace, 6> half_spaces_of(const Box& box);

/// The part of a data set to keep: first the cells whose values are within the threshold, then the parts of these cells
/// inside all half-spaces.
///
/// Threshold  Whole cells of the file (voxels of grids) are kept, not single tets. A cell with cell data is kept if its
///            value is in the closed range. A cell with point data is kept if the values of all its points are in the
///            range; for cells of higher order these are the corners of the tets into which they are divided.
/// Clip       Cells are cut exactly: a tet that a plane crosses is replaced by up to three tets, whose new corners have
///            the value of the linear field at their position. Two cells that share a face cut it in the same way, even
///            if they are in different pieces of a file or on different ranks, because a cut edge is always divided
///            starting from the end that comes first by position, and the remaining part is split like wedges and
///            pyramids of files. Corners whose distance to a plane is within its rounding error are treated as on the
///            plane, so that planes through vertices leave no splinters. New corners whose value equals one of `levels`
///            up to rounding (1e-12 relative) get this value exactly. An iso-surface that coincides with a plane is
///            therefore visible on the whole cut if the remaining part is below the level, and nowhere if it is above.
///            In grids this is true for all values (to 1e-10).
/// Grids      Samples outside the threshold's range are blank, so voxels with such a sample are left out. Rays are cut
///            where they meet a plane. The bounds are those of the remaining part. A plane does not change the range of
///            values.
struct Selection {
  std::vector<HalfSpace> clip;
  std::optional<std::array<double, 2>> threshold{};
  std::vector<double> levels{};  ///< values of iso-surfaces, which the new corners on planes reproduce exactly

  [[nodiscard]] bool all() const { return clip.empty() && !threshold; }
  bool operator==(const Selection&) const = default;
};

/// Throws Error(bad_input) for a plane that is not finite or has no normal, and for an invalid threshold range.
TESSERA_EXPORT void validate(const Selection& selection);

}  // namespace v0_1
}  // namespace tessera
