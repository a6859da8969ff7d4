// SPDX-License-Identifier: BSD-3-Clause
#include "scene/label_source.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "scene/fill_value.hpp"

namespace tessera::scene {
namespace {

constexpr std::size_t most_label_values = 4096;

/// Counts for one value: the samples with this value, and the pairs of neighbours that contain it. A pair of equal
/// values is counted once.
struct LabelTally {
  std::uint64_t samples = 0, equal = 0, unequal = 0;
};

class LabelTallies {
 public:
  /// Adds a row. Returns false if its values cannot be labels.
  bool add(std::span<const double> row) {
    LabelTally* before = nullptr;
    double last = 0;
    for (const double value : row) {
      if (!std::isfinite(value) || std::abs(value) >= huge_value) {  // blank, or a fill value
        before = nullptr;
        continue;
      }
      if (before != nullptr && value == last) {
        ++before->samples, ++before->equal;
        continue;
      }
      if (value != std::floor(value) || std::abs(value) >= 0x1p32) return false;
      LabelTally& here = values_[value];
      if (values_.size() > most_label_values) return false;
      ++here.samples;
      if (before != nullptr) {
        ++here.unequal, ++before->unequal;
        ++unequal_;
        add_step(value, last);
      }
      before = &here, last = value;  // pointers to values of a map remain valid
    }
    return true;
  }

  /// Compares two adjacent rows.
  void compare(std::span<const double> row, std::span<const double> next) {
    for (std::size_t i = 0; i < row.size(); ++i)
      if (row[i] != next[i] && std::abs(row[i] - next[i]) < huge_value) add_step(row[i], next[i]);
  }

  [[nodiscard]] bool are_labels() const {
    const std::size_t count = values_.size();
    if (count <= 2) return false;
    const auto [low, high] = std::ranges::minmax_element(values_, {}, [](const auto& v) { return v.first; });
    const double equal = equal_share();
    if (count <= 24) return equal >= 0.3;
    if (low->first >= 0 && high->first <= 63) return equal >= 0.5;
    return median_share() >= 0.5 && steps_ >= 2 * static_cast<double>(steps_counted_);
  }
  /// Whether the grid may have labels, according to some of its slices. These may have fewer labels than the whole
  /// grid, and smaller shares.
  [[nodiscard]] bool may_be_labels() const {
    if (values_.size() <= 24) return values_.size() <= 2 || equal_share() >= 0.2;
    return median_share() >= 0.4;
  }

  [[nodiscard]] std::vector<double> values() const {
    std::vector<double> values;
    values.reserve(values_.size());
    for (const auto& [value, tally] : values_) values.push_back(value);
    std::ranges::sort(values);
    return values;
  }

 private:
  void add_step(double from, double to) { steps_ += std::abs(from - to), ++steps_counted_; }
  /// The share of pairs with equal values, out of the pairs that are not both background.
  [[nodiscard]] double equal_share() const {
    const auto ground = std::ranges::max_element(values_, {}, [](const auto& v) { return v.second.samples; });
    std::uint64_t equal = 0;
    for (auto value = values_.begin(); value != values_.end(); ++value)
      if (value != ground) equal += value->second.equal;
    const std::uint64_t all = equal + unequal_;
    return all == 0 ? 1 : static_cast<double>(equal) / static_cast<double>(all);
  }
  [[nodiscard]] double median_share() const {
    std::vector<double> shares;
    for (const auto& [value, tally] : values_) {
      const auto pairs = 2 * tally.equal + tally.unequal;
      shares.push_back(pairs == 0 ? 0 : 2 * static_cast<double>(tally.equal) / static_cast<double>(pairs));
    }
    const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
    std::ranges::nth_element(shares, middle);
    return *middle;
  }

  std::unordered_map<double, LabelTally> values_;
  double steps_ = 0;
  std::uint64_t steps_counted_ = 0, unequal_ = 0;  ///< number of differences in `steps_`; number of unequal neighbours
                                                   ///< along i
};

/// Adds a slice of samples. Returns false if the values cannot be labels.
bool add_slice(const SampleSource& source, std::int64_t k, std::vector<double>& values, LabelTallies& tallies) {
  const GridIndex n = source.geometry().samples();
  values.resize(static_cast<std::size_t>(n[0] * n[1]));
  source.read(SampleBox{{0, 0, k}, {n[0], n[1], k + 1}}, std::span<double>(values));
  const Grid& grid = source.grid();
  if (grid.scale != 1 || grid.shift != 0)
    for (double& value : values) value = grid.value(value);
  const auto row = [&](std::int64_t j) {
    return std::span<const double>(values).subspan(static_cast<std::size_t>(j * n[0]), static_cast<std::size_t>(n[0]));
  };
  for (std::int64_t j = 0; j < n[1]; ++j) {
    if (!tallies.add(row(j))) return false;
    if (j > 0) tallies.compare(row(j - 1), row(j));
  }
  return true;
}

/// Returns the coordinates midway between points, and half a spacing beyond the first and the last point.
std::vector<double> voxel_borders(const std::vector<double>& points) {
  if (points.size() < 2) return points;
  std::vector<double> borders;
  borders.reserve(points.size() + 1);
  borders.push_back(points[0] - (points[1] - points[0]) / 2);
  for (std::size_t k = 1; k < points.size(); ++k) borders.push_back((points[k - 1] + points[k]) / 2);
  borders.push_back(points.back() + (points.back() - points[points.size() - 2]) / 2);
  return borders;
}

Grid as_cells(Grid grid) {
  GridGeometry& g = grid.geometry;
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    ++g.points[a];
    if (g.rectilinear(a))
      g.coordinates[a] = voxel_borders(g.coordinates[a]);
    else
      g.origin -= g.direction[axis] * (g.spacing[axis] / 2);
  }
  g.association = Association::cell;
  return grid;
}

}  // namespace

LabelValues label_values(const SampleSource& source, bool stated) {
  const std::int64_t slices = source.geometry().samples()[2];
  std::vector<double> values;
  if (!stated) {
    constexpr std::int64_t examined = 16;
    LabelTallies some;
    for (std::int64_t n = 0; n < std::min(examined, slices); ++n) {
      const std::int64_t k = slices <= examined ? n : (2 * n + 1) * slices / (2 * examined);
      if (!add_slice(source, k, values, some)) return {};
    }
    if (!some.may_be_labels()) return {};
  }
  LabelTallies all;
  for (std::int64_t k = 0; k < slices; ++k)
    if (!add_slice(source, k, values, all)) return {stated, {}};
  if (!stated && !all.are_labels()) return {};
  return {true, all.values()};
}

LabelSource::LabelSource(std::shared_ptr<const SampleSource> points, std::string source)
    : SampleSource(as_cells(points->grid()), std::move(source)), points_(std::move(points)) {}

void LabelSource::read_samples(const SampleBox& box, const SampleLayout& layout, std::byte* destination) const {
  const std::int64_t last = (box.extent(2) - 1) * layout.slice_pitch + (box.extent(1) - 1) * layout.row_pitch;
  const auto bytes = static_cast<std::size_t>(last + box.extent(0)) * size_of(layout.type);
  if (box.count() > 0) points_->read(box, layout, std::span(destination, bytes));
}

}  // namespace tessera::scene
