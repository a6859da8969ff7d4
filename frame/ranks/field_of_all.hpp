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

/// Finds the fill value of a mesh whose parts are on the ranks, if the range in `facts` ends at a fill value.
/// Collective.
std::optional<scene::FillValue> find_fill_value(exchange::Transport& transport, const scene::TetMeshView& part,
                                                const scene::MeshFacts& facts);

/// Samples the field of a mesh whose parts are on the ranks. `global_tet` has the index of each tet in the whole mesh,
/// by which tets are chosen. Collective.
scene::FieldSamples gather_field_samples(exchange::Transport& transport, const scene::TetMeshView& part,
                                         std::span<const std::uint64_t> global_tet, const scene::MeshFacts& facts);

}  // namespace tessera::frame
