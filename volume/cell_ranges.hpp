#pragma once

#include <cstdint>
#include <vector>

#include "compositor/lane_table.hpp"
#include "scene/sample_source.hpp"
#include "volume/brick_layout.hpp"
#include "volume/lane_samples.hpp"

namespace tessera::volume {

/// Smallest and largest lane scalar in every block of 8^3 voxels: what empty space is skipped by, for any brick size.
///
/// Cells   cell (a, b, c) is number a + cells[0] * (b + cells[1] * c); its voxels are 8a <= i < 8a + 8 and so on. Point
///         data: the samples at all corners of those voxels count. Blank samples do not; a cell of blanks is empty
///         (low > high).
struct CellRanges {
  static constexpr std::int64_t side = 8;

  /// Reads all samples once, in boxes of 64^3 voxels. `lanes` follows from the range of the whole volume.
  CellRanges(const scene::SampleSource& source, int threads);

  [[nodiscard]] std::size_t count() const { return low.size(); }

  scene::GridIndex cells{0, 0, 0};
  std::vector<float> low, high;
  scene::ValueRange range;  ///< values, and number of blanks, of the whole volume
  LaneSamples lanes;
};

/// One byte a cell: 1 where the transfer function shows anything of its range.
std::vector<std::uint8_t> visible_cells(const CellRanges& ranges, const compositor::LaneTable& table);

/// Whether the transfer function shows nothing of some value in the volume's range.
bool any_clear(const CellRanges& ranges, const compositor::LaneTable& table);

/// One byte a brick: 1 where it holds voxels of a visible cell.
std::vector<std::uint8_t> visible_bricks(const CellRanges& ranges, const std::vector<std::uint8_t>& visible,
                                         const BrickLayout& layout);

/// Takes more cells for visible than are, to see what leaving them out is worth: those of bricks without a visible one,
/// or the other cells of bricks with one. A cell may lie in several bricks and counts with each.
void show_more(const CellRanges& ranges, const BrickLayout& layout, bool of_invisible_bricks, bool of_visible_bricks,
               std::vector<std::uint8_t>& visible);

}  // namespace tessera::volume
