// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "io/files/reader_programs.hpp"
#include "io/mesh/mesh_formats.hpp"

/// External meshes, which are available only on some machines.
namespace tessera::frame {

inline auto shared_meshes() {
  return testing::Values("oxygen-post/postxyz.bin", "bluntfin/bluntfinxyz.bin",
                         "bracket/bracket_appended_compressed.vtu", "disk-out/disk_out_ref.ex2",
                         "notch/notch_stress_fixed.vtk", "unisim/UNISIM-II-D.vtu");
}

inline std::filesystem::path shared_mesh(const char* name) {
  return std::filesystem::path(TESSERA_SOURCE_DIR) / "../shared/data" / name;
}

/// Why a test of the mesh `name` is skipped; empty if the mesh can be read.
inline std::string missing_mesh(const char* name) {
  if (!io::has_reader(io::Reader::vtk)) return "tessera-read-vtk is not installed";
  return std::filesystem::exists(shared_mesh(name)) ? "" : "no " + shared_mesh(name).string();
}

}  // namespace tessera::frame
