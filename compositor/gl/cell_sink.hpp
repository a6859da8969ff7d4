// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

#include "exchange/part_writer.hpp"
#include "projection/cell_record.hpp"
#include "projection/planes_rasterizer.hpp"
#include "projection/steps.hpp"

namespace tessera::compositor {

/// Sends a tile's cells unchanged, for the device of the tile's compositor to rasterize, before this process's other
/// parts of the tile. These parts are complete to no depth, so that nothing of the tile is composited without the
/// cells.
///
/// One sink serves one thread.
class CellSink {
 public:
  /// `global_tet` as in SegmentSink. Both must outlive the sink.
  CellSink(std::span<const std::uint64_t> global_tet, exchange::PartWriter::Deliver deliver)
      : global_tet_(global_tet), writer_(exchange::RecordKind::cells, std::move(deliver)) {}

  /// Sends those cells of `entries` that a device supports (projection::cell_record()), except those to be cut at steps
  /// of the transfer function (`at_steps`; null: none). Returns the others; the order of `entries` changes.
  std::span<projection::TileEntry> take(std::size_t tile, const scene::PixelRect& rect,
                                        const projection::ProjectedMesh& projected,
                                        const projection::CellsAtSteps* at_steps,
                                        std::span<projection::TileEntry> entries);

  /// Cells sent so far.
  [[nodiscard]] std::uint64_t cells() const { return cells_; }

 private:
  std::span<const std::uint64_t> global_tet_;
  exchange::PartWriter writer_;
  std::uint64_t cells_ = 0;
};

}  // namespace tessera::compositor
