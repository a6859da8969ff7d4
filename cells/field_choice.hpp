// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"
#include "cells/field_summary.hpp"

namespace tessera::cells {

/// The scalar that will be rendered.
struct FieldChoice {
  std::string name;  ///< of the array; empty: the file has none, all is 1
  scene::Association association = scene::Association::point;
  int component = 0;               ///< or `magnitude`
  std::string label;               ///< with component: "Velocity:mag"
  bool shape = false;              ///< no array, but how far points lie along shape_direction
  std::vector<std::string> notes;  ///< why it was chosen, where that may surprise
};

/// One array of one part of a file. An array that changes its number of components from block to block has several.
struct FieldTally {
  FieldSummary summary{};        ///< but for its range and what follows from `numbers`
  NumberTally numbers{};         ///< of scalars, or of vectors' lengths
  bool blocks_count_up = false;  ///< each block numbers its own cells or points
};

/// All arrays of these blocks in the file's order.
std::vector<FieldTally> tally_fields(std::span<const CellBlock> blocks);

/// The arrays of a whole from the tallies of its parts in the file's order: one entry a name and association, with the
/// number of components and the type that come first. The same however the file was divided.
std::vector<FieldSummary> summarize_fields(std::span<const std::vector<FieldTally>> parts);

/// Towards the eye of the default view (tessera/default_view.hpp), of length one.
inline constexpr glm::dvec3 shape_direction{0.4531538935183250, -0.7848855672213958, 0.4226182617406994};

/// Whether a field is a label by its name and holds whole numbers only, or numbers cells or points (FieldInfo::ids).
bool is_label(const FieldSummary& field);

/// Whether a name is that of a label rather than a quantity ("GlobalNodeId", "vtkGhostType", "IBlank", "BLOCK_I"): an
/// id, an index, the number of a rank, part, block or material. Never the default where its values are whole numbers.
bool is_label_name(const std::string& name);

/// Whether a field is nowhere further from zero than 1e-12 and goes through it: what is left of zeros after arithmetic,
/// as a rule. The default only if nothing else varies, and with a note.
bool looks_like_noise(const FieldSummary& field);

/// Resolves ReadOptions::field. Names win over syntax: "a:b" is the array of that name if there is one; a name of both
/// a point and a cell array means the point one. Without a wish: the file's active scalars if they vary, else the first
/// that varies of point scalars, point vectors, cell scalars, cell vectors; of what looks like noise only if nothing
/// else varies. Then a short array of floats that would be ids by its values alone, with a note. If only labels vary:
/// the first, or with `shape` (ReadOptions::shape) no array but the shape; and so if nothing varies. Throws
/// Error(bad_input) listing all names.
FieldChoice choose_field(const std::string& wish, std::span<const FieldSummary> fields, const std::string& source,
                         bool shape = false);

/// Whether samples are colors: of three or four bytes, as MetaImage, NIfTI and VTK's image data have them.
bool look_like_colors(const FieldSummary& field);

/// Throws Error(bad_input) if the magnitude of colors was chosen without being asked for: `wish` is ReadOptions::field.
void refuse_colors(const FieldChoice& choice, const FieldSummary& field, const std::string& wish,
                   const std::string& source);

/// Whether this block has the chosen array, with the summary's number of components.
const BlockField* find_field(const CellBlock& block, const std::string& name, scene::Association association);

}  // namespace tessera::cells
