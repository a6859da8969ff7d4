// SPDX-License-Identifier: BSD-3-Clause
#include "io/foreign/foreign_mixed.hpp"

namespace tessera::io {

cells::MeshBlocks read_by_gmsh(const std::filesystem::path& file, const char* reader,
                               const cells::MeshOptions& options) {
  HelperTask task;
  task.reader = Reader::gmsh;
  return read_foreign_mesh(file, {reader, std::move(task)}, options, GridsAre::volumes);
}

}  // namespace tessera::io
