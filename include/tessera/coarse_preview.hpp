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
  /// Approximate upper limit on the number of samples; a grid with fewer samples is not refined.
  std::uint64_t samples = std::uint64_t{128} * 128 * 128;
  int threads = 0;  ///< 0: all cores
};

/// Returns a coarse grid that resembles the data from a distance. It is intended for interaction, while rendering the
/// data themselves takes too long. The grid has no error bound, so programs should label images made from it.
///
/// Mesh   a regular grid over the mesh's box. A sample inside a tet has the field's value at its place; if several tets
///        contain the sample, the first one determines the value. Cell data are converted to point data. Samples within
///        half a sample spacing of a tet also have a value; all others are blank. The boundary is displaced by up to
///        one spacing in either direction. Parts that are thinner than one spacing are drawn only in some places. These
///        places are thick enough for the parts to look equally dense from a distance.
/// Grid   a grid over the same box with fewer samples along each axis. Each sample is the mean of the nearest samples
///        of the data that are not blank. A grid that has at most `samples` samples is returned unchanged.
///
/// Speed  Integrator `sampled` with GridSettings::step 2 renders 128^3 samples at 512x512 in 30 ms on two cores,
///        192^3 in 50 ms. Resampling a mesh of 12.6 million tets takes a second or two; on a smooth field the mean
///        difference between its image and that of the mesh was below 1e-4.
///
/// The result has the same bits for any number of threads. For a mesh in parts, one per rank, the function is
/// collective and returns the whole grid on every rank. Returns nothing if a stop is requested on any rank. Throws
/// Error(bad_input) for fewer than 8 samples.
TESSERA_EXPORT std::optional<Dataset> coarse_preview(const Dataset& dataset, const PreviewSettings& settings = {},
                                                     const std::stop_token& stop = {},
                                                     const Communicator& communicator = {});

}  // namespace v0_1
}  // namespace tessera
