// SPDX-License-Identifier: BSD-3-Clause
#include "volume/bricks/cell_ranges.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

namespace tessera::volume {
namespace {

/// Returns the size, in voxels, of the blocks that are read at once. A block consists of whole cells and has about 64^3
/// voxels; if the source is stored slice by slice, it has whole rows.
scene::GridIndex scan_block_size(const scene::SampleSource& source) {
  constexpr std::int64_t cell = CellRanges::side, cube = 64, most = cube * cube * cube;
  if (source.storage_block()[2] > 1) return {cube, cube, cube};
  const scene::GridIndex voxels = source.geometry().voxels();
  const auto whole_cells = [](std::int64_t n) { return (n + cell - 1) / cell * cell; };
  const std::int64_t width = std::min(whole_cells(voxels[0]), most / (cell * cell));
  const std::int64_t height = std::min(whole_cells(voxels[1]), most / (width * cell) / cell * cell);
  return {width, height, most / (width * height) / cell * cell};
}

/// Rounds outwards, so that a range of floats contains the range of doubles.
float rounded_down(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float rounded_up(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

/// A block's contribution to the scan.
struct BlockTotals {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  std::uint64_t blanks = 0;
};

/// Scans the voxels of a block that begins at `first_voxel`, up to the last layer of the scan.
template <class T>
BlockTotals scan_block(const scene::SampleSource& source, const scene::GridIndex& first_voxel,
                       const scene::GridIndex& size, CellScan& scan) {
  const scene::GridIndex samples = source.geometry().samples(), cells = cells_along(source.geometry());
  scene::GridIndex voxels = source.geometry().voxels();
  voxels[2] = std::min(voxels[2], scan.last * CellRanges::side);
  const std::int64_t shared = source.geometry().association == scene::Association::point ? 1 : 0;
  scene::SampleBox box;
  for (std::size_t a = 0; a < 3; ++a) {
    box.low[a] = first_voxel[a];
    box.high[a] = std::min(first_voxel[a] + size[a], voxels[a]) + shared;
  }
  std::vector<T> values(static_cast<std::size_t>(box.count()));
  source.read(box, std::span<T>(values));
  const std::int64_t width = box.extent(0), height = box.extent(1);
  constexpr std::int64_t side = CellRanges::side;
  BlockTotals totals;
  for (std::int64_t c = box.low[2] / side; c * side < box.high[2] - shared; ++c)
    for (std::int64_t b = box.low[1] / side; b * side < box.high[1] - shared; ++b)
      for (std::int64_t a = box.low[0] / side; a * side < box.high[0] - shared; ++a) {
        const auto last = [&](std::int64_t cell, std::size_t axis) {
          return std::min((cell + 1) * side + shared, box.high[axis]);
        };
        T low = std::numeric_limits<T>::infinity(), high = -low;
        for (std::int64_t k = c * side; k < last(c, 2); ++k)
          for (std::int64_t j = b * side; j < last(b, 1); ++j) {
            const T* const row = &values[static_cast<std::size_t>(
                ((k - box.low[2]) * height + (j - box.low[1])) * width - box.low[0] + a * side)];
            const std::int64_t count = last(a, 0) - a * side;
            bool blank = false;
            for (std::int64_t i = 0; i < count; ++i) {
              const bool finite = std::abs(row[i]) <= std::numeric_limits<T>::max();
              blank |= !finite;
              low = finite && row[i] < low ? row[i] : low;
              high = finite && row[i] > high ? row[i] : high;
            }
            if (!blank) continue;
            // A blank on the boundary of two cells counts in the upper cell; on the volume's upper boundary, in the
            // last cell.
            const auto owned = [&](std::int64_t index, std::int64_t cell, std::size_t axis) {
              return index < (cell + 1) * side || index == samples[axis] - 1;
            };
            for (std::int64_t i = 0; i < count; ++i)
              if (!(std::abs(row[i]) <= std::numeric_limits<T>::max()) && owned(a * side + i, a, 0) && owned(j, b, 1) &&
                  owned(k, c, 2))
                ++totals.blanks;
          }
        const auto cell = static_cast<std::size_t>(a + cells[0] * (b + cells[1] * (c - scan.first)));
        scan.low[cell] = rounded_down(static_cast<double>(low));
        scan.high[cell] = rounded_up(static_cast<double>(high));
        totals.lowest = std::min(totals.lowest, static_cast<double>(low));
        totals.highest = std::max(totals.highest, static_cast<double>(high));
      }
  return totals;
}

}  // namespace

scene::GridIndex cells_along(const scene::GridGeometry& geometry) {
  scene::GridIndex cells = geometry.voxels();
  for (std::int64_t& count : cells) count = (count + CellRanges::side - 1) / CellRanges::side;
  return cells;
}

CellScan scan_cells(const scene::SampleSource& source, std::int64_t first, std::int64_t last) {
  const scene::GridIndex voxels = source.geometry().voxels(), cells = cells_along(source.geometry());
  CellScan scan;
  scan.first = first, scan.last = last;
  scan.low.resize(static_cast<std::size_t>(cells[0] * cells[1] * (last - first)));
  scan.high.resize(scan.low.size());
  const scene::GridIndex size = scan_block_size(source);
  const std::int64_t layers = size[2] / CellRanges::side;  // layers of cells in a block
  const scene::GridIndex blocks{(voxels[0] + size[0] - 1) / size[0], (voxels[1] + size[1] - 1) / size[1],
                                (last - first + layers - 1) / layers};
  std::mutex mutex;
  tbb::parallel_for(std::int64_t{0}, blocks[0] * blocks[1] * blocks[2], [&](std::int64_t n) {
    const scene::GridIndex first_voxel{n % blocks[0] * size[0], n / blocks[0] % blocks[1] * size[1],
                                       n / blocks[0] / blocks[1] * size[2] + first * CellRanges::side};
    const BlockTotals totals = scene::fits_float(source.grid().type)
                                   ? scan_block<float>(source, first_voxel, size, scan)
                                   : scan_block<double>(source, first_voxel, size, scan);
    const std::lock_guard lock(mutex);
    scan.lowest = std::min(scan.lowest, totals.lowest);
    scan.highest = std::max(scan.highest, totals.highest);
    scan.blanks += totals.blanks;
  });
  return scan;
}

CellRanges::CellRanges(const scene::SampleSource& source)
    : CellRanges(source.grid(), scan_cells(source, 0, cells_along(source.geometry())[2])) {}

CellRanges::CellRanges(const scene::Grid& grid, CellScan whole)
    : cells(cells_along(grid.geometry)), low(std::move(whole.low)), high(std::move(whole.high)) {
  range.blanks = whole.blanks;
  if (whole.lowest <= whole.highest) {
    range.low = std::min(grid.value(whole.lowest), grid.value(whole.highest));
    range.high = std::max(grid.value(whole.lowest), grid.value(whole.highest));
  }
  lanes = LaneSamples(grid, range);
  if (range.empty()) return;
  // The floats were rounded outwards, which is a large error if all values differ only in their last places.
  const float one = lanes.lane(whole.lowest), other = lanes.lane(whole.highest);
  const float least = std::min(one, other), most = std::max(one, other);
  for (std::size_t cell = 0; cell < low.size(); ++cell) {
    if (low[cell] > high[cell]) continue;
    const float a = lanes.lane(low[cell]), b = lanes.lane(high[cell]);
    low[cell] = std::max(least, std::min(a, b));
    high[cell] = std::min(most, std::max(a, b));
  }
}

namespace {

/// For each interval of the table, the number of visible intervals below it.
std::vector<std::size_t> shown_intervals(const integrals::LaneTable& table) {
  using integrals::LaneTable;
  std::vector<std::size_t> shown_before(table.knot_count + 2, 0);
  for (std::size_t i = 0; i <= table.knot_count; ++i) {
    const auto any = [&](int column) { return table.column(column)[i] != 0; };
    bool shows = any(LaneTable::half_extinction) || any(LaneTable::half_extinction_slope);
    shows = shows || table.has_peak[i] != 0 || table.has_peak[i + 1] != 0;
    if (table.emission == scene::Emission::independent)
      for (int c = LaneTable::red; c <= LaneTable::blue_slope; ++c) shows = shows || any(c);
    shown_before[i + 1] = shown_before[i] + (shows ? 1 : 0);
  }
  return shown_before;
}

std::size_t interval_of(const integrals::LaneTable& table, float s) {
  const float* const knots = table.column(integrals::LaneTable::edge) + 1;
  return static_cast<std::size_t>(std::upper_bound(knots, knots + table.knot_count, s) - knots);
}

}  // namespace

bool any_clear(const CellRanges& ranges, const integrals::LaneTable& table) {
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (std::size_t cell = 0; cell < ranges.count(); ++cell)
    low = std::min(low, ranges.low[cell]), high = std::max(high, ranges.high[cell]);
  if (!(low <= high)) return true;
  const std::vector<std::size_t> shown_before = shown_intervals(table);
  const std::size_t first = interval_of(table, low), last = interval_of(table, high);
  return shown_before[last + 1] - shown_before[first] < last + 1 - first;
}

namespace {

/// Returns one byte per range of lane scalars: whether some of the range is visible; 0 if low > high.
std::vector<std::uint8_t> visible_intervals(const std::vector<float>& low, const std::vector<float>& high,
                                            bool whole_numbers, const integrals::LaneTable& table) {
  const std::vector<std::size_t> shown_before = shown_intervals(table);
  // Rounding may move values and knots by two last places of a float and a unit. This may exchange the order of a value
  // and a step, or of two knots.
  const auto uncertain = [&](std::size_t edge) {
    return table.is_moved[edge] != 0 || (table.has_steps && !whole_numbers);
  };
  bool any = false;
  for (std::size_t edge = 1; edge <= table.knot_count; ++edge) any = any || uncertain(edge);
  const auto interval = [&](float s, float away) {
    if (!any) return interval_of(table, s);
    std::size_t n = interval_of(table, s);
    const std::size_t last = interval_of(table, s + away * (std::abs(s) * 0x1p-22f + 1));
    while (n < last && uncertain(n + 1)) ++n;
    while (n > last && uncertain(n)) --n;
    return n;
  };
  std::vector<std::uint8_t> visible(low.size(), 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, low.size(), 4096), [&](const auto& some) {
    for (std::size_t cell = some.begin(); cell != some.end(); ++cell)
      if (low[cell] <= high[cell])
        visible[cell] = shown_before[interval(high[cell], 1) + 1] > shown_before[interval(low[cell], -1)];
  });
  return visible;
}

/// Replaces each cell's value by the `best` of the values in cells up to `radius` cells away along an axis.
template <class Best>
void spread(const scene::GridIndex& cells, std::size_t axis, std::int64_t radius, const Best& best,
            std::vector<float>& values) {
  const std::int64_t length = cells[axis];
  const auto stride = static_cast<std::size_t>(axis == 0 ? 1 : axis == 1 ? cells[0] : cells[0] * cells[1]);
  const std::size_t lines = values.size() / static_cast<std::size_t>(length);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, lines, 256), [&](const auto& some) {
    std::vector<float> line(static_cast<std::size_t>(length));
    for (std::size_t n = some.begin(); n != some.end(); ++n) {
      float* const first = &values[n / stride * stride * line.size() + n % stride];
      for (std::size_t i = 0; i < line.size(); ++i) line[i] = first[i * stride];
      for (std::int64_t i = 0; i < length; ++i) {
        const auto from = line.begin() + std::max<std::int64_t>(0, i - radius),
                   to = line.begin() + std::min(length, i + radius + 1);
        first[static_cast<std::size_t>(i) * stride] = *best(from, to);
      }
    }
  });
}

}  // namespace

std::vector<std::uint8_t> visible_cells(const CellRanges& ranges, const integrals::LaneTable& table) {
  return visible_intervals(ranges.low, ranges.high, ranges.lanes.whole_numbers, table);
}

std::vector<std::uint8_t> visible_to_steps(const CellRanges& ranges, const integrals::LaneTable& table,
                                           const std::array<double, 3>& reach, float margin) {
  std::vector<float> low = ranges.low, high = ranges.high;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double far = std::min(std::ceil(reach[axis] / CellRanges::side), static_cast<double>(ranges.cells[axis]));
    const auto radius = std::max<std::int64_t>(1, static_cast<std::int64_t>(far));
    spread(
        ranges.cells, axis, radius, [](auto from, auto to) { return std::min_element(from, to); }, low);
    spread(
        ranges.cells, axis, radius, [](auto from, auto to) { return std::max_element(from, to); }, high);
  }
  for (float& value : low) value -= margin;
  for (float& value : high) value += margin;
  // Exact lane scalars would need no tolerance, but these ranges have been widened.
  return visible_intervals(low, high, false, table);
}

namespace {

/// Returns the first and last cell, along each axis, that has voxels of a brick.
std::array<scene::GridIndex, 2> cells_of(const BrickLayout& layout, std::size_t brick) {
  const scene::GridIndex place = layout.place(brick);
  std::array<scene::GridIndex, 2> cells;
  for (std::size_t a = 0; a < 3; ++a) {
    cells[0][a] = place[a] * layout.size / CellRanges::side;
    cells[1][a] = (std::min((place[a] + 1) * layout.size, layout.voxels[a]) - 1) / CellRanges::side;
  }
  return cells;
}

}  // namespace

std::vector<std::uint8_t> visible_bricks(const CellRanges& ranges, const std::vector<std::uint8_t>& visible,
                                         const BrickLayout& layout) {
  std::vector<std::uint8_t> shown(layout.count(), 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, layout.count(), 256), [&](const auto& some) {
    for (std::size_t brick = some.begin(); brick != some.end(); ++brick) {
      const auto [first, last] = cells_of(layout, brick);
      for (std::int64_t c = first[2]; c <= last[2]; ++c)
        for (std::int64_t b = first[1]; b <= last[1]; ++b)
          for (std::int64_t a = first[0]; a <= last[0]; ++a)
            shown[brick] |= visible[static_cast<std::size_t>(a + ranges.cells[0] * (b + ranges.cells[1] * c))];
    }
  });
  return shown;
}

void show_more(const CellRanges& ranges, const BrickLayout& layout, bool of_invisible_bricks, bool of_visible_bricks,
               std::vector<std::uint8_t>& visible) {
  const std::vector<std::uint8_t> shown = visible_bricks(ranges, visible, layout);
  for (std::size_t brick = 0; brick < shown.size(); ++brick) {
    if (!(shown[brick] != 0 ? of_visible_bricks : of_invisible_bricks)) continue;
    const auto [first, last] = cells_of(layout, brick);
    for (std::int64_t c = first[2]; c <= last[2]; ++c)
      for (std::int64_t b = first[1]; b <= last[1]; ++b)
        for (std::int64_t a = first[0]; a <= last[0]; ++a)
          visible[static_cast<std::size_t>(a + ranges.cells[0] * (b + ranges.cells[1] * c))] = 1;
  }
}

}  // namespace tessera::volume
