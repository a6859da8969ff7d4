// SPDX-License-Identifier: BSD-3-Clause
#include "api/queries/ray_tets.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "scene/camera.hpp"

namespace tessera::api {
namespace {

/// Bits for the half-spaces that contain a point: four bounded by planes through the ray, and the one behind the eye. A
/// tet whose corners are all in one of these half-spaces does not meet the ray, wherever the eye is.
constexpr std::uint8_t left = 1, right = 2, above = 4, below = 8, behind = 16;

class Sides {
 public:
  Sides(const View& view, PixelIndex pixel)
      : position_(view.camera.position),
        basis_(view_basis(view.camera)),
        perspective_(view.camera.projection == ProjectionKind::perspective) {
    const double half_height =
        perspective_ ? std::tan(glm::radians(view.camera.view_angle) / 2) : view.camera.parallel_scale;
    unit_ = 2 * half_height / view.size.height;
    x_ = (pixel.x + 0.5 - 0.5 * view.size.width) * unit_;
    y_ = (0.5 * view.size.height - pixel.y - 0.5) * unit_;
  }
  [[nodiscard]] std::uint8_t of(const glm::dvec3& p) const {
    const glm::dvec3 from = p - position_;
    const double depth = glm::dot(from, basis_.forward), scale = perspective_ ? depth : 1;
    const double u = glm::dot(from, basis_.right) - x_ * scale, v = glm::dot(from, basis_.up) - y_ * scale;
    // The margin is larger than the rounding errors of this computation and of the rays (reference/view.hpp).
    const double margin = 1e-6 * unit_ * std::abs(scale) + 1e-10 * (glm::length(from) + glm::length(p));
    std::uint8_t bits = 0;
    if (u < -margin) bits |= left;
    if (u > margin) bits |= right;
    if (v < -margin) bits |= below;
    if (v > margin) bits |= above;
    if (depth <= 0) bits |= behind;
    return bits;
  }

 private:
  glm::dvec3 position_;
  ViewBasis basis_;
  bool perspective_;
  double unit_, x_, y_;  ///< size of a pixel and position of the ray, in world units; in perspective at depth 1
};

}  // namespace

std::vector<std::uint32_t> tets_near_ray(const scene::TetMeshView& mesh, const View& view, PixelIndex pixel) {
  const Sides sides(view, pixel);
  std::vector<std::uint8_t> outside(mesh.positions.size());
  constexpr std::size_t points_at_once = 1 << 13, tets_at_once = 1 << 16;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, outside.size(), points_at_once), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) outside[i] = sides.of(mesh.positions[i]);
  });
  std::vector<std::vector<std::uint32_t>> found((mesh.tets.size() + tets_at_once - 1) / tets_at_once);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t block) {
    const std::size_t end = std::min((block + 1) * tets_at_once, mesh.tets.size());
    for (std::size_t t = block * tets_at_once; t < end; ++t) {
      const scene::Tet& tet = mesh.tets[t];
      if ((outside[tet[0]] & outside[tet[1]] & outside[tet[2]] & outside[tet[3]]) == 0)
        found[block].push_back(static_cast<std::uint32_t>(t));
    }
  });
  std::vector<std::uint32_t> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

TriangleMesh triangles_near_ray(const TriangleMesh& mesh, const View& view, PixelIndex pixel) {
  const Sides sides(view, pixel);
  std::vector<std::uint8_t> outside;
  outside.reserve(mesh.points.size());
  for (const glm::dvec3& p : mesh.points) outside.push_back(sides.of(p));
  TriangleMesh near{mesh.points, {}, mesh.values};
  for (const auto& triangle : mesh.triangles)
    if ((outside[triangle[0]] & outside[triangle[1]] & outside[triangle[2]]) == 0) near.triangles.push_back(triangle);
  return near;
}

}  // namespace tessera::api
