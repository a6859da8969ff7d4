// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/gl/cell_sink.hpp"

namespace tessera::compositor {

std::span<projection::TileEntry> CellSink::take(std::size_t tile, const scene::PixelRect& rect,
                                                const projection::ProjectedMesh& projected,
                                                const projection::CellsAtSteps* at_steps,
                                                std::span<projection::TileEntry> entries) {
  writer_.begin_tile(tile, rect);
  std::size_t left = 0;
  for (const projection::TileEntry entry : entries) {
    const std::uint32_t tet = entry.tet;
    const auto record = at_steps != nullptr && at_steps->contain(tet)
                            ? std::nullopt
                            : projection::cell_record(projected, tet, global_tet_.empty() ? tet : global_tet_[tet]);
    if (!record) {
      entries[left++] = entry;
      continue;
    }
    exchange::append(writer_.records(), *record);
    writer_.count(1);
    ++cells_;
    writer_.send_if_full();
  }
  writer_.send_rest();
  return entries.first(left);
}

}  // namespace tessera::compositor
