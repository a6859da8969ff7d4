// SPDX-License-Identifier: BSD-3-Clause
// Histograms and quantiles of a data set's field samples.
#include "tessera/field_queries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <vector>

#include "api/dataset.hpp"
#include "scene/error.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

constexpr std::size_t most_bins = 65536;

/// Tests whether places are visible in a view.
class Window {
 public:
  explicit Window(const View& view) : camera_(view.camera) {
    validate(view.camera);
    validate(view.size);
    basis_ = view_basis(camera_);
    aspect_ = static_cast<double>(view.size.width) / view.size.height;
    perspective_ = camera_.projection == ProjectionKind::perspective;
    half_height_ = perspective_ ? std::tan(glm::radians(camera_.view_angle) / 2) : camera_.parallel_scale;
  }
  [[nodiscard]] bool holds(const glm::dvec3& p_world) const {
    const glm::dvec3 p = p_world - camera_.position;
    const double depth = glm::dot(p, basis_.forward);
    const auto& range = camera_.clipping_range;
    if (!(depth > 0) || (range && !(depth > range->near_distance && depth < range->far_distance))) return false;
    const double half = perspective_ ? half_height_ * depth : half_height_;
    return std::abs(glm::dot(p, basis_.up)) <= half && std::abs(glm::dot(p, basis_.right)) <= half * aspect_;
  }

 private:
  Camera camera_;
  ViewBasis basis_{};
  double aspect_, half_height_;
  bool perspective_;
};

/// A value and the volume in which the field has it.
struct Share {
  double value, volume;
};

glm::dvec3 place_of(const Dataset::State& data, const scene::FieldSample& sample) {
  const glm::dvec3 at(sample.at[0], sample.at[1], sample.at[2]);
  const scene::Box& box = data.facts_of_all().box;
  if (data.samples == nullptr) return box.low + at * (box.high - box.low);
  const GridGeometry& g = data.samples->geometry();
  glm::dvec3 local;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    local[axis] = std::lerp(g.lattice(a, 0), g.lattice(a, g.points[a] - 1), at[axis]);
  }
  return g.origin + g.direction * local;
}

std::vector<Share> shares_of(const Dataset& dataset, const std::optional<View>& seen) {
  const Dataset::State& data = StateAccess::of(dataset);
  std::optional<Window> window;
  if (seen) window.emplace(*seen);
  const bool clipped = !data.clip.empty();
  const auto [low, high] = data.facts.scalar_range;  // the range after the selection
  std::vector<Share> shares;
  for (const scene::FieldSample& sample : data.field_samples().samples) {
    if (data.of_all && !(sample.value >= low && sample.value <= high)) continue;
    if (window || clipped) {
      const glm::dvec3 p = place_of(data, sample);
      if (window && !window->holds(p)) continue;
      if (clipped &&
          std::ranges::any_of(data.clip, [&](const HalfSpace& h) { return glm::dot(p - h.point, h.normal) < 0; }))
        continue;
    }
    shares.push_back({sample.value, sample.volume});
  }
  return shares;
}

std::array<double, 2> default_range(const Dataset& dataset) {
  const auto [low, high] = dataset.range();
  if (low < high) return {low, high};
  const double half = std::max(0.5, std::abs(low) * 0x1p-40);
  return {low - half, low + half};
}

double smallest_positive(const Dataset& dataset, std::span<const Share> shares, double high) {
  double least = std::numeric_limits<double>::infinity();
  for (const Share& share : shares)
    if (share.value > 0) least = std::min(least, share.value);
  if (!(high > 0))
    throw scene::bad_input(fmt::format("{}: `log`: the range ends at {:.6g}, but logarithms need a positive value",
                                       dataset.source(), high));
  return least < high ? least : high / 2;
}

}  // namespace

Histogram histogram(const Dataset& dataset, const HistogramOptions& options) {
  if (options.bins < 1 || options.bins > most_bins)
    throw scene::bad_input(
        fmt::format("histogram: {} bins are not supported; choose 1 to {}", options.bins, most_bins));
  Histogram found;
  found.range = options.range.value_or(default_range(dataset));
  found.logarithmic = options.logarithmic;
  if (!(found.range[0] < found.range[1]) || !std::isfinite(found.range[0]) || !std::isfinite(found.range[1]))
    throw scene::bad_input(
        fmt::format("`range`: {} to {} is empty; give the smaller number first", found.range[0], found.range[1]));
  const std::vector<Share> shares = shares_of(dataset, options.seen);
  if (options.logarithmic && !(found.range[0] > 0)) found.range[0] = smallest_positive(dataset, shares, found.range[1]);

  const auto scale = [&](double value) { return options.logarithmic ? std::log10(value) : value; };
  // Both numbers are halved so that they do not overflow.
  const double low = scale(found.range[0]) / 2, width = scale(found.range[1]) / 2 - low;
  found.shares.assign(options.bins, 0);
  double inside = 0, outside = 0;
  for (const auto& [value, volume] : shares) {
    if (!(value >= found.range[0] && value <= found.range[1])) {
      outside += volume;
      continue;
    }
    const double at = (scale(value) / 2 - low) / width * static_cast<double>(options.bins);
    found.shares[std::min(static_cast<std::size_t>(std::max(at, 0.0)), options.bins - 1)] += volume;
    inside += volume;
  }
  if (inside > 0)
    for (double& share : found.shares) share /= inside;
  if (inside + outside > 0) found.outside = outside / (inside + outside);
  return found;
}

std::vector<double> quantiles(const Dataset& dataset, std::span<const double> fractions,
                              const std::optional<View>& seen) {
  for (const double fraction : fractions)
    if (!(fraction >= 0 && fraction <= 1))
      throw scene::bad_input(fmt::format("quantiles: {} is not a fraction of the volume; give 0 to 1", fraction));
  std::vector<Share> shares = shares_of(dataset, seen);
  if (shares.empty()) return std::vector<double>(fractions.size(), std::numeric_limits<double>::quiet_NaN());
  std::ranges::stable_sort(shares, {}, &Share::value);
  std::vector<double> below;  // cumulative sums of the shares, each including its own share
  below.reserve(shares.size());
  double sum = 0;
  for (const Share& share : shares) below.push_back(sum += share.volume);
  std::vector<double> values;
  for (const double fraction : fractions) {
    const auto at = static_cast<std::size_t>(std::ranges::lower_bound(below, fraction * sum) - below.begin());
    values.push_back(shares[std::min(at, shares.size() - 1)].value);
  }
  return values;
}

}  // namespace v0_1
}  // namespace tessera
