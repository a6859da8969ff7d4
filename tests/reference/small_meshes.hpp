// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <random>

#include "scene/camera.hpp"
#include "scene/tet_mesh.hpp"
#include "scene/transfer_function.hpp"

/// Meshes of a few cells whose rays are known by other means.
namespace tessera::reference {

using Field = std::function<double(const glm::dvec3&)>;

/// A box of n x n x n cubes, each split into the six tets around its diagonal (Kuhn). Interior vertices are moved by up
/// to `jitter` of a cube's side; with 0.15 no tet is inverted. Point data: the field at the vertices.
inline scene::TetMesh box_of_tets(int n, const glm::dvec3& low, const glm::dvec3& high, const Field& field,
                                  double jitter = 0, unsigned seed = 1) {
  scene::TetMesh mesh;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-jitter, jitter);
  const auto index = [n](int i, int j, int k) { return static_cast<std::uint32_t>(i + (n + 1) * (j + (n + 1) * k)); };
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        glm::dvec3 u(i, j, k);
        if (jitter > 0 && i % n && j % n && k % n) u += glm::dvec3(shift(random), shift(random), shift(random));
        mesh.positions.push_back(low + (high - low) * u / static_cast<double>(n));
        mesh.scalars.push_back(field(mesh.positions.back()));
      }
  constexpr int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        for (const auto& order : orders) {
          std::array<int, 3> at{i, j, k};
          scene::Tet tet;
          tet[0] = index(i, j, k);
          for (int step = 0; step < 3; ++step) {
            ++at[static_cast<std::size_t>(order[step])];
            tet[static_cast<std::size_t>(step) + 1] = index(at[0], at[1], at[2]);
          }
          mesh.tets.push_back(tet);
        }
  return mesh;
}

/// The same mesh with cell data: the field at each tet's centre.
inline scene::TetMesh with_cell_data(scene::TetMesh mesh, const Field& field) {
  mesh.association = scene::Association::cell;
  mesh.scalars.clear();
  for (const scene::Tet& t : mesh.tets)
    mesh.scalars.push_back(
        field((mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]] + mesh.positions[t[3]]) / 4.0));
  return mesh;
}

/// Every tet split into four at an inner point, whose scalar is interpolated: the same linear field.
inline scene::TetMesh split_in_four(const scene::TetMesh& mesh) {
  scene::TetMesh split = mesh;
  split.tets.clear();
  for (const scene::Tet& t : mesh.tets) {
    constexpr std::array<double, 4> weights{0.4, 0.3, 0.2, 0.1};
    glm::dvec3 p(0);
    double scalar = 0;
    for (std::size_t i = 0; i < 4; ++i)
      p += weights[i] * mesh.positions[t[i]], scalar += weights[i] * mesh.scalars[t[i]];
    const auto middle = static_cast<std::uint32_t>(split.positions.size());
    split.positions.push_back(p);
    split.scalars.push_back(scalar);
    for (std::size_t i = 0; i < 4; ++i) {
      scene::Tet part = t;
      part[i] = middle;
      split.tets.push_back(part);
    }
  }
  return split;
}

/// A world ray: its start at planar depth 0, and its direction per unit of planar depth.
struct WorldRay {
  glm::dvec3 origin, direction;
};

inline WorldRay world_ray(const scene::Camera& camera, scene::ImageSize size, double x, double y) {
  const scene::ViewBasis basis = scene::view_basis(camera);
  const double half_height = size.height / 2.0;
  const double across = (x - size.width / 2.0) / half_height, upward = (half_height - y) / half_height;
  if (camera.projection == scene::ProjectionKind::orthographic)
    return {camera.position + camera.parallel_scale * (across * basis.right + upward * basis.up), basis.forward};
  const double slope = std::tan(camera.view_angle * std::acos(-1.0) / 360);
  return {camera.position, basis.forward + slope * (across * basis.right + upward * basis.up)};
}

/// Planar depths between which a ray is inside a box, in front of the eye; empty if low >= high.
struct DepthRange {
  double low = 0, high = std::numeric_limits<double>::infinity();
  [[nodiscard]] double size() const { return std::max(0.0, high - low); }
};

inline DepthRange depths_in_box(const WorldRay& ray, const glm::dvec3& low, const glm::dvec3& high) {
  DepthRange range;
  for (int i = 0; i < 3; ++i) {
    if (ray.direction[i] == 0) {
      if (ray.origin[i] < low[i] || ray.origin[i] > high[i]) return {0, 0};
      continue;
    }
    const double a = (low[i] - ray.origin[i]) / ray.direction[i], b = (high[i] - ray.origin[i]) / ray.direction[i];
    range.low = std::max(range.low, std::min(a, b));
    range.high = std::min(range.high, std::max(a, b));
  }
  return range;
}

inline scene::Camera looking(const glm::dvec3& from, const glm::dvec3& at, scene::ProjectionKind projection,
                             double scale_or_angle, const glm::dvec3& up = {0, 1, 0}) {
  scene::Camera camera;
  camera.position = from;
  camera.focal_point = at;
  camera.view_up = up;
  camera.projection = projection;
  (projection == scene::ProjectionKind::orthographic ? camera.parallel_scale : camera.view_angle) = scale_or_angle;
  return camera;
}

}  // namespace tessera::reference
