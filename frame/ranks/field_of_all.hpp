// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "exchange/transport.hpp"
#include "scene/field_samples.hpp"
#include "scene/fill_value.hpp"
#include "scene/mesh_facts.hpp"

namespace tessera::frame {

/// Facts and samples of a data set before any clipping or threshold. Transfer functions are chosen from these.
struct FieldOfAll {
  scene::MeshFacts facts;
  scene::FieldSamples samples;
};

/// The fill value of a mesh in parts, one per rank, if the range in `facts` ends at one. Collective.
std::optional<scene::FillValue> find_fill_value(exchange::Transport& transport, const scene::TetMeshView& part,
                                                const scene::MeshFacts& facts);

/// Samples of a mesh in parts, one per rank, by the indices of the tets in the whole mesh. Collective.
scene::FieldSamples gather_field_samples(exchange::Transport& transport, const scene::TetMeshView& part,
                                         std::span<const std::uint64_t> global_tet, const scene::MeshFacts& facts);

}  // namespace tessera::frame
