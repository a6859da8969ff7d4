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

/// Reading of a mesh file by several processes, each of which reads a part. They must agree three times: before the
/// field is chosen, on the arrays and their locations; then on how finely higher-order cells are divided; at the end on
/// the counts. This directory does not communicate: the caller exchanges these values.
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
/// The tets of all parts, concatenated, are those of read_mesh, in the same order. `joined` returns the same counts,
/// fields and notes as read_mesh, provided that exactly one part examines each key (cells/duplicate_cells.hpp).
namespace tessera::io {

/// Whether the file can be read in parts: .pvtu by pieces, VTK's lists of blocks (.vtm .vtpc) by files, .tets by tets,
/// and some other meshes by shares (io/mesh/mesh_shares.hpp). False if the mesh is to be smoothed, which needs all
/// cells around a point, or if duplicate cells are to be dropped, which needs all cells.
bool readable_in_parts(const InputFile& file, const ReadOptions& options);

/// Returns the files that a file readable in parts lists, or the set of files to which it belongs; none for .tets and
/// directories. Throws Error(bad_input).
std::vector<std::filesystem::path> files_of_parts(const InputFile& file);

/// The result of reading a part, without the mesh. Small, except for `used_points`.
struct PartSummary {
  MeshCounts counts;  ///< the first part counts the points of a .tets file; no part counts the file's unused points
  /// Bit v is set if this part uses point v of a .tets file; empty for other formats. The union over all parts
  /// determines how many points are unused.
  std::vector<std::uint64_t> used_points;
  std::vector<std::string> reading_notes, cell_notes, surfaces;  ///< `surfaces`: see MeshFile
  HigherOrderCells higher_order;
  scene::TimeStepRead time_step{};  ///< a part without files has one step
};

struct MeshFilePart {
  scene::TetMesh mesh;  ///< mesh of this part; may have no tets. `original_cell` counts only this part's cells
  PartSummary summary;
  std::vector<cells::FieldSummary> fields;  ///< fields of the whole file
  std::vector<std::string> choice_notes;    ///< notes on the choice of the field; the same in all parts
  std::vector<std::string> blocks;          ///< names of all blocks; the same in all parts
  std::string format;
  std::vector<std::uint64_t> cell_keys;  ///< duplicate_keys() of this part's cells, before selections apply
};

class MeshPartReading {
 public:
  /// Reads part `part` of `parts`; there may be more parts than pieces. The file must be readable in parts. Throws like
  /// read_mesh; errors name the piece.
  MeshPartReading(InputFile file, const ReadOptions& options, int part, int parts);
  ~MeshPartReading();

  [[nodiscard]] const std::vector<cells::FieldTally>& tallies() const;
  /// Returns higher_order_box() of the part.
  [[nodiscard]] const scene::Box& box() const;
  /// Names of the blocks in this part. If the file lists the names, the first part returns all of them and the others
  /// return none.
  [[nodiscard]] const std::vector<std::string>& block_names() const;

  /// Chooses the field, which is the same in all parts. Throws like choose_field, and for a requested block that no
  /// part has.
  void choose(std::span<const std::vector<cells::FieldTally>> tallies_of_all, const scene::Box& box_of_all,
              std::vector<std::string> names_of_all);

  /// Deviations of the part's higher-order cells. Call choose() first.
  [[nodiscard]] cells::ExcessTally excess() const;

  /// Creates the tets. Call once. Throws like read_mesh, but accepts a part with nothing to render.
  MeshFilePart finish(const cells::ExcessTally& excess_of_all);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns everything that read_mesh would report about the file, without the mesh. `own` is the result of any part,
/// `summaries` are those of all parts, in order. `points_unused` is computed from the `used_points` of the summaries,
/// if they are not empty.
/// Throws Error(bad_input) if no part has anything to render.
cells::MeshFile joined(const MeshFilePart& own, std::span<const PartSummary> summaries,
                       const std::filesystem::path& file);

}  // namespace tessera::io
