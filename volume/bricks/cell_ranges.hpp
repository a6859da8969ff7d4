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

/// Smallest and largest stored sample in cells of 8^3 voxels: the result of scanning a volume or a part of it. A part
/// consists of whole layers of cells along k, so that several processes can share a scan.
///
/// Cells     Cell (a, b, c) has the number a + cells[0] * (b + cells[1] * (c - first)).
struct CellScan {
  std::int64_t first = 0, last = 0;  ///< layers first <= c < last
  std::vector<float> low, high;      ///< for each cell, rounded outwards; low > high if all samples are blank
  /// Lowest and highest of all scanned samples.
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  /// Number of blank samples; each is counted in one cell only, so that the counts of all parts add up.
  std::uint64_t blanks = 0;
};

/// The number of cells of 8^3 voxels along each axis.
scene::GridIndex cells_along(const scene::GridGeometry& geometry);

/// Reads the samples of layers first <= c < last once, in boxes of about 64^3 voxels and the samples that these share
/// with others: cubes, or whole rows if the source is stored slice by slice.
CellScan scan_cells(const scene::SampleSource& source, std::int64_t first, std::int64_t last);

/// Smallest and largest lane scalar in every cell of 8^3 voxels, for skipping empty space with any brick size.
///
/// Cells     Cell (a, b, c) has the number a + cells[0] * (b + cells[1] * c); its voxels are 8a <= i < 8a + 8 and so
///           on. With point data, the samples at all corners of those voxels count. Blank samples are ignored; a cell
///           in which all samples are blank is empty (low > high).
struct CellRanges {
  static constexpr std::int64_t side = 8;

  /// Makes the ranges from a scan of all layers. `lanes` follows from the range of the whole volume.
  CellRanges(const scene::Grid& grid, CellScan whole);
  /// Reads all samples.
  explicit CellRanges(const scene::SampleSource& source);

  [[nodiscard]] std::size_t count() const { return low.size(); }
  scene::GridIndex cells{0, 0, 0};
  std::vector<float> low, high;
  scene::ValueRange range;  ///< range of values, and number of blanks, of the whole volume
  LaneSamples lanes;
};

/// Returns one byte per cell: 1 if the transfer function is visible anywhere in the cell's range.
std::vector<std::uint8_t> visible_cells(const CellRanges& ranges, const integrals::LaneTable& table);

/// Does the same for steps of a ray from one value directly to another value that is at most `reach` voxels away along
/// each axis. The byte is 0 if the function is invisible for all values of the cell, all values that such a step may
/// reach, and those less than `margin` lane scalars beyond. No step that begins or ends in the cell is then visible.
std::vector<std::uint8_t> visible_to_steps(const CellRanges& ranges, const integrals::LaneTable& table,
                                           const std::array<double, 3>& reach, float margin);

/// Whether the transfer function is invisible at some value in the volume's range.
bool any_clear(const CellRanges& ranges, const integrals::LaneTable& table);

/// Returns one byte per brick: 1 if the brick contains voxels of a visible cell.
std::vector<std::uint8_t> visible_bricks(const CellRanges& ranges, const std::vector<std::uint8_t>& visible,
                                         const BrickLayout& layout);

/// Marks more cells as visible, to measure the benefit of culling and skipping: the cells of bricks without a visible
/// cell, or the other cells of bricks with one. A cell may be in several bricks and is marked if one of them qualifies.
void show_more(const CellRanges& ranges, const BrickLayout& layout, bool of_invisible_bricks, bool of_visible_bricks,
               std::vector<std::uint8_t>& visible);

}  // namespace tessera::volume
