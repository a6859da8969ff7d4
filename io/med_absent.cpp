// Built in place of foreign_med.cpp with TESSERA_MED=OFF.
#include <fmt/format.h>

#include "io/mesh_formats.hpp"
#include "scene/error.hpp"

namespace tessera::io {

bool has_med() { return false; }

MeshBlocks read_med(const std::filesystem::path& file, const MeshOptions&) {
  throw scene::bad_input(
      fmt::format("{}: MED files need their library, which this build leaves out; build with TESSERA_MED=ON, or write "
                  ".vtu with ParaVis or meshio",
                  file.string()));
}

}  // namespace tessera::io
