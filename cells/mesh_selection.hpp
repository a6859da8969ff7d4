// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "cells/field_summary.hpp"
#include "scene/selection.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::cells {

/// Leaves of a mesh what is selected (tessera/selection.hpp): threshold, then one half-space after the other. Tets stay
/// in their order, those of one cell next to each other; vertices that are not used any more are dropped. `counts` gets
/// cells_out_of_range, cells_clipped, cells_cut and the new number of tets. The mesh may be a part of one: what comes
/// of a tet depends on its corners' positions and values alone. Throws Error(bad_input) for a mesh that would have 2^32
/// vertices, and as validate() does.
void select(scene::TetMesh& mesh, const scene::Selection& selection, MeshCounts& counts, const std::string& source);

/// Throws Error(bad_input) if a selection has left nothing of a whole mesh.
void require_selected(const MeshCounts& counts, const std::string& source);

}  // namespace tessera::cells
