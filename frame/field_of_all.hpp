#pragma once

#include <cstdint>
#include <span>

#include "exchange/transport.hpp"
#include "scene/field_samples.hpp"
#include "scene/mesh_facts.hpp"

namespace tessera::frame {

/// What colours and opacities go by, of data before a selection.
struct FieldOfAll {
  scene::MeshFacts facts;
  scene::FieldSamples samples;
};

/// Samples of a mesh of which each rank has a part, by the tets' numbers in the whole. Collective.
scene::FieldSamples gather_field_samples(exchange::Transport& transport, const scene::TetMeshView& part,
                                         std::span<const std::uint64_t> global_tet, const scene::MeshFacts& facts);

}  // namespace tessera::frame
