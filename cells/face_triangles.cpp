// SPDX-License-Identifier: BSD-3-Clause
#include "cells/face_triangles.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::cells {
namespace {

// How far rounding may invert triangles, or move corners out of an ear, relative to the area of the face.
constexpr double turned_by_rounding = 1e-9, outside_by_rounding = 1e-12;

/// Rotates a ring to its lexicographically smallest rotation. The same corner may occur several times in a ring.
void start_at_least(std::vector<std::uint32_t>& ring) {
  const std::size_t n = ring.size();
  std::size_t i = 0, j = 1, same = 0;
  while (i < n && j < n && same < n) {
    const std::uint32_t a = ring[(i + same) % n], b = ring[(j + same) % n];
    if (a == b) {
      ++same;
      continue;
    }
    (a > b ? i : j) += same + 1;
    if (i == j) ++j;
    same = 0;
  }
  std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(std::min(i, j)), ring.end());
}

}  // namespace

bool FaceCutter::cut(std::span<const std::uint32_t> corners, std::span<const glm::dvec3> p,
                     std::vector<CornerTriangle>& triangles) {
  if (corners.size() < 3) return true;
  // All rounded values are computed along this ring, so they are the same for every list of the same corners.
  ring_.assign(corners.begin(), corners.end());
  reversed_.assign(corners.rbegin(), corners.rend());
  start_at_least(ring_);
  start_at_least(reversed_);
  backwards_ = reversed_ < ring_;
  if (backwards_) ring_.swap(reversed_);
  triangles_ = &triangles;

  const auto fan_area = [&](std::size_t k) {
    return glm::cross(p[ring_[k]] - p[ring_[0]], p[ring_[k + 1]] - p[ring_[0]]);
  };
  area_ = glm::dvec3(0);
  for (std::size_t k = 1; k + 1 < ring_.size(); ++k) area_ += fan_area(k);
  area_squared_ = glm::dot(area_, area_);
  bool is_fan = ring_.size() == 3 || ring_.size() > most_ears;
  if (!is_fan) {
    is_fan = true;
    for (std::size_t k = 1; k + 1 < ring_.size() && is_fan; ++k)
      is_fan = glm::dot(fan_area(k), area_) >= -turned_by_rounding * area_squared_;
  }
  if (is_fan)
    for (std::size_t k = 1; k + 1 < ring_.size(); ++k) add(ring_[0], ring_[k], ring_[k + 1]);
  else
    cut_ears(p);
  return is_fan;
}

void FaceCutter::add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  backwards_ ? triangles_->push_back({a, c, b}) : triangles_->push_back({a, b, c});
}

double FaceCutter::turn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const {
  return glm::dot(glm::cross(b - a, c - a), area_);
}

FaceCutter::Ear FaceCutter::ear_at(std::size_t k, std::span<const glm::dvec3> p) const {
  const std::size_t n = ring_.size();
  const std::uint32_t before = ring_[(k + n - 1) % n], tip = ring_[k], after = ring_[(k + 1) % n];
  const glm::dvec3 a = p[before], b = p[tip], c = p[after];
  const double rounding = outside_by_rounding * area_squared_;
  const Ear none{std::numeric_limits<double>::infinity(), turn(a, b, c)};
  if (before == after || none.turn <= rounding) return none;
  for (const std::uint32_t v : ring_) {
    if (v == before || v == tip || v == after) continue;
    if (turn(a, b, p[v]) >= -rounding && turn(b, c, p[v]) >= -rounding && turn(c, a, p[v]) >= -rounding) return none;
  }
  return {glm::dot(c - a, c - a), none.turn};
}

void FaceCutter::cut_ears(std::span<const glm::dvec3> p) {
  ears_.resize(ring_.size());
  for (std::size_t k = 0; k < ring_.size(); ++k) ears_[k] = ear_at(k, p);
  while (ring_.size() > 3) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < ears_.size(); ++k) {
      // If there is no ear, as in faces that intersect themselves, the corner with the largest turn is cut off.
      const bool better =
          ears_[k].cut != ears_[best].cut
              ? ears_[k].cut < ears_[best].cut
              : ears_[best].cut == std::numeric_limits<double>::infinity() && ears_[k].turn > ears_[best].turn;
      if (better) best = k;
    }
    const std::size_t n = ring_.size();
    add(ring_[(best + n - 1) % n], ring_[best], ring_[(best + 1) % n]);
    ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(best));
    ears_.erase(ears_.begin() + static_cast<std::ptrdiff_t>(best));
    const std::size_t left = ring_.size();
    for (const std::size_t k : {(best + left - 1) % left, best % left}) ears_[k] = ear_at(k, p);
  }
  add(ring_[0], ring_[1], ring_[2]);
}

}  // namespace tessera::cells
