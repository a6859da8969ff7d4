#include "io/mesh_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "io/clean_errors.hpp"
#include "io/input_file.hpp"
#include "io/mapped_file.hpp"
#include "io/mesh_assembly.hpp"
#include "io/mesh_formats.hpp"
#include "io/tets_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// Families of files that are read alike.
enum class Family { none, vtk_xml, vtk_legacy, exodus, plot3d, tetgen, surface, tets, solver };

struct Extension {
  const char* text;
  Family family;
  const char* reader = "";  ///< of solvers' files: read_solver_file()
};
constexpr std::array extensions = {
    Extension{".vtu", Family::vtk_xml},
    Extension{".pvtu", Family::vtk_xml},
    Extension{".vts", Family::vtk_xml},
    Extension{".pvts", Family::vtk_xml},
    Extension{".vtr", Family::vtk_xml},
    Extension{".pvtr", Family::vtk_xml},
    Extension{".vtk", Family::vtk_legacy},
    Extension{".ex2", Family::exodus},
    Extension{".exo", Family::exodus},
    Extension{".exii", Family::exodus},
    Extension{".e", Family::exodus},
    Extension{".g", Family::exodus},
    Extension{".xyz", Family::plot3d},
    Extension{".p3d", Family::plot3d},
    Extension{".x", Family::plot3d},
    Extension{".bin", Family::plot3d},
    Extension{".node", Family::tetgen},
    Extension{".ele", Family::tetgen},
    Extension{".stl", Family::surface},
    Extension{".ply", Family::surface},
    Extension{".poly", Family::surface},
    Extension{".smesh", Family::surface},
    Extension{".tets", Family::tets},
    Extension{".vtm", Family::vtk_xml},
    Extension{".vtmb", Family::vtk_xml},
    Extension{".vtpc", Family::vtk_xml},
    Extension{".vtpd", Family::vtk_xml},
    Extension{".foam", Family::solver, "openfoam"},
    Extension{".case", Family::solver, "ensight"},
    Extension{".encas", Family::solver, "ensight"},
    Extension{".cgns", Family::solver, "cgns"},
    Extension{".vtkhdf", Family::solver, "vtk_hdf"},
    Extension{".inp", Family::solver, "avs_ucd"},
    Extension{".ucd", Family::solver, "avs_ucd"},
    Extension{".cas", Family::solver, "fluent"},
    Extension{".neu", Family::solver, "gambit"},
    Extension{".tec", Family::solver, "tecplot"},
};

const Extension* extension_of(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  const auto* e = std::find_if(extensions.begin(), extensions.end(),
                               [&](const Extension& known) { return extension == known.text; });
  return e == extensions.end() ? nullptr : e;
}

Family family_of(const std::filesystem::path& file) {
  const Extension* const known = extension_of(file);
  return known == nullptr ? Family::none : known->family;
}

bool has_time_steps(const std::filesystem::path& file) {
  return family_of(file) == Family::exodus || family_of(file) == Family::solver;
}

std::string known_extensions() {
  std::string text;
  for (const Extension& e : extensions) text += fmt::format("{}{}", text.empty() ? "" : " ", e.text);
  return text;
}

[[noreturn]] void refuse_extension(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  for (const char* volume : {".vti", ".pvti", ".mhd", ".mha", ".nrrd", ".nhdr", ".nii", ".gz", ".raw"})
    if (extension == volume)
      throw scene::bad_input(fmt::format(
          "{}: it is a regular grid, no mesh; render, info and convert take it as a volume", file.string()));
  throw scene::bad_input(fmt::format("{}: no mesh format has the extension '{}'; known are {}", file.string(),
                                     file.extension().string(), known_extensions()));
}

MeshBlocks read_blocks(const std::filesystem::path& file, const MeshOptions& options) {
  switch (family_of(file)) {
    case Family::vtk_xml:
      return read_vtk_xml(file);
    case Family::vtk_legacy:
      return read_vtk_legacy(file);
    case Family::exodus:
      return read_exodus(file, options.time_step);
    case Family::plot3d:
      return read_plot3d(file, options.plot3d_q);
    case Family::tetgen:
      return read_node_ele(file);
    case Family::surface:
      return read_surface(file, options.max_volume);
    case Family::tets:
      return blocks_of_tets(parse_tets(MappedFile(file).bytes(), file.string()));
    case Family::solver:
      return read_solver_file(file, extension_of(file)->reader, options.time_step);
    case Family::none:
      break;
  }
  refuse_extension(file);
}

}  // namespace

MeshBlocks blocks_of_tets(scene::TetMesh mesh) {
  CellBlock block;
  block.positions = std::move(mesh.positions);
  block.tets = std::move(mesh.tets);
  block.fields.push_back(field_of_values("scalar", "float", scene::Association::point, 1, std::move(mesh.scalars)));
  MeshBlocks result;
  result.format = "raw tetrahedra (.tets)";
  result.blocks.push_back(std::move(block));
  return result;
}

void require_mesh_file(const std::filesystem::path& file) {
  require_file(file);
  if (!is_mesh_file(file)) refuse_extension(file);
}

bool is_mesh_file(const std::filesystem::path& file) { return family_of(file) != Family::none; }

MeshFile read_mesh(const std::filesystem::path& file, const MeshOptions& options) {
  const std::string source = file.string();
  require_file(file);
  return with_clean_errors(source, [&] {
    MeshBlocks read = read_blocks(file, options);
    if (!has_time_steps(file)) require_no_time_step(options, source);
    MeshFile result = assemble_mesh(std::move(read.blocks), options, source);
    result.format = std::move(read.format);
    result.notes.insert(result.notes.begin(), read.notes.begin(), read.notes.end());
    return result;
  });
}

MeshFile read_mesh(std::span<const std::filesystem::path> files, const MeshOptions& options) {
  if (files.size() == 1) return read_mesh(files.front(), options);
  MeshBlocks all;
  for (const std::filesystem::path& file : files) {
    const std::string source = file.string();
    require_file(file);
    with_clean_errors(source, [&] {
      MeshBlocks read = read_blocks(file, options);
      if (!has_time_steps(file)) require_no_time_step(options, source);
      if (all.format.empty()) all.format = read.format;
      for (CellBlock& block : read.blocks) {
        if (block.source.empty()) block.source = source;
        all.blocks.push_back(std::move(block));
      }
      for (std::string& note : read.notes)
        if (std::find(all.notes.begin(), all.notes.end(), note) == all.notes.end())
          all.notes.push_back(std::move(note));
    });
  }
  const std::string source = files.empty() ? "mesh" : files.front().string();
  return with_clean_errors(source, [&] {
    MeshFile result = assemble_mesh(std::move(all.blocks), options, source);
    result.format = fmt::format("{} files: {}", files.size(), all.format);
    result.notes.insert(result.notes.begin(), all.notes.begin(), all.notes.end());
    return result;
  });
}

}  // namespace tessera::io
