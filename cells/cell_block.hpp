// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cells/number_tally.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::cells {

/// A component number that selects the length of the field's tuples instead of one component.
inline constexpr int magnitude = -1;

/// One array of a block. Its values are read on demand, so that only the chosen field is converted.
struct BlockField {
  std::string name;
  scene::Association association = scene::Association::point;
  int components = 1;
  std::string type;  ///< "float", "int64", ...
  std::size_t tuples = 0;
  bool active = false;                 ///< the file marks the array as its scalars or vectors
  bool ids = false;                    ///< the file marks the array as ids
  std::optional<NumberTally> tally{};  ///< set if it is known without reading the values
  /// Writes tuples [first, first + out.size()) of one component, or their magnitude, as doubles.
  std::function<void(int component, std::size_t first, std::span<double> out)> read;
};

/// Returns a field that owns its values, `components` per tuple.
BlockField field_of_values(std::string name, std::string type, scene::Association association, int components,
                           std::vector<double> values);

/// A part of a mesh as stored in a file, before its cells are split: for example one block of an Exodus or PLOT3D file.
/// Many other files have only a single block.
///
/// Shape   Cell c has type types[c] (VTK's cell type number) and points connectivity[offsets[c]] up to
///         connectivity[offsets[c + 1]]. If all cells are tetrahedra they may be in `tets`, with the other three empty.
///         The points of a polyhedron are those of its faces: at face_locations[c], `faces` contains the number of
///         faces and, for each face, its number of points and these points. For other cells face_locations[c] is
///         no_faces. If there are no polyhedra, both arrays are empty. Ghost arrays contain vtkGhostType bits for each
///         point or cell, or are empty.
/// Holds   The reader has checked that offsets do not decrease and end at connectivity.size(), and that every index is
///         < positions.size(); require_faces() checks faces. Positions and fields may contain NaN.
struct CellBlock {
  static constexpr std::int64_t no_faces = -1;

  std::string name;    ///< name in messages; empty if there is only one block
  std::string source;  ///< file name in messages, if the block is from a piece of the requested file
  std::vector<glm::dvec3> positions;
  std::vector<std::uint8_t> types;
  std::vector<std::uint64_t> offsets;
  std::vector<std::uint32_t> connectivity;
  std::vector<scene::Tet> tets;
  std::vector<std::uint32_t> faces;
  std::vector<std::int64_t> face_locations;
  std::vector<std::uint8_t> point_ghost, cell_ghost;
  std::vector<BlockField> fields;

  [[nodiscard]] std::size_t cell_count() const { return types.empty() ? tets.size() : types.size(); }
};

/// Checks the faces of a block's polyhedra; types, offsets and positions must be set. Every cell must have a location,
/// counts and points must be in range, and no faces may belong to two cells. Otherwise throws Error(bad_input) that
/// begins with `where` and names the cell.
void require_faces(const CellBlock& block, const std::string& where);

}  // namespace tessera::cells
