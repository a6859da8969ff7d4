// SPDX-License-Identifier: BSD-3-Clause
#include "reference/reference.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <tuple>
#include <unordered_set>

#include "reference/integral.hpp"
#include "reference/kept_interval.hpp"
#include "scene/error.hpp"
#include "scene/threads.hpp"

namespace tessera::reference {
namespace {

/// Number of pixels that one task renders in one pass over the tets: enough to amortize the pass, but few enough that
/// their segments fit into memory.
constexpr std::size_t pixels_per_pass = 256;

bool row_major_less(const PixelIndex& a, const PixelIndex& b) { return std::tie(a.y, a.x) < std::tie(b.y, b.x); }

/// Return the first pixel whose centre is not left of (above) `coordinate`, and the last whose centre is not right of
/// (below) it.
int first_pixel(double coordinate) { return static_cast<int>(std::clamp(std::ceil(coordinate - 0.5), -1.0, 1e6)); }
int last_pixel(double coordinate) { return static_cast<int>(std::clamp(std::floor(coordinate - 0.5), -1.0, 1e6)); }

void sort_front_to_back(std::vector<RaySegment>& segments) {
  std::sort(segments.begin(), segments.end(), [](const RaySegment& a, const RaySegment& b) {
    return std::tie(a.front, a.back, a.tet) < std::tie(b.front, b.back, b.tet);
  });
}

}  // namespace

Reference::Reference(const scene::TetMeshView& mesh, const scene::Camera& camera, scene::ImageSize size,
                     const scene::TransferFunction& transfer_function, scene::Emission emission,
                     const Surfaces& surfaces, std::span<const scene::HalfSpace> kept,
                     const std::optional<scene::Shading>& shading)
    : mesh_(mesh),
      size_((scene::validate(camera), scene::validate(size), size)),
      knots_(transfer_function.knots().begin(), transfer_function.knots().end()),
      emission_(emission),
      kept_(kept.begin(), kept.end()),
      view_(camera, size),
      surfaces_(by_value(surfaces, transfer_function)),
      light_(surfaces.light) {
  if (knots_.empty()) throw scene::bad_input("transfer function: no knots; give at least one");
  scene::validate(mesh, "mesh");
  if (shading) matter_light_.emplace(*shading, camera, emission);
  vertices_.reserve(mesh.positions.size());
  for (const glm::dvec3& p : mesh.positions) vertices_.push_back(view_.project(p));
  boxes_.reserve(mesh.tets.size());
  for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet) boxes_.push_back(box(tet));
  if (!surfaces.has_faces()) return;
  function_ = transfer_function;
  for (const BoundarySurface& boundary : surfaces.boundary) boundary_.push_back({boundary.color, boundary.opacity});
  if (!boundary_.empty()) open_ = open_faces(mesh);
  project(surfaces);
}

void Reference::project(const Surfaces& surfaces) {
  const glm::dvec3 light_grey(0.6);
  for (const TriangleSurface& surface : surfaces.triangles) {
    const TriangleMesh& mesh = *surface.mesh;
    const bool by_field = !surface.color && !mesh.values.empty();
    paints_.push_back({by_field ? std::nullopt : std::optional(surface.color.value_or(light_grey)), surface.opacity});
    for (const auto& index : mesh.triangles) {
      ProjectedTriangle triangle{};
      std::array<ProjectedVertex, 3> vertices;
      for (std::size_t i = 0; i < 3; ++i) {
        vertices[i] = view_.project(mesh.points[index[i]]);
        triangle.corners[i] = {vertices[i], mesh.values.empty() ? 0 : mesh.values[index[i]]};
      }
      triangle.normal = normal_of(mesh.points[index[0]], mesh.points[index[1]], mesh.points[index[2]]);
      triangle.paint = paints_.size() - 1;
      triangles_.push_back(triangle);
      triangle_boxes_.push_back(box(vertices));
    }
  }
}

std::array<Corner, 4> Reference::corners(std::size_t tet) const {
  scene::Tet order = mesh_.tets[tet];
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const glm::dvec3 &p = mesh_.positions[i], &q = mesh_.positions[j];
    return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
  });
  std::array<Corner, 4> corners;
  for (int i = 0; i < 4; ++i) {
    const bool cell_data = mesh_.association == scene::Association::cell;
    corners[i] = {vertices_[order[i]], mesh_.scalars[cell_data ? tet : order[i]]};
  }
  return corners;
}

Reference::Box Reference::box(std::size_t tet) const {
  std::array<ProjectedVertex, 4> vertices;
  for (std::size_t i = 0; i < 4; ++i) vertices[i] = vertices_[mesh_.tets[tet][i]];
  return box(vertices);
}

Reference::Box Reference::box(std::span<const ProjectedVertex> vertices) const {
  const double infinity = std::numeric_limits<double>::infinity();
  Box box{infinity, infinity, -infinity, -infinity};
  double least_w = infinity, largest_w = 0, deepest = -infinity;
  for (const ProjectedVertex& v : vertices) {
    const glm::dvec3& h = v.homogeneous;
    least_w = std::min(least_w, h.z);
    largest_w = std::max(largest_w, std::abs(h.z));
    deepest = std::max(deepest, v.depth);
    box.x_low = std::min(box.x_low, h.x / h.z), box.x_high = std::max(box.x_high, h.x / h.z);
    box.y_low = std::min(box.y_low, h.y / h.z), box.y_high = std::max(box.y_high, h.y / h.z);
  }
  if (!(deepest > 0)) return {infinity, infinity, -infinity, -infinity};  // the tet is behind the eye
  if (!(least_w > 1e-6 * largest_w))
    return {-infinity, -infinity, infinity, infinity};  // the tet is at or across the
                                                        // plane of the eye
  // Both the quotients and lines of sight are rounded; the margin is larger than that.
  const double x_margin = 1e-7 + 1e-9 * std::max(std::abs(box.x_low), std::abs(box.x_high));
  const double y_margin = 1e-7 + 1e-9 * std::max(std::abs(box.y_low), std::abs(box.y_high));
  return {box.x_low - x_margin, box.y_low - y_margin, box.x_high + x_margin, box.y_high + y_margin};
}

void Reference::trace(std::size_t tet, const std::array<Corner, 4>& corners, double x, double y,
                      std::vector<RaySegment>& segments) const {
  const std::optional<Stretch> inside = intersect(corners, x, y);
  if (!inside) return;
  const DepthInterval kept = kept_interval(view_, x, y, kept_);
  const std::optional<Stretch> seen = clipped(*inside, kept.nearest, kept.farthest);
  if (!seen) return;
  const double length = (seen->back - seen->front) * view_.length_per_depth(x, y);
  segments.push_back({seen->front, seen->back, length, seen->scalar_front, seen->scalar_back, seen->corner_scalar,
                      seen->change_front, seen->change_back, tet, seen->face_front, seen->face_back});
}

std::vector<TriangleCrossing> Reference::triangles_on(double x, double y) const {
  std::vector<TriangleCrossing> found;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Box& b = triangle_boxes_[i];
    if (!(b.x_low <= x && x <= b.x_high && b.y_low <= y && y <= b.y_high)) continue;
    if (const std::optional<TriangleHit> hit = intersect(triangles_[i].corners, x, y))
      found.push_back({*hit, &triangles_[i]});
  }
  return found;
}

glm::dvec3 Reference::face_normal(std::size_t tet, int face) const {
  std::array<glm::dvec3, 4> corners;
  for (std::size_t i = 0; i < 4; ++i) corners[i] = mesh_.positions[mesh_.tets[tet][i]];
  std::sort(corners.begin(), corners.end(),
            [](const glm::dvec3& p, const glm::dvec3& q) { return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z); });
  std::array<glm::dvec3, 3> of_face;
  for (int i = 0, k = 0; i < 4; ++i)
    if (i != face) of_face[static_cast<std::size_t>(k++)] = corners[static_cast<std::size_t>(i)];
  return normal_of(of_face[0], of_face[1], of_face[2]);
}

std::vector<RaySegment> Reference::segments(double x, double y) const {
  std::vector<RaySegment> segments;
  for (std::size_t tet = 0; tet < boxes_.size(); ++tet) {
    const Box& b = boxes_[tet];
    if (b.x_low <= x && x <= b.x_high && b.y_low <= y && y <= b.y_high) trace(tet, corners(tet), x, y, segments);
  }
  sort_front_to_back(segments);
  return segments;
}

Pixel Reference::pixel(double x, double y) const { return shaded(segments(x, y), x, y); }

std::vector<Pixel> Reference::layers(double x, double y, const Peel& peel) const {
  return layers(segments(x, y), x, y, peel);
}

std::vector<Pixel> Reference::pixels(std::span<const PixelIndex> wanted, int threads) const {
  std::vector<Pixel> result(wanted.size());
  each_ray(wanted, threads, [&](std::size_t i, std::span<const RaySegment> segments) {
    result[i] = shaded(segments, wanted[i].x + 0.5, wanted[i].y + 0.5);
  });
  return result;
}

std::vector<std::vector<Pixel>> Reference::layers(std::span<const PixelIndex> wanted, const Peel& peel,
                                                  int threads) const {
  std::vector<std::vector<Pixel>> result(wanted.size());
  each_ray(wanted, threads, [&](std::size_t i, std::span<const RaySegment> segments) {
    result[i] = layers(segments, wanted[i].x + 0.5, wanted[i].y + 0.5, peel);
  });
  return result;
}

void Reference::each_ray(std::span<const PixelIndex> wanted, int threads,
                         const std::function<void(std::size_t, std::span<const RaySegment>)>& take) const {
  std::vector<std::size_t> order(wanted.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return row_major_less(wanted[a], wanted[b]); });

  const auto pass = [&](std::span<const std::size_t> some) {
    std::vector<std::vector<RaySegment>> segments(some.size());
    const auto first_at_or_after = [&](PixelIndex p) {
      return std::lower_bound(some.begin(), some.end(), p,
                              [&](std::size_t i, const PixelIndex& q) { return row_major_less(wanted[i], q); });
    };
    for (std::size_t tet = 0; tet < boxes_.size(); ++tet) {
      const int x_first = first_pixel(boxes_[tet].x_low), x_last = last_pixel(boxes_[tet].x_high);
      const int y_first = first_pixel(boxes_[tet].y_low), y_last = last_pixel(boxes_[tet].y_high);
      if (y_last < wanted[some.front()].y || y_first > wanted[some.back()].y) continue;
      const std::array<Corner, 4> tet_corners = corners(tet);
      for (auto i = first_at_or_after({x_first, y_first}); i != some.end() && wanted[*i].y <= y_last;) {
        const PixelIndex p = wanted[*i];
        if (p.x < x_first) {
          i = first_at_or_after({x_first, p.y});
        } else if (p.x > x_last) {
          i = first_at_or_after({x_first, p.y + 1});
        } else {
          trace(tet, tet_corners, p.x + 0.5, p.y + 0.5, segments[static_cast<std::size_t>(i - some.begin())]);
          ++i;
        }
      }
    }
    for (std::size_t i = 0; i < some.size(); ++i) {
      sort_front_to_back(segments[i]);
      take(some[i], segments[i]);
    }
  };

  tbb::task_arena arena(scene::threads_for(threads));
  arena.execute([&] {
    const std::size_t passes = (order.size() + pixels_per_pass - 1) / pixels_per_pass;
    tbb::parallel_for(std::size_t{0}, passes, [&](std::size_t i) {
      const std::size_t begin = i * pixels_per_pass;
      pass(std::span(order).subspan(begin, std::min(pixels_per_pass, order.size() - begin)));
    });
  });
}

std::vector<Pixel> Reference::image(int threads) const { return pixels(all_pixels(size_), threads); }

std::vector<Pixel> RayReference::pixels(std::span<const PixelIndex> wanted, int threads) const {
  std::vector<Pixel> result(wanted.size());
  tbb::task_arena arena(scene::threads_for(threads));
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, wanted.size(),
                      [&](std::size_t i) { result[i] = pixel(wanted[i].x + 0.5, wanted[i].y + 0.5); });
  });
  return result;
}

std::vector<PixelIndex> all_pixels(scene::ImageSize size) {
  std::vector<PixelIndex> pixels;
  pixels.reserve(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) pixels.push_back({x, y});
  return pixels;
}

}  // namespace tessera::reference

namespace tessera {
inline namespace v0_1 {

std::vector<PixelIndex> random_pixels(ImageSize size, std::size_t count, std::uint64_t seed) {
  const std::uint64_t width = static_cast<std::uint64_t>(size.width);
  const std::uint64_t total = width * static_cast<std::uint64_t>(size.height);
  if (count >= total) return reference::all_pixels(size);
  // Floyd's algorithm for choosing a subset: Bentley, Floyd, "A Sample of Brilliance", CACM 1987. The bias of the
  // remainder is below 2^-32 for any image.
  std::mt19937_64 random(seed);
  std::unordered_set<std::uint64_t> chosen;
  for (std::uint64_t last = total - count; last < total; ++last)
    if (!chosen.insert(random() % (last + 1)).second) chosen.insert(last);
  std::vector<PixelIndex> pixels;
  pixels.reserve(chosen.size());
  for (const std::uint64_t i : chosen) pixels.push_back({static_cast<int>(i % width), static_cast<int>(i / width)});
  std::sort(pixels.begin(), pixels.end(), reference::row_major_less);
  return pixels;
}

}  // namespace v0_1
}  // namespace tessera
