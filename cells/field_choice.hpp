// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"
#include "cells/field_summary.hpp"

namespace tessera::cells {

/// The scalar to be rendered.
struct FieldChoice {
  std::string name;  ///< of the array; empty: the file has none, all values are 1
  scene::Association association = scene::Association::point;
  int component = 0;               ///< or `magnitude`
  std::string label;               ///< with component: "Velocity:mag"
  bool shape = false;              ///< no array: the points' coordinate along shape_direction
  std::vector<std::string> notes;  ///< reasons for the choice, if it may surprise
};

/// One array of one part of a file. An array whose number of components changes from block to block has several
/// tallies.
struct FieldTally {
  FieldSummary summary{};        ///< without its range and values derived from `numbers`
  NumberTally numbers{};         ///< of scalars, or of the lengths of vectors
  bool blocks_count_up = false;  ///< the values of each block number its own cells or points
};

/// All arrays of these blocks, in file order.
std::vector<FieldTally> tally_fields(std::span<const CellBlock> blocks);

/// The arrays of a whole from the tallies of its parts in file order: one entry per name and association, with the
/// first number of components and type. The result does not depend on how the file was divided.
std::vector<FieldSummary> summarize_fields(std::span<const std::vector<FieldTally>> parts);

/// Unit vector towards the eye of the default view (tessera/default_view.hpp).
inline constexpr glm::dvec3 shape_direction{0.4531538935183250, -0.7848855672213958, 0.4226182617406994};

/// Whether a field's name is that of a label and all its values are integers, or it numbers cells or points
/// (FieldInfo::ids).
bool is_label(const FieldSummary& field);

/// Whether a name is that of a label rather than a quantity ("GlobalNodeId", "vtkGhostType", "IBlank", "BLOCK_I"): an
/// id, an index, the number of a rank, part, block or material. Never the default if its values are integers.
bool is_label_name(const std::string& name);

/// Whether a field is nowhere further from zero than 1e-12 and changes sign: usually rounding errors around zero. The
/// default only if nothing else varies, and with a note.
bool looks_like_noise(const FieldSummary& field);

/// Resolves ReadOptions::field. Names take precedence over syntax: "a:b" is the array of that name if it exists; a name
/// of both a point and a cell array selects the point array. If `requested` is empty: the file's active scalars if they
/// vary, otherwise the first varying array among point scalars, point vectors, cell scalars, cell vectors; fields that
/// look like noise only if nothing else varies. Next, with a note, a short float array that would be ids by its values
/// alone. If only labels vary: the first, or with `shape` (ReadOptions::shape) no array but the shape; the same if
/// nothing varies. Throws Error(bad_input) listing all names.
FieldChoice choose_field(const std::string& requested, std::span<const FieldSummary> fields, const std::string& source,
                         bool shape = false);

/// Whether samples are colors: three or four bytes, as in MetaImage, NIfTI and VTK's image data.
bool look_like_colors(const FieldSummary& field);

/// Throws Error(bad_input) if the magnitude of colors was chosen by default: `requested` is ReadOptions::field.
void refuse_colors(const FieldChoice& choice, const FieldSummary& field, const std::string& requested,
                   const std::string& source);

/// The chosen array of this block, with the summary's number of components; null if the block does not have it.
const BlockField* find_field(const CellBlock& block, const std::string& name, scene::Association association);

}  // namespace tessera::cells
