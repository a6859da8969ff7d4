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

/// Axes of an NRRD file and the directions of the axes. Source: Kindlmann, "Definition of NRRD File Format",
/// teem.sourceforge.net/nrrd/format.html, sections 5 and 7.
namespace tessera::io {

/// The roles of the axes: which axes are spatial and what the others contain.
struct NrrdAxes {
  enum class Use { space, components, steps, nothing };  ///< nothing: a single sample

  std::vector<Use> uses;             ///< one use per axis, the fastest axis first
  std::array<std::size_t, 3> space;  ///< indices of the spatial axes; axes between them have only one sample
  std::string note{};                ///< a note for the user if the header does not determine the roles

  [[nodiscard]] bool is_before(std::size_t axis) const { return axis < space[0]; }
};

/// Determines the roles from `space directions`, in which only spatial axes have a direction, otherwise from the words
/// of `kinds`. Without either, the first of four axes contains components if it is short, otherwise the last contains
/// time steps; of five axes, the first contains components and the last time steps. An axis of kind `list`, and the
/// fourth axis of a four-dimensional space as ITK writes it, contain time steps. Throws Error(bad_input).
NrrdAxes nrrd_axes_of(const NrrdFields& fields, const std::vector<std::int64_t>& sizes,
                      const std::filesystem::path& file);

/// Returns the times of the steps, if the header states spacings or both ends of their axis, or a direction along the
/// fourth dimension of a space with `-time` (the fourth number of `space origin` is then the first time). Otherwise,
/// and for lists, the result is empty.
std::vector<double> nrrd_times(const NrrdFields& fields, const NrrdAxes& axes, const std::vector<std::int64_t>& sizes,
                               const std::filesystem::path& file);

/// Whether the axis of components contains colors, according to its word of `kinds`: false for vectors, no value if the
/// word does not determine it.
std::optional<bool> has_color_axis(const NrrdFields& fields, const NrrdAxes& axes);

/// Sets spacing, directions and origin in a right-handed world, the anatomical axes of the file, and notes.
///
/// space     right-anterior-superior and left-posterior-superior are kept; any other order or direction of anatomical
///           axes, for example left-anterior-superior, becomes right-anterior-superior. 3D-left-handed is mirrored
///           along x. The variants with `-time` have the same meaning.
/// spacing   `space directions`, else `spacings`, else (axis max - axis min) divided by the number of steps between
///           samples; an axis with `centers: cell` extends half a step further at both ends.
void set_nrrd_geometry(const NrrdFields& fields, const NrrdAxes& axes, const std::vector<std::int64_t>& sizes,
                       const std::filesystem::path& file, StoredVolume& volume);

}  // namespace tessera::io
