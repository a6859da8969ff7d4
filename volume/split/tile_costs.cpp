// SPDX-License-Identifier: BSD-3-Clause
#include "volume/split/tile_costs.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "scene/pixel_view.hpp"
#include "volume/tile_rays.hpp"

namespace tessera::volume {
namespace {

/// The fraction of a tile's cost that each part of the tile bears in full. Measurements gave 0.1 to 0.25, and less with
/// finer pixels.
constexpr double shared = 0.12;

/// Returns the overlap of a square and a range along one axis, in pixels.
int overlap(int square, int low, int high) {
  return std::min(high, (square + 1) * TileCosts::side) - std::max(low, square * TileCosts::side);
}

/// Summed-area table of rows of `width` values.
std::vector<double> summed(const std::vector<double>& values, int width) {
  const auto stride = static_cast<std::size_t>(width) + 1;
  std::vector<double> table(stride, 0.0);
  table.reserve(stride + values.size() + values.size() / static_cast<std::size_t>(width));
  for (std::size_t first = 0; first < values.size(); first += static_cast<std::size_t>(width)) {
    table.push_back(0);
    double row = 0;
    for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
      row += values[first + x];
      table.push_back(table[table.size() - stride] + row);
    }
  }
  return table;
}

}  // namespace

TileCosts::TileCosts(const scene::Camera& camera, scene::ImageSize size, const glm::dvec3& middle)
    : camera_(camera),
      size_(size),
      middle_(middle),
      width_((size.width + side - 1) / side),
      height_((size.height + side - 1) / side),
      density_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 1.0f) {}

float TileCosts::at(double x, double y) const {
  const auto along = [](double v, int length) {
    const double place = std::min(std::max(0.0, v / side - 0.5), length - 1.0);  // 0 for NaN
    const int low = std::min(static_cast<int>(place), std::max(0, length - 2));
    return std::pair(low, static_cast<float>(place - low));
  };
  const auto [i, u] = along(x, width_);
  const auto [j, v] = along(y, height_);
  const auto row = [&, i = i, u = u](int n) {
    const float* const d = density_.data() + static_cast<std::size_t>(n) * static_cast<std::size_t>(width_);
    return d[i] + u * (d[std::min(i + 1, width_ - 1)] - d[i]);
  };
  const float above = row(j);
  return above + v * (row(std::min(j + 1, height_ - 1)) - above);
}

void TileCosts::turn_to(const scene::Camera& camera) {
  if (camera == camera_) return;
  const scene::PixelView next(camera, size_), last(camera_, size_);
  // If the eye is inside the volume, the plane is kept in front of the eye, at half the distance of the middle or more.
  const glm::dvec3 to_middle = middle_ - next.position;
  const double depth = std::max(glm::dot(to_middle, next.basis.forward), 0.5 * glm::length(to_middle));
  std::vector<float> density;
  density.reserve(density_.size());
  for (int j = 0; j < height_; ++j) {
    for (int i = 0; i < width_; ++i) {
      const double x = (i + 0.5) * side, y = (j + 0.5) * side;
      glm::dvec3 place = next.position + depth * next.direction(x, y);
      if (!next.perspective)
        place +=
            ((x - next.half_width) * next.basis.right - (y - next.half_height) * next.basis.up) / next.pixels_per_unit;
      const scene::PixelPlace seen = last.project(place);
      density.push_back(seen.w > 0 ? at(seen.x / seen.w, seen.y / seen.w) : at(x, y));
    }
  }
  density_ = std::move(density);
  camera_ = camera;
}

void TileCosts::learn(std::span<const TileTime> times) {
  std::vector<float> learned(density_.size(), 0.0f), covered(density_.size(), 0.0f);
  const auto each = [&](const scene::PixelRect& r, const auto& f) {
    for (int j = r.y0 / side; j * side < r.y1; ++j)
      for (int i = r.x0 / side; i * side < r.x1; ++i)
        f(static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(i),
          static_cast<float>(overlap(i, r.x0, r.x1) * overlap(j, r.y0, r.y1)));
  };
  for (const auto& [part, microseconds] : times) {
    if (part.empty()) continue;
    const int x0 = part.x0 / TileRays::side * TileRays::side, y0 = part.y0 / TileRays::side * TileRays::side;
    float of_part = 0, of_tile = 0, pixels = 0;
    each(part, [&](std::size_t n, float covers) { of_part += covers * density_[n]; });
    each({x0, y0, std::min(x0 + TileRays::side, size_.width), std::min(y0 + TileRays::side, size_.height)},
         [&](std::size_t n, float covers) { of_tile += covers * density_[n], pixels += covers; });
    constexpr auto again = static_cast<float>(shared);
    const float scale = 1e3f * microseconds / std::max((1 - again) * of_part + again * of_tile, 1e-6f);
    // A tenth of the time is distributed uniformly, so that a square with zero cost can get a positive cost.
    constexpr float even = 0.1f;
    const float level = even * of_tile / pixels;
    each(part, [&](std::size_t n, float covers) {
      learned[n] += covers * scale * ((1 - even) * density_[n] + level), covered[n] += covers;
    });
  }
  for (std::size_t n = 0; n < density_.size(); ++n)
    if (covered[n] > 0) density_[n] = std::max(learned[n] / covered[n], 1e-3f);
}

void TileCosts::sum() {
  constexpr int squares = TileRays::side / side;
  const int columns = (width_ + squares - 1) / squares, rows = (height_ + squares - 1) / squares;
  std::vector<double> of_tile(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0.0), of_square;
  of_square.reserve(density_.size());
  for (int j = 0; j < height_; ++j) {
    for (int i = 0; i < width_; ++i) {
      const auto n = static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(i);
      of_square.push_back(static_cast<double>(density_[n]) * overlap(i, 0, size_.width) * overlap(j, 0, size_.height));
      of_tile[static_cast<std::size_t>(j / squares) * static_cast<std::size_t>(columns) +
              static_cast<std::size_t>(i / squares)] += of_square.back();
    }
  }
  squares_ = summed(of_square, width_);
  tiles_ = summed(of_tile, columns);
}

double TileCosts::of(const scene::PixelRect& r) const {
  if (r.empty()) return 0;
  const auto corner = [&](int x, int y) {
    const int i = std::min(x / side, width_ - 1), j = std::min(y / side, height_ - 1);
    const double u = static_cast<double>(x - i * side) / overlap(i, 0, size_.width),
                 v = static_cast<double>(y - j * side) / overlap(j, 0, size_.height);
    const std::size_t stride = static_cast<std::size_t>(width_) + 1;
    const double* const s = squares_.data() + static_cast<std::size_t>(j) * stride + static_cast<std::size_t>(i);
    return (1 - v) * ((1 - u) * s[0] + u * s[1]) + v * ((1 - u) * s[stride] + u * s[stride + 1]);
  };
  const auto tile_corner = [&](int i, int j) {
    const int stride = (width_ + TileRays::side / side - 1) / (TileRays::side / side) + 1;
    return tiles_[static_cast<std::size_t>(j) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(i)];
  };
  const auto inside = [](const auto& at, int x0, int y0, int x1, int y1) {
    return at(x1, y1) - at(x0, y1) - at(x1, y0) + at(x0, y0);
  };
  constexpr int last = TileRays::side - 1;
  return (1 - shared) * inside(corner, r.x0, r.y0, r.x1, r.y1) +
         shared * inside(tile_corner, r.x0 / TileRays::side, r.y0 / TileRays::side, (r.x1 + last) / TileRays::side,
                         (r.y1 + last) / TileRays::side);
}

}  // namespace tessera::volume
