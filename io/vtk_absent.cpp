// Built in place of what needs VTK with TESSERA_VTK=OFF.
#include <fmt/format.h>

#include "io/amr_opened.hpp"
#include "io/foreign_surfaces.hpp"
#include "io/input_file.hpp"
#include "io/listed_pieces.hpp"
#include "io/mesh_formats.hpp"
#include "io/mesh_shares.hpp"
#include "io/volume_formats.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file) {
  const FormatRow* const row = format_of(file);
  throw scene::bad_input(
      fmt::format("{}: {} files need VTK, which this build leaves out; build with TESSERA_VTK=ON, or convert it to "
                  "another format",
                  file.string(), row != nullptr ? row->name : lower_extension(file)));
}

}  // namespace

bool has_vtk() { return false; }

MeshBlocks read_vtk_xml(const std::filesystem::path& file, const MeshOptions&) { refuse(file); }
MeshBlocks read_vtk_legacy(const std::filesystem::path& file, const MeshOptions&) { refuse(file); }
MeshBlocks read_exodus(const std::filesystem::path& file, const MeshOptions&) { refuse(file); }
MeshBlocks read_solver_file(const std::filesystem::path& file, const char*, const MeshOptions&) { refuse(file); }
MeshBlocks read_plot3d(const std::filesystem::path& file, const MeshOptions&) { refuse(file); }
MeshBlocks read_plot3d_list(const std::filesystem::path& file, const MeshOptions&) { refuse(file); }
OpenedAmr open_amr_list(const std::filesystem::path& file) { refuse(file); }
OpenedAmr open_hyper_trees(const std::filesystem::path& file) { refuse(file); }
OpenedAmr open_amr_by(const char*, const std::filesystem::path& file) { refuse(file); }
MeshBlocks read_hdf5(const std::filesystem::path& file, const MeshOptions&) { refuse(file); }
VolumeFile read_vtk_grid(const std::filesystem::path& file, const VolumeOptions&) { refuse(file); }
bool holds_grid_by_vtk(const std::filesystem::path&, const char*) { return false; }
VolumeFile read_by_vtk(const std::filesystem::path& file, const char*, const VolumeOptions&) { refuse(file); }
Surface read_stl(const std::string& source) { refuse(source); }
VtkSurface read_vtk_surface(const std::string& source) { refuse(source); }

// Read whole, by read_vtk_xml().
bool lists_pieces(const std::filesystem::path&) { return false; }
PieceList piece_list(const std::filesystem::path& file, const BlockChoice&, bool) { refuse(file); }
bool has_shares(const std::filesystem::path&) { return false; }
std::vector<std::filesystem::path> exodus_files(const std::filesystem::path&) { return {}; }
MeshBlocks read_share(const std::filesystem::path& file, const MeshOptions&, int, int) { refuse(file); }
MeshBlocks read_pieces(const PieceList&, std::size_t, std::size_t, const ReadProgressFunction&) { return {}; }

}  // namespace tessera::io
