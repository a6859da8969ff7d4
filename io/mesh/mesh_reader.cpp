// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/mesh_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

#include "cells/axis_scale.hpp"
#include "cells/block_choice.hpp"
#include "cells/mesh_assembly.hpp"
#include "cells/warp.hpp"
#include "io/files/inflated_file.hpp"
#include "io/text/clean_errors.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// Keeps only the chosen blocks, if more were read, and the names of all.
void keep_chosen(cells::MeshBlocks& read, const cells::BlockChoice& choice) {
  if (read.block_names.empty())
    for (const cells::CellBlock& block : read.blocks) read.block_names.push_back(block.name);
  read.block_names = cells::distinct_names(std::move(read.block_names));
  // A reader that returns unnamed blocks has chosen them itself.
  std::erase_if(read.blocks, [&](const cells::CellBlock& block) {
    return !block.name.empty() && !cells::is_chosen(choice, block.name);
  });
  if (read.block_names.size() <= 1)
    for (cells::CellBlock& block : read.blocks) block.name.clear();
}

/// Calls a function of the file's format; for a gzip file, with its content.
template <class Read>
auto read_content(const InputFile& file, const Read& read) {
  if (!file.is_gzip) return read(file);
  const InflatedFile inflated(
      file, file.format->open_volume != nullptr ? InflatedFile::Holds::grid : InflatedFile::Holds::mesh);
  return inflated.read([&](const InputFile& content) {
    auto result = read(content);
    if constexpr (std::is_same_v<decltype(result), cells::MeshBlocks>) {
      for (std::string& note : result.notes) note = inflated.renamed(std::move(note));
      for (cells::CellBlock& block : result.blocks) block.source = inflated.renamed(std::move(block.source));
      result.format += ", gzip";
    }
    return result;
  });
}

/// The chosen blocks of a file, warped.
cells::MeshBlocks read_blocks(const InputFile& file, const MeshOptions& options) {
  return with_clean_errors(file.name, [&] {
    require_mesh(file);
    if (file.format->time_steps == nullptr) require_no_time_step(options.time_step, file.name);
    cells::MeshBlocks read =
        read_content(file, [&](const InputFile& content) { return file.format->read_mesh(content, options); });
    keep_chosen(read, options.blocks);
    cells::warp(read, options.warp, file.name);
    return read;
  });
}

/// Adds the blocks of a further file, a piece of the same mesh.
void add_piece(cells::MeshBlocks piece, const std::string& source, cells::MeshBlocks& all) {
  if (!piece.fields.empty())
    throw scene::bad_input(fmt::format(
        "{}: a mesh with levels of refinement cannot be combined with other files; give it alone", printable(source)));
  if (all.format.empty()) all.format = std::move(piece.format);
  all.block_names.insert(all.block_names.end(), piece.block_names.begin(), piece.block_names.end());
  for (cells::CellBlock& block : piece.blocks) {
    if (block.source.empty()) block.source = source;
    all.blocks.push_back(std::move(block));
  }
  all.time_step = piece.time_step;
  all.xy_in_degrees = all.xy_in_degrees || piece.xy_in_degrees;
  cells::add_notes(piece.notes, all.notes);
  cells::add_notes(piece.surface_names, all.surface_names);
}

/// Returns the options that still apply after the blocks were read.
ReadOptions options_after(const cells::MeshBlocks& read, ReadOptions options) {
  if (read.fields.empty()) return options;
  // The reader has already chosen the field.
  options.smooth = false;
  options.field.clear();
  for (const cells::CellBlock& block : read.blocks)
    for (const cells::BlockField& field : block.fields) options.field = field.name;
  return options;
}

}  // namespace

bool is_mesh(const InputFile& file) { return file.format != nullptr && file.format->read_mesh != nullptr; }

void require_mesh(const InputFile& file) {
  if (is_mesh(file)) return;
  const Format* const format = file.format;
  if (format == nullptr)
    throw scene::bad_input(fmt::format(
        "{}: neither its first bytes nor its name are those of a known format; `tessera formats` lists them",
        file.name));
  if (format->holds == FileHolds::not_read)
    throw scene::bad_input(
        fmt::format("{}: its format ({}) is not supported; {}", file.name, format->name, format->remark));
  if (format->holds == FileHolds::series)
    throw scene::bad_input(
        fmt::format("{}: it is a time series, which only render and serve accept; give one of its meshes", file.name));
  throw scene::bad_input(
      fmt::format("{}: it is a regular grid, not a mesh; give it alone or among volumes", file.name));
}

cells::MeshBlocks read_mesh_blocks(const InputFile& file, const MeshOptions& options) {
  cells::MeshBlocks read = read_blocks(file, options);
  cells::require_blocks(options.blocks, read.block_names, file.name, options.surfaces);
  cells::scale_points(read, options.axis_scale);
  return read;
}

cells::MeshFile read_mesh(std::span<const InputFile> files, const ReadOptions& options) {
  const std::string& source = files.front().name;
  cells::MeshBlocks read;
  for (const InputFile& file : files) {
    cells::MeshBlocks piece = read_blocks(file, {options});
    if (files.size() == 1)
      read = std::move(piece);
    else
      add_piece(std::move(piece), file.name, read);
  }
  read.block_names = cells::distinct_names(std::move(read.block_names));
  cells::require_blocks(options.blocks, read.block_names, source);
  cells::scale_points(read, options.axis_scale);  // the same scale for all pieces
  if (files.size() > 1) read.format = fmt::format("{} files: {}", files.size(), read.format);
  const ReadOptions rest = options_after(read, options);
  return with_clean_errors(source, [&] {
    cells::MeshFile result = cells::assemble_mesh(std::move(read.blocks), rest, source);
    if (!read.fields.empty()) result.fields = std::move(read.fields);
    result.format = std::move(read.format);
    result.blocks = std::move(read.block_names);
    result.surfaces = cells::distinct_names(std::move(read.surface_names));
    result.notes.insert(result.notes.begin(), read.notes.begin(), read.notes.end());
    result.time_step = std::move(read.time_step);
    result.axis_scale = read.axis_scale;
    return result;
  });
}

cells::MeshFile read_mesh(const InputFile& file, const ReadOptions& options) {
  return read_mesh(std::span(&file, 1), options);
}

scene::TimeStepRead time_steps_of_mesh(const InputFile& file, const ReadOptions& options) {
  require_mesh(file);
  if (file.format->time_steps == nullptr) return {};
  return with_clean_errors(file.name, [&] {
    return read_content(file, [&](const InputFile& content) { return file.format->time_steps(content, {options}); });
  });
}

}  // namespace tessera::io
