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

/// All points p with dot(p - point, normal) >= 0: what lies where the normal points to from a plane through `point`,
/// and the plane. World units; the normal may have any length but 0.
struct HalfSpace {
  glm::dvec3 point{0}, normal{0, 0, 1};
  bool operator==(const HalfSpace&) const = default;
};

/// The inside of a box as six half-spaces.
TESSERA_EXPORT std::array<HalfSpace, 6> half_spaces_of(const Box& box);

/// Which part of a data set is kept. First whole cells by their values, then what of them lies in all half-spaces.
///
/// Threshold  keeps cells of the file (of grids voxels), whatever tets are made of them: of cell data by its value,
///            of point data those whose points' values are all from the first number to the second, both included (of
///            cells of higher order: at the corners of the tets that they are divided into).
/// Clip       cells are cut exactly: a tet that a plane goes through becomes up to three, whose new corners have the
///            value of the linear field there. Cells that share a face cut it alike, whatever piece of a file or rank
///            they are on, for a cut edge is divided from its end that comes first by position, and what is left is
///            split as wedges and pyramids of files are. Corners within the rounding of their distance to a plane
///            count as on it, so that planes through vertices leave no splinters.
///            Corners there that have one of `levels` but for rounding (a part in 1e12) have it exactly: an iso-surface
///            that coincides with a plane is seen all over what is cut if what is left lies below its value, and
///            nowhere if it lies above. In grids that holds of all values (to a part in 1e10).
/// Grids      Samples out of the threshold's range are blank, so voxels that have one are left out. Rays are cut where
///            they meet a plane; bounds are those of what is left, and a plane does not change the range.
struct Selection {
  std::vector<HalfSpace> clip;
  std::optional<std::array<double, 2>> threshold{};
  std::vector<double> levels{};  ///< values of the field to which corners on planes are true: those of iso-surfaces

  [[nodiscard]] bool all() const { return clip.empty() && !threshold; }
  bool operator==(const Selection&) const = default;
};

/// Throws Error(bad_input) for a plane that is not finite or has no normal, and a threshold that is no range.
TESSERA_EXPORT void validate(const Selection& selection);

}  // namespace v0_1
}  // namespace tessera
