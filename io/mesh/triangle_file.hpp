// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cells/surface.hpp"
#include "io/files/input_file.hpp"
#include "tessera/surfaces.hpp"

namespace tessera::io {

/// A surface as stored in its file. Points at the same position are merged if the format cannot share points between
/// faces.
struct SurfaceFile {
  cells::Surface surface{};
  std::vector<std::string> attribute_names{}, notes{};
  const char* words = "";  ///< description of the file's format
};

/// Implements tessera::read_triangles().
tessera::TriangleMesh read_triangles(const InputFile& file);

}  // namespace tessera::io
