// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/mesh_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "cells/axis_scale.hpp"
#include "cells/mesh_assembly.hpp"
#include "cells/warp.hpp"
#include "io/formats/file_kinds.hpp"
#include "io/formats/inflated_file.hpp"
#include "io/formats/input_file.hpp"
#include "io/formats/whole_file.hpp"
#include "io/mesh/medit_file.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "io/mesh/nastran_file.hpp"
#include "io/mesh/su2_file.hpp"
#include "io/mesh/tecplot_file.hpp"
#include "io/mesh/tets_file.hpp"
#include "io/text/clean_errors.hpp"
#include "scene/error.hpp"
#include "system/gzip.hpp"

namespace tessera::io {
namespace {

bool has_time_steps(const std::filesystem::path& file) {
  const FormatRow* const row = format_of(file);
  return row != nullptr && row->has_time_steps;
}

cells::MeshBlocks read_tecplot(const std::filesystem::path& file, std::optional<std::size_t> time_step) {
  TecplotMesh read = parse_tecplot(WholeFile(file).text(), file.string(), time_step);
  cells::MeshBlocks mesh{std::move(read.blocks), std::move(read.notes), "Tecplot (text)"};
  mesh.time_step = read.time_step;
  return mesh;
}

cells::MeshBlocks read_content(const std::filesystem::path& file, const FormatRow& row,
                               const cells::MeshOptions& options) {
  switch (row.kind) {
    case FileKind::vtk_xml:
      return read_vtk_xml(file, options);
    case FileKind::vtk_legacy:
      return read_vtk_legacy(file, options);
    case FileKind::vtk_grid:
      if (row.holds == FileHolds::grid) refuse_as_mesh(file);
      return read_beginning(file, 8).starts_with("# vtk") ? read_vtk_legacy(file, options)
                                                          : read_vtk_xml(file, options);
    case FileKind::exodus:
      return read_exodus(file, options);
    case FileKind::hdf5:
      return read_hdf5(file, options);
    case FileKind::netcdf:
    case FileKind::solver:
      return read_solver_file(file, row.reader, options);
    case FileKind::gmsh:
      return read_by_gmsh(file, row.reader, options);
    case FileKind::xdmf:
      return read_xdmf_mesh(file, options);
    case FileKind::med:
      return read_med(file, options);
    case FileKind::medit_text:
      return {parse_medit_text(WholeFile(file).text(), file.string()), {}, "Medit"};
    case FileKind::medit:
      return {parse_medit_binary(WholeFile(file).bytes(), file.string()), {}, "Medit, binary"};
    case FileKind::nastran:
      return {read_nastran(file), {}, "Nastran"};
    case FileKind::tecplot:
      return read_tecplot(file, options.time_step);
    case FileKind::su2:
      return {parse_su2(WholeFile(file).text(), file.string()), {}, "SU2"};
    case FileKind::plot3d:
      return read_plot3d(file, options);
    case FileKind::plot3d_list:
      return read_plot3d_list(file, options);
    case FileKind::tetgen_mesh:
      return read_node_ele(file);
    case FileKind::stl:
    case FileKind::vtk_surface:
    case FileKind::ply:
    case FileKind::tetgen_surface:
      return read_surface(file, row.kind, options.max_volume, options.progress);
    case FileKind::tets:
      return blocks_of_tets(parse_tets(TetsBytes(system::PositionalFile(file)), file.string()));
    case FileKind::amr:
      return read_amr(file, row.reader, options);
    default:
      refuse_as_mesh(file);
  }
}

/// Leaves the chosen blocks, if they were not all that was read, and the names of all.
cells::MeshBlocks chosen_blocks(cells::MeshBlocks read, const cells::BlockChoice& choice) {
  if (read.block_names.empty())
    for (const cells::CellBlock& block : read.blocks) read.block_names.push_back(block.name);
  read.block_names = cells::distinct_names(std::move(read.block_names));
  if (!choice.empty())
    std::erase_if(read.blocks, [&](const cells::CellBlock& block) {
      return !block.name.empty() &&
             !cells::is_chosen(choice, block.name);  // those of no name were chosen by their reader
    });
  if (read.block_names.size() <= 1)
    for (cells::CellBlock& block : read.blocks) block.name.clear();
  return read;
}

cells::MeshBlocks warped(cells::MeshBlocks read, const cells::MeshOptions& options, const std::string& source) {
  cells::warp(read, options, source);
  return read;
}

/// What is in a gzip file is read under another name, which nobody is to hear of.
cells::MeshBlocks read_unscaled_blocks(const std::filesystem::path& file, const cells::MeshOptions& options) {
  const FormatRow* const row = format_of(file);
  if (row == nullptr || row->kind == FileKind::unread) refuse_as_mesh(file);  // inflated, it has no name that tells
  if (std::filesystem::is_directory(file) || !system::looks_like_gzip(read_beginning(file, 2)))
    return warped(chosen_blocks(read_content(file, *row, options), options.blocks), options, file.string());
  const InflatedFile inflated(
      file, row->holds == FileHolds::grid_or_mesh ? InflatedFile::Holds::grid : InflatedFile::Holds::mesh);
  cells::MeshBlocks read = inflated.read([&](const std::filesystem::path& content) {
    return warped(chosen_blocks(read_content(content, *row, options), options.blocks), options, file.string());
  });
  for (std::string& note : read.notes) note = inflated.renamed(std::move(note));
  for (cells::CellBlock& block : read.blocks) block.source = inflated.renamed(std::move(block.source));
  read.format += ", gzip";
  return read;
}

cells::MeshBlocks read_blocks(const std::filesystem::path& file, const cells::MeshOptions& options) {
  cells::MeshBlocks read = read_unscaled_blocks(file, options);
  const Box box = read.beside_degrees ? cells::box_of_points(read.blocks) : Box();
  read.axis_scale = cells::chosen_scale(options.axis_scale, read.beside_degrees, box, read.notes);
  cells::scale_blocks(read.blocks, read.axis_scale);
  return read;
}

/// What is left to be chosen of blocks.
cells::MeshOptions options_after(const cells::MeshBlocks& read, cells::MeshOptions options) {
  if (read.fields.empty()) return options;
  options.smooth = false;
  options.field.clear();
  for (const cells::CellBlock& block : read.blocks)
    for (const cells::BlockField& field : block.fields) options.field = field.name;
  return options;
}

}  // namespace

cells::MeshBlocks blocks_of_tets(scene::TetMesh mesh) {
  cells::CellBlock block;
  block.positions = std::move(mesh.positions);
  block.tets = std::move(mesh.tets);
  block.fields.push_back(
      cells::field_of_values("scalar", "float", scene::Association::point, 1, std::move(mesh.scalars)));
  cells::MeshBlocks result;
  result.format = "raw tetrahedra (.tets)";
  result.blocks.push_back(std::move(block));
  return result;
}

void require_mesh_file(const std::filesystem::path& file) {
  require_file(file);
  if (!is_mesh_file(file)) refuse_as_mesh(file);
}

bool is_mesh_file(const std::filesystem::path& file) {
  const FormatRow* const row = format_of(file);
  return row != nullptr &&
         (row->holds == FileHolds::mesh || row->holds == FileHolds::surface || row->holds == FileHolds::grid_or_mesh);
}

cells::MeshBlocks read_mesh_blocks(const std::filesystem::path& file, const cells::MeshOptions& options) {
  const std::string source = file.string();
  require_file(file);
  return with_clean_errors(source, [&] {
    cells::MeshBlocks read = read_blocks(file, options);
    if (!has_time_steps(file)) require_no_time_step(options.time_step, source);
    cells::require_blocks(options.blocks, read.block_names, source, options.surfaces);
    return read;
  });
}

cells::MeshFile read_mesh(const std::filesystem::path& file, const cells::MeshOptions& options) {
  const std::string source = file.string();
  require_file(file);
  return with_clean_errors(source, [&] {
    cells::MeshBlocks read = read_blocks(file, options);
    if (!has_time_steps(file)) require_no_time_step(options.time_step, source);
    cells::require_blocks(options.blocks, read.block_names, source);
    const cells::MeshOptions rest = options_after(read, options);
    cells::MeshFile result = cells::assemble_mesh(std::move(read.blocks), rest, source);
    if (!read.fields.empty()) result.fields = std::move(read.fields);
    result.format = std::move(read.format);
    result.blocks = std::move(read.block_names);
    result.surfaces = cells::distinct_names(std::move(read.surface_names));
    result.notes.insert(result.notes.begin(), read.notes.begin(), read.notes.end());
    result.time_step = read.time_step;
    result.axis_scale = read.axis_scale;
    if (auto note = scene::note_on(read.time_step, options.time_step)) result.notes.insert(result.notes.begin(), *note);
    return result;
  });
}

scene::TimeStepRead time_steps_of_mesh(const std::filesystem::path& file, const cells::MeshOptions& options) {
  require_mesh_file(file);
  if (!has_time_steps(file)) return {};
  return with_clean_errors(file.string(), [&] { return read_blocks(file, options).time_step; });
}

cells::MeshFile read_mesh(std::span<const std::filesystem::path> files, const cells::MeshOptions& options) {
  if (files.size() == 1) return read_mesh(files.front(), options);
  cells::MeshBlocks all;
  for (const std::filesystem::path& file : files) {
    const std::string source = file.string();
    require_file(file);
    with_clean_errors(source, [&] {
      cells::MeshBlocks read = read_blocks(file, options);
      if (!has_time_steps(file)) require_no_time_step(options.time_step, source);
      if (!read.fields.empty())
        throw scene::bad_input(fmt::format("{}: a mesh with levels is read by itself only; give it alone", source));
      if (all.format.empty()) all.format = read.format;
      all.block_names.insert(all.block_names.end(), read.block_names.begin(), read.block_names.end());
      for (cells::CellBlock& block : read.blocks) {
        if (block.source.empty()) block.source = source;
        all.blocks.push_back(std::move(block));
      }
      if (auto note = scene::note_on(read.time_step, options.time_step)) read.notes.insert(read.notes.begin(), *note);
      all.time_step = read.time_step;
      all.axis_scale = read.axis_scale;
      cells::add_notes(read.notes, all.notes);
      cells::add_notes(read.surface_names, all.surface_names);
    });
  }
  const std::string source = files.empty() ? "mesh" : files.front().string();
  return with_clean_errors(source, [&] {
    all.block_names = cells::distinct_names(std::move(all.block_names));
    cells::require_blocks(options.blocks, all.block_names, source);
    cells::MeshFile result = cells::assemble_mesh(std::move(all.blocks), options, source);
    result.format = fmt::format("{} files: {}", files.size(), all.format);
    result.blocks = std::move(all.block_names);
    result.surfaces = std::move(all.surface_names);
    result.time_step = all.time_step;
    result.axis_scale = all.axis_scale;
    result.notes.insert(result.notes.begin(), all.notes.begin(), all.notes.end());
    return result;
  });
}

}  // namespace tessera::io
