// SPDX-License-Identifier: BSD-3-Clause
#include "volume/split/image_split.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tessera::volume {
namespace {

/// Returns edges 0 = e[0] <= ... <= e.back() = length, which divide the length into pieces whose costs are in
/// proportion to `weights`. `before[i]` is the cost of the first i cells of a map with `resolution` cells per image
/// pixel. Every piece has at least one pixel if there are enough pixels.
std::vector<int> cut(const std::vector<double>& before, double resolution, int length,
                     const std::vector<double>& weights, int grain) {
  if (length < grain * static_cast<int>(weights.size())) grain = 1;
  const auto pieces = static_cast<int>(weights.size());
  const double total = before.back(), all = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<int> edges{0};
  double share = 0;
  for (int piece = 1; piece < pieces; ++piece) {
    share += weights[static_cast<std::size_t>(piece) - 1];
    double at = length * share / all;  // without costs: equal pieces
    if (total > 0) {
      const double target = total * share / all;
      const auto above = std::upper_bound(before.begin() + 1, before.end() - 1, target);
      const double low = *(above - 1), high = *above;
      const double cell =
          static_cast<double>(above - 1 - before.begin()) + (high > low ? (target - low) / (high - low) : 0);
      at = cell / resolution;
    }
    const int least = edges.back() + (length >= pieces ? 1 : 0),
              most = length - (length >= pieces ? pieces - piece : 0);
    const int wanted = static_cast<int>(std::lround(at / grain)) * grain;
    edges.push_back(std::clamp(wanted, std::min(least, most), most));
  }
  edges.push_back(length);
  return edges;
}

}  // namespace

SummedArea::SummedArea(const CostMap& map)
    : width_(map.width()),
      sums_(static_cast<std::size_t>(map.width() + 1) * static_cast<std::size_t>(map.height() + 1)) {
  const auto stride = static_cast<std::size_t>(width_) + 1;
  const std::uint32_t* cost = map.cost.data();
  for (std::size_t y = 1; y <= static_cast<std::size_t>(map.height()); ++y) {
    std::uint64_t row = 0;
    for (std::size_t x = 1; x < stride; ++x) {
      row += *cost++;
      sums_[y * stride + x] = sums_[(y - 1) * stride + x] + row;
    }
  }
}

int ImageSplit::processes() const {
  int count = 0;
  for (const auto& edges : columns) count += static_cast<int>(edges.size()) - 1;
  return count;
}

scene::PixelRect ImageSplit::region(int process) const {
  std::size_t row = 0;
  for (; process >= static_cast<int>(columns[row].size()) - 1; ++row)
    process -= static_cast<int>(columns[row].size()) - 1;
  const auto column = static_cast<std::size_t>(process);
  return {columns[row][column], rows[row], columns[row][column + 1], rows[row + 1]};
}

std::vector<scene::PixelRect> ImageSplit::parts(int process) const {
  const scene::PixelRect whole = region(process);
  if (steps.empty()) return {whole};
  std::size_t row = 0;
  for (; process >= static_cast<int>(columns[row].size()) - 1; ++row)
    process -= static_cast<int>(columns[row].size()) - 1;
  const auto edge = [&](int number) {
    const auto n = static_cast<std::size_t>(number);
    return SteppedEdge{columns[row][n], steps[row][n]};
  };
  std::vector<scene::PixelRect> parts;
  each_rectangle(whole.y0, whole.y1, edge(process), edge(process + 1), columns[row].back(),
                 [&](const scene::PixelRect& part) { parts.push_back(part); });
  return parts;
}

std::vector<int> columns_of_rows(int processes, scene::ImageSize size) {
  const double wanted = std::sqrt(static_cast<double>(processes) * size.height / size.width);
  const int rows = std::clamp(static_cast<int>(std::lround(wanted)), 1, processes);
  std::vector<int> columns(static_cast<std::size_t>(rows), processes / rows);
  for (int i = 0; i < processes % rows; ++i) ++columns[static_cast<std::size_t>(i)];
  return columns;
}

ImageSplit even_split(int processes, scene::ImageSize size, const scene::PixelRect& area) {
  const std::vector<int> per_row = columns_of_rows(processes, size);
  const auto edge = [](int low, int high, int part, int parts) {
    return low + static_cast<int>(static_cast<std::int64_t>(high - low) * part / parts);
  };
  ImageSplit split;
  split.rows = {0};
  int done = 0;
  for (std::size_t row = 0; row < per_row.size(); ++row) {
    done += per_row[row];
    split.rows.push_back(row + 1 == per_row.size() ? size.height : edge(area.y0, area.y1, done, processes));
    std::vector<int>& columns = split.columns.emplace_back(1, 0);
    for (int c = 1; c < per_row[row]; ++c) columns.push_back(edge(area.x0, area.x1, c, per_row[row]));
    columns.push_back(size.width);
  }
  return split;
}

SplitSearch::SplitSearch(scene::ImageSize image, double resolution, scene::ImageSize map, std::vector<double> weights,
                         int grain)
    : image_(image),
      map_(map),
      resolution_(resolution),
      grain_(grain),
      weights_(std::move(weights)),
      per_row_(columns_of_rows(static_cast<int>(weights_.size()), image)) {}

RowSums SplitSearch::row_sums(const CostMap& map, const SummedArea& table) {
  RowSums sums{map.region, {}};
  for (int y = 0; y < map.height(); ++y) sums.rows.push_back(table.sum(map.width(), y + 1) - table.sum(map.width(), y));
  return sums;
}

void SplitSearch::find_rows(const std::vector<RowSums>& parts) {
  std::vector<std::uint64_t> rows(static_cast<std::size_t>(map_.height));
  for (const RowSums& part : parts)
    for (std::size_t y = 0; y < part.rows.size(); ++y)
      rows[static_cast<std::size_t>(part.region.y0) + y] += part.rows[y];
  std::vector<double> before{0};
  for (const std::uint64_t cost : rows) before.push_back(before.back() + static_cast<double>(cost));
  std::vector<double> weight_of_row;
  auto weight = weights_.begin();
  for (const int columns : per_row_) {
    weight_of_row.push_back(std::accumulate(weight, weight + columns, 0.0));
    weight += columns;
  }
  rows_ = cut(before, resolution_, image_.height, weight_of_row, grain_);
  for (const int edge : rows_) {
    const double at = std::min(edge * resolution_, static_cast<double>(map_.height));
    for (const int row : {static_cast<int>(std::floor(at)), static_cast<int>(std::ceil(at))})
      if (std::find(map_rows_.begin(), map_rows_.end(), row) == map_rows_.end()) map_rows_.push_back(row);
  }
}

ColumnSums SplitSearch::column_sums(const CostMap& map, const SummedArea& table, const std::vector<int>& map_rows) {
  ColumnSums sums{map.region, {}};
  for (const int row : map_rows) {
    const int y = std::clamp(row - map.region.y0, 0, map.height());
    std::vector<std::uint64_t>& columns = sums.columns.emplace_back();
    for (int x = 0; x < map.width(); ++x) columns.push_back(table.sum(x + 1, y) - table.sum(x, y));
  }
  return sums;
}

ImageSplit SplitSearch::find_columns(const std::vector<ColumnSums>& parts) const {
  // The cost above each requested map row, for each column of the whole map.
  std::vector<std::vector<std::uint64_t>> above(map_rows_.size(),
                                                std::vector<std::uint64_t>(static_cast<std::size_t>(map_.width)));
  for (const ColumnSums& part : parts)
    for (std::size_t r = 0; r < above.size(); ++r)
      for (std::size_t x = 0; x < part.columns[r].size(); ++x)
        above[r][static_cast<std::size_t>(part.region.x0) + x] += part.columns[r][x];
  const auto above_edge = [&](int edge) {
    const double at = std::min(edge * resolution_, static_cast<double>(map_.height));
    const auto number = [&](double row) {
      return static_cast<std::size_t>(std::find(map_rows_.begin(), map_rows_.end(), static_cast<int>(row)) -
                                      map_rows_.begin());
    };
    const auto &low = above[number(std::floor(at))], &high = above[number(std::ceil(at))];
    const double along = at - std::floor(at);
    std::vector<double> columns;
    for (std::size_t x = 0; x < low.size(); ++x)
      columns.push_back(static_cast<double>(low[x]) +
                        along * (static_cast<double>(high[x]) - static_cast<double>(low[x])));
    return columns;
  };

  ImageSplit split;
  split.rows = rows_;
  auto weight = weights_.begin();
  std::vector<double> top = above_edge(rows_.front());
  for (std::size_t row = 0; row < per_row_.size(); ++row) {
    const std::vector<double> bottom = above_edge(rows_[row + 1]);
    std::vector<double> before{0};
    for (std::size_t x = 0; x < bottom.size(); ++x) before.push_back(before.back() + std::max(0.0, bottom[x] - top[x]));
    split.columns.push_back(cut(before, resolution_, image_.width, {weight, weight + per_row_[row]}, grain_));
    weight += per_row_[row];
    top = bottom;
  }
  return split;
}

ImageSplit split(const CostMap& map, scene::ImageSize image, const std::vector<double>& weights, int grain) {
  const SummedArea table(map);
  SplitSearch search(image, map.resolution, map.size, weights, grain);
  search.find_rows({SplitSearch::row_sums(map, table)});
  return search.find_columns({SplitSearch::column_sums(map, table, search.map_rows())});
}

}  // namespace tessera::volume
