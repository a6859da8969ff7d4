// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cells/surface.hpp"

namespace tessera::io {

/// An STL surface by VTK, each face with points of its own. Throws Error(bad_input, "SOURCE: ...").
cells::Surface read_stl(const std::string& source);

/// A VTK surface, XML (.vtp) or legacy: its polygons and strips; point arrays of one component are its attributes.
struct VtkSurface {
  cells::Surface surface;
  std::vector<std::string> attribute_names, notes;
};
VtkSurface read_vtk_surface(const std::string& source);

}  // namespace tessera::io
