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

/// Samples of a mesh on a regular grid. If several tets give a value for one sample, the smallest encoded value is
/// kept. The result therefore does not depend on the order in which threads and ranks compute values. One bit states
/// whether the sample is outside its tet, 31 bits contain the number of the tet, and 32 bits contain the value as a
/// float between 0 and 1. All bits are set if there is no value.
using PreviewSamples = std::vector<std::uint64_t>;
inline constexpr std::uint64_t no_sample = ~std::uint64_t{0};

/// Returns a regular grid over a box, with at most `samples` points.
GridGeometry preview_geometry(const Box& box, std::uint64_t samples);

/// Samples a part of a mesh. `global_tet` contains the indices of the part's tets in the whole mesh; if it is empty,
/// the part is the whole mesh. `range` is the range of the whole mesh. A sample outside all tets also has a value if it
/// is outside the face planes of one tet by at most half of the sample spacing: the tet's field continued linearly to
/// the sample, clamped to the range of the corners. The volume is therefore correct on average, even for parts thinner
/// than that distance. The result is incomplete if `stop` is requested.
PreviewSamples preview_samples(const scene::TetMeshView& part, std::span<const std::uint64_t> global_tet,
                               const std::array<double, 2>& range, const GridGeometry& geometry,
                               const std::stop_token& stop);

/// Returns a grid over the same box with fewer samples, each the mean of the samples nearest to it. Returns null if
/// `stop` is requested.
std::shared_ptr<const scene::SampleSource> coarser(const scene::SampleSource& source, std::uint64_t samples,
                                                   const std::stop_token& stop);

}  // namespace tessera::api
