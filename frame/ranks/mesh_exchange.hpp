// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exchange/transport.hpp"
#include "projection/partition.hpp"
#include "scene/mesh_facts.hpp"
#include "scene/tet_mesh.hpp"

/// A mesh in parts, one part per rank: the facts that all ranks agree on, and the distribution of tets to the
/// projectors.
namespace tessera::frame {

/// The tets of a mesh that one rank holds.
struct MeshPart {
  scene::TetMesh mesh;  ///< does not keep `original_cell` across ranks
  /// Index of each tet in the whole mesh, ascending. The index is the order in the file and the last part of the depth
  /// order's key. Empty if the mesh is the whole mesh, or has no tets.
  std::vector<std::uint64_t> global_tet;

  [[nodiscard]] std::uint64_t global_of(std::size_t tet) const { return global_tet.empty() ? tet : global_tet[tet]; }
};

/// Facts of the whole mesh, with the same bits on every rank, for any distribution, and in one process
/// (scene::facts_of). Collective.
scene::MeshFacts agree_facts(exchange::Transport& transport, const scene::TetMeshView& part);

/// Indices of this rank's tets in the whole mesh, if the whole mesh consists of the tets of rank 0, then those of rank
/// 1, and so on. Collective.
std::vector<std::uint64_t> numbered_by_rank(exchange::Transport& transport, std::size_t tets);

/// Limits the memory of an exchange: a message contains about `chunk_bytes`, and a rank is at most two rounds of
/// `round_bytes` ahead of the slowest receiver.
struct ExchangeLimits {
  std::size_t chunk_bytes = std::size_t{16} << 20, round_bytes = std::size_t{64} << 20;
};

/// Sends every tet to its owner: part p of `how` goes to rank projectors[p]. Collective. `local` contains the tets that
/// this rank has read; any distribution is allowed, with every tet of the mesh on exactly one rank. `facts` is the
/// result of agree_facts(). Ranks that are not projectors end with an empty part.
///
/// Positions and scalars keep their bits. The vertices of the result are those that its tets use, numbered in the order
/// of their first use; a vertex occurs once for each rank that sends it. If no tet must move, nothing is copied and
/// `local` is returned. At its peak, a rank holds what it read, what it received and the bytes of `limits`. Throws
/// Error(system_failure) for a part of 2^32 vertices or tets, or a malformed message.
MeshPart redistribute(exchange::Transport& transport, MeshPart local, const scene::MeshFacts& facts,
                      const projection::Partition& how, std::span<const int> projectors,
                      const ExchangeLimits& limits = {});

}  // namespace tessera::frame
