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

/// Facts and samples of a data set before anything was clipped or left out by a threshold. Transfer functions are
/// chosen by these.
struct FieldOfAll {
  scene::MeshFacts facts;
  scene::FieldSamples samples;
};

/// The fill value of a mesh of which each rank has a part, if its range, which `facts` have, ends at one. Collective.
std::optional<scene::FillValue> find_fill_value(exchange::Transport& transport, const scene::TetMeshView& part,
                                                const scene::MeshFacts& facts);

/// Samples of a mesh of which each rank has a part, by the tets' numbers in the whole. Collective.
scene::FieldSamples gather_field_samples(exchange::Transport& transport, const scene::TetMeshView& part,
                                         std::span<const std::uint64_t> global_tet, const scene::MeshFacts& facts);

}  // namespace tessera::frame
