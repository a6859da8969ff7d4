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

/// Axes of an NRRD file and their directions. Source: Kindlmann, "Definition of NRRD File Format",
/// teem.sourceforge.net/nrrd/format.html, sections 5 and 7.
namespace tessera::io {

/// The roles of the axes: which are spatial and what the others contain.
struct NrrdAxes {
  enum class Use { space, components, steps, nothing };  ///< nothing: a single sample

  std::vector<Use> uses;             ///< one per axis, the fastest first
  std::array<std::size_t, 3> space;  ///< indices of the spatial axes; only axes of one sample are between them
  std::string note{};                ///< set if the header does not determine the roles

  [[nodiscard]] bool is_before(std::size_t axis) const { return axis < space[0]; }
};

/// Uses `space directions`, in which the other axes have no direction, otherwise the words of `kinds`. Without either,
/// a short first of four axes contains components, otherwise the last contains time steps; with five axes both. A list,
/// and the fourth axis of a four-dimensional space as ITK writes it, are time steps. Throws Error(bad_input).
NrrdAxes nrrd_axes_of(const NrrdFields& fields, const std::vector<std::int64_t>& sizes,
                      const std::filesystem::path& file);

/// The times of the steps if their axis has spacings, both ends, or a direction along the fourth dimension of space, as
/// in `-time` (whose origin is the fourth number of `space origin`). Otherwise, and for lists, empty.
std::vector<double> nrrd_times(const NrrdFields& fields, const NrrdAxes& axes, const std::vector<std::int64_t>& sizes,
                               const std::filesystem::path& file);

/// Whether the axis of components holds colors, according to its word of `kinds`: true, false for vectors, no value if
/// unknown.
std::optional<bool> has_color_axis(const NrrdFields& fields, const NrrdAxes& axes);

/// Sets spacing, directions and origin in a right-handed world, the file's anatomical axes, and notes.
///
/// space     right-anterior-superior and left-posterior-superior are kept; any other order or direction of anatomical
///           axes, for example left-anterior-superior, becomes right-anterior-superior. 3D-left-handed is mirrored
///           along x. The variants with `-time` mean the same.
/// spacing   `space directions`, else `spacings`, else (axis max - axis min) over the steps between samples; an axis
///           with `centers: cell` extends half a step further at both ends.
void set_nrrd_geometry(const NrrdFields& fields, const NrrdAxes& axes, const std::vector<std::int64_t>& sizes,
                       const std::filesystem::path& file, StoredVolume& volume);

}  // namespace tessera::io
