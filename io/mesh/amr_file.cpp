// SPDX-License-Identifier: BSD-3-Clause
// Reads meshes with refinement levels and converts them to cells.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "cells/amr/amr_leaves.hpp"
#include "cells/amr/amr_values.hpp"
#include "cells/field_choice.hpp"
#include "io/files/reader_programs.hpp"
#include "io/mesh/amr_opened.hpp"
#include "io/mesh/amrex_file.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "io/text/clean_errors.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

using scene::Association;

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

std::uint64_t product(const std::array<std::uint64_t, 3>& n) {
  std::uint64_t all = 1;
  for (const std::uint64_t side : n)
    if (__builtin_mul_overflow(all, side, &all)) return std::numeric_limits<std::uint64_t>::max();
  return all;
}

void add_fields_of_image(const OpenedAmrBlock& block, cells::CellBlock& fields, const std::string& source) {
  const ForeignPart& part = *block.part;
  std::array<std::uint64_t, 3> points{}, cells{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t first = part.extent[2 * a], last = part.extent[2 * a + 1];
    if (first < INT32_MIN || last > INT32_MAX || last < first)
      throw scene::bad_input(fmt::format(
          "{}: its point indices run from {} to {} along {}, which is impossible; the file is damaged, write it again",
          source, first, last, "xyz"[a]));
    cells[a] = static_cast<std::uint64_t>(std::max<std::int64_t>(last - first, 1));
    points[a] = static_cast<std::uint64_t>(last - first + 1);
  }
  add_foreign_fields(*block.file, part, Association::point, product(points), fields, source);
  add_foreign_fields(*block.file, part, Association::cell, product(cells), fields, source);
}

/// Returns the fields of a block after comparing their sizes with the block's extent or the number of leaves.
cells::CellBlock fields_of(const OpenedAmrBlock& block, const std::string& source) {
  const ForeignPart& part = *block.part;
  cells::CellBlock fields;
  fields.name = part.name;
  if (part.kind == ForeignPart::Kind::trees)
    add_foreign_fields(*block.file, part, Association::cell, part.types ? part.types->tuples : 0, fields, source);
  else
    add_fields_of_image(block, fields, source);
  if (fields.fields.empty())  // the sizes of fields bound the extent by the size of the file
    throw scene::bad_input(fmt::format("{}: it has no field; write all blocks with the same fields", source));
  return fields;
}

/// Reads the numbers of an array of T; empty if the array has another type or is missing.
template <class T>
std::optional<std::vector<T>> numbers_as(const OpenedAmrBlock& block, const std::optional<ForeignArray>& array,
                                         NumberType type, int components, const std::string& source) {
  if (!array || array->type != type || array->components != components) return std::nullopt;
  const std::vector<std::byte> bytes = block.file->arrays->copy(*array, source);
  const auto* const first = reinterpret_cast<const T*>(bytes.data());
  return std::vector<T>(first, first + bytes.size() / sizeof(T));
}

cells::AmrBlock described(const OpenedAmrBlock& block, const std::string& source) {
  const ForeignPart& part = *block.part;
  cells::AmrBlock amr{.name = part.name, .extent = part.extent};
  amr.ghosts = [block](std::size_t cells) {
    return block.file != nullptr ? ghost_bits(*block.file, block.part->cell_fields, cells)
                                 : std::vector<std::uint8_t>();
  };
  amr.is_image = part.kind == ForeignPart::Kind::image;
  amr.origin = part.origin, amr.spacing = part.spacing, amr.direction = part.direction;
  if (part.kind != ForeignPart::Kind::trees) return amr;
  amr.branching = part.branching, amr.levels = part.levels;
  amr.coordinates = [block, source](std::size_t axis) {
    if (block.part->coordinates.size() != 3) return std::vector<double>();
    const ForeignArray& array = block.part->coordinates[axis];
    std::vector<double> at(array.tuples);
    read_tuples(block.file->arrays->copy(array, source), array.type, array.components, 0, 0, at);
    return at;
  };
  amr.leaves = [block, source]() -> std::optional<cells::AmrTreeLeaves> {
    auto lows = numbers_as<std::int32_t>(block, block.part->points, NumberType::int32, 3, source);
    auto levels = numbers_as<std::uint8_t>(block, block.part->types, NumberType::uint8, 1, source);
    if (!lows || !levels) return std::nullopt;
    return cells::AmrTreeLeaves{std::move(*lows), std::move(*levels)};
  };
  return amr;
}

/// Reads the numbers of the chosen field in one block; empty if the block does not have the field.
std::vector<double> numbers_in(const cells::CellBlock& block, const cells::FieldChoice& choice) {
  std::vector<double> numbers;
  if (const cells::BlockField* const field = cells::find_field(block, choice.name, choice.association)) {
    numbers.resize(field->tuples);
    field->read(choice.component, 0, numbers);
  }
  return numbers;
}

/// Returns the cell data of the leaves. Blocks without the field have no values.
std::vector<double> values_of_leaves(std::span<const cells::CellBlock> fields, const cells::AmrLeaves& amr,
                                     const cells::FieldChoice& choice) {
  std::vector<double> values(amr.leaves.size(), no_value);
  std::vector<double> numbers;
  std::size_t of = fields.size();
  for (std::size_t l = 0; l < values.size(); ++l) {  // the leaves of a block are consecutive
    const cells::AmrLeaf& leaf = amr.leaves[l];
    if (leaf.part != of) of = leaf.part, numbers = numbers_in(fields[of], choice);
    if (!numbers.empty()) values[l] = numbers[leaf.cell];
  }
  return values;
}

/// Removes leaves without a value; their neighbours become boundary cells.
std::uint64_t drop_blank(cells::AmrLeaves& amr, std::vector<double>& values) {
  std::size_t kept = 0;
  for (std::size_t l = 0; l < values.size(); ++l)
    if (std::isfinite(values[l])) amr.leaves[kept] = amr.leaves[l], values[kept] = values[l], ++kept;
  const std::size_t blank = values.size() - kept;
  amr.leaves.resize(kept), values.resize(kept);
  return blank;
}

cells::CellBlock smooth_block(const cells::AmrLeaves& amr, std::span<const double> values, const std::string& field) {
  return cells::conforming_cells(amr.lattice, 2, cells::smooth_cubes(amr, values), field);
}

cells::CellBlock point_block(std::span<const cells::CellBlock> fields, const cells::AmrLeaves& amr,
                             const cells::FieldChoice& choice) {
  std::vector<std::vector<double>> numbers;
  for (std::size_t p = 0; p < fields.size(); ++p) {
    numbers.push_back(numbers_in(fields[p], choice));
    std::size_t points = 1;
    for (const std::int32_t n : amr.parts[p].cells) points *= static_cast<std::size_t>(n) + 1;
    numbers.back().resize(points, no_value);
  }
  return cells::conforming_cells(amr.lattice, 1, cells::cubes_of_points(amr, numbers), choice.label);
}

void add_notes_on(std::span<const cells::CellBlock> fields, const cells::AmrLeaves& amr,
                  const cells::FieldChoice& choice, cells::MeshBlocks& result) {
  std::vector<std::uint64_t> of_level(amr.size.size());
  for (const cells::AmrLeaf& leaf : amr.leaves) ++of_level[static_cast<std::size_t>(leaf.level)];
  std::string counts;
  for (const std::uint64_t n : of_level) counts += fmt::format("{}{}", counts.empty() ? "" : " + ", n);
  result.notes.push_back(fmt::format("AMR: {} levels of {} cells", amr.size.size(), counts));
  if (amr.covered > 0)
    result.notes.push_back(fmt::format("{} cells are covered by finer ones and left out", amr.covered));
  if (amr.hidden > 0) result.notes.push_back(fmt::format("{} cells are ghosts or hidden and left out", amr.hidden));
  for (const cells::CellBlock& block : fields)
    if (!choice.name.empty() && find_field(block, choice.name, choice.association) == nullptr)
      result.notes.push_back(
          fmt::format("block '{}' lacks the field '{}': its cells are blanked", block.name, choice.name));
}

cells::MeshBlocks mesh_of(const OpenedAmr& opened, const MeshOptions& options, const std::string& source) {
  if (opened.blocks.empty())
    throw scene::bad_input(fmt::format("{}: it holds no cells; check how it was written", source));
  std::vector<cells::CellBlock> fields = opened.fields;
  for (const OpenedAmrBlock& block : std::span(opened.blocks).subspan(fields.size()))
    fields.push_back(
        fields_of(block, block.part->name.empty() ? source : fmt::format("{}: block '{}'", source, block.part->name)));
  cells::MeshBlocks result;
  result.format = opened.format;
  result.notes = opened.notes;
  const std::vector<cells::FieldTally> tallies = cells::tally_fields(fields);
  result.fields = cells::summarize_fields(std::span(&tallies, 1));
  const cells::FieldChoice choice = cells::choose_field(options.field, result.fields, source);
  result.notes.insert(result.notes.end(), choice.notes.begin(), choice.notes.end());

  const bool has_trees = !opened.blocks.empty() && opened.blocks.front().part->kind == ForeignPart::Kind::trees;
  std::vector<cells::AmrBlock> blocks;
  blocks.reserve(opened.blocks.size());
  for (const OpenedAmrBlock& block : opened.blocks) blocks.push_back(described(block, source));
  cells::AmrLeaves amr = has_trees ? cells::leaves_of_trees(blocks, source) : cells::leaves_of_blocks(blocks, source);
  add_notes_on(fields, amr, choice, result);
  if (choice.association == Association::point) {
    if (options.smooth) result.notes.emplace_back("smoothing has no effect on point data");
    result.blocks.push_back(point_block(fields, amr, choice));
    return result;
  }
  std::vector<double> values = values_of_leaves(fields, amr, choice);
  if (!options.smooth) {
    result.blocks.push_back(
        cells::voxels_of(amr.lattice, 1, cells::cubes_of_cells(amr, std::move(values)), choice.label));
    return result;
  }
  if (const std::uint64_t blank = drop_blank(amr, values); blank > 0)
    result.notes.push_back(fmt::format("{} cells without a finite number are left out", blank));
  result.blocks.push_back(smooth_block(amr, values, choice.label));
  return result;
}

}  // namespace

void OpenedAmr::add(ForeignFile opened) {
  files.push_back(std::move(opened));
  const ForeignFile& file = files.back();
  for (const ForeignPart& part : file.contents.parts) blocks.push_back({&file, &part});
  for (const std::string& note : file.contents.notes)
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
  if (format.empty()) format = file.contents.format;
}

cells::MeshBlocks read_amrex(const InputFile& file, const MeshOptions& options) {
  return mesh_of(open_amrex(file.path), options, file.name);
}

cells::MeshBlocks read_amr_list(const InputFile& file, const MeshOptions& options) {
  if (!has_reader(Reader::vtk))
    throw missing_reader(Reader::vtk, file.name, file.format);  // otherwise the error would name a block
  return mesh_of(open_amr_list(file), options, file.name);
}

cells::MeshBlocks read_hyper_trees(const InputFile& file, const MeshOptions& options) {
  if (!has_reader(Reader::vtk)) throw missing_reader(Reader::vtk, file.name, file.format);
  return mesh_of(open_hyper_trees(file), options, file.name);
}

cells::MeshBlocks read_enzo(const InputFile& file, const MeshOptions& options) {
  OpenedAmr opened;
  opened.add(open_foreign(file, {{"reader", "enzo"}}));
  return mesh_of(opened, options, file.name);
}

cells::MeshBlocks read_amr(ForeignFile blocks, const MeshOptions& options) {
  require_no_time_step(options.time_step, blocks.source);
  OpenedAmr opened;
  opened.add(std::move(blocks));
  return mesh_of(opened, options, opened.files.front().source);
}

}  // namespace tessera::io
