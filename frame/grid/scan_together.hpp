// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"
#include "scene/sample_source.hpp"
#include "volume/bricks/cell_ranges.hpp"

namespace tessera::frame {

/// The ranges of a volume's cells, scanned by all ranks together: each reads its share of the layers of cells, whole
/// ones, in the order of ranks along k, and gives what it found to all others. On every rank the same as of one
/// process; a rank without layers, where there are fewer than ranks, reads nothing.
///
/// Collective: the same volume on every rank, from a source of each rank's own. Throws the run's error, or this rank's
/// (a source that cannot be read), which the caller gives to transport.fail().
volume::CellRanges scan_together(exchange::Transport& transport, const scene::SampleSource& source, int threads);

}  // namespace tessera::frame
