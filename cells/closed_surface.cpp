// SPDX-License-Identifier: BSD-3-Clause
#include "cells/closed_surface.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "scene/position_order.hpp"

namespace tessera::cells {
namespace {

/// Calls `use` for each run of edges with the same corners.
template <class Edges, class Use>
void for_each_edge(const Edges& edges, const Use& use) {
  for (auto first = edges.begin(); first != edges.end();) {
    const auto last =
        std::find_if(first, edges.end(), [&](const auto& edge) { return edge.corners != first->corners; });
    if (!use(std::span(&*first, static_cast<std::size_t>(last - first)))) return;
    first = last;
  }
}

double volume6_of(std::span<const CornerTriangle> triangles, std::span<const glm::dvec3> p) {
  double sum = 0;
  const glm::dvec3 origin = p[triangles[0][0]];
  for (const CornerTriangle& t : triangles)
    sum += glm::dot(glm::cross(p[t[0]] - origin, p[t[1]] - origin), p[t[2]] - origin);
  return sum;
}

}  // namespace

bool ClosedSurface::set(std::span<const std::uint32_t> faces, std::span<const glm::dvec3> positions) {
  triangles_.clear();
  volume6_ = 0;
  number_corners(faces, positions);
  number_faces(faces);
  list_edges();
  turned_.assign(face_count(), 0);
  if (points_.empty() || (!is_balanced() && !turn_faces())) return false;
  cut_faces();
  return true;
}

void ClosedSurface::number_corners(std::span<const std::uint32_t> faces, std::span<const glm::dvec3> positions) {
  by_place_.clear();
  for (std::size_t k = 0; k < faces.size(); k += faces[k] + 1)
    by_place_.insert(by_place_.end(), faces.begin() + static_cast<std::ptrdiff_t>(k + 1),
                     faces.begin() + static_cast<std::ptrdiff_t>(k + 1 + faces[k]));
  std::sort(by_place_.begin(), by_place_.end());
  by_place_.erase(std::unique(by_place_.begin(), by_place_.end()), by_place_.end());
  std::stable_sort(by_place_.begin(), by_place_.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return scene::is_before(positions[a], positions[b]); });
  points_.clear(), indices_.clear(), numbers_.clear();
  for (const std::uint32_t index : by_place_) {
    if (points_.empty() || points_.back() != positions[index]) {
      points_.push_back(positions[index]);
      indices_.push_back(index);
    }
    numbers_.emplace_back(index, static_cast<std::uint32_t>(points_.size() - 1));
  }
  std::sort(numbers_.begin(), numbers_.end());
}

void ClosedSurface::number_faces(std::span<const std::uint32_t> faces) {
  face_corners_.clear();
  face_starts_.assign(1, 0);
  for (std::size_t k = 0; k < faces.size(); k += faces[k] + 1) {
    const std::size_t start = face_corners_.size();
    for (const std::uint32_t index : faces.subspan(k + 1, faces[k])) {
      const std::uint32_t number =
          std::lower_bound(numbers_.begin(), numbers_.end(), std::pair(index, std::uint32_t{0}))->second;
      if (face_corners_.size() == start || face_corners_.back() != number) face_corners_.push_back(number);
    }
    while (face_corners_.size() > start + 1 && face_corners_.back() == face_corners_[start]) face_corners_.pop_back();
    // Faces that collapsed to an edge or a point are ignored.
    if (face_corners_.size() < start + 3)
      face_corners_.resize(start);
    else
      face_starts_.push_back(face_corners_.size());
  }
}

void ClosedSurface::list_edges() {
  edges_.clear();
  for (std::size_t f = 0; f < face_count(); ++f) {
    const auto corners = face(f);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const std::uint64_t a = corners[k], b = corners[k + 1 < corners.size() ? k + 1 : 0];
      edges_.push_back({a < b ? a << 32 | b : b << 32 | a, static_cast<std::uint32_t>(f), a < b});
    }
  }
  std::sort(edges_.begin(), edges_.end(),
            [](const Edge& a, const Edge& b) { return std::pair(a.corners, a.face) < std::pair(b.corners, b.face); });
}

bool ClosedSurface::is_balanced() const {
  bool balanced = true;
  for_each_edge(edges_, [&](std::span<const Edge> uses) {
    std::ptrdiff_t sum = 0;
    for (const Edge& edge : uses) sum += edge.forward != (turned_[edge.face] != 0) ? 1 : -1;
    return balanced = sum == 0;
  });
  return balanced;
}

/// Returns the root of the tree that contains a face, and whether the orientations of root and face are opposite.
std::uint32_t ClosedSurface::group_of(std::uint32_t face, bool& turned) {
  std::uint32_t root = face;
  turned = false;
  for (; parent_[root] != root; root = parent_[root]) turned ^= against_[root] != 0;
  // Path compression: all faces on the path now point to the root.
  for (bool left = turned; parent_[face] != root && face != root;) {
    const std::uint32_t next = parent_[face];
    const bool own = against_[face] != 0;
    parent_[face] = root, against_[face] = left ? 1 : 0;
    left ^= own;
    face = next;
  }
  return root;
}

/// Flips faces so that the faces at an edge with exactly two faces use it in opposite directions, and each connected
/// group of faces has a volume that is not negative. Returns false if the surface is still not closed.
bool ClosedSurface::turn_faces() {
  parent_.resize(face_count());
  for (std::size_t f = 0; f < face_count(); ++f) parent_[f] = static_cast<std::uint32_t>(f);
  against_.assign(face_count(), 0);
  bool possible = true;
  for_each_edge(edges_, [&](std::span<const Edge> uses) {
    if (uses.size() % 2 != 0) return possible = false;
    if (uses.size() != 2 || uses[0].face == uses[1].face) return true;
    bool first_turned = false, second_turned = false;
    const std::uint32_t first = group_of(uses[0].face, first_turned), second = group_of(uses[1].face, second_turned);
    const bool differ = (uses[0].forward == uses[1].forward) != (first_turned != second_turned);
    if (first == second) return possible = !differ;
    parent_[second] = first, against_[second] = differ ? 1 : 0;
    return true;
  });
  if (!possible) return false;
  std::vector<double> volumes(face_count(), 0);
  std::vector<CornerTriangle> fan;
  std::vector<std::uint32_t> groups(face_count());
  for (std::size_t f = 0; f < face_count(); ++f) {
    bool turned = false;
    groups[f] = group_of(static_cast<std::uint32_t>(f), turned);
    turned_[f] = turned ? 1 : 0;
    const auto corners = face(f);
    fan.assign(1, {0, 0, 0});  // common origin of the cones
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) fan.push_back({corners[0], corners[k], corners[k + 1]});
    volumes[groups[f]] += (turned ? -1 : 1) * volume6_of(fan, points_);
  }
  for (std::size_t f = 0; f < face_count(); ++f)
    if (volumes[groups[f]] < 0) turned_[f] ^= 1;
  return is_balanced();
}

void ClosedSurface::cut_faces() {
  all_fans_ = true;
  for (std::size_t f = 0; f < face_count(); ++f) {
    const std::size_t first = triangles_.size();
    if (!cutter_.cut(face(f), points_, triangles_)) all_fans_ = false;
    for (std::size_t t = first; t < triangles_.size() && turned_[f] != 0; ++t)
      std::swap(triangles_[t][1], triangles_[t][2]);
  }
  // A face that touches itself has triangles with two coincident corners.
  std::erase_if(triangles_, [](const CornerTriangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  if (triangles_.empty()) return;
  volume6_ = volume6_of(triangles_, points_);
  if (volume6_ >= 0) return;
  for (CornerTriangle& t : triangles_) std::swap(t[1], t[2]);
  volume6_ = -volume6_;
}

std::optional<std::array<std::uint32_t, 8>> ClosedSurface::as_hexahedron() const {
  if (face_count() != 6 || face_corners_.size() != 24 || points_.size() != 8 || !all_fans_) return std::nullopt;
  for (std::size_t f = 0; f < 6; ++f)
    if (face(f).size() != 4) return std::nullopt;
  std::array<std::uint32_t, 8> corner{};
  std::copy_n(face(0).begin(), 4, corner.begin());
  const auto in_base = [&](std::uint32_t v) {
    return static_cast<std::size_t>(std::find(corner.begin(), corner.begin() + 4, v) - corner.begin());
  };
  int ups = 0;
  for_each_edge(edges_, [&](std::span<const Edge> uses) {
    const auto low = static_cast<std::uint32_t>(uses[0].corners >> 32),
               high = static_cast<std::uint32_t>(uses[0].corners);
    const std::size_t a = in_base(low), b = in_base(high);
    if ((a < 4) == (b < 4)) return true;
    corner[4 + std::min(a, b)] = a < 4 ? high : low;
    return ++ups < 5;
  });
  auto distinct = corner;
  std::sort(distinct.begin(), distinct.end());
  if (ups != 4 || std::adjacent_find(distinct.begin(), distinct.end()) != distinct.end()) return std::nullopt;
  // The other five faces must be those that the corners define.
  static constexpr std::array<std::array<std::uint8_t, 4>, 5> sides = {
      {{4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
  const auto has_face = [&](const std::array<std::uint8_t, 4>& side) {
    for (std::size_t f = 1; f < 6; ++f)
      if (std::all_of(side.begin(), side.end(), [&](std::uint8_t k) {
            return std::find(face(f).begin(), face(f).end(), corner[k]) != face(f).end();
          }))
        return true;
    return false;
  };
  if (!std::all_of(sides.begin(), sides.end(), has_face)) return std::nullopt;
  return corner;
}

}  // namespace tessera::cells
