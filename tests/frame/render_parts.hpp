// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "exchange/loopback_transport.hpp"
#include "frame/ranks/distributed.hpp"
#include "scene/mesh_facts.hpp"

namespace tessera::frame {

/// Renders a frame of a mesh that is divided into parts. There is one rank for each part; every rank is a projector and
/// a compositor. The parts must be in a box with a diagonal of at most 4. Their original_cell contains the numbers of
/// their tets in the whole mesh.
inline std::vector<FinishedFrame> render_parts(const std::vector<scene::TetMesh>& parts,
                                               const DistributedSettings& settings, const FrameJob& job,
                                               const scene::TransferFunction& function) {
  std::vector<FinishedFrame> frames;
  scene::MeshFacts whole;
  for (const scene::TetMesh& part : parts) whole = scene::joined(whole, scene::facts_of(part));
  const auto ranks = static_cast<int>(parts.size());
  exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
    DistributedSettings mine = settings;
    mine.roles = assign_roles(ranks, ranks, ranks);
    render_distributed(
        transport, mine, std::span(&job, 1), function,
        [&](std::size_t) {
          ProjectorMesh mesh;
          const scene::TetMesh& part = parts[static_cast<std::size_t>(transport.rank())];
          mesh.part = part;
          mesh.global_tet = part.original_cell;
          mesh.diagonal = 4;
          mesh.box = whole.box;
          mesh.scalar_range = whole.scalar_range;
          return mesh;
        },
        [&](FinishedFrame frame) { frames.push_back(std::move(frame)); });
  });
  return frames;
}

}  // namespace tessera::frame
