// SPDX-License-Identifier: BSD-3-Clause
#include "cells/polygon_triangles.hpp"

#include <algorithm>
#include <tuple>

namespace tessera::cells {

void PolygonTriangles::cut(std::span<const std::uint32_t> polygon, std::span<const glm::dvec3> points,
                           std::vector<std::array<std::uint32_t, 3>>& triangles) {
  ring_.clear();
  for (const std::uint32_t v : polygon)
    if (ring_.empty() || points[v] != points[ring_.back()]) ring_.push_back(v);
  while (ring_.size() > 1 && points[ring_.front()] == points[ring_.back()]) ring_.pop_back();
  if (ring_.size() < 3) return;
  if (ring_.size() == 3) {
    triangles.push_back({ring_[0], ring_[1], ring_[2]});
    return;
  }
  // Returns the number of a corner in the order of positions.
  const auto place = [&](std::uint32_t v) {
    const glm::dvec3& p = points[v];
    return std::tuple(p.x, p.y, p.z);
  };
  sorted_ = ring_;
  std::ranges::sort(sorted_, {}, place);
  corners_.clear(), places_.clear(), triangles_.clear();
  for (const std::uint32_t v : sorted_) places_.push_back(points[v]);
  for (const std::uint32_t v : ring_)
    corners_.push_back(
        static_cast<std::uint32_t>(std::ranges::lower_bound(sorted_, place(v), {}, place) - sorted_.begin()));
  cutter_.cut(corners_, places_, triangles_);
  for (const CornerTriangle& t : triangles_) triangles.push_back({sorted_[t[0]], sorted_[t[1]], sorted_[t[2]]});
}

}  // namespace tessera::cells
