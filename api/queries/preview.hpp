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

/// Samples of a mesh on a regular grid, encoded so that the smaller of two is the one to keep, in whatever order they
/// come from threads and ranks: 1 bit whether the sample is outside its tet, 31 bits for the tet, and 32 bits for the
/// float of its value, which is between 0 and 1. All ones: none.
using PreviewSamples = std::vector<std::uint64_t>;
inline constexpr std::uint64_t no_sample = ~std::uint64_t{0};

/// A regular grid over a box with at most `samples` points.
GridGeometry preview_geometry(const Box& box, std::uint64_t samples);

/// Samples of a part of a mesh, whose tets have the indices `global_tet` in the whole mesh (empty: their own). `range`
/// is that of the whole. A point outside all tets that is no further than half of the sample spacing from the planes of
/// all faces of one tet has that tet's value there, clamped to the range of its corners; so the volume is correct on
/// average, even of parts thinner than that distance. Incomplete if `stop` is requested.
PreviewSamples preview_samples(const scene::TetMeshView& part, std::span<const std::uint64_t> global_tet,
                               const std::array<double, 2>& range, const GridGeometry& geometry,
                               const std::stop_token& stop);

/// Fewer samples of a grid over the same box, each the mean of those nearest to it; null if `stop` is requested.
std::shared_ptr<const scene::SampleSource> coarser(const scene::SampleSource& source, std::uint64_t samples,
                                                   const std::stop_token& stop);

}  // namespace tessera::api
