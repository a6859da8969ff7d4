// SPDX-License-Identifier: BSD-3-Clause
#include "volume/bricks/cell_ranges.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace tessera::volume::cell_ranges_test {
namespace {

/// Noise of odd sizes, with blanks, also on the faces shared by cells.
std::unique_ptr<scene::MemorySource> noise(scene::Association association, double scale) {
  scene::Grid grid;
  grid.geometry.points = {21, 70, 83};
  grid.geometry.association = association;
  grid.scale = scale;
  grid.shift = 0.1;
  std::mt19937 random(5);
  std::vector<float> values(static_cast<std::size_t>(grid.geometry.all_samples().count()));
  for (float& v : values) {
    v = static_cast<float>(random()) * 0x1p-32f;
    if (random() % 50 == 0) v = random() % 2 == 0 ? std::nanf("") : std::numeric_limits<float>::infinity();
  }
  return scene::MemorySource::of(grid, std::move(values));
}

TEST(CellRanges, AreThoseOfEachCellsSamples) {
  for (const auto association : {scene::Association::point, scene::Association::cell}) {
    const auto source = noise(association, -3);
    const CellRanges ranges(*source);
    EXPECT_EQ(ranges.range, scene::value_range(*source));
    const scene::GridIndex samples = source->geometry().samples();
    const std::int64_t shared = association == scene::Association::point ? 1 : 0;
    std::size_t cell = 0;
    for (std::int64_t c = 0; c < ranges.cells[2]; ++c)
      for (std::int64_t b = 0; b < ranges.cells[1]; ++b)
        for (std::int64_t a = 0; a < ranges.cells[0]; ++a, ++cell) {
          const scene::GridIndex at{a, b, c};
          scene::SampleBox box;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            box.low[axis] = 8 * at[axis];
            box.high[axis] = std::min(8 * at[axis] + 8 + shared, samples[axis]);
          }
          std::vector<float> values(static_cast<std::size_t>(box.count()));
          source->read(box, std::span<float>(values));
          float low = std::numeric_limits<float>::infinity(), high = -low;
          for (const float v : values) {
            if (!std::isfinite(v)) continue;
            const float lane = ranges.lanes.lane(static_cast<double>(v));
            low = std::min(low, lane), high = std::max(high, lane);
          }
          ASSERT_EQ(ranges.low[cell], low) << a << " " << b << " " << c;
          ASSERT_EQ(ranges.high[cell], high) << a << " " << b << " " << c;
        }
    EXPECT_EQ(cell, ranges.count());
  }
}

TEST(CellRanges, PartsOfAScanAddUpToTheWholeWhereverItIsCut) {
  for (const auto association : {scene::Association::point, scene::Association::cell}) {
    const auto source = noise(association, 2);
    const std::int64_t layers = cells_along(source->geometry())[2];
    const CellScan whole = scan_cells(*source, 0, layers);
    for (std::int64_t cut = 0; cut <= layers; ++cut) {
      CellScan both = scan_cells(*source, 0, cut);
      const CellScan rest = scan_cells(*source, cut, layers);
      both.low.insert(both.low.end(), rest.low.begin(), rest.low.end());
      both.high.insert(both.high.end(), rest.high.begin(), rest.high.end());
      EXPECT_EQ(both.low, whole.low) << cut;
      EXPECT_EQ(both.high, whole.high) << cut;
      EXPECT_EQ(std::min(both.lowest, rest.lowest), whole.lowest);
      EXPECT_EQ(std::max(both.highest, rest.highest), whole.highest);
      EXPECT_EQ(both.blanks + rest.blanks, whole.blanks) << cut;
    }
  }
}

}  // namespace
}  // namespace tessera::volume::cell_ranges_test
