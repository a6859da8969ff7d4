// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cells/surface.hpp"
#include "io/files/input_file.hpp"
#include "io/foreign/messages/surface_message.hpp"

namespace tessera::io {

/// By tessera-read-tetgen, which links TetGen; nothing else does. Throws Error(bad_input, "FILE: ...") if the surface
/// is not closed, cuts itself, TetGen gives up or takes more memory or time than the facets and tets explain
/// (readers/common/limits.cpp), or missing_reader().
FilledMesh fill_surface(const cells::Surface& surface, const FillSize& size, const InputFile& file);

}  // namespace tessera::io
