#pragma once

#include <gtest/gtest.h>

#include "io/mesh_formats.hpp"

/// Skips a test that needs what TESSERA_VTK=OFF leaves out.
#define TESSERA_VTK_OR_SKIP() \
  if (!tessera::io::has_vtk()) GTEST_SKIP() << "built without VTK"
