// SPDX-License-Identifier: BSD-3-Clause
#include "apps/trial_cells.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <set>
#include <utility>

namespace tessera::apps {
namespace {

constexpr std::array<std::array<std::size_t, 2>, 6> edges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// Projects world points to pixels: x to the right, y down, z the planar depth.
class ToPixels {
 public:
  ToPixels(const Camera& camera, ImageSize size)
      : camera_(camera), basis_(view_basis(camera)), middle_(size.width * 0.5, size.height * 0.5, 0) {
    const double half = camera.projection == ProjectionKind::orthographic
                            ? camera.parallel_scale
                            : std::tan(camera.view_angle / 2 * std::numbers::pi / 180);
    pixels_ = size.height * 0.5 / half;
  }

  /// Projects the corners of a cell. Returns false if a corner is not in front of the eye or not between the near and
  /// the far plane.
  [[nodiscard]] bool operator()(const std::array<glm::dvec3, 4>& corners, std::array<glm::dvec3, 4>& projected) const {
    for (std::size_t k = 0; k < 4; ++k) {
      const glm::dvec3 from_eye = corners[k] - camera_.position;
      const double depth = glm::dot(from_eye, basis_.forward);
      const auto& range = camera_.clipping_range;
      if (!(depth > 0) || (range && (depth < range->near_distance || depth > range->far_distance))) return false;
      const double scale = camera_.projection == ProjectionKind::orthographic ? pixels_ : pixels_ / depth;
      projected[k] =
          middle_ + glm::dvec3(glm::dot(from_eye, basis_.right) * scale, -glm::dot(from_eye, basis_.up) * scale, depth);
    }
    return true;
  }

 private:
  const Camera& camera_;
  ViewBasis basis_;
  glm::dvec3 middle_;
  double pixels_ = 1;  ///< pixels per world unit; in perspective at depth 1
};

/// Returns the range in x where a cell's outline meets the row of pixel centres at `y`.
std::pair<double, double> across(const std::array<glm::dvec3, 4>& p, double y) {
  double low = 1e300, high = -1e300;
  for (const auto& [a, b] : edges) {
    const double below = p[a].y - y, above = p[b].y - y;
    if ((below > 0) == (above > 0)) continue;
    const double x = p[a].x + (p[b].x - p[a].x) * (below / (below - above));
    low = std::min(low, x), high = std::max(high, x);
  }
  return {low, high};
}

struct Extent {
  double low, high;
};

template <int axis>
Extent extent_along(const std::array<glm::dvec3, 4>& p) {
  const auto by = [](const glm::dvec3& a, const glm::dvec3& b) { return a[axis] < b[axis]; };
  const auto [low, high] = std::minmax_element(p.begin(), p.end(), by);
  return {(*low)[axis], (*high)[axis]};
}

/// Returns the pixels, out of `count`, whose centres are in [low, high]: the first one, and one past the last.
std::pair<int, int> centres(double low, double high, int count) {
  const double first = std::clamp(std::ceil(low - 0.5), 0.0, static_cast<double>(count));
  const double last = std::clamp(std::floor(high - 0.5), -1.0, count - 1.0);
  return {static_cast<int>(first), static_cast<int>(last) + 1};
}

}  // namespace

TrialCells::TrialCells(const Dataset& data, const TransferFunction& function, bool emits)
    : function_(function), emits_(emits) {
  if (data.is_mesh()) {
    mesh_ = data.mesh_arrays();
    return;
  }
  const GridGeometry& g = data.grid_geometry();
  std::array<glm::dvec3, 8> corners;
  for (std::size_t n = 0; n < 8; ++n) {
    glm::dvec3 local;
    for (std::size_t axis = 0; axis < 3; ++axis)
      local[static_cast<int>(axis)] = g.lattice(axis, (n >> axis & 1) != 0 ? g.points[axis] - 1 : 0);
    corners[n] = g.origin + g.direction * local;
  }
  for (const auto& [first, second] : {std::array{1u, 3u}, {3u, 2u}, {2u, 6u}, {6u, 4u}, {4u, 5u}, {5u, 1u}})
    box_.push_back({corners[0], corners[first], corners[second], corners[7]});
}

template <class Use>
void TrialCells::for_each(const Use& use) const {
  for (const Corners& corners : box_)
    if (!use(corners)) return;
  const auto points = mesh_.points.as<double>(), values = mesh_.scalars.as<double>();
  const auto tets = mesh_.tets.as<std::uint32_t>();
  const bool of_points = mesh_.association == Association::point;
  for (std::size_t t = 0; 4 * t < tets.size(); ++t) {
    Corners corners;
    double low = 1e300, high = -1e300;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t point = tets[4 * t + k];
      corners[k] = {points[3 * point], points[3 * point + 1], points[3 * point + 2]};
      const double value = values[of_points ? point : t];
      low = std::min(low, value), high = std::max(high, value);
    }
    if (function_.visible(low, high, emits_) && !use(corners)) return;
  }
}

std::uint64_t TrialCells::pixels(const Camera& camera, ImageSize size, const glm::dvec3& scale) const {
  const ToPixels to_pixels(camera, size);
  std::set<std::pair<int, int>> covered;
  const std::uint64_t sought = enough(size);
  for_each([&](Corners corners) {
    for (glm::dvec3& corner : corners) corner *= scale;
    Corners p;
    if (!to_pixels(corners, p)) return true;
    const auto [top, bottom] = extent_along<1>(p);
    const auto [first_row, row_end] = centres(top, bottom, size.height);
    for (int row = first_row; row < row_end; ++row) {
      const auto [left, right] = across(p, row + 0.5);
      const auto [first, end] = centres(left, right, size.width);
      for (int column = first; column < end && covered.size() < sought; ++column) covered.emplace(column, row);
      if (covered.size() >= sought) return false;
    }
    return true;
  });
  return covered.size();
}

bool TrialCells::is_in_view(const Camera& camera, ImageSize size) const {
  const ToPixels to_pixels(camera, size);
  bool found = false;
  for_each([&](const Corners& corners) {
    Corners p;
    if (!to_pixels(corners, p)) return true;
    const Extent x = extent_along<0>(p), y = extent_along<1>(p);
    found = x.high >= 0 && x.low <= size.width && y.high >= 0 && y.low <= size.height;
    return !found;
  });
  return found;
}

TrialCells::Cell TrialCells::largest() const {
  Cell most;
  for_each([&](const Corners& c) {
    const auto area = [&](std::size_t i, std::size_t j, std::size_t k) {
      return glm::length(glm::cross(c[j] - c[i], c[k] - c[i])) / 2;
    };
    const double volume = std::abs(glm::dot(c[1] - c[0], glm::cross(c[2] - c[0], c[3] - c[0]))) / 6;
    const double a = area(1, 2, 3), b = area(0, 2, 3), d = area(0, 1, 3), e = area(0, 1, 2), all = a + b + d + e;
    const double radius = all > 0 ? 3 * volume / all : 0;
    // The ball touches all faces. Its centre is the mean of the corners, weighted by the areas of the opposite faces.
    if (radius > most.radius) most = {(c[0] * a + c[1] * b + c[2] * d + c[3] * e) / all, radius};
    return true;
  });
  return most;
}

}  // namespace tessera::apps
