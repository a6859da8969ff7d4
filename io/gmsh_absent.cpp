// Built in place of foreign_gmsh.cpp with TESSERA_GMSH=OFF.
#include <fmt/format.h>

#include "io/mesh_formats.hpp"
#include "scene/error.hpp"

namespace tessera::io {

bool has_gmsh() { return false; }

MeshBlocks read_by_gmsh(const std::filesystem::path& file, const char*, const MeshOptions&) {
  const FormatRow* const row = format_of(file);
  throw scene::bad_input(
      fmt::format("{}: {} files need Gmsh's library, which this build leaves out; build with TESSERA_GMSH=ON, or "
                  "convert it to .vtu",
                  file.string(), row != nullptr ? row->name : "such"));
}

}  // namespace tessera::io
