// SPDX-License-Identifier: BSD-3-Clause
#include "volume/split/cost_map.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "scene/error.hpp"
#include "scene/pixel_view.hpp"
#include "volume/frame_view.hpp"

namespace tessera::volume {
namespace {

constexpr double units = 64;  // cost of a voxel
constexpr double silhouette_weight = 0.25;
constexpr int band_rows = 16;

/// The outline of a box in the map.
struct Outline {
  std::array<glm::dvec2, 8> corner;  ///< in map pixels; bit a of the index is set for corners at the high end of axis a
  int x0, y0, x1, y1;                ///< map pixels whose centres the box may cover
  bool behind_eye;
  double total;  ///< cost of the whole box for the depth of its centre
};

/// Rows [y0, y1) of the map's region, and the costs of their pixels so far.
struct Band {
  int y0, y1;
  std::vector<double> cost;  ///< row by row
};

/// Computes the costs of one frame.
class Costs {
 public:
  Costs(const scene::Camera& camera, scene::ImageSize image, const scene::GridGeometry& geometry,
        const CostSettings& settings, const scene::PixelRect& region)
      : geometry_(geometry),
        settings_(settings),
        region_(region),
        space_(camera, image),
        rays_(camera, image, geometry),
        perspective_(camera.projection == scene::ProjectionKind::perspective),
        mean_voxel_(std::cbrt(std::abs(glm::determinant(geometry.direction)) * geometry.spacing.x * geometry.spacing.y *
                              geometry.spacing.z)),
        map_pixel_(
            (perspective_ ? 2 * std::tan(camera.view_angle * std::numbers::pi / 360) : 2 * camera.parallel_scale) /
            image.height / settings.resolution) {}

  [[nodiscard]] Outline outline(const CostBox& box) const {
    Outline o{};
    glm::dvec2 low(1e300), high(-1e300);
    for (int c = 0; c < 8; ++c) {
      const glm::dvec3 index((c & 1) != 0 ? box.high.x : box.low.x, (c & 2) != 0 ? box.high.y : box.low.y,
                             (c & 4) != 0 ? box.high.z : box.low.z);
      const scene::PixelPlace v = space_.project(scene::world_of_index(geometry_, index));
      o.behind_eye = o.behind_eye || !(v.w > 0) || !(v.depth > rays_.near_depth);
      o.corner[static_cast<std::size_t>(c)] = glm::dvec2(v.x, v.y) / v.w * settings_.resolution;
      low = glm::min(low, o.corner[static_cast<std::size_t>(c)]);
      high = glm::max(high, o.corner[static_cast<std::size_t>(c)]);
    }
    if (o.behind_eye) low = glm::dvec2(-1e9), high = glm::dvec2(1e9);
    const auto first = [](double v) { return static_cast<int>(std::ceil(std::clamp(v, -1e6, 1e6) - 0.5)); };
    o.x0 = std::max(region_.x0, first(low.x)), o.x1 = std::min(region_.x1, first(high.x) + 1);
    o.y0 = std::max(region_.y0, first(low.y)), o.y1 = std::min(region_.y1, first(high.y) + 1);
    const glm::dvec3 centre = scene::world_of_index(geometry_, 0.5 * (box.low + box.high));
    const scene::PixelPlace v = space_.project(centre);
    const glm::dvec3 extent = box.high - box.low;
    const double world = mean_voxel_ * mean_voxel_ * mean_voxel_ * extent.x * extent.y * extent.z;
    const double pixel = map_pixel_ * (perspective_ ? v.depth : 1);
    o.total = rate(v.x / v.w, v.y / v.w) * world / (pixel * pixel);
    return o;
  }

  /// Adds each ray's path through the box.
  void add_way(const CostBox& box, const Outline& o, Band& band) const {
    for (int y = std::max(o.y0, band.y0); y < std::min(o.y1, band.y1); ++y)
      for (int x = o.x0; x < o.x1; ++x) {
        const double px = (x + 0.5) / settings_.resolution, py = (y + 0.5) / settings_.resolution;
        const glm::dvec3 origin = rays_.origin + px * rays_.origin_x + py * rays_.origin_y;
        const glm::dvec3 inverse = 1.0 / direction(px, py);
        const glm::dvec3 a = (box.low - origin) * inverse, b = (box.high - origin) * inverse;
        const glm::dvec3 enter = glm::min(a, b), leave = glm::max(a, b);
        const double from = std::max({enter.x, enter.y, enter.z, rays_.near_depth});
        const double to = std::min({leave.x, leave.y, leave.z, rays_.far_depth});
        if (to > from) at(band, x, y) += (to - from) * rate(px, py);
      }
  }

  /// Adds the cells that the caster visits along each ray.
  void add_visited(const VisibleCells& cells, Band& band) const {
    for (int y = band.y0; y < band.y1; ++y)
      for (int x = region_.x0; x < region_.x1; ++x)
        at(band, x, y) += visited(cells, (x + 0.5) / settings_.resolution, (y + 0.5) / settings_.resolution);
  }

  /// Adds a sphere around the box. The lengths of its chords are scaled to the box's total.
  void add_splat(const Outline& o, Band& band) const {
    double diameter = 0;
    for (int c = 0; c < 4; ++c)
      diameter = std::max(
          diameter, glm::length(o.corner[static_cast<std::size_t>(c)] - o.corner[static_cast<std::size_t>(7 - c)]));
    glm::dvec2 centre(0);
    for (const glm::dvec2& corner : o.corner) centre += 0.125 * corner;
    // A diagonal that points to the eye appears short, so the longest projected distance of any two corners is used; it
    // is a lower bound of the sphere's diameter.
    double longest = 0;
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < a; ++b)
        longest = std::max(longest,
                           glm::length(o.corner[static_cast<std::size_t>(a)] - o.corner[static_cast<std::size_t>(b)]));
    const double radius = std::max({0.5 * diameter, 0.5 * longest, 0.75});
    const double scale = o.total / (4 * std::numbers::pi / 3 * radius * radius * radius);
    const int first_y = std::max(band.y0, static_cast<int>(std::floor(centre.y - radius)));
    const int last_y = std::min(band.y1, static_cast<int>(std::ceil(centre.y + radius)) + 1);
    for (int y = first_y; y < last_y; ++y)
      for (int x = std::max(region_.x0, static_cast<int>(std::floor(centre.x - radius)));
           x < std::min(region_.x1, static_cast<int>(std::ceil(centre.x + radius)) + 1); ++x) {
        const glm::dvec2 d = glm::dvec2(x + 0.5, y + 0.5) - centre;
        const double left = radius * radius - glm::dot(d, d);
        if (left > 0) at(band, x, y) += scale * 2 * std::sqrt(left);
      }
  }

  void add_back_faces(const CostBox& box, const Outline& o, Band& band) const {
    // A face is a back face if the eye is on its inner side.
    bool back[3][2];
    for (int a = 0; a < 3; ++a) {
      if (perspective_) {
        back[a][0] = rays_.origin[a] > box.low[a];
        back[a][1] = rays_.origin[a] < box.high[a];
      } else {
        back[a][0] = rays_.direction[a] < 0;
        back[a][1] = rays_.direction[a] > 0;
      }
    }
    const auto inner = [&](int corner) {
      bool all = true;
      for (int a = 0; a < 3; ++a) all = all && back[a][corner >> a & 1];
      return all;
    };
    std::array<std::array<int, 3>, 12> triangles{};
    std::size_t count = 0;
    double sum = 0;
    const auto weight = [&](int corner) { return inner(corner) ? 1.0 : silhouette_weight; };
    const auto add_triangle = [&](int a, int b, int c) {
      triangles[count++] = {a, b, c};
      const glm::dvec2 p = at(o, b) - at(o, a), q = at(o, c) - at(o, a);
      sum += 0.5 * std::abs(p.x * q.y - p.y * q.x) * (weight(a) + weight(b) + weight(c)) / 3;
    };
    for (int a = 0; a < 3; ++a)
      for (int side = 0; side < 2; ++side) {
        if (!back[a][side]) continue;
        const int u = 1 << (a + 1) % 3, v = 1 << (a + 2) % 3, first = side << a;
        std::array<int, 4> ring{first, first + u, first + u + v, first + v};
        // The diagonal starts at the inner corner, so that both triangles have its weight.
        const auto found = std::find_if(ring.begin(), ring.end(), inner);
        if (found != ring.end()) std::rotate(ring.begin(), found, ring.end());
        add_triangle(ring[0], ring[1], ring[2]);
        add_triangle(ring[0], ring[2], ring[3]);
      }
    if (!(sum > 0)) return;
    for (std::size_t t = 0; t < count; ++t) {
      const auto [a, b, c] = triangles[t];
      fill({at(o, a), at(o, b), at(o, c)}, glm::dvec3(weight(a), weight(b), weight(c)) * (o.total / sum), o, band);
    }
  }

 private:
  [[nodiscard]] double& at(Band& band, int x, int y) const {
    return band.cost[static_cast<std::size_t>(y - band.y0) * static_cast<std::size_t>(region_.width()) +
                     static_cast<std::size_t>(x - region_.x0)];
  }
  static const glm::dvec2& at(const Outline& o, int corner) { return o.corner[static_cast<std::size_t>(corner)]; }

  [[nodiscard]] glm::dvec3 direction(double px, double py) const {
    glm::dvec3 d = rays_.direction + px * rays_.direction_x + py * rays_.direction_y;
    // A ray parallel to a slab is entirely inside or outside of it; a tiny slope gives this result without 0 / 0.
    const double least = 1e-12 * std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    for (int a = 0; a < 3; ++a)
      if (std::abs(d[a]) < least) d[a] = least;
    return d;
  }

  [[nodiscard]] double visited(const VisibleCells& cells, double px, double py) const {
    const glm::dvec3 origin = rays_.origin + px * rays_.origin_x + py * rays_.origin_y, d = direction(px, py);
    const scene::GridIndex voxels = geometry_.voxels();
    const glm::dvec3 size(static_cast<double>(voxels[0]), static_cast<double>(voxels[1]),
                          static_cast<double>(voxels[2]));
    const glm::dvec3 a = -origin / d, b = (size - origin) / d, enter = glm::min(a, b), leave = glm::max(a, b);
    const double from = std::max({enter.x, enter.y, enter.z, rays_.near_depth});
    const double to = std::min({leave.x, leave.y, leave.z, rays_.far_depth});
    if (!(to > from)) return 0;
    // k is the axis of the slabs, which are counted in the ray's direction. The other rays of a packet are at most two
    // pixels away on either side.
    const glm::dvec3 steep = glm::abs(d);
    const int k = steep.x >= steep.y && steep.x >= steep.z ? 0 : steep.y >= steep.z ? 1 : 2;
    const bool mirrored = d[k] < 0;
    const auto slab_at = [&](double t) { return mirrored ? size[k] - (origin[k] + t * d[k]) : origin[k] + t * d[k]; };
    const auto depth_at = [&](double slab) { return ((mirrored ? size[k] - slab : slab) - origin[k]) / d[k]; };
    constexpr auto side = static_cast<double>(CellRanges::side);
    double way = 0, depth = 0;
    const double length = space_.length_per_depth(px, py) / settings_.length_unit;
    for (double slab = std::floor(slab_at(from) / side) * side; slab < size[k] && depth_at(slab) < to; slab += side) {
      const double t0 = depth_at(slab), t1 = depth_at(slab + side);
      const double begin = std::max(from, t0), end = std::min(to, t1);
      if (!(end > begin)) continue;
      std::array<std::int64_t, 3> low{}, high{};
      for (int axis = 0; axis < 3; ++axis) {
        double first = slab, last = std::min(slab + side, size[k]) - 0.5;
        if (axis != k) {
          const double spread = 2 * (std::abs(rays_.origin_x[axis] + t1 * rays_.direction_x[axis]) +
                                     std::abs(rays_.origin_y[axis] + t1 * rays_.direction_y[axis]));
          const double p = origin[axis] + t0 * d[axis], q = origin[axis] + t1 * d[axis];
          first = std::min(p, q) - spread, last = std::max(p, q) + spread;
        } else if (mirrored) {
          first = size[k] - std::min(slab + side, size[k]), last = size[k] - slab - 0.5;
        }
        const double most = static_cast<double>(cells.cells[static_cast<std::size_t>(axis)] - 1);
        low[static_cast<std::size_t>(axis)] =
            static_cast<std::int64_t>(std::clamp(std::floor(first / side), 0.0, most));
        high[static_cast<std::size_t>(axis)] =
            static_cast<std::int64_t>(std::clamp(std::floor(last / side), 0.0, most));
      }
      if (!any_visible(cells, low, high)) continue;
      if (settings_.learned == nullptr) {
        way += end - begin;
        continue;
      }
      const glm::dvec3 middle = origin + 0.5 * (begin + end) * d;
      const std::size_t cell =
          settings_.learned->cells().number(static_cast<std::int64_t>(middle.x), static_cast<std::int64_t>(middle.y),
                                            static_cast<std::int64_t>(middle.z));
      way += (end - begin) * steep[k] * settings_.learned->samples(cell);
      depth += (end - begin) * length * settings_.learned->depth(cell);
      if (depth > settings_.most_depth) break;
    }
    return settings_.learned == nullptr ? way * rate(px, py) : way;
  }

  static bool any_visible(const VisibleCells& cells, const std::array<std::int64_t, 3>& low,
                          const std::array<std::int64_t, 3>& high) {
    for (std::int64_t c = low[2]; c <= high[2]; ++c)
      for (std::int64_t b = low[1]; b <= high[1]; ++b)
        for (std::int64_t a = low[0]; a <= high[0]; ++a)
          if (cells.visible[static_cast<std::size_t>(a + cells.cells[0] * (b + cells.cells[1] * c))] != 0) return true;
    return false;
  }

  /// Returns the cost per unit of planar depth along a pixel's ray.
  [[nodiscard]] double rate(double px, double py) const {
    if (!settings_.by_voxels) return space_.length_per_depth(px, py) / mean_voxel_;
    const glm::dvec3 d = glm::abs(direction(px, py));
    return d.x + d.y + d.z;
  }

  /// Adds a triangle within a box's outline. `weights` are those at its corners; they are linear in between.
  void fill(const std::array<glm::dvec2, 3>& corners, const glm::dvec3& weights, const Outline& o, Band& band) const {
    const auto& [a, b, c] = corners;
    const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (area == 0) return;
    const auto first = [](double v) { return static_cast<int>(std::ceil(v - 0.5)); };
    const int bottom = std::min({o.y1, band.y1, first(std::max({a.y, b.y, c.y})) + 1});
    const int right = std::min(o.x1, first(std::max({a.x, b.x, c.x})) + 1);
    for (int y = std::max({o.y0, band.y0, first(std::min({a.y, b.y, c.y}))}); y < bottom; ++y)
      for (int x = std::max(o.x0, first(std::min({a.x, b.x, c.x}))); x < right; ++x) {
        const glm::dvec2 p(x + 0.5, y + 0.5);
        const double u = ((b.x - p.x) * (c.y - p.y) - (c.x - p.x) * (b.y - p.y)) / area;
        const double v = ((c.x - p.x) * (a.y - p.y) - (a.x - p.x) * (c.y - p.y)) / area, w = 1 - u - v;
        if (u < 0 || v < 0 || w < 0) continue;
        at(band, x, y) += u * weights.x + v * weights.y + w * weights.z;
      }
  }

  const scene::GridGeometry& geometry_;
  const CostSettings& settings_;
  scene::PixelRect region_;
  scene::PixelView space_;
  PixelRays rays_;
  bool perspective_;
  double mean_voxel_, map_pixel_;  // in world units; map_pixel_ is that at depth one in perspective views
};

}  // namespace

scene::ImageSize map_size(scene::ImageSize image, double resolution) {
  if (!(resolution > 0 && resolution <= 1))
    throw scene::bad_input(fmt::format("balance resolution {}: it must be above 0 and at most 1", resolution));
  return {std::max(1, static_cast<int>(std::ceil(image.width * resolution))),
          std::max(1, static_cast<int>(std::ceil(image.height * resolution)))};
}

scene::PixelRect footprint(const scene::Camera& camera, scene::ImageSize image, const scene::GridGeometry& geometry) {
  return footprint(camera, image, geometry, VoxelBox::all_of(geometry));
}

scene::PixelRect footprint(const scene::Camera& camera, scene::ImageSize image, const scene::GridGeometry& geometry,
                           const VoxelBox& part) {
  const scene::PixelView space(camera, image);
  glm::dvec2 low(1e300), high(-1e300);
  for (int c = 0; c < 8; ++c) {
    glm::dvec3 index;
    for (std::size_t a = 0; a < 3; ++a)
      index[static_cast<int>(a)] = static_cast<double>((c >> a & 1) != 0 ? part.high[a] : part.low[a]);
    const scene::PixelPlace v = space.project(scene::world_of_index(geometry, index));
    if (!(v.w > 0) || !(v.depth > 0)) return {0, 0, image.width, image.height};
    low = glm::min(low, glm::dvec2(v.x, v.y) / v.w);
    high = glm::max(high, glm::dvec2(v.x, v.y) / v.w);
  }
  const auto pixel = [](double v, int length) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(length)));
  };
  return {pixel(std::floor(low.x), image.width), pixel(std::floor(low.y), image.height),
          pixel(std::ceil(high.x), image.width), pixel(std::ceil(high.y), image.height)};
}

CostMap cost_map(const scene::Camera& camera, scene::ImageSize image, const scene::GridGeometry& geometry,
                 const VisibleCells& cells, std::span<const CostBox> bricks, const CostSettings& settings) {
  CostMap map;
  map.resolution = settings.resolution;
  map.size = map_size(image, settings.resolution);
  map.region = settings.region.value_or(scene::PixelRect{0, 0, map.size.width, map.size.height});
  map.cost.assign(
      static_cast<std::size_t>(std::max(0, map.width())) * static_cast<std::size_t>(std::max(0, map.height())), 0);
  if (map.cost.empty()) return map;
  const Costs costs(camera, image, geometry, settings, map.region);
  const std::span<const CostBox> boxes = settings.method == CostMethod::visited ? std::span<const CostBox>() : bricks;
  std::vector<Outline> outlines(boxes.size());
  tbb::parallel_for(std::size_t{0}, boxes.size(), [&](std::size_t i) { outlines[i] = costs.outline(boxes[i]); });
  const int bands = (map.height() + band_rows - 1) / band_rows;
  tbb::parallel_for(0, bands, [&](int number) {
    const int y0 = map.region.y0 + number * band_rows, y1 = std::min(map.region.y1, y0 + band_rows);
    Band band{y0, y1, std::vector<double>(static_cast<std::size_t>(y1 - y0) * static_cast<std::size_t>(map.width()))};
    if (settings.method == CostMethod::visited) costs.add_visited(cells, band);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Outline& o = outlines[i];
      if (o.behind_eye || settings.method == CostMethod::accurate)
        costs.add_way(boxes[i], o, band);
      else if (settings.method == CostMethod::backface)
        costs.add_back_faces(boxes[i], o, band);
      else
        costs.add_splat(o, band);
    }
    std::uint32_t* out =
        map.cost.data() + static_cast<std::size_t>(y0 - map.region.y0) * static_cast<std::size_t>(map.width());
    for (const double c : band.cost) *out++ = static_cast<std::uint32_t>(std::min(std::lround(c * units), 0xffffffffL));
  });
  return map;
}

}  // namespace tessera::volume
