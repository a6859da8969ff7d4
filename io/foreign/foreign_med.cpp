// SPDX-License-Identifier: BSD-3-Clause
// MED, read by a helper of its own.
#include "io/foreign/foreign_mixed.hpp"

namespace tessera::io {

cells::MeshBlocks read_med(const std::filesystem::path& file, const cells::MeshOptions& options) {
  HelperTask task;
  task.reader = Reader::med;
  return read_foreign_mesh(file, {"med", std::move(task)}, options, GridsAre::hexahedra);
}

}  // namespace tessera::io
