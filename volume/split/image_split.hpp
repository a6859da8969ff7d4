// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "scene/camera.hpp"
#include "volume/render.hpp"

namespace tessera::volume {

/// Cost of the pixels of an image or a part of it. Costs are integers so that sums do not depend on the order of
/// summation.
///
/// Map pixel (x, y) represents the image's pixels around ((x + 0.5) / resolution, (y + 0.5) / resolution).
struct CostMap {
  double resolution = 1;            ///< map pixels per image pixel along each axis
  scene::ImageSize size{0, 0};      ///< size of the whole map, in map pixels
  scene::PixelRect region{};        ///< the part of the map that is stored, in map pixels
  std::vector<std::uint32_t> cost;  ///< row by row in the region

  [[nodiscard]] int width() const { return region.x1 - region.x0; }
  [[nodiscard]] int height() const { return region.y1 - region.y0; }
};

/// Summed-area table of a cost map (Crow 1984), which gives the cost of any rectangle from four numbers.
class SummedArea {
 public:
  explicit SummedArea(const CostMap& map);

  /// Cost of the region's first `x` columns and first `y` rows.
  [[nodiscard]] std::uint64_t sum(int x, int y) const {
    return sums_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1) + static_cast<std::size_t>(x)];
  }

 private:
  int width_;
  std::vector<std::uint64_t> sums_;
};

/// A vertical edge of a rectangle: it is `x` pixels from the left, and `region_grain` pixels further to the right above
/// row `step`.
struct SteppedEdge {
  int x, step;
};

/// Calls use(rectangle) for rectangles that cover the pixels between two edges in lines [y0, y1), from top to bottom.
template <class Use>
void each_rectangle(int y0, int y1, const SteppedEdge& left, const SteppedEdge& right, int width, const Use& use) {
  const auto at = [width](const SteppedEdge& edge, int y) {
    return std::min(width, edge.x + (y < edge.step ? region_grain : 0));
  };
  for (const int bottom : {std::min(left.step, right.step), std::max(left.step, right.step), y1}) {
    if (bottom <= y0) continue;
    use(scene::PixelRect{at(left, y0), y0, at(right, y0), bottom});
    y0 = bottom;
  }
}

/// An image divided into rows of columns, one rectangle per process (Moloney, "Ray Coherence in Parallel Volume
/// Rendering", SFU 2008, 4.2). Each row may have any number of columns, so any number of processes is possible.
struct ImageSplit {
  std::vector<int> rows;                  ///< edges in image pixels, from 0 to the height
  std::vector<std::vector<int>> columns;  ///< for each row: edges of its rectangles, from 0 to the width
  /// One value for each of these edges: the y above which the edge is `region_grain` pixels further to the right. It is
  /// a multiple of a tile's side, or the row's upper edge. Empty if no edge has a step.
  std::vector<std::vector<int>> steps{};

  [[nodiscard]] int processes() const;
  /// The rectangle of the process, without steps.
  [[nodiscard]] scene::PixelRect region(int process) const;
  /// The pixels of the process, as rectangles from top to bottom. No two rectangles have pixels of the same tile.
  [[nodiscard]] std::vector<scene::PixelRect> parts(int process) const;
};

/// Returns the number of columns of each row, for `processes` rectangles that are approximately square.
std::vector<int> columns_of_rows(int processes, scene::ImageSize size);

/// Divides `area` into equal rectangles, as rows of columns; used when no costs are known. Rectangles at the boundary
/// of `area` extend to the image's boundary.
ImageSplit even_split(int processes, scene::ImageSize size, const scene::PixelRect& area);

/// A process's contribution to the two stages of the parallel search (Moloney 2008, Figure 4.3), in which only sums
/// along edges are exchanged.
///   first    the cost of each row of its map: the right-most column of its table
///   second   for each map row in which a row of rectangles begins: the cost, above this map row, of each column of its
///            map
/// All processes gather the sums of all others and find the same edges. If one process has the whole map, it finds the
/// same split from a single part.
struct RowSums {
  scene::PixelRect region{};        ///< region of the map to which the sums belong, in map pixels
  std::vector<std::uint64_t> rows;  ///< one value per row of the region
};
struct ColumnSums {
  scene::PixelRect region{};
  /// One value per column of the region, for each of the requested map rows.
  std::vector<std::vector<std::uint64_t>> columns;
};

/// Searches for the edges with which the costs of the processes are in proportion to `weights`. Edges may be inside a
/// map pixel, whose cost is then assumed to be uniform. Edges are multiples of `grain` image pixels if the image is
/// large enough.
class SplitSearch {
 public:
  SplitSearch(scene::ImageSize image, double resolution, scene::ImageSize map, std::vector<double> weights, int grain);

  static RowSums row_sums(const CostMap& map, const SummedArea& table);
  void find_rows(const std::vector<RowSums>& parts);

  /// Map rows at which column sums are needed. Valid after find_rows().
  [[nodiscard]] const std::vector<int>& map_rows() const { return map_rows_; }
  static ColumnSums column_sums(const CostMap& map, const SummedArea& table, const std::vector<int>& map_rows);
  [[nodiscard]] ImageSplit find_columns(const std::vector<ColumnSums>& parts) const;

 private:
  scene::ImageSize image_, map_;
  double resolution_;
  int grain_;
  std::vector<double> weights_;
  std::vector<int> per_row_, rows_, map_rows_;
};

/// Performs both stages with the whole map in one process.
ImageSplit split(const CostMap& map, scene::ImageSize image, const std::vector<double>& weights, int grain = 1);

}  // namespace tessera::volume
