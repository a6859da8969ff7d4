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

/// The faces of a mesh that belong to only one tet (tessera/surfaces.hpp), in the order of their corners' positions.
/// The order of a face's corners varies, but its normal points outward; for faces of flat tets the orientation is
/// arbitrary.
struct BoundaryFaces {
  tessera::TriangleMesh mesh;     ///< three separate points per triangle; for cell data three times the tet's value
  std::vector<std::uint8_t> own;  ///< by triangle: 1 if this rank has the tet
};

/// For a mesh that is whole. Uses 80 bytes per tet while it runs, in the caller's task arena (oneTBB).
BoundaryFaces boundary_faces(const scene::TetMeshView& mesh);

/// For a mesh in parts, one per rank; the same triangles on all ranks. Collective: sends every face that no other tet
/// of the part shares to all ranks, 104 bytes per face.
BoundaryFaces boundary_faces(const scene::TetMeshView& part, exchange::Transport& transport);

/// All triangle surfaces of a frame, with the triangles owned by process `process` of `processes`. `boundary` is null
/// if there is none; it and the surfaces' triangles must outlive the result.
std::vector<projection::SurfaceFaces> faces_of(const scene::Surfaces& surfaces, const scene::SurfaceSet& set,
                                               const BoundaryFaces* boundary, std::uint32_t process = 0,
                                               std::uint32_t processes = 1);

}  // namespace tessera::frame
