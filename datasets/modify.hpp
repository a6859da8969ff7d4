// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/tet_mesh.hpp"

/// Derives meshes from meshes, with properties of files from other sources. All keep scalars and the order of tets
/// unless stated otherwise.
namespace tessera::datasets {

/// Every vertex at scale * p + offset. Extinction is per world unit: scale the transfer function by the inverse
/// (transfer_functions.hpp: scaled).
scene::TetMesh transformed(scene::TetMesh mesh, double scale, const glm::dvec3& offset);

enum class Orientation { all_inverted, every_other_inverted };
/// The same tets with two vertices swapped: left-handed.
scene::TetMesh inverted(scene::TetMesh mesh, Orientation orientation = Orientation::all_inverted);

/// Point data averaged over each run of `tets_per_cell` tets (1: every tet; 6: the voxels of boxes.hpp) and given to
/// them as cell data, with original_cell set to the run. Throws Error(bad_input) unless the count divides evenly.
scene::TetMesh with_cell_data(scene::TetMesh mesh, int tets_per_cell = 1);

/// Vertices on the boundary of the tets whose centroid has p[axis] < place are duplicated at the same position: the two
/// sides then share no vertex. Geometry is unchanged.
scene::TetMesh with_seam(scene::TetMesh mesh, int axis, double place);

/// Each tet cut into eight at its edge midpoints ("red" refinement; the inner octahedron is cut along one fixed
/// diagonal). Linear fields, volumes, orientation and matching faces are kept; cell data is inherited. Children of a
/// tet are adjacent; original_cell is dropped. Throws Error(bad_input) past 2^32 - 1 vertices.
/// Source: Bey, "Tetrahedral grid refinement", Computing 55, 1995.
scene::TetMesh subdivided(const scene::TetMesh& mesh);

/// Tets and vertices in random order, original_cell dropped: the order has no spatial locality.
scene::TetMesh shuffled(const scene::TetMesh& mesh, std::uint64_t seed);

/// How a mesh is distributed over parts.
enum class Partition {
  interleaved,  ///< each tet to a random part: the worst case, parts overlap everywhere
  random_blobs  ///< each tet to the nearest of four random centres per part: jagged, not convex, not connected
};
/// Disjoint parts whose union is the mesh; some may be empty. Each keeps the tets' order, has only the vertices it
/// uses, and stores each tet's index in the whole as original_cell (or the whole's own original_cell).
std::vector<scene::TetMesh> parts(const scene::TetMesh& mesh, int count, Partition partition, std::uint64_t seed);

/// One mesh of all parts, part after part, vertices not merged. Original cells are kept if all parts have them. All
/// must have the same association of scalars.
scene::TetMesh merged(const std::vector<scene::TetMesh>& parts);

}  // namespace tessera::datasets
