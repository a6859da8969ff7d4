// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "api/dataset.hpp"
#include "frame/mesh/uncut_mesh.hpp"
#include "tessera/selection.hpp"

namespace tessera::api {

/// Of a data set that is whole on this rank, or was made of files, which may be read once more. Throws as
/// Dataset::open, and Error(bad_input) if this rank has only a part. The state must outlive it.
frame::UncutMesh uncut_mesh(const Dataset::State& data);

/// Makes a grid's box that of what half-spaces leave of it. Throws Error(bad_input) if that is nothing.
void clip_box(Dataset::State& grid, const Selection& selection, const std::string& source);

}  // namespace tessera::api
