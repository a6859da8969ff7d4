// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "cells/amr/amr_values.hpp"

namespace tessera::cells {
namespace {

constexpr std::uint32_t none = AmrVertices::none;

/// The leaves around a point, one per octant: bit a of the index is set on the higher side along axis a. `none` if an
/// octant does not contain a leaf.
using Around = std::array<std::uint32_t, 8>;

/// Computes the smooth field. Points are on a lattice with half the step of the leaves' lattice.
class Smoothing {
 public:
  Smoothing(const AmrLeaves& amr, std::span<const double> values) : amr_(amr), values_(values) {
    for (const AmrLeaf& leaf : amr.leaves) lows_.add(leaf.low);
  }

  AmrCubes cubes() {
    add_cubes();
    cubes_.values.resize(cubes_.corners.size());
    for (std::size_t v = 0; v < cubes_.corners.size(); ++v) cubes_.values[v] = value_at(cubes_.corners[v]);
    for (std::size_t level = 0; level < amr_.size.size(); ++level) {
      add_finer(2 * amr_.size[level], amr_.size[level]);
      if (level + 1 < amr_.size.size()) add_finer(amr_.size[level], amr_.size[level + 1]);
    }
    return std::move(cubes_);
  }

 private:
  [[nodiscard]] const AmrLeaf& leaf(std::uint32_t l) const { return amr_.leaves[l]; }
  [[nodiscard]] std::int32_t size_of(std::uint32_t l) const {
    return amr_.size[static_cast<std::size_t>(leaf(l).level)];
  }

  void add_finer(std::int32_t size, std::int32_t part) {
    for (const auto& [from, to] : cubes_.finer)
      if (from == size) return;
    cubes_.finer.emplace_back(size, part);
  }

  /// Returns the leaf that contains a cell of the finest lattice.
  [[nodiscard]] std::uint32_t leaf_at(const AmrIndex& cell) const {
    if (cell[0] < 0 || cell[1] < 0 || cell[2] < 0) return none;
    for (std::size_t level = amr_.size.size(); level-- > 0;) {
      const std::int32_t size = amr_.size[level];
      const std::uint32_t l =
          lows_.find({cell[0] - cell[0] % size, cell[1] - cell[1] % size, cell[2] - cell[2] % size});
      if (l != none && leaf(l).level == static_cast<std::int32_t>(level)) return l;
    }
    return none;
  }

  [[nodiscard]] Around leaves_around(const AmrIndex& p) const {
    Around around;
    for (unsigned k = 0; k < 8; ++k) {
      AmrIndex cell;
      for (std::size_t a = 0; a < 3; ++a) cell[a] = p[a] % 2 != 0 || (k >> a & 1) != 0 ? p[a] / 2 : p[a] / 2 - 1;
      around[k] = leaf_at(cell);
    }
    return around;
  }

  /// Whether all existing leaves around a point have the same level.
  [[nodiscard]] bool are_of_one_level(const Around& around) const {
    std::int32_t level = -1;
    for (const std::uint32_t l : around) {
      if (l == none) continue;
      if (level >= 0 && leaf(l).level != level) return false;
      level = leaf(l).level;
    }
    return true;
  }

  void add_cubes() {
    AmrVertices leaf_corners;
    for (const AmrLeaf& leaf : amr_.leaves) {
      const std::int32_t size = amr_.size[static_cast<std::size_t>(leaf.level)];
      for (unsigned k = 0; k < 8; ++k) leaf_corners.add(corner_of(leaf.low, size, k));
    }
    for (std::size_t v = 0; v < leaf_corners.size(); ++v) {
      const AmrIndex p = leaf_corners[v];
      const Around around = leaves_around(p);
      if (std::find(around.begin(), around.end(), none) == around.end() && are_of_one_level(around)) {
        const std::int32_t size = size_of(around[0]);
        add_cube({{p[0] - size, p[1] - size, p[2] - size}, 2 * size});
        continue;
      }
      for (unsigned k = 0; k < 8; ++k) {
        if (around[k] == none) continue;
        const std::int32_t size = size_of(around[k]);
        if (corner_of(leaf(around[k]).low, size, 7 - k) != p) continue;  // the point is on an edge or face of the leaf
        add_cube(
            {{p[0] - ((k & 1) != 0 ? 0 : size), p[1] - ((k & 2) != 0 ? 0 : size), p[2] - ((k & 4) != 0 ? 0 : size)},
             size});
      }
    }
  }

  static AmrIndex corner_of(const AmrIndex& low, std::int32_t size, unsigned k) {
    return {2 * (low[0] + ((k & 1) != 0 ? size : 0)), 2 * (low[1] + ((k & 2) != 0 ? size : 0)),
            2 * (low[2] + ((k & 4) != 0 ? size : 0))};
  }

  void add_cube(const AmrCube& cube) {
    for (unsigned k = 0; k < 8; ++k)
      cubes_.corners.add({cube.low[0] + ((k & 1) != 0 ? cube.size : 0), cube.low[1] + ((k & 2) != 0 ? cube.size : 0),
                          cube.low[2] + ((k & 4) != 0 ? cube.size : 0)});
    cubes_.cubes.push_back(cube);
  }

  [[nodiscard]] double value_at(const AmrIndex& p) const {
    const Around around = leaves_around(p);
    if (are_of_one_level(around)) return mean_around(p, around);
    const std::uint32_t finest = *std::max_element(around.begin(), around.end(), [&](std::uint32_t a, std::uint32_t b) {
      return (a == none ? -1 : leaf(a).level) < (b == none ? -1 : leaf(b).level);
    });
    // In the middle of an edge or face, the value is the mean of the corners of the edge or face, which does not depend
    // on the leaf.
    const std::int32_t size = size_of(finest);
    std::array<std::int32_t, 3> half{};
    int corners = 1;
    for (std::size_t a = 0; a < 3; ++a)
      if (p[a] - 2 * leaf(finest).low[a] == size) half[a] = size, corners *= 2;
    if (corners == 1) return value_at_corner(p, around);
    double sum = 0;
    for (unsigned k = 0; k < 8; ++k) {
      AmrIndex q = p;
      bool is_corner = true;
      for (std::size_t a = 0; a < 3; ++a) {
        if (half[a] == 0 && (k >> a & 1) != 0) is_corner = false;
        q[a] += (k >> a & 1) != 0 ? half[a] : -half[a];
      }
      if (is_corner) sum += value_at(q);
    }
    return sum / corners;
  }

  /// Returns the value at a point surrounded by leaves of the same level: the mean of their values or, where the sizes
  /// of the leaves differ along an axis, the interpolation between their centres.
  [[nodiscard]] double mean_around(const AmrIndex& p, const Around& around) const {
    std::array<double, 3> higher{0.5, 0.5, 0.5};  // weight of the higher side
    if (!amr_.lattice.is_even()) {
      const auto some = *std::find_if(around.begin(), around.end(), [](std::uint32_t l) { return l != none; });
      const double half = 0.5 * size_of(some);
      for (std::size_t a = 0; a < 3; ++a) {
        const double at = 0.5 * p[a], low = amr_.lattice.position(a, at - half),
                     high = amr_.lattice.position(a, at + half);
        higher[a] = (amr_.lattice.position(a, at) - low) / (high - low);
      }
    }
    double sum = 0, weights = 0;
    for (unsigned k = 0; k < 8; ++k) {
      if (around[k] == none) continue;
      double weight = 1;
      for (std::size_t a = 0; a < 3; ++a) weight *= (k >> a & 1) != 0 ? higher[a] : 1 - higher[a];
      sum += weight * values_[around[k]], weights += weight;
    }
    return sum / weights;
  }

  /// Returns the value at a corner where different levels meet.
  [[nodiscard]] double value_at_corner(const AmrIndex& p, const Around& around) const {
    std::array<std::uint32_t, 8> leaves{};
    std::array<glm::dvec3, 8> offsets{};
    std::array<double, 8> weights{};
    std::size_t n = 0;
    for (const std::uint32_t l : around) {
      if (l == none) continue;
      const std::size_t at =
          static_cast<std::size_t>(std::find(leaves.begin(), leaves.begin() + n, l) - leaves.begin());
      weights[at] += 1;
      if (at < n) continue;
      leaves[n] = l;
      for (std::size_t a = 0; a < 3; ++a)
        offsets[n][static_cast<int>(a)] =
            amr_.lattice.position(a, leaf(l).low[a] + 0.5 * size_of(l)) - amr_.lattice.position(a, 0.5 * p[a]);
      ++n;
    }
    weigh_by_entropy(std::span(offsets).first(n), std::span(weights).first(n));
    double value = 0;
    for (std::size_t k = 0; k < n; ++k) value += weights[k] * values_[leaves[k]];
    return value;
  }

  const AmrLeaves& amr_;
  std::span<const double> values_;
  AmrVertices lows_;  ///< points numbered like the leaves that begin there
  AmrCubes cubes_;
};

}  // namespace

namespace {

/// Computes weights with sum 1 for which the weighted mean of the offsets is 0 and which deviate least from the
/// proportions of the factors; some may be negative. Returns false and leaves `weights` unchanged if such weights do
/// not exist, or if they could extrapolate beyond the range of the values by more than the width of the range.
bool weigh_by_squares(std::span<const glm::dvec3> d, std::span<const double> factor, const glm::dvec3& is_used,
                      std::span<double> weights) {
  glm::dmat4 moments(0);
  for (int a = 0; a < 3; ++a) moments[a + 1][a + 1] = 1 - is_used[a];
  for (std::size_t k = 0; k < d.size(); ++k) {
    const glm::dvec4 v(1, d[k]);
    moments += factor[k] * glm::outerProduct(v, v);
  }
  if (!(std::abs(glm::determinant(moments)) > 1e-9)) return false;
  const glm::dvec4 multiplier = glm::inverse(moments)[0];
  std::array<double, 8> found{};
  double sum = -1, size = 0;
  glm::dvec3 mean(0);
  for (std::size_t k = 0; k < d.size(); ++k) {
    found[k] = factor[k] * glm::dot(multiplier, glm::dvec4(1, d[k]));
    sum += found[k], size += std::abs(found[k]), mean += found[k] * d[k];
  }
  if (!(size <= 3) || !(std::abs(sum) < 1e-9) || !(glm::length(mean) < 1e-9)) return false;
  std::copy_n(found.begin(), d.size(), weights.begin());
  return true;
}

}  // namespace

void weigh_by_entropy(std::span<const glm::dvec3> offsets, std::span<double> weights) {
  // Axes along which all offsets are on one side are ignored: values are continued as constants there.
  glm::dvec3 scale(0), is_used(0);
  glm::bvec3 below(false), above(false);
  for (const glm::dvec3& d : offsets)
    for (int a = 0; a < 3; ++a) {
      scale[a] = std::max(scale[a], std::abs(d[a]));
      below[a] = below[a] || d[a] < 0, above[a] = above[a] || d[a] > 0;
    }
  std::array<glm::dvec3, 8> d{};
  std::array<double, 8> factor{};
  const std::size_t n = std::min(offsets.size(), d.size());
  for (int a = 0; a < 3; ++a) is_used[a] = below[a] && above[a] ? 1 : 0;
  for (std::size_t k = 0; k < n; ++k) {
    factor[k] = weights[k];
    for (int a = 0; a < 3; ++a) d[k][a] = is_used[a] > 0 ? offsets[k][a] / scale[a] : 0;
  }
  // Minimizes the logarithm of the sum of factor exp(multiplier . d), which is convex, by Newton's method. Its gradient
  // is 0 at the desired weights.
  const auto log_sum = [&](const glm::dvec3& multiplier) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += weights[k] = factor[k] * std::exp(glm::dot(multiplier, d[k]));
    for (std::size_t k = 0; k < n; ++k) weights[k] /= sum;
    return std::log(sum);
  };
  glm::dvec3 multiplier(0);
  double now = log_sum(multiplier);
  for (int step = 0; step < 50; ++step) {
    glm::dvec3 mean(0);
    glm::dmat3 curvature(0);
    for (std::size_t k = 0; k < n; ++k) mean += weights[k] * d[k];
    if (glm::length(mean) < 1e-15) return;
    for (std::size_t k = 0; k < n; ++k) curvature += weights[k] * glm::outerProduct(d[k] - mean, d[k] - mean);
    for (int a = 0; a < 3; ++a) curvature[a][a] += 1e-12;
    const glm::dvec3 change = glm::inverse(curvature) * mean;
    glm::dvec3 next = multiplier - change;
    double then = log_sum(next);
    const double most = now + 1e-14;  // near the minimum, only rounding changes the sum
    // If 0 is outside the hull of the offsets, the logarithm decreases without bound.
    const auto is_good = [&] { return then <= most && then > -20; };
    for (double length = 0.5; length > 1e-6 && !is_good(); length /= 2) {
      next = multiplier - length * change;
      then = log_sum(next);
    }
    if (!is_good()) {
      log_sum(multiplier);
      break;
    }
    multiplier = next, now = then;
  }
  glm::dvec3 mean(0);
  for (std::size_t k = 0; k < n; ++k) mean += weights[k] * d[k];
  if (glm::length(mean) > 1e-12)  // far above the residual of Newton's method if the desired weights exist
    weigh_by_squares(std::span(d).first(n), std::span(factor).first(n), is_used, weights);
}

AmrCubes smooth_cubes(const AmrLeaves& amr, std::span<const double> values) { return Smoothing(amr, values).cubes(); }

}  // namespace tessera::cells
