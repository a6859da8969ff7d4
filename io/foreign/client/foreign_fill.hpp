// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cells/surface.hpp"
#include "io/files/input_file.hpp"
#include "io/foreign/messages/surface_message.hpp"

namespace tessera::io {

/// Fills a surface with tets by running tessera-read-tetgen, the only program that links TetGen. Throws
/// Error(bad_input, "FILE: ...") if the surface is not closed or intersects itself, or if TetGen gives up or needs more
/// memory or time than the number of facets and tets explains (readers/common/limits.cpp). Throws missing_reader() if
/// the program is not installed.
FilledMesh fill_surface(const cells::Surface& surface, const FillSize& size, const InputFile& file);

}  // namespace tessera::io
