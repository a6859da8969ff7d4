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
  scene::TetMeshView mesh;                      ///< no tets: it was not made
  std::span<const std::uint64_t> global_tet{};  ///< index in the whole mesh of each tet; empty: its own

  /// Made from this member's tets `tets`, whose corners are in canonical order, of mesh `part`; `global_tet` as above.
  /// Makes none if it would take more than half of the machine's free memory, or is too large for 32-bit indices.
  /// Within an epoch of the team, collective; valid until the next one is made.
  static HostMesh made(scene::Team& team, const scene::TetMeshView& part, std::span<const scene::Tet> tets,
                       std::span<const std::uint64_t> global_tet);
};

}  // namespace tessera::frame
