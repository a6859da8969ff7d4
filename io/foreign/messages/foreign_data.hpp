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

/// What the helper program (readers/README.md) says of a file that it has read with somebody else's library. The
/// numbers stay there until they are asked for, an array at a time.

using scene::size_of;
using scene::with_number_type;
using tessera::NumberType;

/// Tuples [first, first + out.size()) of an array as doubles: one component, or their lengths (`magnitude`,
/// cells/cell_block.hpp). The bytes hold them all, aligned as the type wants.
void read_tuples(std::span<const std::byte> bytes, NumberType type, int components, int component, std::size_t first,
                 std::span<double> out);

/// An array that the helper holds.
struct ForeignArray {
  std::uint64_t number = 0;  ///< what it is asked for by
  std::string name{};
  NumberType type = NumberType::float64;
  int components = 1;
  std::uint64_t tuples = 0;
  bool active = false;         ///< the file marks it as its scalars or vectors
  bool ids = false;            ///< the file marks it as ids
  cells::NumberTally tally{};  ///< of fields

  [[nodiscard]] std::size_t tuple_bytes() const { return static_cast<std::size_t>(components) * size_of(type); }
  [[nodiscard]] std::uint64_t bytes() const { return tuples * tuple_bytes(); }
};

/// One data set of a file.
///
/// unstructured  points, connectivity (uint32, the largest of which stands for what it cannot hold); of tets alone a
///               tuple of four each, of others types (uint8, VTK's) and offsets (cells + 1); of polyhedra faces (uint32
///               as connectivity) and the place of each cell's there (int64, -1 of other cells), see CellBlock
/// surface       points; offsets and connectivity of its polygons
/// structured    points, extent
/// rectilinear   three arrays of coordinates, extent
/// image         extent, origin of index 0, spacing, direction (row by row)
/// trees         leaves of cells divided into branching^3 again and again: extent and three arrays of coordinates of
/// the
///               cells that were divided first; points (int32), the leaves' lowest corners from 0 in cells of the last
///               of `levels`; types (uint8), the leaves' levels; cell fields of the leaves
struct ForeignPart {
  enum class Kind : std::uint8_t { unstructured, surface, structured, rectilinear, image, trees };

  Kind kind = Kind::unstructured;
  std::string name;                      ///< empty if it is the only one
  std::array<std::int64_t, 6> extent{};  ///< first and last point along each axis
  std::array<double, 3> origin{}, spacing{};
  std::array<double, 9> direction{};
  std::optional<ForeignArray> points, types, offsets, connectivity, faces, face_locations;
  std::vector<ForeignArray> coordinates;  ///< three of a rectilinear grid or trees, none of others
  int branching = 0, levels = 0;
  std::vector<ForeignArray> point_fields, cell_fields;
};

struct ForeignContents {
  std::vector<ForeignPart> parts;
  std::vector<std::string> notes;
  std::string format;
  std::string modality{}, unit{};            ///< of a patient's picture, of its values; may be empty
  std::vector<std::string> block_names{};    ///< of all blocks, where parts are not the blocks; empty: of the parts
  std::vector<std::string> surface_names{};  ///< of surfaces beside the volume, where they are left out
  scene::TimeStepRead time_step{};
  bool labels = false;          ///< values are labels, whatever they are
  bool beside_degrees = false;  ///< x and y are degrees, z is a length
  bool has_levels = false;      ///< the parts, images, are blocks of several levels of refinement
};

/// As bytes (CBOR, RFC 8949) and back. contents_of() throws std::exception for bytes of anything else.
std::vector<std::uint8_t> bytes_of(const ForeignContents& contents);
ForeignContents contents_of(std::span<const std::uint8_t> bytes);

}  // namespace tessera::io
