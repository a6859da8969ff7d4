// SPDX-License-Identifier: BSD-3-Clause
#include "projection/surface_faces.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "projection/edge_sign.hpp"
#include "projection/footprint.hpp"
#include "projection/surface_crossings.hpp"

namespace tessera::projection {
namespace {

using TriangleCorners = std::array<PixelVertex, 3>;

/// The largest tolerance of a mark, relative to its depth: matter within it is ignored.
constexpr double most_tolerance = 1e-9;

/// Planes whose slopes differ by less than this, relative to the terms of a slope, count as one plane: the rounding
/// errors of positions and edge functions are smaller.
constexpr double coplanar = 1e-9;

scene::PixelRect box_of(const TriangleCorners& c, const scene::PixelRect& window) {
  return footprint({c[0], c[1], c[2], c[2]}, window);
}

/// Returns the largest change of an edge function, at any pixel of the box, by rounding and line_of_sight(). With q = X
/// - px w, E = q_x r_y - q_y r_x. Each q has an error of one last place of its terms, and twice this where products are
/// rounded.
double edge_error(const TriangleCorners& corners, const scene::PixelRect& box, double pixels_per_tangent) {
  constexpr double u = 0x1p-53;
  const double right = box.x1, bottom = box.y1;
  double q = 0, error = 0;
  for (const PixelVertex& v : corners) {
    const double w = std::abs(v.w);
    const double reach_x = std::max(std::abs(v.x - box.x0 * v.w), std::abs(v.x - right * v.w));
    const double reach_y = std::max(std::abs(v.y - box.y0 * v.w), std::abs(v.y - bottom * v.w));
    q = std::max({q, reach_x, reach_y});
    error = std::max(
        error, u * (q + 2 * std::max(right, bottom) * w) + sight_error(v, pixels_per_tangent, std::max(right, bottom)));
  }
  return 8 * q * (error + u * q);
}

/// Returns the largest change of an edge function by the rounding of orthographic pixel positions (PixelSpace). This
/// rounding changes the depth of a plane if the plane is divided into other triangles. The result is four times the
/// rounding error of a position (2^-33 pixel), multiplied by the width plus the height of the triangle's box; the
/// errors of an edge and of the distance from the edge contribute to it.
double position_error(const TriangleCorners& c) {
  const auto [left, right] = std::minmax({c[0].x, c[1].x, c[2].x});
  const auto [top, bottom] = std::minmax({c[0].y, c[1].y, c[2].y});
  return 0x1p-31 * ((right - left) + (bottom - top));
}

struct Edge {
  double value;
  bool met;  ///< whether the ray meets the edge
};

Edge edge_at(const PixelVertex& a, const PixelVertex& b, double x, double y, double error, double pixels_per_tangent) {
  const double value = (a.x - x * a.w) * (b.y - y * b.w) - (a.y - y * a.w) * (b.x - x * b.w);
  if (std::abs(value) > error) return {value, false};
  bool met = false;
  const int sign = edge_sign(a, b, x, y, pixels_per_tangent, &met);
  // Within the error bound, any magnitude is equally valid.
  return {sign * std::max({std::abs(value), error * 0x1p-20, 1e-290}), met};
}

/// Returns the change of an edge function from one pixel to the next, in x and in y.
std::array<double, 2> growth(const PixelVertex& a, const PixelVertex& b) {
  return {a.y * b.w - a.w * b.y, a.w * b.x - a.x * b.w};
}

bool one_side(const Edge& a, const Edge& b) { return (a.value > 0 && b.value > 0) || (a.value < 0 && b.value < 0); }

}  // namespace

FrameFaces::FrameFaces(std::span<const SurfaceFaces> surfaces, const PixelSpace& space, const TileGrid& grid)
    : surfaces_(surfaces), space_(&space), grid_(grid), begin_(grid.count() + 1, 0), owned_(grid.count(), 0) {
  const scene::PixelRect window{0, 0, grid.image.width, grid.image.height};
  const int size = grid.tile_size;
  std::vector<std::vector<scene::PixelRect>> boxes(surfaces.size());
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const tessera::TriangleMesh& mesh = *surfaces[s].mesh;
    std::vector<PixelVertex>& vertices = vertices_.emplace_back(mesh.points.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, vertices.size(), 4096), [&](const auto& range) {
      const std::size_t n = range.end() - range.begin();
      space.project(std::span(mesh.points).subspan(range.begin(), n), std::span(vertices).subspan(range.begin(), n));
    });
    boxes[s].resize(mesh.triangles.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, boxes[s].size(), 4096), [&](const auto& range) {
      for (std::size_t t = range.begin(); t < range.end(); ++t) {
        const auto& c = mesh.triangles[t];
        boxes[s][t] = box_of({vertices[c[0]], vertices[c[1]], vertices[c[2]]}, window);
      }
    });
  }
  const auto visit = [&](const auto& action) {
    for (std::uint32_t s = 0; s < boxes.size(); ++s)
      for (std::uint32_t t = 0; t < boxes[s].size(); ++t) {
        const scene::PixelRect& box = boxes[s][t];
        if (box.empty()) continue;
        for (int row = box.y0 / size; row <= (box.y1 - 1) / size; ++row)
          for (int column = box.x0 / size; column <= (box.x1 - 1) / size; ++column)
            action(static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns()) +
                       static_cast<std::size_t>(column),
                   Place{s, t});
      }
  };
  visit([&](std::size_t tile, const Place& place) {
    ++begin_[tile + 1];
    if (surfaces[place.surface].owns(place.triangle)) owned_[tile] = 1;
  });
  for (std::size_t tile = 1; tile < begin_.size(); ++tile) begin_[tile] += begin_[tile - 1];
  places_.resize(begin_.back());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  visit([&](std::size_t tile, const Place& place) { places_[next[tile]++] = place; });
}

std::uint64_t FrameFaces::bytes() const {
  std::uint64_t bytes = places_.capacity() * sizeof(Place) + begin_.capacity() * sizeof(std::size_t);
  for (const auto& vertices : vertices_) bytes += vertices.capacity() * sizeof(PixelVertex);
  return bytes;
}

void FrameFaces::meet(const scene::PixelRect& rect, FaceMarks& marks) const {
  marks.reset(static_cast<std::size_t>(rect.area()));
  const int row = rect.y0 / grid_.tile_size, column = rect.x0 / grid_.tile_size;
  const auto tile =
      static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.columns()) + static_cast<std::size_t>(column);
  for (std::size_t i = begin_[tile]; i < begin_[tile + 1]; ++i) meet_triangle(places_[i], rect, marks);
  marks.sort();
}

void FrameFaces::meet_triangle(const Place& place, const scene::PixelRect& rect, FaceMarks& marks) const {
  const SurfaceFaces& surface = surfaces_[place.surface];
  const tessera::TriangleMesh& mesh = *surface.mesh;
  const auto& index = mesh.triangles[place.triangle];
  const std::vector<PixelVertex>& vertices = vertices_[place.surface];
  const TriangleCorners c{vertices[index[0]], vertices[index[1]], vertices[index[2]]};
  const scene::PixelRect box = box_of(c, rect);
  if (box.empty()) return;
  const double per_tangent = space_->pixels_per_tangent();
  for (std::size_t i = 0; i < 3; ++i) {
    const PixelVertex &a = c[i], &b = c[(i + 1) % 3];
    // An edge has no sides if both ends are on one line of sight.
    if ((a.w == b.w && a.x == b.x && a.y == b.y) ||
        ((a.w <= 0 || b.w <= 0) && edge_sign(a, b, 0.5, 0.5, per_tangent) == 0))
      return;
  }
  const std::array<glm::dvec3, 3> at{mesh.points[index[0]], mesh.points[index[1]], mesh.points[index[2]]};
  const glm::dvec3 normal = unit(glm::cross(unit(at[1] - at[0]), unit(at[2] - at[0])));
  // The error is computed for the whole image, so that no bit depends on the rectangle.
  const double error = edge_error(c, box_of(c, {0, 0, grid_.image.width, grid_.image.height}), per_tangent);
  const double depth_error = error + (per_tangent == 0 ? position_error(c) : 0);
  const auto [least, most] = std::minmax({c[0].depth, c[1].depth, c[2].depth});
  const double size = std::max(std::abs(least), std::abs(most));
  std::array<double, 3> value{};
  if (!mesh.values.empty())
    for (std::size_t i = 0; i < 3; ++i) value[i] = mesh.values[index[i]];
  const auto [low, high] = std::minmax({value[0], value[1], value[2]});
  // Without perspective, all rays have one direction.
  const auto seen_along = [&](const glm::dvec3& ray) {
    return std::pair(glm::dot(ray, normal) > 0 ? surface.leaving : surface.entering, cosine_between(ray, normal));
  };
  const auto seen = seen_along(space_->direction(0, 0));
  // Changes of the edge functions of the edges opposite to the corners.
  const std::array<std::array<double, 2>, 3> growths{growth(c[1], c[2]), growth(c[2], c[0]), growth(c[0], c[1])};
  for (int y = box.y0; y < box.y1; ++y)
    for (int x = box.x0; x < box.x1; ++x) {
      const double px = x + 0.5, py = y + 0.5;
      const Edge ab = edge_at(c[0], c[1], px, py, error, per_tangent);
      const Edge bc = edge_at(c[1], c[2], px, py, error, per_tangent);
      if (!one_side(ab, bc)) continue;
      const Edge ca = edge_at(c[2], c[0], px, py, error, per_tangent);
      if (!one_side(ca, ab)) continue;
      if (ab.met && bc.met && ca.met) continue;  // the ray is in the plane of the triangle, which contains the eye
      const double wa = std::abs(bc.value), wb = std::abs(ca.value), wc = std::abs(ab.value), sum = wa + wb + wc;
      const auto mean = [&](double a, double b, double of_c) {
        return of_c + ((a - of_c) * wa + (b - of_c) * wb) / sum;
      };
      const double depth = std::clamp(mean(c[0].depth, c[1].depth, c[2].depth), least, most);
      const double tolerance =
          std::min(8 * (depth_error / sum * (most - least) + 0x1p-52 * size), most_tolerance * size);
      // If the depth is that of the eye, only rounding can put the mark in front of the eye.
      if (!(depth > space_->near_depth() + (space_->near_depth() > 0 ? 0 : tolerance)) ||
          !(depth < space_->far_depth()))
        continue;
      // The depth is a mean with the edge functions as weights; its slope is a mean with the changes of the edge
      // functions as weights.
      const double whole = 1 / (ab.value + bc.value + ca.value);
      std::array<double, 2> slope{}, slope_error{};
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t axis = 0; axis < 2; ++axis) {
          const double weight = growths[i][axis] * whole;
          slope[axis] += weight * (c[i].depth - depth);
          slope_error[axis] += std::abs(weight) * (2 * tolerance + coplanar * std::abs(c[i].depth - depth));
        }
      const auto [number, cosine] = per_tangent == 0 ? seen : seen_along(space_->direction(px, py));
      marks.add({static_cast<std::uint32_t>((y - rect.y0) * rect.width() + x - rect.x0), number, depth,
                 std::clamp(mean(value[0], value[1], value[2]), low, high), tolerance, slope, slope_error, cosine,
                 surface.owns(place.triangle)});
    }
}

}  // namespace tessera::projection
