// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "integrals/lane_table.hpp"
#include "scene/sample_source.hpp"
#include "volume/bricks/brick_layout.hpp"
#include "volume/bricks/lane_samples.hpp"

namespace tessera::volume {

/// Smallest and largest sample in cells of 8^3 voxels, as stored: what a scan of a volume, or of a part of it, finds. A
/// part is whole layers of cells along k, so that several processes may share a scan.
///
/// Cells   cell (a, b, c) is number a + cells[0] * (b + cells[1] * (c - first)).
struct CellScan {
  std::int64_t first = 0, last = 0;  ///< layers first <= c < last
  std::vector<float> low, high;      ///< of each cell, rounded outwards; low > high: all are blank
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;  ///< of all its samples
  std::uint64_t blanks = 0;  ///< in cells whose lowest corner they are, or in the last ones: all parts add up
};

/// Cells of 8^3 voxels along each axis.
scene::GridIndex cells_along(const scene::GridGeometry& geometry);

/// Reads the samples of layers first <= c < last once, in boxes of some 64^3 voxels and the samples they share with
/// others: cubes, or whole rows where a source is stored slice by slice.
CellScan scan_cells(const scene::SampleSource& source, std::int64_t first, std::int64_t last, int threads);

/// Smallest and largest lane scalar in every block of 8^3 voxels: what empty space is skipped by, for any brick size.
///
/// Cells   cell (a, b, c) is number a + cells[0] * (b + cells[1] * c); its voxels are 8a <= i < 8a + 8 and so on. Point
///         data: the samples at all corners of those voxels count. Blank samples do not; a cell of blanks is empty
///         (low > high).
struct CellRanges {
  static constexpr std::int64_t side = 8;

  /// Of a scan of all layers. `lanes` follows from the range of the whole volume.
  CellRanges(const scene::Grid& grid, CellScan whole);
  /// Reads all samples.
  CellRanges(const scene::SampleSource& source, int threads);

  [[nodiscard]] std::size_t count() const { return low.size(); }
  scene::GridIndex cells{0, 0, 0};
  std::vector<float> low, high;
  scene::ValueRange range;  ///< values, and number of blanks, of the whole volume
  LaneSamples lanes;
};

/// One byte a cell: 1 where the transfer function shows anything of its range.
std::vector<std::uint8_t> visible_cells(const CellRanges& ranges, const integrals::LaneTable& table);

/// The same for steps from one value straight to another, no farther than `reach` voxels along each axis: 0 where no
/// step that begins or ends in the cell shows anything, as the function shows nothing of the values of the cell and of
/// all that a step may reach, nor of those less than `margin` lane scalars beyond.
std::vector<std::uint8_t> visible_to_steps(const CellRanges& ranges, const integrals::LaneTable& table,
                                           const std::array<double, 3>& reach, float margin);

/// Whether the transfer function shows nothing of some value in the volume's range.
bool any_clear(const CellRanges& ranges, const integrals::LaneTable& table);

/// One byte a brick: 1 where it holds voxels of a visible cell.
std::vector<std::uint8_t> visible_bricks(const CellRanges& ranges, const std::vector<std::uint8_t>& visible,
                                         const BrickLayout& layout);

/// Takes more cells for visible than are, to see what leaving them out is worth: those of bricks without a visible one,
/// or the other cells of bricks with one. A cell may lie in several bricks and counts with each.
void show_more(const CellRanges& ranges, const BrickLayout& layout, bool of_invisible_bricks, bool of_visible_bricks,
               std::vector<std::uint8_t>& visible);

}  // namespace tessera::volume
