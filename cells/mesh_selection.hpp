// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "cells/field_summary.hpp"
#include "scene/selection.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::cells {

/// Reduces a mesh to the selection (tessera/selection.hpp): first by the threshold, then by each half-space. Tets keep
/// their order, and those of one cell remain consecutive; unused vertices are dropped. Sets cells_out_of_range,
/// cells_clipped, cells_cut and the new number of tets in `counts`. The mesh may be a part of another mesh, because the
/// result for a tet depends only on the positions and values of its corners. Throws Error(bad_input) for a mesh that
/// would have 2^32 vertices, and the errors of validate().
void select(scene::TetMesh& mesh, const scene::Selection& selection, MeshCounts& counts, const std::string& source);

/// Throws Error(bad_input) if the selection of a whole mesh is empty.
void require_selected(const MeshCounts& counts, const std::string& source);

}  // namespace tessera::cells
