// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tessera/association.hpp"
#include "tessera/camera.hpp"
#include "tessera/export.hpp"

namespace tessera {
inline namespace v0_1 {

/// Type in which a sample is stored. Readers convert other types (64-bit integers, bits) to float64 or uint8.
enum class SampleType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of one sample: 1, 2, 4 or 8.
TESSERA_EXPORT std::size_t size_of(SampleType type);
/// "uint8", "float32", ...
TESSERA_EXPORT const char* name_of(SampleType type);
/// Returns the type of this name; "float" and "double" are also names. Returns none for an unknown name.
TESSERA_EXPORT std::optional<SampleType> sample_type_named(const std::string& name);
TESSERA_EXPORT bool is_float(SampleType type);
/// Whether single precision represents every number of the type.
TESSERA_EXPORT bool fits_float(SampleType type);

/// Indices or counts along the axes i, j, k. The index i varies fastest in memory and in files.
using GridIndex = std::array<std::int64_t, 3>;

/// The samples with low <= (i, j, k) < high. The box is empty if low >= high along any axis.
struct SampleBox {
  GridIndex low{0, 0, 0}, high{0, 0, 0};

  [[nodiscard]] std::int64_t extent(std::size_t axis) const { return high[axis] - low[axis]; }
  [[nodiscard]] std::int64_t count() const {
    return extent(0) <= 0 || extent(1) <= 0 || extent(2) <= 0 ? 0 : extent(0) * extent(1) * extent(2);
  }
  bool operator==(const SampleBox&) const = default;
};

/// The position of the lattice of a regular or rectilinear grid.
///
/// Frames  index: (0, 0, 0) is the first lattice point; lattice points have whole numbers, places between them
///         fractions.
///         local: lengths along the grid's own axes. Regular: index * spacing. Rectilinear: coordinates[axis][index].
///         world: origin + direction * local.
/// Data    Point data have a sample at every lattice point and are trilinear between lattice points. Cell data have a
///         sample for each voxel, one fewer than lattice points along each axis, and are constant in the voxel. In both
///         cases the volume is the box between the first and the last lattice point, and voxel (i, j, k) is between
///         lattice points (i, j, k) and (i + 1, j + 1, k + 1).
/// Units   Lengths are in the world units of the file. All indices are int64, so 2048^3 samples and more can be
///         addressed.
/// Holds   validate() checks: at least two lattice points along each axis; spacing > 0; if an axis has coordinates,
///         there is one per lattice point, and they increase strictly; the columns of `direction` have unit length and
///         are linearly independent; all numbers are finite. The columns may have either handedness and need not be
///         orthogonal (NIfTI may shear).
struct GridGeometry {
  GridIndex points{0, 0, 0};  ///< lattice points along each axis
  Association association = Association::point;
  glm::dvec3 origin{0};       ///< world position of local (0, 0, 0)
  glm::dmat3 direction{1.0};  ///< column a: unit vector of the grid's axis a in the world
  glm::dvec3 spacing{1.0};    ///< world units between lattice points; unused along rectilinear axes
  std::array<std::vector<double>, 3> coordinates;  ///< rectilinear: local coordinates of lattice points; else empty

  /// Samples along each axis.
  [[nodiscard]] GridIndex samples() const {
    const std::int64_t fewer = association == Association::cell ? 1 : 0;
    return {points[0] - fewer, points[1] - fewer, points[2] - fewer};
  }
  [[nodiscard]] GridIndex voxels() const { return {points[0] - 1, points[1] - 1, points[2] - 1}; }
  [[nodiscard]] SampleBox all_samples() const { return {{0, 0, 0}, samples()}; }
  [[nodiscard]] bool rectilinear(std::size_t axis) const { return !coordinates[axis].empty(); }
  [[nodiscard]] bool rectilinear() const { return rectilinear(0) || rectilinear(1) || rectilinear(2); }

  /// Local coordinate of lattice point `index` along `axis`. Every call returns the same double for the same point.
  [[nodiscard]] double lattice(std::size_t axis, std::int64_t index) const {
    return coordinates[axis].empty() ? spacing[static_cast<int>(axis)] * static_cast<double>(index)
                                     : coordinates[axis][static_cast<std::size_t>(index)];
  }

  bool operator==(const GridGeometry&) const = default;
};

/// World position of a continuous lattice index. Outside the lattice, the first and the last spacing are continued.
TESSERA_EXPORT glm::dvec3 world_of_index(const GridGeometry& geometry, const glm::dvec3& index);
/// The inverse of world_of_index().
TESSERA_EXPORT glm::dvec3 index_of_world(const GridGeometry& geometry, const glm::dvec3& p_world);
/// Inverse of `direction`: local = world_to_local * (world - origin).
TESSERA_EXPORT glm::dmat3 world_to_local(const GridGeometry& geometry);

/// World box that contains the eight corners of the volume.
TESSERA_EXPORT Box bounds(const GridGeometry& geometry);

/// The grid's volume divided by the area of the largest face of bounds(), in world units. The value is comparable to
/// scene::mean_thickness() of a mesh of the same object.
TESSERA_EXPORT double mean_thickness(const GridGeometry& geometry);

/// The description of a volume, without its samples. Every reader provides it, and every renderer needs it first.
///
/// Value   The field's value is scale * sample + shift (NIfTI's slope and intercept). Transfer functions, ranges and
///         images refer to the value. `scale` and `shift` are finite, and `scale` is not zero. Trilinear interpolation
///         commutes with the conversion.
/// Blank   A sample that is NaN or infinite is blank. A voxel with a blank corner or, for cell data, a blank sample is
///         not part of the volume: it neither absorbs nor emits light. Readers convert integer files with blanks (ghost
///         arrays) to a float type with NaN.
struct Grid {
  GridGeometry geometry;
  SampleType type = SampleType::float32;  ///< as stored
  double scale = 1, shift = 0;
  std::string field_name{};  ///< name of the chosen field, with its component: "Velocity:mag"

  [[nodiscard]] double value(double sample) const { return scale * sample + shift; }
};

/// Throws Error(bad_input) if the invariants of Grid or GridGeometry do not hold. The message begins with `source` and
/// states what is wrong and along which axis.
TESSERA_EXPORT void validate(const Grid& grid, const std::string& source);

}  // namespace v0_1
}  // namespace tessera
