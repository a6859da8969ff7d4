// SPDX-License-Identifier: BSD-3-Clause
// Meshes in other programs' formats, read by the helper.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "io/foreign/foreign_mixed.hpp"
#include "io/formats/file_beginnings.hpp"
#include "io/formats/file_kinds.hpp"
#include "io/formats/inflated_file.hpp"
#include "io/formats/input_file.hpp"
#include "io/mesh/listed_pieces.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "io/mesh/mesh_shares.hpp"
#include "io/mesh/plot3d_layout.hpp"
#include "io/mesh/plot3d_list.hpp"
#include "io/text/text_file.hpp"
#include "io/vtk/vtk_xml_file.hpp"
#include "scene/error.hpp"
#include "system/gzip.hpp"

namespace tessera::io {
namespace {

/// VTK's readers do not check what other files of these names hold, and crash or never end with some.
void require_solver_beginning(const std::filesystem::path& file, std::string_view reader) {
  const bool is_gambit = reader == "gambit";
  if (!is_gambit && reader != "avs_ucd") return;
  const std::string first = read_beginning(file, 2);
  const bool is_binary_ucd = !is_gambit && first.starts_with('\a');
  if (format_begun(file) == nullptr && !is_binary_ucd && !system::looks_like_gzip(first))
    throw scene::bad_input(fmt::format("{}: it does not begin as a file of {} does; check what it is", file.string(),
                                       is_gambit ? "GAMBIT" : "AVS UCD"));
}

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

/// The value of `type` in <VTKFile type="...">; empty if the file does not begin like VTK XML.
std::string xml_type(const std::filesystem::path& file) { return vtk_xml_type(read_beginning(file, 4096)); }

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

/// All of a file that the helper reads in one go.
cells::MeshBlocks read_foreign(const std::filesystem::path& file, nlohmann::json request,
                               const cells::MeshOptions& options) {
  HelperTask task;
  task.progress = options.progress;
  const ForeignFile opened = open_foreign(std::make_shared<HelperProcess>(std::move(task)), file, std::move(request));
  cells::MeshBlocks result;
  result.format = opened.contents.format;
  result.notes = opened.contents.notes;
  result.time_step = opened.contents.time_step;
  result.block_names = opened.contents.block_names;
  result.surface_names = opened.contents.surface_names;
  result.blocks = blocks_of(opened, result.notes);
  return result;
}

/// One data set in this process, or by VTK's reader if it has what this one does not know.
cells::MeshBlocks read_data_set(const std::filesystem::path& file, const std::string& type,
                                const cells::MeshOptions& options) {
  const std::optional<ForeignFile> opened = type.starts_with('P') ? std::nullopt : open_vtk_xml(file, options.progress);
  if (!opened) return read_foreign(file, {{"reader", "vtk_xml"}, {"type", type}}, options);
  cells::MeshBlocks result;
  result.blocks = blocks_of(*opened, result.notes);
  return result;
}

cells::MeshBlocks blocks_of_solver(const ForeignFile& opened) {
  cells::MeshBlocks result;
  result.format = opened.contents.format;
  result.notes = opened.contents.notes;
  result.time_step = opened.contents.time_step;
  result.block_names = opened.contents.block_names;
  result.surface_names = opened.contents.surface_names;
  result.blocks = blocks_of(opened, result.notes, GridsAre::hexahedra);
  return result;
}

}  // namespace

cells::MeshBlocks read_vtk_xml(const std::filesystem::path& file, const cells::MeshOptions& options) {
  const std::string source = file.string(), extension = system::lower_extension(file), type = xml_type(file);
  const XmlKind* const kind = kind_of(type);
  if (type.empty()) {
    require_no_utf16(file);
    throw scene::bad_input(fmt::format("{}: it does not begin as a VTK XML file does; check that it is one", source));
  }
  if (type == "ImageData" || type == "PImageData")
    throw scene::bad_input(
        fmt::format("{}: it is a regular grid (image data), no mesh; give it alone or among volumes", source));
  if (lists_pieces(file)) {
    // Pieces one by one, so that the whole reads as its parts do, and faults name the piece.
    const PieceList list = piece_list(file, options.blocks, options.surfaces);
    return read_pieces(list, 0, list.pieces.size(), options.progress);
  }
  if (!kind) throw scene::bad_input(fmt::format("{}: its type is '{}'; give a mesh", source, type));

  if (type.starts_with('P')) require_beside_others(file);
  cells::MeshBlocks result = named_format(*kind, extension);
  cells::MeshBlocks read = read_data_set(file, type, options);
  cells::add_notes(read.notes, result.notes);
  result.surface_names = std::move(read.surface_names);
  result.blocks = std::move(read.blocks);
  return result;
}

cells::MeshBlocks read_vtk_legacy(const std::filesystem::path& file, const cells::MeshOptions& options) {
  if (!read_beginning(file, 64).starts_with("# vtk DataFile Version"))
    throw scene::bad_input(fmt::format(
        "{}: it does not begin with '# vtk DataFile Version'; check that it is a legacy VTK file", file.string()));
  return read_foreign(file, {{"reader", "vtk_legacy"}}, options);
}

cells::MeshBlocks read_exodus(const std::filesystem::path& file, const cells::MeshOptions& options) {
  if (!exodus_files(file).empty()) return read_share(file, options, 0, 1);
  const std::string magic = read_beginning(file, 8);
  if (!magic.starts_with("CDF") && !magic.starts_with("\x89HDF\r\n\x1a\n"))
    throw scene::bad_input(
        fmt::format("{}: it is neither NetCDF nor HDF5; check that it is an Exodus file", file.string()));
  nlohmann::json request{{"reader", "exodus"}, {"blocks", options.blocks}};
  if (options.surfaces) request["surfaces"] = true;
  if (options.time_step) request["time_step"] = *options.time_step;
  return read_foreign(file, std::move(request), options);
}

cells::MeshBlocks read_solver_file(const std::filesystem::path& file, const char* reader,
                                   const cells::MeshOptions& options) {
  const std::string_view name = reader;
  require_solver_beginning(file, name);
  if (name == "openfoam" || name == "ensight") require_beside_others(file);
  HelperTask task;
  if (name == "fluent")  // good ones make it crash
    task.remedy = "VTK's reader does not know all kinds of it: export CGNS or EnSight";
  return read_foreign_mesh(file, {reader, std::move(task)}, options, GridsAre::hexahedra);
}

cells::MeshBlocks read_hdf5(const std::filesystem::path& file, const cells::MeshOptions& options) {
  if (!exodus_files(file).empty()) return read_share(file, options, 0, 1);
  nlohmann::json request{{"reader", "hdf5"}, {"blocks", options.blocks}};
  if (options.surfaces) request["surfaces"] = true;
  if (options.time_step) request["time_step"] = *options.time_step;
  if (!options.field.empty()) request["field"] = options.field;
  HelperTask task;
  task.progress = options.progress;
  ForeignFile opened = open_foreign(std::make_shared<HelperProcess>(std::move(task)), file, std::move(request));
  return opened.contents.has_levels ? read_amr(std::move(opened), options) : blocks_of_solver(opened);
}

cells::MeshBlocks read_plot3d(const std::filesystem::path& file, const cells::MeshOptions& options) {
  const std::filesystem::path& q_file = options.plot3d_q;
  const Plot3dLayout layout = detect_plot3d(file);
  const std::filesystem::path q = q_file.empty() ? find_plot3d_solution(file) : q_file;
  std::vector<std::string> notes;
  if (q.empty())
    notes.emplace_back(is_inflated(file)
                           ? "beside a gzip file no solution (Q) is looked for: it has no field; name one by `q`"
                           : "no solution (Q) file lies beside the grid: it has no field; name one by `q`");
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
  cells::MeshBlocks result = read_foreign(file,
                                          {{"reader", "plot3d"},
                                           {"q", q.string()},
                                           {"text", layout.is_text},
                                           {"big_endian", layout.big_endian},
                                           {"record_marks", layout.record_marks},
                                           {"multi_grid", layout.multi_grid},
                                           {"double_precision", layout.double_precision},
                                           {"iblank", layout.iblank}},
                                          options);
  result.notes.insert(result.notes.begin(), notes.begin(), notes.end());
  return result;
}

cells::MeshBlocks read_plot3d_list(const std::filesystem::path& file, const cells::MeshOptions& options) {
  require_beside_others(file);
  const std::vector<Plot3dStep> steps = parse_plot3d_list(read_text_file(file), file);
  scene::TimeStepRead chosen = scene::chosen_step(options.time_step, steps.size(), file.string());
  for (const Plot3dStep& each : steps) chosen.times.push_back(each.time);
  const Plot3dStep& step = steps[chosen.step];
  cells::MeshOptions of_step = options;
  of_step.time_step.reset();
  if (of_step.plot3d_q.empty()) of_step.plot3d_q = step.solution;
  cells::MeshBlocks result = read_plot3d(step.grid, of_step);
  for (cells::CellBlock& block : result.blocks)
    if (block.source.empty()) block.source = step.grid.string();
  result.time_step = std::move(chosen);
  if (step.has_functions)
    result.notes.emplace_back("the list names a file of functions beside the solution, which is not read");
  return result;
}

}  // namespace tessera::io
