// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/mesh_parts.hpp"

#include <algorithm>
#include <bit>

#include "cells/axis_scale.hpp"
#include "cells/block_choice.hpp"
#include "cells/mesh_assembly.hpp"
#include "cells/part_range.hpp"
#include "cells/warp.hpp"
#include "io/mesh/listed_pieces.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "io/mesh/mesh_shares.hpp"
#include "io/mesh/tets_file.hpp"
#include "io/text/clean_errors.hpp"
#include "system/positional_file.hpp"

namespace tessera::io {
namespace {

bool is_tets(const InputFile& file) { return system::lower_extension(file.path) == ".tets"; }

}  // namespace

bool readable_in_parts(const InputFile& file, const ReadOptions& options) {
  if (options.smooth || options.drop_duplicates) return false;
  if (is_tets(file)) return options.blocks.empty();
  return lists_pieces(file) || has_shares(file);
}

std::vector<std::filesystem::path> files_of_parts(const InputFile& file) {
  if (is_tets(file)) return {};
  if (has_shares(file)) return exodus_files(file);
  std::vector<std::filesystem::path> files;
  for (const ListedPiece& piece : piece_list(file, {}).pieces) files.push_back(piece.file);
  return files;
}

struct MeshPartReading::State {
  InputFile file;
  ReadOptions options;
  cells::MeshBlocks blocks;
  std::vector<cells::FieldTally> tallies;
  scene::Box box;  ///< box of this part
  std::vector<cells::FieldSummary> fields;
  cells::FieldChoice choice;
  cells::CurvedSettings asked;
  // For a .tets file:
  std::vector<std::uint32_t> file_vertex;
  std::uint64_t file_vertices = 0;
  bool counts_points = true;  ///< the first part counts the points for all

  void read_tets(int part, int parts) {
    const std::string& source = file.name;
    const system::PositionalFile opened(file.path);
    const TetsBytes bytes(opened);
    const TetsHeader header = tets_header(bytes, source);
    TetsRange range = parse_tets_range(bytes, cells::first_of_part(header.tets, part, parts),
                                       cells::first_of_part(header.tets, part + 1, parts), source);
    file_vertex = std::move(range.file_vertex);
    file_vertices = header.vertices;
    counts_points = part == 0;
    // The tally covers all vertices, used or not; each part tallies its share of them.
    const std::uint64_t first = cells::first_of_part(header.vertices, part, parts);
    cells::BlockField share;
    share.name = "scalar";
    share.type = "float";
    share.tuples = cells::first_of_part(header.vertices, part + 1, parts) - first;
    share.read = [&](int, std::size_t from, std::span<double> out) { read_scalars(bytes, header, first + from, out); };
    cells::CellBlock shares;
    shares.fields.push_back(std::move(share));
    tallies = cells::tally_fields(std::span(&shares, 1));
    blocks = blocks_of_tets(std::move(range.mesh));
  }

  void read_listed(int part, int parts) {
    const PieceList list = piece_list(file, options.blocks);
    blocks = read_pieces(list, cells::first_of_part(list.pieces.size(), part, parts),
                         cells::first_of_part(list.pieces.size(), part + 1, parts), options.progress);
    blocks.block_names = cells::distinct_names(std::move(blocks.block_names));
    if (list.pieces.size() == 1 && blocks.block_names.size() <= 1)  // a single block has no name, as in read_mesh
      for (cells::CellBlock& block : blocks.blocks) block.name.clear();
    if (part > 0) blocks.block_names.clear();
    tallies = cells::tally_fields(blocks.blocks);
  }

  void read_shared(int part, int parts) {
    blocks = read_share(file, options, part, parts);
    blocks.block_names = cells::distinct_names(std::move(blocks.block_names));
    tallies = cells::tally_fields(blocks.blocks);
  }

  void read(int part, int parts) {
    const bool is_shared = !is_tets(file) && has_shares(file);
    if (!is_shared || file.format->time_steps == nullptr) require_no_time_step(options.time_step, file.name);
    if (is_tets(file))
      read_tets(part, parts);
    else if (is_shared)
      read_shared(part, parts);
    else
      read_listed(part, parts);
    cells::warp(blocks, options.warp, file.name);
  }
};

MeshPartReading::MeshPartReading(InputFile file, const ReadOptions& options, int part, int parts)
    : state_(std::make_unique<State>()) {
  state_->file = std::move(file);
  state_->options = options;
  const std::string source = state_->file.name;
  with_clean_errors(source, [&] {
    state_->read(part, parts);
    cells::scale_points(state_->blocks, state_->options.axis_scale);
    state_->box = cells::higher_order_box(state_->blocks.blocks);
  });
}

MeshPartReading::~MeshPartReading() = default;

const std::vector<cells::FieldTally>& MeshPartReading::tallies() const { return state_->tallies; }

const scene::Box& MeshPartReading::box() const { return state_->box; }

const std::vector<std::string>& MeshPartReading::block_names() const { return state_->blocks.block_names; }

void MeshPartReading::choose(std::span<const std::vector<cells::FieldTally>> tallies_of_all,
                             const scene::Box& box_of_all, std::vector<std::string> names_of_all) {
  const std::string source = state_->file.name;
  with_clean_errors(source, [&] {
    cells::require_blocks(state_->options.blocks, names_of_all, source);
    state_->blocks.block_names = std::move(names_of_all);
    state_->fields = cells::summarize_fields(tallies_of_all);
    state_->choice = cells::choose_field(state_->options.field, state_->fields, source, state_->options.shape);
    state_->asked = cells::asked_tolerance(state_->options, box_of_all, state_->choice, state_->fields);
  });
}

cells::ExcessTally MeshPartReading::excess() const {
  return with_clean_errors(state_->file.name,
                           [&] { return cells::tally_excess(state_->blocks.blocks, state_->choice, state_->asked); });
}

MeshFilePart MeshPartReading::finish(const cells::ExcessTally& excess_of_all) {
  const std::string source = state_->file.name;
  return with_clean_errors(source, [&] {
    MeshFilePart part;
    part.format = std::move(state_->blocks.format);
    part.blocks = std::move(state_->blocks.block_names);
    part.fields = std::move(state_->fields);
    part.choice_notes = state_->choice.notes;
    cells::AssembledBlocks assembled =
        cells::assemble_blocks(std::move(state_->blocks.blocks), part.fields, state_->choice, source,
                               cells::planned(state_->options, state_->asked, excess_of_all), cells::Duplicates::keys);
    part.mesh = std::move(assembled.mesh);
    part.cell_keys = std::move(assembled.cell_keys);
    part.summary.counts = assembled.counts;
    part.summary.higher_order = assembled.higher_order;
    part.summary.cell_notes = std::move(assembled.notes);
    part.summary.time_step = state_->blocks.time_step;
    cells::add_notes(state_->blocks.notes, part.summary.reading_notes);
    part.summary.surfaces = cells::distinct_names(std::move(state_->blocks.surface_names));
    if (is_tets(state_->file)) {
      part.summary.counts.points_read = state_->counts_points ? state_->file_vertices : 0;
      part.summary.counts.points_unused = 0;
      part.summary.used_points.resize((state_->file_vertices + 63) / 64, 0);
      for (const scene::Tet& tet : part.mesh.tets)
        for (const std::uint32_t v : tet) {
          const std::uint32_t point = state_->file_vertex[v];
          part.summary.used_points[point / 64] |= std::uint64_t{1} << point % 64;
        }
    }
    return part;
  });
}

cells::MeshFile joined(const MeshFilePart& own, std::span<const PartSummary> summaries,
                       const std::filesystem::path& file) {
  cells::MeshFile whole;
  whole.format = own.format;
  whole.fields = own.fields;
  whole.blocks = own.blocks;
  whole.mesh.field_name = own.mesh.field_name;
  whole.mesh.association = own.mesh.association;
  std::vector<std::uint64_t> used;
  // Notes that every part makes about a shared file are listed once.
  const auto add = [&](const std::vector<std::string>& notes) { cells::add_notes(notes, whole.notes); };
  for (const PartSummary& part : summaries) {
    whole.counts += part.counts;
    whole.higher_order += part.higher_order;
    add(part.reading_notes);
    cells::add_notes(part.surfaces, whole.surfaces);
    if (part.time_step.count > whole.time_step.count) whole.time_step = part.time_step;
    used.resize(std::max(used.size(), part.used_points.size()), 0);
    for (std::size_t w = 0; w < part.used_points.size(); ++w) used[w] |= part.used_points[w];
  }
  add(own.choice_notes);
  for (const PartSummary& part : summaries) add(part.cell_notes);
  add(cells::notes_on_cells(whole.counts, whole.higher_order, file.string()));
  if (!used.empty()) {
    whole.counts.points_unused = whole.counts.points_read;
    for (const std::uint64_t word : used) whole.counts.points_unused -= static_cast<std::uint64_t>(std::popcount(word));
  }
  return whole;
}

}  // namespace tessera::io
