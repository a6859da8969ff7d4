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

/// A mesh file read by several processes, each a part of it. They have to agree three times: before they choose the
/// field, on what arrays there are and where; on how finely higher-order cells are divided; and at the end on the
/// counts. This folder knows no messages: whoever reads carries these around.
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
/// The tets of all parts, one part after the other, are those that read_mesh gives, in its order; `joined` gives
/// read_mesh's counts, fields and notes, if each key (cells/duplicate_cells.hpp) is looked at by one part alone.
namespace tessera::io {

/// Whether the file can be read in parts: .pvtu, whose pieces are divided over the parts, VTK's lists of blocks (.vtm
/// .vtpc), whose files are, .tets, whose tets are, and meshes in shares (io/mesh/mesh_shares.hpp). Not if it is to be
/// smoothed, which needs all cells round a point, or each cell drawn once, which needs all of them.
bool readable_in_parts(const InputFile& file, const ReadOptions& options);

/// The files that such a file lists, or that it is one of; none of .tets and of what is in folders. Throws
/// Error(bad_input).
std::vector<std::filesystem::path> files_of_parts(const InputFile& file);

/// What a part knows beside its mesh. Small, but for `used_points`.
struct PartSummary {
  MeshCounts counts;  ///< points of a .tets file are counted in the first part, and its unused ones not at all
  /// Bit v is set if this part uses point v of a .tets file; empty for other formats. All parts' bits together tell
  /// how many points are unused.
  std::vector<std::uint64_t> used_points;
  std::vector<std::string> reading_notes, cell_notes, surfaces;  ///< surfaces: as MeshFile has them
  HigherOrderCells higher_order;
  scene::TimeStepRead time_step{};  ///< of a part without files, of one step
};

struct MeshFilePart {
  scene::TetMesh mesh;  ///< of this part; may have no tets. `original_cell` counts the part's cells only
  PartSummary summary;
  std::vector<cells::FieldSummary> fields;  ///< of the whole
  std::vector<std::string> choice_notes;    ///< on the field, the same on all parts
  std::vector<std::string> blocks;          ///< the names of all, the same on all parts
  std::string format;
  std::vector<std::uint64_t> cell_keys;  ///< duplicate_keys() of the part's cells, before any are selected
};

class MeshPartReading {
 public:
  /// Reads part `part` of `parts`, which may be more than the file has pieces. The file has to be readable in parts.
  /// Throws as read_mesh; faults name the piece.
  MeshPartReading(InputFile file, const ReadOptions& options, int part, int parts);
  ~MeshPartReading();

  [[nodiscard]] const std::vector<cells::FieldTally>& tallies() const;
  /// higher_order_box() of the part.
  [[nodiscard]] const scene::Box& box() const;
  /// The names of blocks that this part adds: those in its share, of files that list them the first part's alone.
  [[nodiscard]] const std::vector<std::string>& block_names() const;

  /// Chooses the field, the same on all parts. Throws as choose_field, and for a block asked for that is in no part.
  void choose(std::span<const std::vector<cells::FieldTally>> tallies_of_all, const scene::Box& box_of_all,
              std::vector<std::string> names_of_all);

  /// After the choice.
  [[nodiscard]] cells::ExcessTally excess() const;

  /// Makes the tets. Once. Throws as read_mesh, but for a part in which nothing is left to render.
  MeshFilePart finish(const cells::ExcessTally& excess_of_all);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What read_mesh would say of the file: all but the mesh. `own` is any part's result, `summaries` are those of all
/// parts, in order; `points_unused` is taken from their `used_points`, if there are any.
/// Throws Error(bad_input) if nothing is left to render in any part.
cells::MeshFile joined(const MeshFilePart& own, std::span<const PartSummary> summaries,
                       const std::filesystem::path& file);

}  // namespace tessera::io
