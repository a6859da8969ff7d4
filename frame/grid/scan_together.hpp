// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exchange/transport.hpp"
#include "scene/sample_source.hpp"
#include "volume/bricks/cell_ranges.hpp"

namespace tessera::frame {

/// Scans the value ranges of a volume's cells with all ranks together. Each rank reads its share of whole layers of
/// cells (the shares follow each other along k in the order of ranks) and sends the result to all others. Returns on
/// every rank what one process would compute. If there are fewer layers than ranks, some ranks read nothing.
///
/// Collective: every rank passes a separate source of the same volume. Throws the run's error. If this rank's source
/// cannot be read, throws this rank's error, which the caller passes to transport.fail().
volume::CellRanges scan_together(exchange::Transport& transport, const scene::SampleSource& source);

}  // namespace tessera::frame
