// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

#include "scene/team.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::frame {

/// The parts of a team's members as one mesh in their shared memory. Its tets are in the order of the whole mesh, so
/// that ties in depth are resolved as in one process.
struct HostMesh {
  scene::TetMeshView mesh;                      ///< has no tets if the mesh was not made
  std::span<const std::uint64_t> global_tet{};  ///< index of each tet in the whole mesh; empty: the index in `mesh`

  /// Makes the mesh. This member contributes the tets `tets` of mesh `part`, whose corners are in canonical order;
  /// `global_tet` has their indices as above. The result has no tets if the mesh would take more than half of the
  /// machine's free memory, or is too large for 32-bit indices. Collective, within an epoch of the team; the result is
  /// valid until the next mesh is made.
  static HostMesh made(scene::Team& team, const scene::TetMeshView& part, std::span<const scene::Tet> tets,
                       std::span<const std::uint64_t> global_tet);
};

}  // namespace tessera::frame
