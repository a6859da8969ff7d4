// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cells/surface.hpp"
#include "io/formats/file_kinds.hpp"
#include "tessera/surfaces.hpp"

namespace tessera::io {

/// A surface as its file has it, points at one place made one where the format cannot say it.
struct SurfaceFile {
  cells::Surface surface;
  std::vector<std::string> attribute_names, notes;
  const char* words = "";  ///< of its format
};
SurfaceFile read_surface_file(const std::filesystem::path& file, FileKind kind);

/// As tessera::read_triangles().
tessera::TriangleMesh read_triangles(const std::filesystem::path& file);

}  // namespace tessera::io
