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

/// The faces of a mesh that one tet alone has (tessera/surfaces.hpp), in the order of their corners' positions. The
/// corners are in no common order but turn so that the normal points outward; of a flat tet's faces one way or other.
struct BoundaryFaces {
  tessera::TriangleMesh mesh;     ///< three points of its own a triangle; of cell data three times the tet's value
  std::vector<std::uint8_t> own;  ///< by triangle: 1 if this rank has the tet
};

/// Of a mesh that is whole. Takes 80 bytes a tet while it runs, in the caller's task arena (oneTBB).
BoundaryFaces boundary_faces(const scene::TetMeshView& mesh);

/// Of a mesh of which each rank has a part; the same triangles on all. Collective: what no other tet of the part has is
/// sent to all ranks, 104 bytes a face.
BoundaryFaces boundary_faces(const scene::TetMeshView& part, exchange::Transport& transport);

/// All surfaces of triangles of a frame as process `process` of `processes` has them. `boundary` is null where there
/// are none of it; it and the surfaces' triangles must outlive what is returned.
std::vector<projection::SurfaceFaces> faces_of(const scene::Surfaces& surfaces, const scene::SurfaceSet& set,
                                               const BoundaryFaces* boundary, std::uint32_t process = 0,
                                               std::uint32_t processes = 1);

}  // namespace tessera::frame
