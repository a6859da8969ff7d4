// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cells/curved/higher_order_plan.hpp"
#include "cells/field_choice.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "scene/time_step_read.hpp"

/// A mesh file that several processes read, each a part of it. They must agree three times: before the field is chosen,
/// on the arrays and their locations; then on how finely higher-order cells are divided; at the end on the counts. This
/// directory does not communicate: the caller exchanges these values.
///
///     MeshPartReading reading(file, options, part, parts);
///     tallies = reading.tallies() of all parts, in part order; box = reading.box() of all, joined
///     names = reading.block_names() of all, in part order, each once
///     reading.choose(tallies, box, names);
///     excess = sum of reading.excess() of all parts
///     MeshFilePart own = reading.finish(excess);
///     own.summary.counts.cells_duplicate = count_repetitions(cell_keys of all parts that this one looks at)
///     MeshFile whole = joined(own.summary of all parts, in part order, ...)
///
/// The tets of all parts, concatenated, are those of read_mesh, in its order; `joined` returns read_mesh's counts,
/// fields and notes, provided that exactly one part examines each key (cells/duplicate_cells.hpp).
namespace tessera::io {

/// Whether the file can be read in parts: .pvtu, by pieces; VTK's lists of blocks (.vtm .vtpc), by files; .tets, by
/// tets; and meshes in shares (io/mesh/mesh_shares.hpp). Not if it is to be smoothed, which needs all cells around a
/// point, or if duplicate cells are to be dropped, which needs all cells.
bool readable_in_parts(const InputFile& file, const ReadOptions& options);

/// The files that such a file lists, or the set of files to which it belongs; none for .tets and for directories.
/// Throws Error(bad_input).
std::vector<std::filesystem::path> files_of_parts(const InputFile& file);

/// What a part knows apart from its mesh. Small, except for `used_points`.
struct PartSummary {
  MeshCounts counts;  ///< points of a .tets file are counted in the first part; its unused points are not counted here
  /// Bit v is set if this part uses point v of a .tets file; empty for other formats. The union over all parts
  /// determines how many points are unused.
  std::vector<std::uint64_t> used_points;
  std::vector<std::string> reading_notes, cell_notes, surfaces;  ///< surfaces: see MeshFile
  HigherOrderCells higher_order;
  scene::TimeStepRead time_step{};  ///< of a part without files: one step
};

struct MeshFilePart {
  scene::TetMesh mesh;  ///< of this part; may have no tets. `original_cell` counts only this part's cells
  PartSummary summary;
  std::vector<cells::FieldSummary> fields;  ///< of the whole file
  std::vector<std::string> choice_notes;    ///< about the field; the same in all parts
  std::vector<std::string> blocks;          ///< names of all blocks; the same in all parts
  std::string format;
  std::vector<std::uint64_t> cell_keys;  ///< duplicate_keys() of this part's cells, before any selection
};

class MeshPartReading {
 public:
  /// Reads part `part` of `parts`, which may exceed the number of pieces. The file must be readable in parts. Throws
  /// like read_mesh; errors name the piece.
  MeshPartReading(InputFile file, const ReadOptions& options, int part, int parts);
  ~MeshPartReading();

  [[nodiscard]] const std::vector<cells::FieldTally>& tallies() const;
  /// higher_order_box() of the part.
  [[nodiscard]] const scene::Box& box() const;
  /// The names of blocks that this part adds: those in its share. If the file lists them, only the first part adds
  /// names.
  [[nodiscard]] const std::vector<std::string>& block_names() const;

  /// Chooses the field, the same in all parts. Throws like choose_field, and for a requested block that no part has.
  void choose(std::span<const std::vector<cells::FieldTally>> tallies_of_all, const scene::Box& box_of_all,
              std::vector<std::string> names_of_all);

  /// Valid after choose().
  [[nodiscard]] cells::ExcessTally excess() const;

  /// Creates the tets. Call once. Throws like read_mesh, but accepts a part with nothing to render.
  MeshFilePart finish(const cells::ExcessTally& excess_of_all);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Everything that read_mesh would report about the file except the mesh. `own` is any part's result, `summaries` are
/// those of all parts, in order; `points_unused` is computed from their `used_points`, if there are any.
/// Throws Error(bad_input) if no part has anything to render.
cells::MeshFile joined(const MeshFilePart& own, std::span<const PartSummary> summaries,
                       const std::filesystem::path& file);

}  // namespace tessera::io
