// SPDX-License-Identifier: BSD-3-Clause
#include "volume/split/balanced_split.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "volume/render.hpp"
#include "volume/tile_rays.hpp"

namespace tessera::volume {
namespace {

constexpr int tile_side = TileRays::side;

/// The edges that a row of rectangles may have, numbered from left to right.
class EdgesOfRow {
 public:
  EdgesOfRow(int y0, int y1, int width) : y0_(y0), y1_(y1), width_(width) {
    const int first = y0 / tile_side, last = (std::max(y0 + 1, y1) - 1) / tile_side;
    per_grain_ = last - first + 1;
    count_ = (width + region_grain - 1) / region_grain * per_grain_;
  }

  /// The number of the image's right edge; the left edge has number 0.
  [[nodiscard]] int last() const { return count_; }
  [[nodiscard]] SteppedEdge operator[](int number) const {
    const int tile_rows = number % per_grain_;
    return {std::min(width_, number / per_grain_ * region_grain),
            tile_rows == 0 ? y0_ : std::min(y1_, (y0_ / tile_side + tile_rows) * tile_side)};
  }

 private:
  int y0_, y1_, width_, per_grain_, count_;
};

class Search {
 public:
  Search(const TileCosts& costs, std::span<const double> beside)
      : costs_(costs),
        beside_(beside),
        per_row_(columns_of_rows(static_cast<int>(beside.size()), costs.size())),
        rows_(per_row_.size()) {}

  ImageSplit find() {
    const double all = costs_.of({0, 0, costs_.size().width, costs_.size().height}) +
                       std::accumulate(beside_.begin(), beside_.end(), 0.0);
    // The range in which the largest load is searched: from a load that is too small to a load that is sufficient.
    double low = all / static_cast<double>(beside_.size()), high = 1.1 * low;
    while (!fits(high)) low = high, high *= 1.5;
    for (int n = 0; n < 12; ++n) {
      const double middle = 0.5 * (low + high);
      (fits(middle) ? high : low) = middle;
    }
    fits(high);
    return split();
  }

 private:
  /// Cost of the pixels between two edges.
  [[nodiscard]] double between(int y0, int y1, const SteppedEdge& left, const SteppedEdge& right) const {
    double cost = 0;
    each_rectangle(y0, y1, left, right, costs_.size().width,
                   [&](const scene::PixelRect& part) { cost += costs_.of(part); });
    return cost;
  }

  /// Whether the row's processes, beginning with `first`, can render the row's pixels with a load of at most `most`
  /// each. Writes the edges of these processes.
  bool fits_row(std::size_t row, std::size_t first, int y0, int y1, double most, std::vector<int>& edges) const {
    const EdgesOfRow all(y0, y1, costs_.size().width);
    edges.assign(1, 0);
    for (int c = 0; c < per_row_[row]; ++c) {
      const double room = most - beside_[first + static_cast<std::size_t>(c)];
      const int left = edges.back();
      int low = left, high = all.last();
      while (low < high) {
        const int middle = low + (high - low + 1) / 2;
        if (between(y0, y1, all[left], all[middle]) <= room)
          low = middle;
        else
          high = middle - 1;
      }
      edges.push_back(low);
    }
    return edges.back() == all.last();
  }

  /// Makes rows from top to bottom, each as high as possible, and returns whether they cover the image.
  bool fits(double most) {
    std::size_t first = 0;
    int y0 = 0;
    const int height = costs_.size().height;
    for (std::size_t row = 0; row < per_row_.size(); ++row) {
      std::vector<int> edges;
      int low = y0 / region_grain, high = (height + region_grain - 1) / region_grain;
      while (low < high) {
        const int middle = low + (high - low + 1) / 2;
        if (fits_row(row, first, y0, std::min(height, middle * region_grain), most, edges))
          low = middle;
        else
          high = middle - 1;
      }
      rows_[row] = {y0, std::min(height, std::max(y0, low * region_grain)), first, most};
      first += static_cast<std::size_t>(per_row_[row]);
      y0 = rows_[row].y1;
    }
    return y0 == height;
  }

  struct Row {
    int y0, y1;
    std::size_t first;  ///< first process of the row
    double most;
  };

  /// The edges of a row with the smallest possible load.
  [[nodiscard]] std::vector<int> even_edges(std::size_t row) const {
    const Row& r = rows_[row];
    std::vector<int> edges, best;
    double low = 0, high = r.most;
    fits_row(row, r.first, r.y0, r.y1, high, best);
    for (int n = 0; n < 16; ++n) {
      const double middle = 0.5 * (low + high);
      if (fits_row(row, r.first, r.y0, r.y1, middle, edges))
        high = middle, best = edges;
      else
        low = middle;
    }
    return best;
  }

  [[nodiscard]] ImageSplit split() const {
    ImageSplit split;
    split.rows = {0};
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      split.rows.push_back(rows_[row].y1);
      const EdgesOfRow all(rows_[row].y0, rows_[row].y1, costs_.size().width);
      std::vector<int>&columns = split.columns.emplace_back(), &steps = split.steps.emplace_back();
      for (const int edge : even_edges(row)) columns.push_back(all[edge].x), steps.push_back(all[edge].step);
    }
    return split;
  }

  const TileCosts& costs_;
  std::span<const double> beside_;
  std::vector<int> per_row_;
  std::vector<Row> rows_;
};

}  // namespace

ImageSplit balanced_split(const TileCosts& costs, std::span<const double> beside) {
  return Search(costs, beside).find();
}

}  // namespace tessera::volume
