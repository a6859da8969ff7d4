// SPDX-License-Identifier: BSD-3-Clause
#include "cells/surface_ears.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

namespace tessera::cells {
namespace {

using Tet = std::array<std::uint32_t, 4>;

// Largest number of comparisons of ears with corners, edges and triangles of one surface in all attempts, which takes
// about 20 ms.
constexpr std::size_t most_work = 6'000'000;

std::uint64_t edge_of(std::uint64_t a, std::uint64_t b) { return a < b ? a << 32 | b : b << 32 | a; }

double volume6(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  return glm::dot(glm::cross(b - a, c - a), d - a);
}

/// Whether `x` is in the closed tet, up to rounding.
bool holds(const std::array<glm::dvec3, 4>& t, const glm::dvec3& x) {
  const double whole = volume6(t[0], t[1], t[2], t[3]);
  for (std::size_t k = 0; k < 4; ++k) {
    auto part = t;
    part[k] = x;
    if (volume6(part[0], part[1], part[2], part[3]) / whole < -1e-9) return false;
  }
  return true;
}

/// Whether the segment crosses or touches the triangle. False if the segment is in the plane of the triangle.
bool crosses(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& a, const glm::dvec3& b,
             const glm::dvec3& c) {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double first = glm::dot(normal, from - a), second = glm::dot(normal, to - a);
  const double plane = 1e-12 * glm::dot(normal, normal);
  if (std::abs(first) <= plane && std::abs(second) <= plane) return false;
  if ((first > plane && second > plane) || (first < -plane && second < -plane)) return false;
  const glm::dvec3 x = from + (to - from) * (first / (first - second));
  const double most = 1e-9 * glm::dot(normal, normal);
  return glm::dot(glm::cross(b - a, x - a), normal) >= -most && glm::dot(glm::cross(c - b, x - b), normal) >= -most &&
         glm::dot(glm::cross(a - c, x - c), normal) >= -most;
}

template <class Corners>
bool holds_corner(const Corners& corners, std::uint32_t v) {
  return std::find(corners.begin(), corners.end(), v) != corners.end();
}

}  // namespace

std::vector<std::vector<CornerTriangle>> parts_on_edges(std::span<const CornerTriangle> triangles) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> edges;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      edges.emplace_back(edge_of(triangles[t][k], triangles[t][(k + 1) % 3]), static_cast<std::uint32_t>(t));
  std::sort(edges.begin(), edges.end());
  std::vector<std::uint32_t> parent(triangles.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root_of = [&](std::uint32_t t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  for (std::size_t k = 0; k + 1 < edges.size();) {
    std::size_t end = k;
    while (end < edges.size() && edges[end].first == edges[k].first) ++end;
    if (end - k == 2) {
      const std::uint32_t a = root_of(edges[k].second), b = root_of(edges[k + 1].second);
      parent[std::max(a, b)] = std::min(a, b);
    }
    k = end;
  }
  std::vector<std::vector<CornerTriangle>> parts;
  std::vector<std::size_t> part_of(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t root = root_of(static_cast<std::uint32_t>(t));
    if (root == t) part_of[t] = parts.size(), parts.emplace_back();
    parts[part_of[root]].push_back(triangles[t]);
  }
  return parts;
}

bool SurfaceEars::set(std::span<const glm::dvec3> p, std::span<const CornerTriangle> triangles, std::uint32_t attempt) {
  if (triangles.size() > most_triangles) return false;
  p_ = p;
  triangles_.assign(triangles.begin(), triangles.end());
  if (attempt == 0) work_left_ = most_work;
  attempt_ = attempt;
  chance_.seed(attempt + 1);
  cuts_left_ = 2 * triangles.size();
  return true;
}

bool SurfaceEars::cut(Tet& tet) {
  if (cuts_left_ == 0) return false;
  --cuts_left_;
  list();
  work_left_ -= std::min(80 * triangles_.size(), work_left_);  // cost of listing the remaining triangles
  for (const Ear& ear : ears_) {
    if (work_left_ == 0) return false;
    if (!is_free(ear)) continue;
    take_off(ear);
    tet = ear.corner;
    return true;
  }
  return false;
}

/// Lists the current edges and, for convex edges, the ears, with the best ears first.
void SurfaceEars::list() {
  edges_.clear(), ears_.clear(), corners_.clear();
  for (const CornerTriangle& t : triangles_) corners_.insert(corners_.end(), t.begin(), t.end());
  std::sort(corners_.begin(), corners_.end());
  corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      edges_.push_back({edge_of(triangles_[t][k], triangles_[t][(k + 1) % 3]), static_cast<std::uint32_t>(t)});
  std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) {
    return std::pair(a.corners, a.triangle) < std::pair(b.corners, b.triangle);
  });
  for (std::size_t k = 0; k + 1 < edges_.size();) {
    std::size_t end = k;
    while (end < edges_.size() && edges_[end].corners == edges_[k].corners) ++end;
    if (end - k == 2) {
      CornerTriangle first = triangles_[edges_[k].triangle];
      const CornerTriangle& second = triangles_[edges_[k + 1].triangle];
      const auto a = static_cast<std::uint32_t>(edges_[k].corners >> 32),
                 b = static_cast<std::uint32_t>(edges_[k].corners);
      while (first[2] == a || first[2] == b) std::rotate(first.begin(), first.begin() + 1, first.end());
      const std::uint32_t d = second[0] + second[1] + second[2] - a - b;
      if (d != first[2]) {
        const glm::dvec3 p = p_[first[0]], q = p_[first[1]], r = p_[first[2]], s = p_[d];
        double edges = 0;
        for (const glm::dvec3& e : {q - p, r - p, s - p, r - q, s - q, s - r}) edges += glm::dot(e, e);
        // Triangles are oriented outward: the inside is on their negative side.
        const double quality = -volume6(p, q, r, s) / (edges * std::sqrt(edges));
        const bool ends_a_corner =
            has_edge(first[2], d) && (find({first[0], first[2], d}) >= 0 || find({first[2], first[1], d}) >= 0);
        if (quality > 1e-8)
          ears_.push_back({{first[0], first[1], first[2], d}, rank_of(quality, edges, ends_a_corner)});
      }
    }
    k = end;
  }
  std::sort(ears_.begin(), ears_.end(),
            [](const Ear& a, const Ear& b) { return a.rank != b.rank ? a.rank > b.rank : a.corner < b.corner; });
}

/// Returns the priority of an ear. Ears that remove a corner have a higher one, because they leave fewer triangles.
double SurfaceEars::rank_of(double quality, double edges, bool ends_a_corner) {
  const double more = ends_a_corner ? 1 : 0;
  switch (attempt_) {
    case 0:
      return quality + more;
    case 1:
      return -edges;
    case 2:
      return quality * edges * std::sqrt(edges);
    default:
      return more * (attempt_ % 2) + static_cast<double>(chance_()) / static_cast<double>(std::minstd_rand::max());
  }
}

bool SurfaceEars::has_edge(std::uint32_t a, std::uint32_t b) const {
  const std::uint64_t corners = edge_of(a, b);
  const auto at = std::lower_bound(edges_.begin(), edges_.end(), corners,
                                   [](const Edge& edge, std::uint64_t wanted) { return edge.corners < wanted; });
  return at != edges_.end() && at->corners == corners;
}

/// Returns the index of a triangle with the same orientation, or -1.
std::ptrdiff_t SurfaceEars::find(const CornerTriangle& wanted) const {
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const CornerTriangle& x = triangles_[t];
    for (std::size_t k = 0; k < 3; ++k)
      if (x[k] == wanted[0] && x[(k + 1) % 3] == wanted[1] && x[(k + 2) % 3] == wanted[2])
        return static_cast<std::ptrdiff_t>(t);
  }
  return -1;
}

/// Whether no part of the surface is inside the ear, or on its new faces.
bool SurfaceEars::is_free(const Ear& ear) {
  const auto [a, b, c, d] = ear.corner;
  const std::size_t work = corners_.size() + edges_.size() + triangles_.size();
  work_left_ -= std::min(work, work_left_);
  const std::array<CornerTriangle, 2> sides = {{{a, c, d}, {c, b, d}}};
  std::array<bool, 2> is_there{};
  const bool is_old_edge = has_edge(c, d);
  for (std::size_t side = 0; side < 2 && is_old_edge; ++side) {
    is_there[side] = find(sides[side]) >= 0;
    // The new face would coincide with a triangle of the surface.
    if (find({sides[side][0], sides[side][2], sides[side][1]}) >= 0) return false;
  }
  if (is_old_edge && !is_there[0] && !is_there[1]) return false;
  const std::array<glm::dvec3, 4> places = {p_[a], p_[b], p_[c], p_[d]};
  glm::dvec3 low = places[0], high = low;
  for (const glm::dvec3& p : places) low = glm::min(low, p), high = glm::max(high, p);
  const glm::dvec3 margin = 1e-6 * (high - low) + glm::dvec3(1e-9 * glm::length(high - low));
  low -= margin, high += margin;
  const auto is_outside = [&](const glm::dvec3& a, const glm::dvec3& b) {
    for (int axis = 0; axis < 3; ++axis)
      if ((a[axis] < low[axis] && b[axis] < low[axis]) || (a[axis] > high[axis] && b[axis] > high[axis])) return true;
    return false;
  };
  for (const std::uint32_t v : corners_)
    if (!is_outside(p_[v], p_[v]) && !holds_corner(ear.corner, v) && holds(places, p_[v])) return false;
  for (std::size_t side = 0; side < 2; ++side) {
    if (is_there[side]) continue;
    const CornerTriangle& t = sides[side];
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      if (k > 0 && edges_[k].corners == edges_[k - 1].corners) continue;
      const auto u = static_cast<std::uint32_t>(edges_[k].corners >> 32),
                 v = static_cast<std::uint32_t>(edges_[k].corners);
      if (is_outside(p_[u], p_[v]) || holds_corner(t, u) || holds_corner(t, v)) continue;
      if (crosses(p_[u], p_[v], p_[t[0]], p_[t[1]], p_[t[2]])) return false;
    }
  }
  if (is_old_edge) return true;
  for (const CornerTriangle& t : triangles_)
    if (!holds_corner(t, c) && !holds_corner(t, d) && crosses(p_[c], p_[d], p_[t[0]], p_[t[1]], p_[t[2]])) return false;
  return true;
}

/// Removes each of the ear's four faces that the surface contains, and adds the other side of the remaining faces to
/// the surface.
void SurfaceEars::take_off(const Ear& ear) {
  const auto [a, b, c, d] = ear.corner;
  for (const CornerTriangle& face : {CornerTriangle{a, b, c}, {b, a, d}, {a, c, d}, {c, b, d}}) {
    const std::ptrdiff_t there = find(face);
    if (there >= 0)
      triangles_.erase(triangles_.begin() + there);
    else
      triangles_.push_back({face[0], face[2], face[1]});
  }
}

}  // namespace tessera::cells
