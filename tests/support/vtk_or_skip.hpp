// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include "io/files/reader_programs.hpp"

/// Skips a test of files that tessera-read-vtk reads if that is not built (TESSERA_VTK=OFF).
#define TESSERA_VTK_OR_SKIP() \
  if (!tessera::io::has_reader(tessera::io::Reader::vtk)) GTEST_SKIP() << "tessera-read-vtk is not installed"
