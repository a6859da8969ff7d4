// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"
#include "frame/mesh/array_mesh.hpp"

namespace tessera::frame {

/// This rank's part of a caller's mesh. All ranks divide higher-order cells with one tolerance, computed from the box,
/// the field's range and the number of tets of all parts, so that shared faces are cut the same way. If tolerances and
/// limits differ, the smallest are used. Counts and higher_order are those of the whole mesh. Collective; throws as
/// mesh_of_arrays.
ArrayMesh mesh_of_part(const MeshArrays& part, exchange::Transport& transport);

}  // namespace tessera::frame
