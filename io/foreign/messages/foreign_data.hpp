// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cells/number_tally.hpp"
#include "scene/grid.hpp"
#include "scene/number_type.hpp"
#include "scene/time_step_read.hpp"
#include "tessera/array.hpp"

namespace tessera::io {

/// Description of a file that the helper program (readers/README.md) has read with a third-party library. The numbers
/// stay in the helper until they are requested, one array at a time.

using scene::size_of;
using scene::with_number_type;
using tessera::NumberType;

/// Writes tuples [first, first + out.size()) of an array as doubles: one component, or, for `component` = `magnitude`
/// (cells/cell_block.hpp), the lengths of the tuples. `bytes` contains the whole array, aligned for its type.
void read_tuples(std::span<const std::byte> bytes, NumberType type, int components, int component, std::size_t first,
                 std::span<double> out);

/// An array held by the helper.
struct ForeignArray {
  std::uint64_t number = 0;  ///< identifies the array in requests
  std::string name{};
  NumberType type = NumberType::float64;
  int components = 1;
  std::uint64_t tuples = 0;
  bool active = false;         ///< the file marks the array as its scalars or vectors
  bool ids = false;            ///< the file marks the array as ids
  cells::NumberTally tally{};  ///< fields only

  [[nodiscard]] std::size_t tuple_bytes() const { return static_cast<std::size_t>(components) * size_of(type); }
  [[nodiscard]] std::uint64_t bytes() const { return tuples * tuple_bytes(); }
};

/// One data set of a file.
///
/// unstructured  points, connectivity (uint32; its largest value replaces indices that do not fit); if all cells are
///               tets, tuples of four; otherwise types (uint8, VTK's) and offsets (cells + 1); for polyhedra faces
///               (uint32 like connectivity) and the position of each cell in it (int64, -1 for other cells), see
///               CellBlock
/// surface       points; offsets and connectivity of its polygons
/// structured    points, extent
/// rectilinear   three arrays of coordinates, extent
/// image         extent, origin of index 0, spacing, direction (row by row)
/// trees         leaves of cells that are repeatedly divided into branching^3: extent and three arrays of coordinates
///               of the root cells; points (int32), the lowest corners of the leaves, counted from 0 in cells of the
///               finest of `levels`; types (uint8), the levels of the leaves; cell fields of the leaves
struct ForeignPart {
  enum class Kind : std::uint8_t { unstructured, surface, structured, rectilinear, image, trees };

  Kind kind = Kind::unstructured;
  std::string name;                      ///< empty if it is the only part
  std::array<std::int64_t, 6> extent{};  ///< first and last point index along each axis
  std::array<double, 3> origin{}, spacing{};
  std::array<double, 9> direction{};
  std::optional<ForeignArray> points, types, offsets, connectivity, faces, face_locations;
  std::vector<ForeignArray> coordinates;  ///< three arrays for a rectilinear grid or trees; otherwise empty
  int branching = 0, levels = 0;
  std::vector<ForeignArray> point_fields, cell_fields;
};

struct ForeignContents {
  std::vector<ForeignPart> parts;
  std::vector<std::string> notes;
  std::string format;
  std::string modality{}, unit{};            ///< modality, and unit of the values, of a patient's image; may be empty
  std::vector<std::string> block_names{};    ///< names of all blocks, if blocks are not parts; otherwise empty
  std::vector<std::string> surface_names{};  ///< names of surfaces left out because the file has volume cells
  scene::TimeStepRead time_step{};
  bool labels = false;         ///< the values are declared to be labels
  bool xy_in_degrees = false;  ///< x and y are degrees, z is a length
  bool has_levels = false;     ///< the parts are images: blocks of several refinement levels
};

/// Serializes the contents as CBOR (RFC 8949). contents_of() is the inverse and throws std::exception for other bytes.
std::vector<std::uint8_t> bytes_of(const ForeignContents& contents);
ForeignContents contents_of(std::span<const std::uint8_t> bytes);

}  // namespace tessera::io
