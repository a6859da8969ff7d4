// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>

#include "tessera/communicator.hpp"
#include "tessera/dataset.hpp"
#include "tessera/export.hpp"

namespace tessera {
inline namespace v0_1 {

struct PreviewSettings {
  /// Approximate upper limit on the number of samples; a grid with fewer samples keeps its own number.
  std::uint64_t samples = std::uint64_t{128} * 128 * 128;
  int threads = 0;  ///< 0: all cores
};

/// A coarse grid that resembles the data from a distance: for use while something moves, when the data themselves take
/// too long. It has no error bound; programs should label images made from it.
///
/// Mesh   a regular grid over the mesh's box. A sample inside a tet has the field's value there, or that of the first
///        tet if there are several; cell data also become point data. Samples within half a sample spacing of a tet
///        have a value too; others are blank. The boundary is off by up to one spacing in either direction. Parts
///        thinner than that are only drawn partly, thick enough to look as dense from a distance.
/// Grid   fewer samples along each axis over the same box; each is the mean of the nearest samples that are not blank.
///        A grid that has no more than `samples` is returned as it is.
///
/// Speed  Integrator `sampled` with GridSettings::step 2 renders 128^3 samples at 512x512 in 30 ms on two cores,
///        192^3 in 50 ms. Resampling a mesh of 12.6 million tets takes a second or two; on a smooth field the mean
///        difference between its image and that of the mesh was below 1e-4.
///
/// The result has the same bits for any number of threads. Collective for a mesh in parts, one per rank: every rank
/// then has the whole grid. Returns nothing if a stop is requested, on any rank. Throws Error(bad_input) for fewer than
/// 8 samples.
TESSERA_EXPORT std::optional<Dataset> coarse_preview(const Dataset& dataset, const PreviewSettings& settings = {},
                                                     const std::stop_token& stop = {},
                                                     const Communicator& communicator = {});

}  // namespace v0_1
}  // namespace tessera
