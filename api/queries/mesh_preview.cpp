// SPDX-License-Identifier: BSD-3-Clause
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "api/queries/preview.hpp"

namespace tessera::api {
namespace {

constexpr double reach = 0.5;  ///< largest distance from a tet at which samples have values, in units of the sample
                               ///< spacing

struct Plane {
  glm::dvec3 inward;  ///< unit length
  double at;          ///< dot(inward, p) for the face's points
};

/// One tet in the grid of samples; lengths are in units of the sample spacing.
class TetOfSamples {
 public:
  /// `value` contains the values of the corners, from 0 to 1 over the range.
  TetOfSamples(const std::array<glm::dvec3, 4>& corner, const std::array<double, 4>& value) {
    const glm::dvec3 a = corner[1] - corner[0], b = corner[2] - corner[0], c = corner[3] - corner[0];
    const double volume = glm::dot(a, glm::cross(b, c));
    flat_ = !(std::abs(volume) > 1e-12 * glm::length(a) * glm::length(b) * glm::length(c));
    if (flat_) return;
    const std::array<glm::dvec3, 3> dual{glm::cross(b, c) / volume, glm::cross(c, a) / volume,
                                         glm::cross(a, b) / volume};
    gradient_ = glm::dvec3(0);
    for (std::size_t i = 0; i < 3; ++i) gradient_ += (value[i + 1] - value[0]) * dual[i];
    origin_ = corner[0], at_origin_ = value[0];
    std::tie(least_, most_) = std::minmax({value[0], value[1], value[2], value[3]});
    for (std::size_t i = 0; i < 4; ++i) {
      // The direction to corner i from the opposite face.
      const glm::dvec3 up = i == 0 ? -(dual[0] + dual[1] + dual[2]) : dual[i - 1];
      planes_[i].inward = up / glm::length(up);
      planes_[i].at = glm::dot(planes_[i].inward, corner[i == 0 ? 1 : 0]);
    }
  }
  [[nodiscard]] bool flat() const { return flat_; }
  /// Distance to the nearest face plane: positive inside the tet, negative outside.
  [[nodiscard]] double inside(const glm::dvec3& p) const {
    double least = HUGE_VAL;
    for (const Plane& plane : planes_) least = std::min(least, glm::dot(plane.inward, p) - plane.at);
    return least;
  }
  [[nodiscard]] double value(const glm::dvec3& p) const {
    return std::clamp(at_origin_ + glm::dot(gradient_, p - origin_), least_, most_);
  }

 private:
  std::array<Plane, 4> planes_{};
  glm::dvec3 gradient_{0}, origin_{0};
  double at_origin_ = 0, least_ = 0, most_ = 0;
  bool flat_ = true;
};

void keep_least(std::uint64_t& sample, std::uint64_t key) {
  const std::atomic_ref<std::uint64_t> shared(sample);
  std::uint64_t now = shared.load(std::memory_order_relaxed);
  while (key < now && !shared.compare_exchange_weak(now, key, std::memory_order_relaxed)) {
  }
}

}  // namespace

GridGeometry preview_geometry(const Box& box, std::uint64_t samples) {
  const glm::dvec3 sides = box.high - box.low;
  const double longest = std::max({sides.x, sides.y, sides.z});
  GridGeometry geometry;
  geometry.origin = box.low;
  if (!(longest > 0) || !std::isfinite(longest)) {
    geometry.points = {2, 2, 2};
    return geometry;
  }
  const auto points = [&](double distance) {
    GridIndex n{};
    for (std::size_t a = 0; a < 3; ++a)
      n[a] = std::max<std::int64_t>(2, static_cast<std::int64_t>(sides[static_cast<int>(a)] / distance) + 1);
    return n;
  };
  const auto fits = [&](double distance) {
    const GridIndex n = points(distance);
    return static_cast<double>(n[0]) * static_cast<double>(n[1]) * static_cast<double>(n[2]) <=
           static_cast<double>(samples);
  };
  double small = longest / static_cast<double>(samples), large = longest;
  for (int halving = 0; halving < 60; ++halving)
    (fits(std::sqrt(small * large)) ? large : small) = std::sqrt(small * large);
  geometry.points = points(large);
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    geometry.spacing[axis] = sides[axis] > 0 ? sides[axis] / static_cast<double>(geometry.points[a] - 1) : large;
  }
  return geometry;
}

PreviewSamples preview_samples(const scene::TetMeshView& part, std::span<const std::uint64_t> global_tet,
                               const std::array<double, 2>& range, const GridGeometry& geometry,
                               const std::stop_token& stop) {
  const GridIndex n = geometry.points;
  PreviewSamples samples(static_cast<std::size_t>(geometry.all_samples().count()), no_sample);
  const double scale = range[0] < range[1] ? 1 / (range[1] - range[0]) : 0;
  const bool points = part.association == Association::point;
  constexpr std::size_t tets_at_once = 1 << 14;
  tbb::parallel_for(std::size_t{0}, (part.tets.size() + tets_at_once - 1) / tets_at_once, [&](std::size_t block) {
    if (stop.stop_requested()) return;
    const std::size_t end = std::min((block + 1) * tets_at_once, part.tets.size());
    for (std::size_t t = block * tets_at_once; t < end; ++t) {
      std::array<glm::dvec3, 4> corner;
      std::array<double, 4> value{};
      glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL);
      for (std::size_t c = 0; c < 4; ++c) {
        const std::uint32_t v = part.tets[t][c];
        corner[c] = (part.positions[v] - geometry.origin) / geometry.spacing;
        value[c] = (part.scalars[points ? v : t] - range[0]) * scale;
        low = glm::min(low, corner[c]), high = glm::max(high, corner[c]);
      }
      std::array<std::int64_t, 3> first{}, last{};
      bool any = true;
      for (std::size_t a = 0; a < 3; ++a) {
        const auto axis = static_cast<int>(a);
        const auto count = static_cast<double>(n[a]);
        first[a] = static_cast<std::int64_t>(std::clamp(std::ceil(low[axis] - reach), 0.0, count));
        last[a] = static_cast<std::int64_t>(std::clamp(std::floor(high[axis] + reach), -1.0, count - 1));
        any = any && first[a] <= last[a];
      }
      if (!any) continue;
      const TetOfSamples tet(corner, value);
      if (tet.flat()) continue;
      const std::uint64_t number =
          std::min<std::uint64_t>(global_tet.empty() ? t : global_tet[t], (std::uint64_t{1} << 31) - 1);
      for (std::int64_t k = first[2]; k <= last[2]; ++k)
        for (std::int64_t j = first[1]; j <= last[1]; ++j)
          for (std::int64_t i = first[0]; i <= last[0]; ++i) {
            const glm::dvec3 p(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
            const double inside = tet.inside(p);
            if (!(inside >= -reach)) continue;
            const std::uint64_t beside = inside >= -1e-9 ? 0 : 1;
            const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(tet.value(p)) + 0.0F);
            keep_least(samples[static_cast<std::size_t>(i + n[0] * (j + n[1] * k))],
                       beside << 63 | number << 32 | bits);
          }
    }
  });
  return samples;
}

}  // namespace tessera::api
