// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "scene/sample_source.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::api {

/// Samples of a mesh on a regular grid, so encoded that the lesser of two is the one that holds, in whatever order they
/// come, from whatever thread or rank: 1 bit whether it lies beside its tet, 31 bits the tet, 32 bits its value as a
/// float's bits, which are from 0 to 1. All ones: none.
using StandInSamples = std::vector<std::uint64_t>;
inline constexpr std::uint64_t no_sample = ~std::uint64_t{0};

/// A regular grid over a box with so many points at most.
GridGeometry stand_in_geometry(const Box& box, std::uint64_t samples);

/// Samples of a mesh's part, whose tets have the numbers `global_tet` in the whole (empty: their own). `range` is the
/// whole's. A point beside tets that is no further than half of a sample's distance from the planes of all faces of one
/// has the value that the field would have there, within that tet's; so the volume is right in the mean, of what is
/// thinner than that distance too. Less than all once `stop` is asked for.
StandInSamples stand_in_samples(const scene::TetMeshView& part, std::span<const std::uint64_t> global_tet,
                                const std::array<double, 2>& range, const GridGeometry& geometry,
                                const std::stop_token& stop);

/// Fewer samples of a grid over the same box, each the mean of those nearest to it; null once `stop` is asked for.
std::shared_ptr<const scene::SampleSource> coarser(const scene::SampleSource& source, std::uint64_t samples,
                                                   const std::stop_token& stop);

}  // namespace tessera::api
