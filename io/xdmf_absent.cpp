// Built in place of foreign_xdmf.cpp with TESSERA_XDMF=OFF.
#include <fmt/format.h>

#include "io/mesh_formats.hpp"
#include "io/volume_formats.hpp"

namespace tessera::io {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw scene::bad_input(
      fmt::format("{}: XDMF files need its library, which this build leaves out; build with TESSERA_XDMF=ON, or save "
                  "it as .vtu in ParaView",
                  file.string()));
}

}  // namespace

bool has_xdmf() { return false; }
bool holds_xdmf_grid(const std::filesystem::path&) { return false; }
VolumeFile read_xdmf_grid(const std::filesystem::path& file, const VolumeOptions&) { refuse(file); }
MeshBlocks read_xdmf_mesh(const std::filesystem::path& file, const MeshOptions&) { refuse(file); }

}  // namespace tessera::io
