// SPDX-License-Identifier: BSD-3-Clause
#include "readers/tetgen/surface_fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <numeric>
#include <optional>

namespace tessera::readers {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Box {
  glm::dvec3 low{infinity}, high{-infinity};

  void add(const glm::dvec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
  [[nodiscard]] double squared_distance(const glm::dvec3& p) const {
    const glm::dvec3 outside = glm::max(glm::max(low - p, p - high), glm::dvec3(0));
    return glm::dot(outside, outside);
  }
};

/// A tree of boxes. A node is split at the median along the longest axis of its box, down to a few items.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    if (!order_.empty()) split(0, order_.size());
  }

  /// Calls `visit(item)` for items whose boxes are not farther from p than a limit, a squared distance that is
  /// `squared` at first and then what `visit` has returned. Searches the nearer half of a node first.
  template <class Visit>
  void near(const glm::dvec3& p, double squared, const Visit& visit) const {
    if (!nodes_.empty()) near(0, p, squared, visit);
  }

 private:
  struct Node {
    Box box;
    std::size_t first, last;          ///< range in `order_`
    std::size_t left = 0, right = 0;  ///< child nodes; 0 for a leaf
  };

  std::size_t split(std::size_t first, std::size_t last) {
    Node node{{}, first, last};
    for (std::size_t i = first; i < last; ++i)
      node.box.add(boxes_[order_[i]].low), node.box.add(boxes_[order_[i]].high);
    const std::size_t self = nodes_.size();
    nodes_.push_back(node);
    if (last - first <= 4) return self;
    const glm::dvec3 size = node.box.high - node.box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = first + (last - first) / 2;
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(last), [&](std::size_t a, std::size_t b) {
      return boxes_[a].low[axis] + boxes_[a].high[axis] < boxes_[b].low[axis] + boxes_[b].high[axis];
    });
    const std::size_t left = split(first, middle), right = split(middle, last);
    nodes_[self].left = left, nodes_[self].right = right;
    return self;
  }

  template <class Visit>
  void near(std::size_t number, const glm::dvec3& p, double& squared, const Visit& visit) const {
    const Node& node = nodes_[number];
    if (node.box.squared_distance(p) > squared) return;
    if (node.left == 0) {
      for (std::size_t i = node.first; i < node.last; ++i)
        if (boxes_[order_[i]].squared_distance(p) <= squared) squared = visit(order_[i]);
      return;
    }
    const bool left_first = nodes_[node.left].box.squared_distance(p) <= nodes_[node.right].box.squared_distance(p);
    near(left_first ? node.left : node.right, p, squared, visit);
    near(left_first ? node.right : node.left, p, squared, visit);
  }

  std::vector<Box> boxes_;
  std::vector<std::size_t> order_;
  std::vector<Node> nodes_;
};

/// Returns the squared distance from p to the nearest point of a triangle. Source: Ericson, "Real-Time Collision
/// Detection", 2005, 5.1.5.
double squared_distance(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const auto to = [&](const glm::dvec3& q) { return glm::dot(p - q, p - q); };
  const glm::dvec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap), d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp),
               d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return to(a);
  if (d3 >= 0 && d4 <= d3) return to(b);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return to(a + ab * (d1 / (d1 - d3)));
  if (d6 >= 0 && d5 <= d6) return to(c);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return to(a + ac * (d2 / (d2 - d6)));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return to(b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
  return to(a + ab * (vb / (va + vb + vc)) + ac * (vc / (va + vb + vc)));
}

using Weights = std::array<double, 4>;

/// Returns the barycentric weights of a point in a tet; no value for a flat tet.
std::optional<Weights> weights_in(const glm::dvec3& p, const FilledSurface& mesh, std::size_t tet) {
  const auto corner = [&](std::size_t k) { return mesh.points[mesh.tets[4 * tet + k]]; };
  const glm::dvec3 a = corner(0), ab = corner(1) - a, ac = corner(2) - a, ad = corner(3) - a, ap = p - a;
  const double volume = glm::dot(ab, glm::cross(ac, ad));
  if (volume == 0) return std::nullopt;
  const double wb = glm::dot(ap, glm::cross(ac, ad)) / volume, wc = glm::dot(ab, glm::cross(ap, ad)) / volume,
               wd = glm::dot(ab, glm::cross(ac, ap)) / volume;
  return Weights{1 - wb - wc - wd, wb, wc, wd};
}

/// Returns the boxes of items that have `corners` points each.
std::vector<Box> boxes_of(const std::vector<glm::dvec3>& points, const std::vector<std::uint32_t>& indices,
                          std::size_t corners) {
  std::vector<Box> boxes(indices.size() / corners);
  for (std::size_t k = 0; k < boxes.size() * corners; ++k) boxes[k / corners].add(points[indices[k]]);
  return boxes;
}

}  // namespace

std::vector<double> depth_below_surface(const FilledSurface& filled) {
  const BoxTree tree(boxes_of(filled.points, filled.triangles, 3));
  std::vector<bool> on_boundary(filled.points.size());
  for (const std::uint32_t v : filled.triangles) on_boundary[v] = true;
  std::vector<double> depth(filled.points.size(), 0.0);
  for (std::size_t v = 0; v < depth.size(); ++v) {
    if (on_boundary[v]) continue;
    double nearest = infinity;
    tree.near(filled.points[v], infinity, [&](std::size_t triangle) {
      const std::uint32_t* corner = &filled.triangles[3 * triangle];
      return nearest = std::min(nearest, squared_distance(filled.points[v], filled.points[corner[0]],
                                                          filled.points[corner[1]], filled.points[corner[2]]));
    });
    depth[v] = std::isfinite(nearest) ? std::sqrt(nearest) : 0;
  }
  return depth;
}

std::vector<std::vector<double>> spread_attributes(const cells::Surface& surface, const FilledSurface& coarse,
                                                   const FilledSurface& filled) {
  std::vector<std::vector<double>> at_coarse = surface.attributes, result = surface.attributes;
  for (std::vector<double>& values : at_coarse) fill_unknown(coarse, surface.points.size(), values);
  const BoxTree tree(boxes_of(coarse.points, coarse.tets, 4));
  Box whole;
  for (const glm::dvec3& p : coarse.points) whole.add(p);
  const glm::dvec3 size = whole.high - whole.low;
  const double rounding = 1e-18 * glm::dot(size, size);
  for (std::size_t v = surface.points.size(); v < filled.points.size(); ++v) {
    // Finds the tet that contains the point or, because of rounding, is nearest to it.
    double deepest = -infinity;
    Weights weights{};
    std::size_t inside = 0;
    tree.near(filled.points[v], rounding, [&](std::size_t tet) {
      if (const auto found = weights_in(filled.points[v], coarse, tet)) {
        const double least = *std::min_element(found->begin(), found->end());
        if (least > deepest) deepest = least, weights = *found, inside = tet;
      }
      return rounding;
    });
    for (std::size_t a = 0; a < result.size(); ++a) {
      double value = 0;
      for (std::size_t k = 0; std::isfinite(deepest) && k < 4; ++k)
        value += weights[k] * at_coarse[a][coarse.tets[4 * inside + k]];
      result[a].push_back(value);
    }
  }
  return result;
}

}  // namespace tessera::readers
