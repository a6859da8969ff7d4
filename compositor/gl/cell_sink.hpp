// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

#include "exchange/part_writer.hpp"
#include "projection/cell_record.hpp"
#include "projection/planes_rasterizer.hpp"
#include "projection/steps.hpp"

namespace tessera::compositor {

/// Sends a tile's cells unchanged, so that the device of the tile's compositor rasterizes them. The parts with cells
/// precede this process's other parts of the tile. They do not state a depth up to which the tile is complete, so that
/// the compositor composites nothing before it has all cells.
///
/// One sink serves one thread.
class CellSink {
 public:
  /// `global_tet` has the same meaning as in SegmentSink. The indices and `deliver` must outlive the sink.
  CellSink(std::span<const std::uint64_t> global_tet, exchange::PartWriter::Deliver deliver)
      : global_tet_(global_tet), writer_(exchange::RecordKind::cells, std::move(deliver)) {}

  /// Sends those cells of `entries` that a device supports (projection::cell_record()), except cells that must be cut
  /// at steps of the transfer function (`at_steps`; null: no cells). Returns the other cells; changes the order of
  /// `entries`.
  std::span<projection::TileEntry> take(std::size_t tile, const scene::PixelRect& rect,
                                        const projection::ProjectedMesh& projected,
                                        const projection::CellsAtSteps* at_steps,
                                        std::span<projection::TileEntry> entries);

  /// Number of cells sent so far.
  [[nodiscard]] std::uint64_t cells() const { return cells_; }

 private:
  std::span<const std::uint64_t> global_tet_;
  exchange::PartWriter writer_;
  std::uint64_t cells_ = 0;
};

}  // namespace tessera::compositor
