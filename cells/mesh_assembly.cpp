// SPDX-License-Identifier: BSD-3-Clause
#include "cells/mesh_assembly.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>

#include "cells/block_tets.hpp"
#include "cells/duplicate_cells.hpp"
#include "cells/field_choice.hpp"
#include "cells/mesh_selection.hpp"
#include "scene/error.hpp"

namespace tessera::cells {
namespace {

using scene::Association;
using scene::Tet;

/// Merges blocks into one mesh, a block at a time.
class Assembly {
 public:
  Assembly(std::span<const FieldSummary> fields, const FieldChoice& choice, const std::string& source,
           const HigherOrderPlan& plan)
      : fields_(fields), choice_(choice), source_(source), plan_(plan) {}

  void reserve(std::size_t points, std::size_t tets) {
    require_points(points);
    result_.mesh.positions.reserve(points);
    result_.mesh.tets.reserve(tets);
  }

  void add(CellBlock& block) {
    const std::size_t first_point = result_.mesh.positions.size();
    if (first_point == 0) {
      result_.mesh.positions = std::move(block.positions);
    } else {
      result_.mesh.positions.insert(result_.mesh.positions.end(), block.positions.begin(), block.positions.end());
      block.positions = {};
    }
    for (std::size_t v = first_point; v < result_.mesh.positions.size(); ++v)
      result_.mesh.positions[v] += 0.0;  // -0 becomes 0: coincident points then have the same bits
    result_.counts.points_read += result_.mesh.positions.size() - first_point;
    points_ = std::span(result_.mesh.positions).subspan(first_point);
    read_values(block);

    cells_before_ = result_.counts.cells_read;
    as_given_ = 0;
    const bool point = choice_.association == Association::point;
    add_cells(block.tets,
              BlockCells(block, points_, std::span(values_).subspan(point ? first_point : 0), choice_.association,
                         block.source.empty() ? source_ : block.source, plan_.settings, result_.higher_order));
    if (as_given_) take_tets(block.tets);
    take_added_points();
    block = {};
  }

  AssembledBlocks finish(Duplicates duplicates) {
    result_.mesh.association = choice_.association;
    result_.counts.points_unused = unused_points();
    // Cells without a value have been removed, so a blank copy of another does not count as a duplicate.
    if (duplicates == Duplicates::keys) {
      result_.cell_keys = duplicate_keys(result_.mesh);
    } else {
      const bool drop = duplicates == Duplicates::drop;
      const std::uint64_t found = find_duplicate_cells(result_.mesh, drop);
      (drop ? result_.counts.duplicates_dropped : result_.counts.cells_duplicate) = found;
      if (drop && found > 0) result_.counts.points_unused = unused_points();
    }
    result_.counts.tets_made = result_.mesh.tets.size();
    if (choice_.association == Association::point) result_.mesh.scalars = std::move(values_);
    result_.mesh.field_name = choice_.label;
    if (result_.higher_order.divided > 0) result_.higher_order.tolerance = plan_.tolerance;
    return std::move(result_);
  }

 private:
  void require_points(std::size_t points) const {
    if (points > std::numeric_limits<std::uint32_t>::max())
      throw scene::bad_input(fmt::format(
          "{}: it has {} points, but one process supports at most 2^32 - 1; convert it to a .pvtu of pieces", source_,
          points));
  }

  /// Reads the scalars of the block's points (appending them to those of previous blocks) or of its cells. They are NaN
  /// if the block lacks the field.
  void read_values(const CellBlock& block) {
    const bool point = choice_.association == Association::point;
    const std::size_t n = point ? points_.size() : block.cell_count();
    if (!point) values_.clear();
    const std::size_t first = values_.size();
    if (choice_.shape) {
      values_.reserve(first + n);
      for (std::size_t p = 0; p < n; ++p) values_.push_back(glm::dot(points_[p], shape_direction));
      return;
    }
    if (choice_.name.empty()) {
      values_.resize(first + n, 1.0);
      return;
    }
    values_.resize(first + n, std::numeric_limits<double>::quiet_NaN());
    const BlockField* field = find_field(block, choice_.name, choice_.association);
    const auto same = [&](const FieldSummary& s) {
      return s.name == choice_.name && s.association == choice_.association;
    };
    const auto summary = std::find_if(fields_.begin(), fields_.end(), same);
    if (!field || summary == fields_.end() || field->components != summary->components) {
      if (block.cell_count() > 0 && !block.source.empty())
        throw scene::bad_input(fmt::format(
            "{}: it lacks the {} field '{}' of {}, which other pieces have; write all pieces with the same fields",
            block.source, point ? "point" : "cell", choice_.name,
            summary == fields_.end() || summary->components == 1 ? "one component"
                                                                 : fmt::format("{} components", summary->components)));
      if (block.cell_count() > 0)
        result_.notes.push_back(
            fmt::format("block '{}' lacks the field '{}': its cells are blanked", block.name, choice_.name));
      return;
    }
    const auto values = std::span(values_).subspan(first, n);
    field->read(choice_.component, 0, values);
    // Subnormal numbers are too coarse for interpolation and become 0.
    for (double& value : values)
      if (std::abs(value) < std::numeric_limits<double>::min()) value = 0;
  }

  /// Appends, in the order of the cells, the results of threads that split some cells at a time. `given` are the
  /// block's tets, if it has only tets.
  void add_cells(std::span<const Tet> given, const BlockCells& cells) {
    const std::size_t cells_a_task = cells.divides() ? 16 : 16384, count = cells.count();
    if (count <= cells_a_task) {
      BlockTets tets;
      cells.split(0, count, tets);
      append(given, tets);
      return;
    }
    const auto in_flight = 2 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    std::vector<BlockTets> results(in_flight);
    std::size_t next = 0;
    // The pipeline has at most `in_flight` tasks at a time, so a result is reused only after it has been appended.
    const auto begin = [&](tbb::flow_control& flow) {
      if (next * cells_a_task >= count) flow.stop();
      return next++;
    };
    const auto split = [&](std::size_t task) {
      BlockTets& tets = results[task % in_flight];
      try {
        const std::size_t first = task * cells_a_task;
        cells.split(first, std::min(count, first + cells_a_task), tets);
      } catch (...) {
        tets.error = std::current_exception();  // the first cell's error is reported, whatever the timing
      }
      return task;
    };
    const auto append_next = [&](std::size_t task) {
      const BlockTets& tets = results[task % in_flight];
      if (tets.error) std::rethrow_exception(tets.error);
      append(given, tets);
    };
    using tbb::filter_mode;
    tbb::parallel_pipeline(in_flight,
                           tbb::make_filter<void, std::size_t>(filter_mode::serial_in_order, begin) &
                               tbb::make_filter<std::size_t, std::size_t>(filter_mode::parallel, split) &
                               tbb::make_filter<std::size_t, void>(filter_mode::serial_in_order, append_next));
  }

  void append(std::span<const Tet> given, const BlockTets& made) {
    result_.counts += made.counts;
    result_.higher_order += made.curved;
    if (as_given_ && made.tets.size() == made.counts.cells_read && !given.empty()) {
      *as_given_ += made.tets.size();
      return;
    }
    append_given(given);
    append_tets(made.tets, [&](std::size_t t) { return made.cells[t]; });
    for (const std::uint32_t v : made.nodes) higher_order_nodes_.push_back(first_point() + v);
    if (made.added.empty()) return;
    require_points(result_.mesh.positions.size() + added_points_.size() + made.added.size());
    for (const glm::dvec3& p : made.added) added_points_.push_back(p + 0.0);
    added_values_.insert(added_values_.end(), made.added_values.begin(), made.added_values.end());
  }

  /// Appends the points at which the block's cells were split to the block's own points, which threads have read until
  /// now.
  void take_added_points() {
    result_.mesh.positions.insert(result_.mesh.positions.end(), added_points_.begin(), added_points_.end());
    if (choice_.association == Association::point)
      values_.insert(values_.end(), added_values_.begin(), added_values_.end());
    added_points_.clear(), added_values_.clear();
  }

  /// Appends the block's tets that were kept as given until now; from here on they are copied.
  void append_given(std::span<const Tet> given) {
    if (!as_given_) return;
    result_.mesh.tets.reserve(result_.mesh.tets.size() + given.size());
    append_tets(given.first(*as_given_), [](std::size_t t) { return t; });
    as_given_.reset();
  }

  /// Takes over all of a block's tets.
  void take_tets(std::vector<Tet>& given) {
    if (!result_.mesh.tets.empty() || first_point() > 0 || cells_before_ > 0) return append_given(given);
    result_.mesh.tets = std::move(given);
    if (choice_.association == Association::cell) result_.mesh.scalars.swap(values_);
  }

  template <class CellOf>
  void append_tets(std::span<const Tet> tets, const CellOf& cell_of) {
    for (std::size_t t = 0; t < tets.size() && !numbered_; ++t)
      if (cells_before_ + cell_of(t) != result_.mesh.tets.size() + t) number_cells();
    if (numbered_)
      for (std::size_t t = 0; t < tets.size(); ++t) result_.mesh.original_cell.push_back(cells_before_ + cell_of(t));
    if (choice_.association == Association::cell)
      for (std::size_t t = 0; t < tets.size(); ++t) result_.mesh.scalars.push_back(values_[cell_of(t)]);
    const auto own = static_cast<std::uint32_t>(points_.size()),
               added = static_cast<std::uint32_t>(added_points_.size());
    const std::uint32_t first = first_point();
    const auto corner = [&](std::uint32_t v) { return first + v + (v < own ? 0 : added); };
    for (const Tet& t : tets) result_.mesh.tets.push_back({corner(t[0]), corner(t[1]), corner(t[2]), corner(t[3])});
  }

  /// Returns the index in the mesh of the current block's first point.
  [[nodiscard]] std::uint32_t first_point() const {
    return static_cast<std::uint32_t>(result_.mesh.positions.size() - points_.size());
  }

  /// Starts to store the cell number of each tet, because tet and cell numbers differ from here on.
  void number_cells() {
    result_.mesh.original_cell.reserve(result_.mesh.tets.capacity());
    result_.mesh.original_cell.resize(result_.mesh.tets.size());
    std::iota(result_.mesh.original_cell.begin(), result_.mesh.original_cell.end(), std::uint64_t{0});
    numbered_ = true;
  }

  /// Returns the number of points that no tet uses.
  std::uint64_t unused_points() {
    std::vector<std::uint8_t> is_used(result_.mesh.positions.size());
    constexpr std::size_t grain = 65536;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, result_.mesh.tets.size(), grain), [&](const auto& range) {
      for (std::size_t t = range.begin(); t < range.end(); ++t)
        for (const std::uint32_t v : result_.mesh.tets[t]) {
          std::atomic_ref<std::uint8_t> point(is_used[v]);
          if (point.load(std::memory_order_relaxed) == 0) point.store(1, std::memory_order_relaxed);
        }
    });
    for (const std::uint32_t v : higher_order_nodes_) is_used[v] = 1;
    return static_cast<std::uint64_t>(std::ranges::count(is_used, 0));
  }

  AssembledBlocks result_;
  std::span<const FieldSummary> fields_;
  const FieldChoice& choice_;
  const std::string& source_;
  const HigherOrderPlan& plan_;
  std::span<const glm::dvec3> points_;  ///< of the current block
  std::uint64_t cells_before_ = 0;      ///< of the previous blocks
  /// Number of the current block's tets that have been kept without copying them. No value once a tet is not kept as
  /// given.
  std::optional<std::size_t> as_given_;
  std::vector<double> values_;            ///< of all points so far, or of the block's cells
  std::vector<glm::dvec3> added_points_;  ///< of the current block
  std::vector<double> added_values_;
  std::vector<std::uint32_t> higher_order_nodes_;  ///< nodes of all cells that were divided
  bool numbered_ = false;
};

}  // namespace

AssembledBlocks assemble_blocks(std::vector<CellBlock> blocks, std::span<const FieldSummary> fields,
                                const FieldChoice& choice, const std::string& source, const HigherOrderPlan& plan,
                                Duplicates duplicates) {
  Assembly assembly(fields, choice, source, plan);
  std::size_t points = 0, tets = 0;
  for (const CellBlock& block : blocks) {
    points += block.positions.size();
    tets += block.tets.size();
  }
  if (blocks.size() > 1) assembly.reserve(points, tets);
  for (CellBlock& block : blocks) assembly.add(block);
  return assembly.finish(duplicates);
}

std::vector<std::string> notes_on_cells(const MeshCounts& n, const HigherOrderCells& higher_order,
                                        const std::string& source) {
  require_selected(n, source);
  if (n.cells_read == 0)
    throw scene::bad_input(
        fmt::format("{}: it has no cells, so nothing is left to render; check how it was written", source));
  if (n.tets_made == 0)
    throw scene::bad_input(fmt::format(
        "{}: nothing is left to render: of {} cells {} are not volumes, {} ghosts, {} hidden, {} hold NaN, infinite or "
        "missing numbers, {} are polyhedra whose faces do not close, {} are collapsed to a point or face; give a mesh "
        "of volume cells or choose another field",
        source, n.cells_read, n.cells_not_volumetric, n.cells_ghost, n.cells_hidden, n.cells_nan, n.cells_open,
        n.cells_zero_volume));
  std::vector<std::string> notes;
  if (n.cells_tangled > n.polyhedra_tangled)
    notes.push_back(
        fmt::format("{} cells are so warped that their tets overlap", n.cells_tangled - n.polyhedra_tangled));
  if (n.cells_polyhedra > 0) {
    std::string note = fmt::format("{} polyhedra are split into tets, ", n.cells_polyhedra);
    const std::uint64_t others = n.polyhedra_from_inside + n.polyhedra_in_pieces + n.polyhedra_tangled;
    note += others == 0 ? "from a corner" : fmt::format("{} from a corner", n.cells_polyhedra - others);
    if (n.polyhedra_from_inside > 0) note += fmt::format(", {} from a point inside", n.polyhedra_from_inside);
    if (n.polyhedra_in_pieces > 0) note += fmt::format(", {} piece by piece", n.polyhedra_in_pieces);
    notes.push_back(note);
  }
  if (higher_order.divided > 0)
    notes.push_back(
        fmt::format("{} higher-order cells are drawn as {} tets, which differ from them by at most {:.2g} in position "
                    "and {:.2g} in value",
                    higher_order.divided, higher_order.tets, higher_order.position_error, higher_order.field_error));
  return notes;
}

std::vector<std::string> warnings_on_cells(const MeshCounts& n, const HigherOrderCells& higher_order) {
  std::vector<std::string> warnings;
  if (higher_order.by_corners > 0)
    warnings.push_back(
        fmt::format("{} higher-order cells are rendered as linear cells with the same corners, without a bound on the "
                    "error of this simplification",
                    higher_order.by_corners));
  const std::tuple<const char*, std::uint64_t, std::uint64_t> kinds[] = {
      {"hexahedra", n.hexahedra, n.hexahedra_tangled},
      {"wedges", n.wedges, n.wedges_tangled},
      {"pyramids", n.pyramids, n.pyramids_tangled},
      {"voxels", n.voxels, n.voxels_tangled},
      {"prisms", n.prisms, n.prisms_tangled}};
  for (const auto& [kind, count, tangled] : kinds)
    if (count > 0 && tangled == count)
      warnings.push_back(
          fmt::format("all {} {} are tangled, so they are drawn incorrectly: the order of their nodes may not be "
                      "VTK's; write them in VTK's order",
                      count, kind));
  if (n.cells_open > 0)
    warnings.push_back(
        fmt::format("{} polyhedra are left out: their faces do not form a closed surface", n.cells_open));
  if (n.polyhedra_tangled > 0)
    warnings.push_back(fmt::format(
        "{} polyhedra are drawn by tets that overlap: their faces cross each other, or they could not be split",
        n.polyhedra_tangled));
  if (n.cells_duplicate > 0)
    warnings.push_back(fmt::format(
        "{} cell{} the corners of other cells, as if parts of the mesh were given twice, and {} drawn on top of them: "
        "`drop_duplicates` draws each cell once; `block` selects the parts to draw",
        n.cells_duplicate, n.cells_duplicate == 1 ? " has" : "s have", n.cells_duplicate == 1 ? "is" : "are"));
  return warnings;
}

MeshFile assemble_mesh(std::vector<CellBlock> blocks, const ReadOptions& options, const std::string& source,
                       const HigherOrderPlanning& planning) {
  MeshFile file;
  const std::vector<FieldTally> tallies = tally_fields(blocks);
  file.fields = summarize_fields(std::span(&tallies, 1));
  const FieldChoice choice = choose_field(options.field, file.fields, source, options.shape);
  file.notes = choice.notes;

  const HigherOrderPlan plan = planning(blocks, options, choice, file.fields);
  AssembledBlocks assembled = assemble_blocks(std::move(blocks), file.fields, choice, source, plan,
                                              options.drop_duplicates ? Duplicates::drop : Duplicates::count);
  file.mesh = std::move(assembled.mesh);
  file.counts = assembled.counts;
  file.higher_order = assembled.higher_order;
  const auto add = [&](const std::vector<std::string>& notes) {
    file.notes.insert(file.notes.end(), notes.begin(), notes.end());
  };
  add(assembled.notes);
  add(notes_on_cells(file.counts, file.higher_order, source));
  if (options.smooth) {
    if (choice.association == Association::cell)
      smooth_to_points(file.mesh);
    else
      file.notes.emplace_back("smoothing has no effect on point data");
  }
  return file;
}

}  // namespace tessera::cells
