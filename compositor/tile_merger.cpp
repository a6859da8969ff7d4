// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/tile_merger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compositor/gl/gl_merger.hpp"
#include "compositor/merge_kinds.hpp"

namespace tessera::compositor {

void merge(TileMerger& merger, const std::vector<exchange::TilePart>& parts, double final_depth,
           std::uint64_t budget_bytes) {
  const std::uint64_t bytes_a_step = std::min<std::uint64_t>(budget_bytes / 20, 1 << 20);
  std::uint64_t added = 0;
  for (const exchange::TilePart& part : parts) {
    // The merger must not advance beyond final_depth: projectors without a part in this list may still send fragments
    // behind it.
    if (added >= bytes_a_step && std::isfinite(part.start_depth)) {
      merger.advance(std::min(part.start_depth, final_depth));
      added = 0;
    }
    merger.add(part);
    added += part.records.size();
  }
  merger.advance(final_depth);
}

std::unique_ptr<TileMerger> make_tile_merger(exchange::RecordKind kind, const MergeContext& context,
                                             const scene::PixelRect& rect) {
  if (context.device != nullptr) return make_gl_merger(context, rect);
  switch (kind) {
    case exchange::RecordKind::runs:
    case exchange::RecordKind::lattice_runs:
      return make_run_merger(context, rect);
    case exchange::RecordKind::chains:
    case exchange::RecordKind::chains_of_cells:
    case exchange::RecordKind::lit_chains:
      return make_segment_merger(context, rect);
    case exchange::RecordKind::lattice:
    case exchange::RecordKind::lit_lattice:
      return make_window_merger(context, rect);
    case exchange::RecordKind::tuples:
      return make_tuple_merger(context, rect);
    case exchange::RecordKind::pixels:
      return make_pixel_merger();
    case exchange::RecordKind::cells:  // only for devices
      break;
  }
  throw scene::Error(scene::ErrorCode::system_failure,
                     fmt::format("exchange: received records of unknown kind {}; all ranks must run the same program",
                                 static_cast<int>(kind)));
}

}  // namespace tessera::compositor
