// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cells/surface.hpp"
#include "io/files/input_file.hpp"
#include "tessera/surfaces.hpp"

namespace tessera::io {

/// A surface as its file has it, points at one place made one where the format cannot say it.
struct SurfaceFile {
  cells::Surface surface{};
  std::vector<std::string> attribute_names{}, notes{};
  const char* words = "";  ///< of its format
};

/// As tessera::read_triangles().
tessera::TriangleMesh read_triangles(const InputFile& file);

}  // namespace tessera::io
