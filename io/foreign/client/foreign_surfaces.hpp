// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cells/surface.hpp"
#include "io/files/input_file.hpp"

namespace tessera::io {

/// Reads an STL surface with VTK; each face has its own points. Throws Error(bad_input, "FILE: ...").
cells::Surface read_stl(const InputFile& file);

/// A surface in a VTK file, XML (.vtp) or legacy. Polygons and strips are read; point arrays with one component become
/// attributes.
struct VtkSurface {
  cells::Surface surface;
  std::vector<std::string> attribute_names, notes;
};
VtkSurface read_vtk_surface(const InputFile& file);

}  // namespace tessera::io
