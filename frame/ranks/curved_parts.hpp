// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"
#include "frame/mesh/array_mesh.hpp"

namespace tessera::frame {

/// Converts this rank's part of a caller's mesh. All ranks divide higher-order cells with one tolerance, so that shared
/// faces are cut the same way; it is computed from the box, the range of the field and the number of tets of all parts.
/// If tolerances and limits differ between ranks, the smallest are used. In the result, `counts` and `higher_order` are
/// those of the whole mesh. Collective; throws like mesh_of_arrays.
ArrayMesh mesh_of_part(const MeshArrays& part, exchange::Transport& transport);

}  // namespace tessera::frame
