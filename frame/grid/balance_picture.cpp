// SPDX-License-Identifier: BSD-3-Clause
#include "frame/grid/balance_picture.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <numeric>
#include <vector>

#include "projection/pixel_space.hpp"

namespace tessera::frame {
namespace {

using Rgb = glm::dvec3;

/// Colours in linear light; neighbours in the list differ clearly in hue.
constexpr std::array<Rgb, 8> process_colors = {Rgb{0.90, 0.10, 0.05}, Rgb{0.05, 0.55, 0.10}, Rgb{0.08, 0.20, 0.95},
                                               Rgb{0.95, 0.70, 0.02}, Rgb{0.60, 0.08, 0.70}, Rgb{0.02, 0.65, 0.70},
                                               Rgb{0.95, 0.35, 0.02}, Rgb{0.45, 0.30, 0.15}};

/// Blends `color` over a pixel with weight `share`.
void put(scene::Image& image, int x, int y, const Rgb& color, double share) {
  float* const p = &image.rgba[4 * image.index(x, y)];
  for (int c = 0; c < 3; ++c) p[c] = static_cast<float>(p[c] * (1 - share) + color[c] * share);
  p[3] = static_cast<float>(p[3] * (1 - share) + share);
}

void draw_edges_of(scene::Image& image, const volume::ImageSplit& split) {
  const auto white = [&](int x, int y) {
    if (x > 0 && y > 0 && x < image.size.width && y < image.size.height) put(image, x, y, Rgb(1), 1);
  };
  for (int process = 0; process < split.processes(); ++process) {
    const std::vector<scene::PixelRect> parts = split.parts(process);
    for (const scene::PixelRect& r : parts) {
      for (int x = r.x0; r.y0 == parts.front().y0 && r.y0 > 0 && x < r.x1; ++x) white(x, r.y0);
      for (int y = r.y0; r.x0 > 0 && y < r.y1; ++y) white(r.x0, y);
    }
  }
}

std::vector<std::uint8_t> owners_of(const volume::ImageSplit& split, scene::ImageSize size) {
  std::vector<std::uint8_t> owners(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  for (int process = 0; process < split.processes(); ++process) {
    for (const scene::PixelRect& r : split.parts(process))
      for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; ++x)
          owners[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)] =
              static_cast<std::uint8_t>(static_cast<std::size_t>(process) % process_colors.size());
  }
  return owners;
}

/// Returns the part of a line, from 0 to 1, that is inside the image; the part is empty if first > second.
std::pair<double, double> inside(const glm::dvec2& a, const glm::dvec2& b, scene::ImageSize size) {
  double from = 0, to = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double length = axis == 0 ? size.width : size.height, change = b[axis] - a[axis];
    if (change == 0) {
      if (a[axis] < 0 || a[axis] > length) return {1, 0};
      continue;
    }
    const double u = -a[axis] / change, v = (length - a[axis]) / change;
    from = std::max(from, std::min(u, v)), to = std::min(to, std::max(u, v));
  }
  return {from, to};
}

/// Draws a grid's boxes as lines over an image. A pixel where many lines cross is no brighter than one with a single
/// line.
class BoxLines {
 public:
  BoxLines(const scene::Camera& camera, scene::ImageSize size, const scene::GridGeometry& geometry)
      : space_(camera, size), size_(size), geometry_(geometry), covered_(scene::Image(size).depth.size()) {
    colors_.resize(covered_.size());
  }

  /// Adds the edges of the box from `low` to `high`, in index space.
  void add(const glm::dvec3& low, const glm::dvec3& high, const Rgb& color) {
    for (int corner = 0; corner < 8; ++corner)
      for (int axis = 0; axis < 3; ++axis) {
        if ((corner >> axis & 1) != 0) continue;
        const auto at = [&](int c) {
          return space_.project(scene::world_of_index(
              geometry_,
              {(c & 1) != 0 ? high.x : low.x, (c & 2) != 0 ? high.y : low.y, (c & 4) != 0 ? high.z : low.z}));
        };
        add_edge(at(corner), at(corner | 1 << axis), color);
      }
  }

  /// Paints each pixel of a line in the line's colour, or in the colour that `color_of` returns for the pixel's index.
  void paint(scene::Image& image, const std::function<Rgb(std::size_t)>& color_of = nullptr) const {
    for (int y = 0; y < size_.height; ++y)
      for (int x = 0; x < size_.width; ++x) {
        const std::size_t n = image.index(x, y);
        if (covered_[n] > 0) put(image, x, y, color_of ? color_of(n) : colors_[n], static_cast<double>(covered_[n]));
      }
  }

 private:
  void add_edge(projection::PixelVertex a, projection::PixelVertex b, const Rgb& color) {
    // An edge that reaches behind the eye is clipped to its part in front of the eye.
    constexpr double least = 1e-6;
    const double near = least * std::max(std::abs(a.w), std::abs(b.w));
    if (a.w <= near && b.w <= near) return;
    if (a.w <= near) std::swap(a, b);
    if (b.w <= near) {
      const double u = (a.w - near) / (a.w - b.w);
      b.x = a.x + u * (b.x - a.x), b.y = a.y + u * (b.y - a.y), b.w = near;
    }
    const glm::dvec2 p(a.x / a.w, a.y / a.w), q(b.x / b.w, b.y / b.w);
    const auto [from, to] = inside(p, q, size_);
    if (from > to) return;
    const glm::dvec2 way = q - p;
    const bool flat = std::abs(way.x) >= std::abs(way.y);
    const int steps = static_cast<int>(std::ceil(std::max(std::abs(way.x), std::abs(way.y)) * (to - from))) + 1;
    for (int n = 0; n <= steps; ++n) {
      const glm::dvec2 r = p + way * (from + (to - from) * n / steps);
      // The line is distributed to the two pixels on either side of it.
      const double across = (flat ? r.y : r.x) - 0.5, part = across - std::floor(across);
      touch(flat ? r.x : r.x - 0.5, flat ? r.y - 0.5 : r.y, 1 - part, color);
      touch(flat ? r.x : r.x + 0.5, flat ? r.y + 0.5 : r.y, part, color);
    }
  }

  void touch(double x, double y, double share, const Rgb& color) {
    const int px = static_cast<int>(std::floor(x)), py = static_cast<int>(std::floor(y));
    if (px < 0 || py < 0 || px >= size_.width || py >= size_.height) return;
    const auto n = static_cast<std::size_t>(py) * static_cast<std::size_t>(size_.width) + static_cast<std::size_t>(px);
    if (static_cast<float>(share) <= covered_[n]) return;
    covered_[n] = static_cast<float>(share), colors_[n] = color;
  }

  projection::PixelSpace space_;
  scene::ImageSize size_;
  const scene::GridGeometry& geometry_;
  std::vector<float> covered_;  ///< covered share of each pixel
  std::vector<Rgb> colors_;
};

void dim(scene::Image& image) {
  for (std::size_t n = 0; n < image.rgba.size(); ++n) image.rgba[n] = n % 4 == 3 ? 1.0f : 0.5f * image.rgba[n];
}

/// Maps 0 to 1 to colours: from black over blue, red and yellow to white.
Rgb heat_of(double share) {
  constexpr std::array<Rgb, 6> heat = {Rgb{0, 0, 0},          Rgb{0.02, 0.03, 0.35}, Rgb{0.35, 0.02, 0.35},
                                       Rgb{0.85, 0.08, 0.05}, Rgb{0.95, 0.65, 0.05}, Rgb{1, 1, 1}};
  const double at = share * (heat.size() - 1);
  const std::size_t n = std::min(static_cast<std::size_t>(at), heat.size() - 2);
  return glm::mix(heat[n], heat[n + 1], at - static_cast<double>(n));
}

std::array<glm::dvec3, 2> corners_of(const volume::VoxelBox& box) {
  std::array<glm::dvec3, 2> corners;
  for (int a = 0; a < 3; ++a) {
    corners[0][a] = static_cast<double>(box.low[static_cast<std::size_t>(a)]);
    corners[1][a] = static_cast<double>(box.high[static_cast<std::size_t>(a)]);
  }
  return corners;
}

}  // namespace

void draw_bricks(scene::Image& image, const scene::Camera& camera, const scene::GridGeometry& geometry,
                 std::span<const std::array<glm::dvec3, 2>> bricks, const volume::ImageSplit& split) {
  const std::vector<std::uint8_t> owners = owners_of(split, image.size);
  dim(image);
  BoxLines lines(camera, image.size, geometry);
  for (const auto& [low, high] : bricks) lines.add(low, high, {});
  lines.paint(image, [&](std::size_t n) { return process_colors[owners[n]]; });
  draw_edges_of(image, split);
}

void draw_bricks(scene::Image& image, const scene::Camera& camera, const scene::GridGeometry& geometry,
                 std::span<const std::array<glm::dvec3, 2>> bricks, std::span<const volume::VoxelBox> parts) {
  dim(image);
  BoxLines of_bricks(camera, image.size, geometry), of_parts(camera, image.size, geometry);
  for (std::size_t process = 0; process < parts.size(); ++process) {
    const auto [low, high] = corners_of(parts[process]);
    if (low == high) continue;
    for (const auto& [from, to] : bricks) {
      // The boundary planes of a part may cut through a brick.
      const glm::dvec3 a = glm::max(low, from), b = glm::min(high, to);
      if (glm::all(glm::lessThan(a, b))) of_bricks.add(a, b, process_colors[process % process_colors.size()]);
    }
    of_parts.add(low, high, Rgb(1));
  }
  of_bricks.paint(image);
  of_parts.paint(image);
}

scene::Image cost_of_parts(const scene::Camera& camera, scene::ImageSize size, const scene::GridGeometry& geometry,
                           std::span<const volume::VoxelBox> parts, std::span<const double> seconds) {
  scene::Image image(size);
  dim(image);
  const double most = seconds.empty() ? 0 : *std::ranges::max_element(seconds);
  // The most expensive part is drawn last, so that it covers the lines that it shares with others.
  std::vector<std::size_t> order(std::min(parts.size(), seconds.size()));
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t process) { return seconds[process]; });
  for (const std::size_t process : order) {
    const auto [low, high] = corners_of(parts[process]);
    if (low == high || most <= 0) continue;
    BoxLines lines(camera, size, geometry);
    constexpr double least = 0.2;  // lets parts without cost remain visible
    lines.add(low, high, heat_of(least + (1 - least) * seconds[process] / most));
    lines.paint(image);
  }
  return image;
}

scene::Image cost_picture(const volume::CostMap& cost, scene::ImageSize size, const volume::ImageSplit& split) {
  scene::Image image(size);
  const std::uint32_t most = cost.cost.empty() ? 0 : *std::max_element(cost.cost.begin(), cost.cost.end());
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const int mx = static_cast<int>((x + 0.5) * cost.resolution) - cost.region.x0,
                my = static_cast<int>((y + 0.5) * cost.resolution) - cost.region.y0;
      double share = 0;
      if (mx >= 0 && my >= 0 && mx < cost.width() && my < cost.height() && most > 0)
        share = static_cast<double>(cost.cost[static_cast<std::size_t>(my) * static_cast<std::size_t>(cost.width()) +
                                              static_cast<std::size_t>(mx)]) /
                most;
      put(image, x, y, heat_of(share), 1);
    }
  draw_edges_of(image, split);
  return image;
}

}  // namespace tessera::frame
