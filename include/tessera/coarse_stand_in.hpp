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

struct StandInSettings {
  /// How many samples at most, about; the grid has as many as the data if they have fewer.
  std::uint64_t samples = std::uint64_t{128} * 128 * 128;
  int threads = 0;  ///< 0: all cores
};

/// A coarse grid that looks like the data from afar: for use while something moves, where the data themselves take too
/// long. It is not the data, and no error is promised; say so where it is shown.
///
/// Mesh   a regular grid over the mesh's box. A sample in a tet has the field's value there, of several tets that of
///        the first; cell data too become point data. So do samples within half of their distance beside a tet; others
///        are blank. The boundary is off by up to a sample's distance, to both sides alike; of what is thinner than
///        that only parts are drawn, so thick that it looks as dense from afar.
/// Grid   fewer samples along each axis over the same box; each is the mean of those nearest to it that are not blank.
///        A grid that has no more than `samples` is returned as it is.
///
/// Fast   Integrator `sampled` with GridSettings::step 2 renders 128^3 samples at 512x512 in 30 ms on two cores, 192^3
/// in
///        50. Of a mesh of 12.6 million tets they are made in a second or two; on a smooth field the picture's mean
///        difference to the mesh's was below 1e-4.
///
/// The same bits for any number of threads. Of a mesh in parts, one a rank, collective: every rank has all of the grid
/// then. Nothing is returned once `stop` is asked for, on ranks on any of them. Throws Error(bad_input) for fewer
/// than 8 samples.
TESSERA_EXPORT std::optional<Dataset> coarse_stand_in(const Dataset& dataset, const StandInSettings& settings = {},
                                                      const std::stop_token& stop = {},
                                                      const Communicator& communicator = {});

}  // namespace v0_1
}  // namespace tessera
