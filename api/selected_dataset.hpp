// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "api/dataset.hpp"
#include "frame/mesh/uncut_mesh.hpp"
#include "tessera/selection.hpp"

namespace tessera::api {

/// Returns the mesh before clipping. The data set must be whole on this rank or have been read from files, which may be
/// read again. Throws the same errors as Dataset::open(), and Error(bad_input) if this rank has only a part of a mesh
/// without files. `data` must outlive the result.
frame::UncutMesh uncut_mesh(const Dataset::State& data);

/// Reduces a grid's box to the bounding box of its part inside `grid.clip`. Throws Error(bad_input) if nothing
/// remains.
void clip_box(Dataset::State& grid, const std::string& source);

}  // namespace tessera::api
