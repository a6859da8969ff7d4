// SPDX-License-Identifier: BSD-3-Clause
#include "cells/convex_hull.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace tessera::cells {
namespace {

/// How a plane divides the points. `supporting`: all other points are on its inner side.
enum class Side { supporting, cutting, holding_all };

class Hull {
 public:
  Hull(std::span<const std::uint32_t> points, std::span<const glm::dvec3> positions, double thickness)
      : p_(positions), thickness_(thickness) {
    for (const std::uint32_t v : points) {
      const bool is_new = std::none_of(points_.begin(), points_.end(), [&](std::uint32_t u) { return p_[u] == p_[v]; });
      if (is_new) points_.push_back(v);
      if (points_.size() > most_hull_points) return;
    }
  }

  /// Tries every plane through three points.
  bool find(std::vector<std::uint32_t>& faces) {
    const std::size_t n = points_.size();
    if (n < 4 || n > most_hull_points) return false;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        for (std::size_t k = j + 1; k < n; ++k) {
          if (!set_plane(p_[points_[i]], p_[points_[j]], p_[points_[k]])) continue;
          const Side side = look();
          if (side == Side::holding_all) return false;
          const auto is_same = [&](const Plane& plane) { return plane.points == on_; };
          if (side == Side::supporting && std::none_of(found_.begin(), found_.end(), is_same))
            found_.push_back({on_, normal_});
        }
    // Planes with the most points come first, because a plane through three points that are close to each other is
    // inaccurate and contains fewer points of its face.
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Plane& a, const Plane& b) { return a.points.size() > b.points.size(); });
    std::vector<Plane> kept;
    for (Plane& plane : found_) {
      if (std::any_of(kept.begin(), kept.end(), [&](const Plane& other) { return is_part(plane, other); })) continue;
      add_outline(plane, faces);
      kept.push_back(std::move(plane));
    }
    return !kept.empty();
  }

 private:
  /// Sets the plane through three points. Returns false if they are almost collinear.
  bool set_plane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    std::array<double, 3> edges = {glm::length(b - a), glm::length(c - b), glm::length(a - c)};
    std::sort(edges.begin(), edges.end());
    normal_ = glm::cross(b - a, c - a);
    origin_ = a;
    const double area = glm::length(normal_);
    if (!(area > 1e-6 * edges[0] * edges[1]) || !std::isfinite(area)) return false;
    normal_ /= area;
    return true;
  }

  Side look() {
    on_.clear();
    bool above = false, below = false;
    for (const std::uint32_t v : points_) {
      const double height = glm::dot(normal_, p_[v] - origin_);
      if (height > thickness_)
        above = true;
      else if (height < -thickness_)
        below = true;
      else
        on_.push_back(v);
      if (above && below) return Side::cutting;
    }
    if (!above && !below) return Side::holding_all;
    if (above) normal_ = -normal_;
    return Side::supporting;
  }

  struct Plane {
    std::vector<std::uint32_t> points;  ///< in the order of `points_`
    glm::dvec3 normal;
  };

  /// Whether both planes are the same face: they are nearly parallel and have three points in common.
  [[nodiscard]] bool is_part(const Plane& plane, const Plane& of) const {
    if (glm::dot(plane.normal, of.normal) < 0.999) return false;
    return std::count_if(plane.points.begin(), plane.points.end(), [&](std::uint32_t v) {
             return std::find(of.points.begin(), of.points.end(), v) != of.points.end();
           }) > 2;
  }

  /// Appends the outline of the points on the plane, by Andrew's monotone chain (1979), which keeps points in the
  /// middle of edges.
  void add_outline(const Plane& plane, std::vector<std::uint32_t>& faces) {
    const glm::dvec3 normal = plane.normal, origin = p_[plane.points[0]];
    const glm::dvec3 other = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(other, normal)), up = glm::cross(normal, right);
    flat_.clear();
    for (const std::uint32_t v : plane.points)
      flat_.push_back({{glm::dot(p_[v] - origin, right), glm::dot(p_[v] - origin, up)}, v});
    std::sort(flat_.begin(), flat_.end(), [](const Flat& a, const Flat& b) {
      return a.place.x != b.place.x ? a.place.x < b.place.x : a.place.y < b.place.y;
    });
    ring_.clear();
    const auto add_chain = [&](auto first, auto last) {
      const std::size_t start = ring_.size();
      for (; first != last; ++first) {
        while (ring_.size() >= start + 2 && turns_inward(ring_[ring_.size() - 2], ring_.back(), *first))
          ring_.pop_back();
        ring_.push_back(*first);
      }
      ring_.pop_back();  // the last point is also the first of the other chain
    };
    add_chain(flat_.begin(), flat_.end());
    add_chain(flat_.rbegin(), flat_.rend());
    faces.push_back(static_cast<std::uint32_t>(ring_.size()));
    for (const Flat& corner : ring_) faces.push_back(corner.index);
  }

  struct Flat {
    glm::dvec2 place;
    std::uint32_t index;
  };
  [[nodiscard]] bool turns_inward(const Flat& a, const Flat& b, const Flat& c) const {
    const glm::dvec2 way = b.place - a.place, whole = c.place - a.place;
    return way.x * whole.y - way.y * whole.x < -thickness_ * glm::length(whole);
  }

  std::span<const glm::dvec3> p_;
  double thickness_;
  std::vector<std::uint32_t> points_, on_;
  std::vector<Plane> found_;
  std::vector<Flat> flat_, ring_;
  glm::dvec3 normal_{0}, origin_{0};
};

}  // namespace

bool hull_faces(std::span<const std::uint32_t> points, std::span<const glm::dvec3> positions, double thickness,
                std::vector<std::uint32_t>& faces) {
  faces.clear();
  return Hull(points, positions, thickness).find(faces);
}

}  // namespace tessera::cells
