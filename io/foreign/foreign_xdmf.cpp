// SPDX-License-Identifier: BSD-3-Clause
// XDMF, read by a helper of its own.
#include "io/foreign/foreign_mixed.hpp"
#include "io/volume/volume_formats.hpp"

namespace tessera::io {
namespace {

ForeignReader xdmf() {
  HelperTask task;
  task.reader = Reader::xdmf;
  return {"xdmf", task};
}

}  // namespace

bool holds_xdmf_grid(const std::filesystem::path& file) { return holds_one_grid(file, xdmf()); }

VolumeFile read_xdmf_grid(const std::filesystem::path& file, const VolumeOptions& options) {
  return read_foreign_volume(file, xdmf(), options);
}

cells::MeshBlocks read_xdmf_mesh(const std::filesystem::path& file, const cells::MeshOptions& options) {
  return read_foreign_mesh(file, xdmf(), options, GridsAre::hexahedra);
}

}  // namespace tessera::io
