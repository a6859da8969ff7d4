// SPDX-License-Identifier: BSD-3-Clause
#include "cells/surface_tets.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace tessera::cells {
namespace {

// Fraction of a cell's volume that rounding may put on the wrong side. Cells with a larger fraction are counted as
// tangled (block_tets.cpp).
constexpr double by_rounding = 1e-10;
// Largest number of triangles times the number of apexes tried.
constexpr std::size_t most_tries = 4'000'000;
// Largest number of different orders in which ears are cut.
constexpr std::uint32_t most_attempts = 12;

/// Returns six times the volume of the tet between a triangle that is oriented outward and a point; positive if the
/// point is inside.
double depth6(const CornerTriangle& t, const glm::dvec3& apex, std::span<const glm::dvec3> p) {
  return glm::dot(glm::cross(p[t[0]] - apex, p[t[1]] - apex), p[t[2]] - apex);
}

bool has(const CornerTriangle& t, std::uint32_t v) { return t[0] == v || t[1] == v || t[2] == v; }

/// Solves m x = b for a symmetric matrix; if the matrix is singular, x has no component in its null space.
glm::dvec3 solve(std::array<std::array<double, 3>, 3> m, glm::dvec3 b) {
  std::array<int, 3> order{0, 1, 2};
  double largest = 0;
  for (const auto& row : m)
    for (const double v : row) largest = std::max(largest, std::abs(v));
  const double nothing = 1e-14 * largest;
  glm::dvec3 x(0);
  int rank = 0;
  for (; rank < 3; ++rank) {
    const auto step = static_cast<std::size_t>(rank);
    std::size_t row = step, column = step;
    for (std::size_t r = step; r < 3; ++r)
      for (std::size_t c = step; c < 3; ++c)
        if (std::abs(m[r][c]) > std::abs(m[row][column])) row = r, column = c;
    if (!(std::abs(m[row][column]) > nothing)) break;
    std::swap(m[row], m[step]);
    std::swap(b[static_cast<int>(row)], b[rank]);
    for (auto& r : m) std::swap(r[column], r[step]);
    std::swap(order[column], order[step]);
    for (std::size_t r = step + 1; r < 3; ++r) {
      const double factor = m[r][step] / m[step][step];
      for (std::size_t c = step; c < 3; ++c) m[r][c] -= factor * m[step][c];
      b[static_cast<int>(r)] -= factor * b[rank];
    }
  }
  for (int r = rank - 1; r >= 0; --r) {
    const auto row = static_cast<std::size_t>(r);
    double sum = b[r];
    for (int c = r + 1; c < rank; ++c)
      sum -= m[row][static_cast<std::size_t>(c)] * x[order[static_cast<std::size_t>(c)]];
    x[order[row]] = sum / m[row][row];
  }
  return x;
}

}  // namespace

double fitted_value(std::span<const glm::dvec3> points, std::span<const double> values, const glm::dvec3& x) {
  const auto n = static_cast<double>(points.size());
  glm::dvec3 centre(0);
  double mean = 0;
  for (std::size_t k = 0; k < points.size(); ++k) centre += points[k] / n, mean += values[k] / n;
  std::array<std::array<double, 3>, 3> spread{};
  glm::dvec3 moment(0);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const glm::dvec3 d = points[k] - centre;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) spread[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] += d[r] * d[c];
    moment += (values[k] - mean) * d;
  }
  const double value = mean + glm::dot(solve(spread, moment), x - centre);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return std::isfinite(value) ? std::clamp(value, *low, *high) : mean;
}

SurfaceFill SurfaceTets::fill(std::span<const glm::dvec3> p, std::span<const CornerTriangle> triangles) {
  p_ = p;
  tets_.clear(), inside_.clear();
  fill_ = SurfaceFill::from_corner;
  if (!triangles.empty()) fill_part(Triangles(triangles.begin(), triangles.end()));
  return fill_;
}

void SurfaceTets::take_measures(const Triangles& part) {
  corners_.clear();
  for (const CornerTriangle& t : part) corners_.insert(corners_.end(), t.begin(), t.end());
  std::sort(corners_.begin(), corners_.end());
  corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  mean_ = glm::dvec3(0);
  glm::dvec3 low = p_[corners_[0]], high = low;
  for (const std::uint32_t v : corners_) {
    mean_ += p_[v] / static_cast<double>(corners_.size());
    low = glm::min(low, p_[v]), high = glm::max(high, p_[v]);
  }
  size_ = glm::length(high - low);
  volume6_ = 0, noise6_ = 0;
  const glm::dvec3 origin = p_[corners_[0]];
  for (const CornerTriangle& t : part) {
    const double v = depth6(t, origin, p_);
    volume6_ += v;
    noise6_ += std::abs(v);
  }
}

/// Returns six times the volume that the cone from `apex` has on the wrong side. The sum stops as soon as it exceeds
/// `enough`.
double SurfaceTets::wrong_side(const Triangles& part, const glm::dvec3& apex, double enough) const {
  double wrong = 0;
  for (const CornerTriangle& t : part) {
    const double depth = depth6(t, apex, p_);
    if (depth >= 0) continue;
    wrong -= depth;
    if (wrong > enough) break;
  }
  return wrong;
}

void SurfaceTets::add_cone(const Triangles& part, std::uint32_t apex) {
  for (const CornerTriangle& t : part)
    if (!has(t, apex)) tets_.push_back({t[0], t[1], t[2], apex});
}

void SurfaceTets::add_cone_inside(const Triangles& part, const glm::dvec3& apex) {
  const auto number = static_cast<std::uint32_t>(p_.size() + inside_.size());
  for (const CornerTriangle& t : part) tets_.push_back({t[0], t[1], t[2], number});
  inside_.push_back({apex, corners_});
  fill_ = std::max(fill_, SurfaceFill::from_inside);
}

/// Whether the cone from a corner has a flat tet over a triangle that has an area.
bool SurfaceTets::has_flat_tets(const Triangles& part, std::uint32_t apex) const {
  const double flat = by_rounding * volume6_;
  return std::any_of(part.begin(), part.end(), [&](const CornerTriangle& t) {
    return !has(t, apex) && depth6(t, p_[apex], p_) <= flat &&
           glm::length(glm::cross(p_[t[1]] - p_[t[0]], p_[t[2]] - p_[t[0]])) > 1e-10 * size_ * size_;
  });
}

/// Fills the part by a cone from one point that sees all triangles. Prefers a corner that is only in the planes of its
/// own triangles, then an inner point; without `strictly`, accepts any corner that sees all triangles.
bool SurfaceTets::fill_star(const Triangles& part, bool strictly) {
  take_measures(part);
  const double rounding = by_rounding * volume6_;
  std::size_t tries = most_tries / part.size() + 1;
  const std::uint32_t* second_best = nullptr;
  for (const std::uint32_t& v : corners_) {
    if (tries-- == 0) break;
    if (wrong_side(part, p_[v], rounding) > rounding) continue;
    if (!has_flat_tets(part, v)) {
      add_cone(part, v);
      return true;
    }
    if (second_best == nullptr) second_best = &v;
  }
  glm::dvec3 x = mean_;
  if (wrong_side(part, x, rounding) <= rounding ||
      (find_kernel_point(part, strictly, x) && wrong_side(part, x, rounding) <= rounding)) {
    add_cone_inside(part, x);
    return true;
  }
  if (second_best == nullptr || strictly) return false;
  add_cone(part, *second_best);
  return true;
}

/// Moves `x` to a point on the inner side of all triangles' planes, if it finds one. Repeatedly moves `x` by the
/// distance to the most violated plane (Agmon, "The relaxation method for linear inequalities", Canadian Journal of
/// Mathematics, 1954). With `soon`, gives up early.
bool SurfaceTets::find_kernel_point(const Triangles& part, bool soon, glm::dvec3& x) {
  planes_.clear();
  for (const CornerTriangle& t : part) {
    const glm::dvec3 area = glm::cross(p_[t[1]] - p_[t[0]], p_[t[2]] - p_[t[0]]);
    const double length = glm::length(area);
    if (length <= 1e-12 * size_ * size_) continue;
    const glm::dvec3 normal = area / length;
    planes_.push_back({normal, glm::dot(normal, p_[t[0]])});
  }
  const int steps = soon ? 25 : part.size() > 2000 ? 20 : 100;
  for (const double margin : {3e-2, 3e-3, 3e-4}) {
    if (soon && margin != 3e-3) continue;
    for (int step = 0; step < steps; ++step) {
      double least = std::numeric_limits<double>::infinity();
      const Plane* worst = nullptr;
      for (const Plane& plane : planes_) {
        const double depth = plane.offset - glm::dot(plane.normal, x);
        if (depth < least) least = depth, worst = &plane;
      }
      if (worst == nullptr || least >= margin * size_) return true;
      // The point moves a little farther than the plane requires, which ends in finitely many steps if the region has
      // an interior.
      x -= worst->normal * (1.2 * (1.1 * margin * size_ - least));
    }
  }
  return false;
}

void SurfaceTets::fill_part(const Triangles& part) {
  take_measures(part);
  if (volume6_ <= 1e-12 * noise6_) return add_cone(part, corners_[0]);  // flat
  if (fill_star(part, false)) return;
  fill_ = std::max(fill_, SurfaceFill::in_pieces);
  if (split_apart(part)) return;
  const std::size_t tets = tets_.size(), points = inside_.size();
  for (std::uint32_t attempt = 0; attempt < most_attempts; ++attempt) {
    if (fill_by_ears(part, attempt)) return;
    tets_.resize(tets), inside_.resize(points);
  }
  fill_overlapping(part);
}

/// Divides the part at edges with more than two triangles and fills the pieces one by one. Returns false if there is
/// only one piece, or if a piece is a void.
bool SurfaceTets::split_apart(const Triangles& part) {
  const std::vector<Triangles> parts = parts_on_edges(part);
  if (parts.size() < 2) return false;
  for (const Triangles& one : parts) {
    take_measures(one);
    if (volume6_ < 0 && -volume6_ > 1e-12 * noise6_) return false;  // a void
  }
  for (const Triangles& one : parts) fill_part(one);
  return true;
}

bool SurfaceTets::fill_by_ears(const Triangles& part, std::uint32_t attempt) {
  if (!ears_.set(p_, part, attempt)) return false;
  LocalTet ear{};
  while (ears_.cut(ear)) {
    tets_.push_back(ear);
    if (ears_.left().empty()) return true;
    const std::vector<Triangles> parts = parts_on_edges(ears_.left());
    if (parts.size() > 1) {
      for (const Triangles& one : parts) fill_part(one);
      return true;
    }
    if (fill_star(ears_.left(), true)) return true;
  }
  return fill_star(ears_.left(), false);
}

/// Fills the part by a cone from a corner, or from the mean of the corners, whichever has the least volume on the wrong
/// side.
void SurfaceTets::fill_overlapping(const Triangles& part) {
  fill_ = SurfaceFill::overlapping;
  take_measures(part);
  double least = wrong_side(part, mean_, std::numeric_limits<double>::infinity());
  std::size_t tries = most_tries / part.size() + 1;
  const std::uint32_t* best = nullptr;
  for (const std::uint32_t& v : corners_) {
    if (tries-- == 0) break;
    const double wrong = wrong_side(part, p_[v], least);
    if (wrong < least) least = wrong, best = &v;
  }
  best != nullptr ? add_cone(part, *best) : add_cone_inside(part, mean_);
}

}  // namespace tessera::cells
