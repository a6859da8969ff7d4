// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "io/volume/nrrd_fields.hpp"
#include "io/volume/volume_formats.hpp"

/// Axes of an NRRD file and where they lead. Source: Kindlmann, "Definition of NRRD File Format",
/// teem.sourceforge.net/nrrd/format.html, sections 5 and 7.
namespace tessera::io {

/// Which axes are those of space, and what the others hold.
struct NrrdAxes {
  enum class Use { space, components, steps, nothing };  ///< nothing: one sample only

  std::vector<Use> uses;             ///< one an axis, the fastest first
  std::array<std::size_t, 3> space;  ///< their numbers, with none but axes of nothing between them
  std::string note{};                ///< where the header leaves open which they are

  [[nodiscard]] bool is_before(std::size_t axis) const { return axis < space[0]; }
};

/// By `space directions`, which has no direction in space for the other axes, else by the words of `kinds`. Without
/// either a short first of four axes holds components, else the last holds time steps; of five both. A list and the
/// fourth axis of a space of four dimensions, as ITK writes it, are time steps. Throws Error(bad_input).
NrrdAxes nrrd_axes_of(const NrrdFields& fields, const std::vector<std::int64_t>& sizes,
                      const std::filesystem::path& file);

/// Of the steps along an axis that has spacings, both ends, or a direction along the fourth dimension of space, such as
/// that of `-time` (whose origin is the fourth number of `space origin`); else, and of lists, none.
std::vector<double> nrrd_times(const NrrdFields& fields, const NrrdAxes& axes, const std::vector<std::int64_t>& sizes,
                               const std::filesystem::path& file);

/// Whether the axis of components holds colors, by its word of `kinds`: true, false of vectors, or not known.
std::optional<bool> has_color_axis(const NrrdFields& fields, const NrrdAxes& axes);

/// Spacing, directions and origin in a right-handed world, what the file says of a body, and notes.
///
/// space     right-anterior-superior and left-posterior-superior stay as they are; any other order or direction of a
///           body's axes, left-anterior-superior for one, becomes right-anterior-superior. 3D-left-handed is mirrored
///           along x. With `-time` all mean the same.
/// spacing   `space directions`, else `spacings`, else (axis max - axis min) over the steps between samples; an axis
///           with `centers: cell` has half a step more at both ends.
void set_nrrd_geometry(const NrrdFields& fields, const NrrdAxes& axes, const std::vector<std::int64_t>& sizes,
                       const std::filesystem::path& file, StoredVolume& volume);

}  // namespace tessera::io
