// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/tet_mesh.hpp"

/// Derives meshes from other meshes, with properties of files from other sources. All functions keep scalars and the
/// order of tets unless stated otherwise.
namespace tessera::datasets {

/// Moves every vertex to scale * p + offset. Extinction is per world unit, so the transfer function should be scaled by
/// the inverse (transfer_functions.hpp: scaled).
scene::TetMesh transformed(scene::TetMesh mesh, double scale, const glm::dvec3& offset);

enum class Orientation { all_inverted, every_other_inverted };
/// Swaps two vertices of all tets, or of every other tet, which inverts their orientation.
scene::TetMesh inverted(scene::TetMesh mesh, Orientation orientation = Orientation::all_inverted);

/// Converts point data to cell data: the average over each run of `tets_per_cell` tets (1: every tet; 6: the voxels of
/// boxes.hpp). original_cell becomes the number of the run. Throws Error(bad_input) unless the number of tets is a
/// multiple of `tets_per_cell`.
scene::TetMesh with_cell_data(scene::TetMesh mesh, int tets_per_cell = 1);

/// Duplicates, at the same position, the vertices on the boundary of the tets whose centroid has p[axis] < place, so
/// that the two sides do not share any vertex. The geometry is unchanged.
scene::TetMesh with_seam(scene::TetMesh mesh, int axis, double place);

/// Cuts each tet into eight at its edge midpoints ("red" refinement; the inner octahedron is cut along one fixed
/// diagonal). Linear fields, volumes, orientation and matching faces are kept; cell data is inherited. The children of
/// a tet are consecutive; original_cell is dropped. Throws Error(bad_input) for more than 2^32 - 1 vertices.
/// Source: Bey, "Tetrahedral grid refinement", Computing 55, 1995.
scene::TetMesh subdivided(const scene::TetMesh& mesh);

/// Returns tets and vertices in random order, which has no spatial locality. original_cell is dropped.
scene::TetMesh shuffled(const scene::TetMesh& mesh, std::uint64_t seed);

/// How a mesh is distributed over parts.
enum class Partition {
  interleaved,  ///< each tet is in a random part: the worst case, because parts overlap everywhere
  random_blobs  ///< each tet is in the part with the nearest of four random centres per part: jagged, neither convex
                ///< nor connected
};
/// Divides a mesh into disjoint parts whose union is the mesh; some parts may be empty. Each part keeps the order of
/// its tets, has only the vertices that it uses, and stores in original_cell each tet's index in the whole mesh (or, if
/// the whole mesh has an original_cell, that of the tet).
std::vector<scene::TetMesh> parts(const scene::TetMesh& mesh, int count, Partition partition, std::uint64_t seed);

/// Returns one mesh of all parts, part after part, without merging vertices. Original cells are kept if all parts have
/// them. The scalars of all parts must have the same association.
scene::TetMesh merged(const std::vector<scene::TetMesh>& parts);

}  // namespace tessera::datasets
