// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cells/surface.hpp"
#include "io/files/input_file.hpp"

namespace tessera::io {

/// Reads an STL surface by VTK; each face has its own points. Throws Error(bad_input, "FILE: ...").
cells::Surface read_stl(const InputFile& file);

/// A VTK surface, XML (.vtp) or legacy: its polygons and strips; point arrays with one component become its attributes.
struct VtkSurface {
  cells::Surface surface;
  std::vector<std::string> attribute_names, notes;
};
VtkSurface read_vtk_surface(const InputFile& file);

}  // namespace tessera::io
