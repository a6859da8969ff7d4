// SPDX-License-Identifier: BSD-3-Clause
// Meshes in formats of other programs, read by the helper.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "io/files/file_beginnings.hpp"
#include "io/files/inflated_file.hpp"
#include "io/foreign/foreign_formats.hpp"
#include "io/mesh/listed_pieces.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "io/mesh/mesh_shares.hpp"
#include "io/mesh/plot3d_layout.hpp"
#include "io/mesh/plot3d_list.hpp"
#include "io/text/text_file.hpp"
#include "io/vtk/vtk_xml_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

struct XmlKind {
  const char *extension, *type, *words;
};
constexpr std::array xml_kinds = {
    XmlKind{".vtu", "UnstructuredGrid", "VTK XML unstructured grid"},
    XmlKind{".vts", "StructuredGrid", "VTK XML structured grid"},
    XmlKind{".pvts", "PStructuredGrid", "VTK XML parallel structured grid"},
    XmlKind{".vtr", "RectilinearGrid", "VTK XML rectilinear grid"},
    XmlKind{".pvtr", "PRectilinearGrid", "VTK XML parallel rectilinear grid"},
};

const XmlKind* kind_of(const std::string& type) {
  const auto* kind = std::find_if(xml_kinds.begin(), xml_kinds.end(), [&](const XmlKind& k) { return type == k.type; });
  return kind == xml_kinds.end() ? nullptr : kind;
}

cells::MeshBlocks named_format(const XmlKind& kind, const std::string& extension) {
  cells::MeshBlocks result;
  result.format = kind.words;
  if (!extension.empty() && extension != kind.extension)
    result.notes.push_back(fmt::format("the file is a {}, read as {}", extension.substr(1), kind.words));
  return result;
}

/// Reads one data set in this process, or by VTK's reader if it uses features not supported here.
cells::MeshBlocks read_data_set(const InputFile& file, const std::string& type, const MeshOptions& options) {
  std::optional<ForeignFile> opened = type.starts_with('P') ? std::nullopt : open_vtk_xml(file.path, options.progress);
  if (!opened) opened = open_foreign(file, {{"reader", "vtk_xml"}, {"type", type}}, options.progress);
  return mesh_of(*opened);
}

ForeignFile open_exodus(const InputFile& file, const char* reader, const MeshOptions& options) {
  nlohmann::json request{{"reader", reader}, {"blocks", options.blocks}};
  if (options.surfaces) request["surfaces"] = true;
  if (options.time_step) request["time_step"] = *options.time_step;
  if (!options.field.empty()) request["field"] = options.field;  // needed by the readers of other kinds of HDF5
  return open_foreign(file, std::move(request), options.progress);
}

std::vector<Plot3dStep> steps_of_list(const InputFile& file) {
  require_uncompressed(file.path);
  return parse_plot3d_list(read_text_file(file.path), file.path);
}

scene::TimeStepRead chosen_of(std::span<const Plot3dStep> steps, const InputFile& file, const MeshOptions& options) {
  scene::TimeStepRead chosen = scene::chosen_step(options.time_step, steps.size(), file.name);
  for (const Plot3dStep& each : steps) chosen.times.push_back(each.time);
  return chosen;
}

[[noreturn]] void refuse_beginning(const InputFile& file, const char* format) {
  throw scene::bad_input(fmt::format("{}: it does not begin like a file of {}; check what it is", file.name, format));
}

}  // namespace

cells::MeshBlocks read_vtk_xml(const InputFile& file, const MeshOptions& options) {
  const std::string &source = file.name, extension = system::lower_extension(file.path),
                    type = vtk_xml_type(file.beginning);
  const XmlKind* const kind = kind_of(type);
  if (type.empty()) {
    require_no_utf16(file.beginning, source);
    throw scene::bad_input(fmt::format("{}: it does not begin like a VTK XML file; check that it is one", source));
  }
  if (type == "ImageData" || type == "PImageData")
    throw scene::bad_input(
        fmt::format("{}: it is a regular grid (image data), not a mesh; give it alone or among volumes", source));
  if (lists_pieces(file)) {
    // Reads pieces one by one, so that reading the whole gives the same result as reading parts, and errors name the
    // piece.
    const PieceList list = piece_list(file, options.blocks, options.surfaces);
    return read_pieces(list, 0, list.pieces.size(), options.progress);
  }
  if (!kind) throw scene::bad_input(fmt::format("{}: its type is '{}'; give a mesh", source, type));

  if (type.starts_with('P')) require_uncompressed(file.path);
  cells::MeshBlocks result = named_format(*kind, extension);
  cells::MeshBlocks read = read_data_set(file, type, options);
  cells::add_notes(read.notes, result.notes);
  result.surface_names = std::move(read.surface_names);
  result.blocks = std::move(read.blocks);
  return result;
}

cells::MeshBlocks read_vtk_legacy(const InputFile& file, const MeshOptions& options) {
  if (!file.beginning.starts_with("# vtk DataFile Version"))
    throw scene::bad_input(fmt::format(
        "{}: it does not begin with '# vtk DataFile Version'; check that it is a legacy VTK file", file.name));
  return mesh_of(open_foreign(file, {{"reader", "vtk_legacy"}}, options.progress));
}

cells::MeshBlocks read_exodus(const InputFile& file, const MeshOptions& options) {
  if (!exodus_files(file).empty()) return read_share(file, options, 0, 1);
  if (!file.beginning.starts_with("CDF") && !file.beginning.starts_with(hdf5_signature))
    throw scene::bad_input(
        fmt::format("{}: it is neither NetCDF nor HDF5; check that it is an Exodus file", file.name));
  return mesh_of(open_exodus(file, "exodus", options));
}

scene::TimeStepRead exodus_time_steps(const InputFile& file, const MeshOptions& options) {
  if (const auto files = exodus_files(file); !files.empty())
    return read_share(file, options, 0, static_cast<int>(files.size())).time_step;  // time step of the first file
  return open_exodus(file, "exodus", options).contents.time_step;
}

cells::MeshBlocks read_hdf5(const InputFile& file, const MeshOptions& options) {
  if (!exodus_files(file).empty()) return read_share(file, options, 0, 1);
  ForeignFile opened = open_exodus(file, "hdf5", options);
  return opened.contents.has_levels ? read_amr(std::move(opened), options) : mesh_of(opened, GridsAre::hexahedra);
}

cells::MeshBlocks read_openfoam(const InputFile& file, const MeshOptions& options) {
  require_uncompressed(file.path);
  return read_foreign_mesh(file, {Reader::vtk, "openfoam"}, options);
}

cells::MeshBlocks read_ensight(const InputFile& file, const MeshOptions& options) {
  require_uncompressed(file.path);
  return read_foreign_mesh(file, {Reader::vtk, "ensight"}, options);
}

cells::MeshBlocks read_fluent(const InputFile& file, const MeshOptions& options) {
  // VTK's reader crashes even for some valid files.
  constexpr const char* remedy = "VTK's reader does not support all variants of it: export CGNS or EnSight";
  return read_foreign_mesh(file, {Reader::vtk, "fluent", remedy}, options);
}

cells::MeshBlocks read_gambit(const InputFile& file, const MeshOptions& options) {
  if (!file.is_recognized) refuse_beginning(file, "GAMBIT");
  return read_foreign_mesh(file, {Reader::vtk, "gambit"}, options);
}

cells::MeshBlocks read_avs_ucd(const InputFile& file, const MeshOptions& options) {
  const bool is_binary = file.beginning.starts_with('\a');
  if (!file.is_recognized && !is_binary) refuse_beginning(file, "AVS UCD");
  return read_foreign_mesh(file, {Reader::vtk, "avs_ucd"}, options);
}

cells::MeshBlocks read_plot3d(const InputFile& input, const MeshOptions& options) {
  const std::filesystem::path &file = input.path, &q_file = options.plot3d_q;
  const Plot3dLayout layout = detect_plot3d(file);
  const std::filesystem::path q = q_file.empty() ? find_plot3d_solution(file) : q_file;
  std::vector<std::string> notes;
  if (q.empty())
    notes.emplace_back(
        is_inflated(file)
            ? "the program does not search for a solution (Q) file next to a gzip file, so the grid has no field; name "
              "a file with `q`"
            : "there is no solution (Q) file next to the grid, so the grid has no field; name a file with `q`");
  else if (const std::uint64_t left = check_plot3d_solution(q, layout); left > 0)
    notes.push_back(fmt::format("{} {} after the solution in {} are not used", left,
                                layout.is_text ? "numbers" : "bytes", q.filename().string()));
  const std::string stored = layout.is_text
                                 ? "text"
                                 : fmt::format("{}-endian {}, {}", layout.big_endian ? "big" : "little",
                                               layout.double_precision ? "float64" : "float32",
                                               layout.record_marks ? "with record marks" : "no record marks");
  notes.push_back(fmt::format("PLOT3D: {} grid{}, {}, {}{}", layout.grids.size(), layout.grids.size() == 1 ? "" : "s",
                              stored, layout.iblank ? "IBLANK" : "no IBLANK",
                              q.empty() ? "" : fmt::format(", solution {}", q.filename().string())));
  cells::MeshBlocks result = mesh_of(open_foreign(input,
                                                  {{"reader", "plot3d"},
                                                   {"q", q.string()},
                                                   {"text", layout.is_text},
                                                   {"big_endian", layout.big_endian},
                                                   {"record_marks", layout.record_marks},
                                                   {"multi_grid", layout.multi_grid},
                                                   {"double_precision", layout.double_precision},
                                                   {"iblank", layout.iblank}},
                                                  options.progress));
  result.notes.insert(result.notes.begin(), notes.begin(), notes.end());
  return result;
}

cells::MeshBlocks read_plot3d_list(const InputFile& file, const MeshOptions& options) {
  const std::vector<Plot3dStep> steps = steps_of_list(file);
  scene::TimeStepRead chosen = chosen_of(steps, file, options);
  const Plot3dStep& step = steps[chosen.step];
  MeshOptions of_step = options;
  of_step.time_step.reset();
  if (of_step.plot3d_q.empty()) of_step.plot3d_q = step.solution;
  cells::MeshBlocks result =
      read_plot3d({.path = step.grid, .name = step.grid.string(), .format = file.format}, of_step);
  for (cells::CellBlock& block : result.blocks)
    if (block.source.empty()) block.source = step.grid.string();
  result.time_step = std::move(chosen);
  if (step.has_functions) result.notes.emplace_back("the list also names a file of functions, which is not read");
  return result;
}

scene::TimeStepRead plot3d_list_time_steps(const InputFile& file, const MeshOptions& options) {
  return chosen_of(steps_of_list(file), file, options);
}

}  // namespace tessera::io
