// SPDX-License-Identifier: BSD-3-Clause
#include "api/queries/mesh_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <queue>
#include <set>
#include <unordered_set>

#include "api/queries/box_tree.hpp"
#include "scene/position_order.hpp"

namespace tessera::api {
namespace {

constexpr double tolerance = 1e-6, flat_determinant = 1e-14;
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

using Corners = std::array<glm::dvec3, 4>;

Corners corners_of(const scene::TetMeshView& mesh, std::size_t tet) {
  const scene::Tet& t = mesh.tets[tet];
  return {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], mesh.positions[t[3]]};
}

scene::Box box_of(std::span<const glm::dvec3> points) {
  scene::Box box{points[0], points[0]};
  for (const glm::dvec3& p : points) box.low = glm::min(box.low, p), box.high = glm::max(box.high, p);
  return box;
}

double longest_edge(const Corners& c) {
  double longest = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < i; ++k) longest = std::max(longest, glm::distance(c[i], c[k]));
  return longest;
}

/// Six times the signed volume, divided by the cube of the longest edge.
double relative_determinant(const Corners& c) {
  const double length = longest_edge(c);
  if (!(length > 0)) return 0;
  const glm::dvec3 a = (c[1] - c[0]) / length, b = (c[2] - c[0]) / length, d = (c[3] - c[0]) / length;
  return glm::dot(glm::cross(a, b), d);
}

/// Longest edge divided by the smallest height.
double aspect_ratio(const Corners& c, double determinant) {
  const double length = longest_edge(c);
  double most_area = 0;  // twice the area of a face, over length^2
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 a = (c[(i + 1) % 4] - c[i]) / length, b = (c[(i + 2) % 4] - c[i]) / length;
    most_area = std::max(most_area, glm::length(glm::cross(a, b)));
  }
  return most_area / std::abs(determinant);
}

/// Whether two tets overlap by more than `margin` along every axis of the separating axis theorem for convex bodies:
/// the normals of faces and the cross products of edges.
bool interiors_meet(const Corners& a, const Corners& b, double margin) {
  const glm::dvec3 origin = a[0];
  Corners p, q;
  for (std::size_t i = 0; i < 4; ++i) p[i] = a[i] - origin, q[i] = b[i] - origin;
  const auto apart = [&](const glm::dvec3& axis, double scale) {
    const double length = glm::length(axis);
    if (!(length > 1e-9 * scale)) return false;
    double low[2], high[2];
    for (int side = 0; side < 2; ++side) {
      const Corners& c = side == 0 ? p : q;
      low[side] = high[side] = glm::dot(axis, c[0]);
      for (std::size_t i = 1; i < 4; ++i) {
        const double at = glm::dot(axis, c[i]);
        low[side] = std::min(low[side], at), high[side] = std::max(high[side], at);
      }
    }
    const double allowed = margin * length;
    return high[0] <= low[1] + allowed || high[1] <= low[0] + allowed;
  };
  std::array<glm::dvec3, 6> edges[2];
  for (int side = 0; side < 2; ++side) {
    const Corners& c = side == 0 ? p : q;
    edges[side] = {c[1] - c[0], c[2] - c[0], c[3] - c[0], c[2] - c[1], c[3] - c[1], c[3] - c[2]};
    const auto& e = edges[side];
    for (const auto& [i, k] : {std::pair{0, 1}, {0, 2}, {1, 2}, {3, 4}}) {
      const auto m = static_cast<std::size_t>(i), n = static_cast<std::size_t>(k);
      if (apart(glm::cross(e[m], e[n]), glm::length(e[m]) * glm::length(e[n]))) return false;
    }
  }
  for (const glm::dvec3& e : edges[0])
    for (const glm::dvec3& f : edges[1])
      if (apart(glm::cross(e, f), glm::length(e) * glm::length(f))) return false;
  return true;
}

/// Twice the area of the part of triangle `b` inside triangle `a`, both projected along `normal` (Sutherland, Hodgman,
/// "Reentrant polygon clipping", CACM 1974).
double common_area(std::span<const glm::dvec3> a, std::span<const glm::dvec3> b, const glm::dvec3& normal) {
  std::vector<glm::dvec3> polygon(b.begin(), b.end()), next;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 inward = glm::cross(normal, a[(i + 1) % 3] - a[i]);
    next.clear();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const glm::dvec3 &from = polygon[k], &to = polygon[(k + 1) % polygon.size()];
      const double at_from = glm::dot(inward, from - a[i]), at_to = glm::dot(inward, to - a[i]);
      if (at_from >= 0) next.push_back(from);
      if ((at_from > 0 && at_to < 0) || (at_from < 0 && at_to > 0))
        next.push_back(glm::mix(from, to, at_from / (at_from - at_to)));
    }
    polygon.swap(next);
    if (polygon.size() < 3) return 0;
  }
  glm::dvec3 sum(0);
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
    sum += glm::cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
  return std::abs(glm::dot(sum, normal));
}

struct Face {
  std::array<std::uint32_t, 3> points;  ///< sorted; points at the same position have the same number
  std::uint32_t tet;
  std::uint8_t opposite;  ///< the corner that is not in the face
};

class Check {
 public:
  Check(const scene::TetMeshView& mesh, const CheckProgressFunction& progress) : mesh_(mesh), progress_(progress) {
    result_.tets = mesh.tets.size();
    name_points();
    begin_part(0.07, 0.13);
    measure_tets();
    begin_part(0.13, 0.2);
    match_faces();
    begin_part(0.6, 0.62);
    find_non_conforming();
    begin_part(0.62, 1);
    find_overlaps();
  }

  MeshCheck take() { return std::move(result_); }

 private:
  /// Begins a part of the check whose progress is from `begin` to `end`. The intervals are approximately the shares of
  /// the time that the parts took for a mesh of 1.6 million tets.
  void begin_part(double begin, double end) {
    part_begin_ = begin, part_length_ = end - begin;
    report(0, 1);
  }
  /// Reports that `n` of the `count` steps of the part are done.
  void report(std::size_t n, std::size_t count) const {
    constexpr std::size_t steps = 1 << 15;
    if (progress_ && n % steps == 0)
      progress_(part_begin_ + part_length_ * static_cast<double>(n) / static_cast<double>(count));
  }
  MeshCheck::Place place(std::size_t tet, std::size_t other) const {
    const Corners c = corners_of(mesh_, tet);
    return {mesh_.cell_of(tet), mesh_.cell_of(other), 0.25 * (c[0] + c[1] + c[2] + c[3]), 0};
  }
  /// Adds a place to the list unless its cell is already listed. A cell from which several tets were made is listed
  /// once; `count` counts each tet.
  static void list(MeshCheck::Finding& finding, const MeshCheck::Place& place) {
    if (finding.places.size() == MeshCheck::most_places) return;
    for (const MeshCheck::Place& p : finding.places)
      if (p.cell == place.cell && p.other == place.other) return;
    finding.places.push_back(place);
  }
  static void note(MeshCheck::Finding& finding, const MeshCheck::Place& place) {
    list(finding, place);
    ++finding.count;
  }

  /// Replaces the number of every point by that of the first point at the same position.
  void name_points() {
    std::vector<std::uint8_t> used(mesh_.positions.size(), 0);
    for (const scene::Tet& t : mesh_.tets)
      for (const std::uint32_t v : t) used[v] = 1;
    std::vector<std::uint32_t> order;
    for (std::uint32_t v = 0; v < used.size(); ++v)
      if (used[v] != 0) order.push_back(v);
    result_.points = order.size();
    const auto less = [&](std::uint32_t a, std::uint32_t b) {
      const glm::dvec3 &p = mesh_.positions[a], &q = mesh_.positions[b];
      return p != q ? scene::is_before(p, q) : a < b;
    };
    std::sort(order.begin(), order.end(), less);
    name_.assign(mesh_.positions.size(), none);
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool same = i > 0 && mesh_.positions[order[i]] == mesh_.positions[order[i - 1]];
      name_[order[i]] = same ? name_[order[i - 1]] : order[i];
      if (same) note(result_.duplicate_points, {order[i], name_[order[i]], mesh_.positions[order[i]], 0});
    }
  }

  void measure_tets() {
    solid_.assign(mesh_.tets.size(), 0);
    std::vector<std::pair<double, std::size_t>> worst;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      report(t, mesh_.tets.size());
      const Corners c = corners_of(mesh_, t);
      const double determinant = relative_determinant(c);
      if (std::abs(determinant) <= flat_determinant) {
        note(result_.flat, place(t, t));
        continue;
      }
      ++(determinant > 0 ? result_.right_handed : result_.left_handed);
      const double aspect = aspect_ratio(c, determinant);
      solid_[t] = aspect < 1 / tolerance ? 1 : 0;
      result_.worst_aspect = std::max(result_.worst_aspect, aspect);
      if (aspect <= 100) continue;
      ++result_.slivers.count;
      result_.slivers_1e4 += aspect > 1e4 ? 1 : 0;
      result_.slivers_1e6 += aspect > 1e6 ? 1 : 0;
      worst.emplace_back(-aspect, t);
      if (worst.size() < 4096) continue;
      // More slivers are kept than will be listed, since several may belong to one cell.
      std::nth_element(worst.begin(), worst.begin() + 1024, worst.end());
      worst.resize(1024);
    }
    std::sort(worst.begin(), worst.end());
    for (const auto& [aspect, t] : worst) {
      MeshCheck::Place where = place(t, t);
      where.value = -aspect;
      list(result_.slivers, where);
    }
  }

  [[nodiscard]] std::array<glm::dvec3, 3> triangle(const Face& f) const {
    return {mesh_.positions[f.points[0]], mesh_.positions[f.points[1]], mesh_.positions[f.points[2]]};
  }

  /// The side of a face on which its tet is: -1 or 1; 0 if this cannot be decided.
  [[nodiscard]] int side(const Face& f) const {
    const auto [a, b, c] = triangle(f);
    const double determinant = relative_determinant({a, b, c, mesh_.positions[mesh_.tets[f.tet][f.opposite]]});
    return determinant > flat_determinant ? 1 : determinant < -flat_determinant ? -1 : 0;
  }

  /// Sorts all faces; those that belong to only one tet are the boundary. Two tets that share a face and are on the
  /// same side of it are a fold.
  void match_faces() {
    std::vector<Face> faces;
    faces.reserve(4 * mesh_.tets.size());
    for (std::uint32_t t = 0; t < mesh_.tets.size(); ++t) {
      report(t, mesh_.tets.size());
      for (std::uint8_t k = 0; k < 4; ++k) {
        const scene::Tet& v = mesh_.tets[t];
        std::array<std::uint32_t, 3> p{name_[v[(k + 1u) % 4]], name_[v[(k + 2u) % 4]], name_[v[(k + 3u) % 4]]};
        std::sort(p.begin(), p.end());
        if (p[0] != p[1] && p[1] != p[2]) faces.push_back({p, t, k});
      }
    }
    begin_part(0.2, 0.5);
    std::sort(faces.begin(), faces.end(),
              [](const Face& a, const Face& b) { return a.points != b.points ? a.points < b.points : a.tet < b.tet; });
    begin_part(0.5, 0.6);
    neighbor_.assign(4 * mesh_.tets.size(), none);
    std::vector<std::uint8_t> folded(mesh_.tets.size(), 0);
    for (std::size_t i = 0; i < faces.size();) {
      std::size_t end = i + 1;
      while (end < faces.size() && faces[end].points == faces[i].points) ++end;
      if (end == i + 1) boundary_.push_back(faces[i]);
      if (end == i + 2) {
        neighbor_[4 * faces[i].tet + faces[i].opposite] = faces[i + 1].tet;
        neighbor_[4 * faces[i + 1].tet + faces[i + 1].opposite] = faces[i].tet;
      }
      for (std::size_t a = i; a < end; ++a)
        for (std::size_t b = a + 1; b < std::min(end, a + 8); ++b) {
          const int s = side(faces[a]);
          if (s == 0 || s != side(faces[b])) continue;
          seeds_.emplace_back(faces[a].tet, faces[b].tet);
          folded[faces[a].tet] = folded[faces[b].tet] = 1;
        }
      i = end;
    }
    for (std::size_t t = 0; t < folded.size(); ++t)
      if (folded[t] != 0) note(result_.inverted, place(t, t));
  }

  void find_non_conforming() {
    std::vector<scene::Box> boxes;
    boxes.reserve(boundary_.size());
    for (const Face& f : boundary_) boxes.push_back(box_of(triangle(f)));
    const BoxTree tree(boxes);
    std::vector<std::uint8_t> found(boundary_.size(), 0);
    for (std::uint32_t i = 0; i < boundary_.size(); ++i) {
      report(i, boundary_.size());
      const auto a = triangle(boundary_[i]);
      const glm::dvec3 cross = glm::cross(a[1] - a[0], a[2] - a[0]);
      const double area = glm::length(cross);
      const double reach = std::sqrt(std::max(glm::dot(a[1] - a[0], a[1] - a[0]), glm::dot(a[2] - a[0], a[2] - a[0])));
      if (!(area > 1e-12 * reach * reach)) continue;
      const glm::dvec3 normal = cross / area;
      const int here = side(boundary_[i]);
      scene::Box box = boxes[i];
      box.low -= tolerance * reach, box.high += tolerance * reach;
      tree.visit(box, [&](std::uint32_t k) {
        if (k <= i || (found[i] != 0 && found[k] != 0)) return;
        const auto b = triangle(boundary_[k]);
        for (const glm::dvec3& p : b)
          if (std::abs(glm::dot(normal, p - a[0])) > tolerance * reach) return;
        const glm::dvec3 other = glm::cross(b[1] - b[0], b[2] - b[0]);
        const int there = side(boundary_[k]) * (glm::dot(other, normal) > 0 ? 1 : -1);
        if (here == 0 || there == 0) return;
        const double common = common_area(a, b, normal);
        if (common <= tolerance * std::min(area, glm::length(other))) return;
        // Tets on the same side overlap; the search for overlaps counts them.
        if (here == there) {
          seeds_.emplace_back(boundary_[i].tet, boundary_[k].tet);
          return;
        }
        found[i] = found[k] = 1;
      });
    }
    for (std::size_t i = 0; i < found.size(); ++i)
      if (found[i] != 0) note(result_.non_conforming_faces, place(boundary_[i].tet, boundary_[i].tet));
  }

  [[nodiscard]] bool overlap(std::uint32_t a, std::uint32_t b) const {
    if (solid_[a] == 0 || solid_[b] == 0) return false;
    const Corners p = corners_of(mesh_, a), q = corners_of(mesh_, b);
    return interiors_meet(p, q, tolerance * std::min(longest_edge(p), longest_edge(q)));
  }

  /// Starts from folds and from the tets that overlap a tet with a boundary face. Continues from each overlapping pair
  /// to the neighbours of its tets.
  void find_overlaps() {
    std::vector<scene::Box> boxes;
    boxes.reserve(mesh_.tets.size());
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) boxes.push_back(box_of(corners_of(mesh_, t)));
    const BoxTree tree(boxes);
    std::unordered_set<std::uint64_t> seen;
    std::queue<std::pair<std::uint32_t, std::uint32_t>> pending;
    std::set<std::pair<std::uint64_t, std::uint64_t>> pairs;  // pairs of cells
    std::unordered_set<std::uint64_t> overlapping;
    const auto consider = [&](std::uint32_t a, std::uint32_t b) {
      if (a == b || a == none || b == none || result_.more_overlaps) return;
      if (a > b) std::swap(a, b);
      // Tets on opposite sides of a common face do not overlap. Tets on the same side are already a starting pair.
      if (!overlap(a, b) || !seen.insert(std::uint64_t{a} << 32 | b).second) return;
      const std::uint64_t one = mesh_.cell_of(a), other = mesh_.cell_of(b);
      const std::uint64_t first = std::min(one, other), second = std::max(one, other);
      if (pairs.emplace(first, second).second) {
        const MeshCheck::Place where = place(a, b);
        note(result_.overlaps, {first, second, where.at, 0});
        overlapping.insert({first, second});
      }
      pending.emplace(a, b);
      result_.more_overlaps = seen.size() >= MeshCheck::most_overlaps;
    };
    for (const auto& [a, b] : seeds_) consider(a, b);
    for (std::size_t i = 0; i < boundary_.size(); ++i) {
      report(i, boundary_.size());
      const std::uint32_t tet = boundary_[i].tet;
      tree.visit(box_of(triangle(boundary_[i])), [&](std::uint32_t t) { consider(tet, t); });
    }
    while (!pending.empty() && !result_.more_overlaps) {
      const auto [a, b] = pending.front();
      pending.pop();
      for (std::size_t k = 0; k < 4; ++k) consider(neighbor_[4 * a + k], b), consider(a, neighbor_[4 * b + k]);
    }
    result_.overlapping_cells = overlapping.size();
  }

  scene::TetMeshView mesh_;
  const CheckProgressFunction& progress_;
  double part_begin_ = 0, part_length_ = 0;
  MeshCheck result_;
  std::vector<std::uint32_t> name_, neighbor_;
  std::vector<std::uint8_t> solid_;  ///< for each tet: neither flat nor a sliver beyond the tolerance for overlaps
  std::vector<Face> boundary_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seeds_;
};

}  // namespace

MeshCheck check_mesh(const scene::TetMeshView& mesh, const CheckProgressFunction& progress) {
  return Check(mesh, progress).take();
}

}  // namespace tessera::api
