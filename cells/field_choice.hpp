// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"
#include "cells/field_summary.hpp"

namespace tessera::cells {

/// The choice of the scalar to render.
struct FieldChoice {
  std::string name;  ///< name of the array; empty: the file has no array, and all values are 1
  scene::Association association = scene::Association::point;
  int component = 0;               ///< or `magnitude`
  std::string label;               ///< name with the component: "Velocity:mag"
  bool shape = false;              ///< no array: the values are the coordinate of points along shape_direction
  std::vector<std::string> notes;  ///< reasons for the choice, if it may be unexpected
};

/// Summary of one array in one part of a file. If the number of components of an array changes from block to block, it
/// has several tallies.
struct FieldTally {
  FieldSummary summary{};        ///< without the range and values that follow from `numbers`
  NumberTally numbers{};         ///< tally of the scalars, or of the lengths of the vectors
  bool blocks_count_up = false;  ///< the values of each block number its own cells or points
};

/// Tallies all arrays of these blocks, in file order.
std::vector<FieldTally> tally_fields(std::span<const CellBlock> blocks);

/// Summarizes the arrays of a whole mesh from the tallies of its parts in file order. There is one entry per name and
/// association, with the number of components and the type of the first tally. The result does not depend on how the
/// file was divided.
std::vector<FieldSummary> summarize_fields(std::span<const std::vector<FieldTally>> parts);

/// Unit vector towards the eye of the default view (tessera/default_view.hpp).
inline constexpr glm::dvec3 shape_direction{0.4531538935183250, -0.7848855672213958, 0.4226182617406994};

/// Whether a field is a label: its name is that of a label and all its values are integers, or it numbers cells or
/// points (FieldInfo::ids).
bool is_label(const FieldSummary& field);

/// Whether a name is that of a label rather than a quantity ("GlobalNodeId", "vtkGhostType", "IBlank", "BLOCK_I"): an
/// id, an index, or the number of a rank, part, block or material. A field with such a name is never the default if its
/// values are integers.
bool is_label_name(const std::string& name);

/// Whether all values of a field are within 1e-12 of zero and change sign, which usually means rounding errors around
/// zero. A field like this is the default only if nothing else varies, and with a note.
bool looks_like_noise(const FieldSummary& field);

/// Resolves ReadOptions::field. Names take precedence over syntax: "a:b" is the array of that name if it exists; a name
/// of both a point and a cell array selects the point array. If `requested` is empty, the choice is, in this order: the
/// file's active scalars if they vary; the first varying array among point scalars, point vectors, cell scalars, cell
/// vectors, where fields that look like noise are considered only if nothing else varies; a short float array that only
/// its values suggest to be ids, with a note. If only labels vary or nothing varies, the choice is the first field
/// (labels last) or, with `shape` (ReadOptions::shape), the shape instead of an array. Throws Error(bad_input) listing
/// all names.
FieldChoice choose_field(const std::string& requested, std::span<const FieldSummary> fields, const std::string& source,
                         bool shape = false);

/// Whether samples are colors: three or four bytes, as in MetaImage, NIfTI and VTK's image data.
bool look_like_colors(const FieldSummary& field);

/// Throws Error(bad_input) if the magnitude of colors was chosen by default. `requested` is ReadOptions::field.
void refuse_colors(const FieldChoice& choice, const FieldSummary& field, const std::string& requested,
                   const std::string& source);

/// Returns the chosen array of this block, with the number of components in the summary; null if the block does not
/// have it.
const BlockField* find_field(const CellBlock& block, const std::string& name, scene::Association association);

}  // namespace tessera::cells
