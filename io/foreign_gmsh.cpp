#include "io/foreign_mixed.hpp"

namespace tessera::io {

bool has_gmsh() { return true; }

MeshBlocks read_by_gmsh(const std::filesystem::path& file, const char* reader, const MeshOptions& options) {
  HelperTask task;
  task.program = "tessera-read-gmsh";
  return read_foreign_mesh(file, {reader, std::move(task)}, options, GridsAre::volumes);
}

}  // namespace tessera::io
