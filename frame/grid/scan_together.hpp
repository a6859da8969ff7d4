// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"
#include "scene/sample_source.hpp"
#include "volume/bricks/cell_ranges.hpp"

namespace tessera::frame {

/// The ranges of a volume's cells, scanned by all ranks together: each reads its share of whole layers of cells, in the
/// order of ranks along k, and sends the result to all others. The result is that of one process, on every rank. If
/// there are fewer layers than ranks, some ranks read nothing.
///
/// Collective: the same volume on every rank, from each rank's own source. Throws the run's error, or this rank's (a
/// source that cannot be read), which the caller passes to transport.fail().
volume::CellRanges scan_together(exchange::Transport& transport, const scene::SampleSource& source);

}  // namespace tessera::frame
