// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"
#include "frame/mesh/array_mesh.hpp"

namespace tessera::frame {

/// This rank's part of a caller's mesh. All ranks divide higher-order cells by one tolerance, from the box, the field's
/// range and the number of tets of all parts, so that what two parts share is cut alike; of different tolerances and
/// limits the smallest. Counts and higher_order are the whole mesh's. Collective; throws as mesh_of_arrays.
ArrayMesh mesh_of_part(const MeshArrays& part, exchange::Transport& transport);

}  // namespace tessera::frame
