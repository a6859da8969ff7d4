// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "exchange/transport.hpp"
#include "projection/surface_faces.hpp"
#include "scene/surface_set.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::frame {

/// The faces of a mesh that belong to only one tet (tessera/surfaces.hpp), sorted by the positions of their corners.
/// The order of the three corners of a face varies, but its normal points outward; for faces of flat tets the
/// orientation is arbitrary.
struct BoundaryFaces {
  tessera::TriangleMesh mesh;  ///< three separate points per triangle; cell data: each of the three has the tet's value
  std::vector<std::uint8_t> own;  ///< one flag per triangle: 1 if this rank, or its team, has the tet
};

/// Finds the boundary faces of a whole mesh. Uses 80 bytes per tet while it runs. Must be called in the caller's task
/// arena (oneTBB).
BoundaryFaces boundary_faces(const scene::TetMeshView& mesh);

/// Finds the boundary faces of a mesh in parts, one part per rank, and returns the same triangles on all ranks.
/// Collective: every rank sends to all ranks those faces of its part that belong to only one tet of the part, 104 bytes
/// per face. Ranks that share one part pass the same `owner`, the rank that sends the part's faces.
BoundaryFaces boundary_faces(const scene::TetMeshView& part, exchange::Transport& transport, int owner);

/// Returns all triangle surfaces of a frame and marks those that belong to this process (SurfaceFaces::here).
/// `boundary` may be null. `boundary` and the triangles of the surfaces must outlive the result.
std::vector<projection::SurfaceFaces> faces_of(const scene::Surfaces& surfaces, const scene::SurfaceSet& set,
                                               const BoundaryFaces* boundary,
                                               const std::vector<std::uint8_t>& here = {1});

}  // namespace tessera::frame
