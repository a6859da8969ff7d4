// SPDX-License-Identifier: BSD-3-Clause
#include "projection/surface_crossings.hpp"

#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::projection {
namespace {

double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace

glm::dvec3 gradient_direction(const PreparedMesh& prepared, std::size_t tet) {
  return gradient_direction(prepared.mesh(), prepared.tets()[tet]);
}

glm::dvec3 gradient_direction(const scene::TetMeshView& mesh, const scene::Tet& corners) {
  std::array<glm::dvec3, 3> edge;
  std::array<double, 3> change{};
  double size = 0, most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    edge[i] = mesh.positions[corners[i + 1]] - mesh.positions[corners[0]];
    change[i] = mesh.scalars[corners[i + 1]] - mesh.scalars[corners[0]];
    size = std::max(size, largest(edge[i]));
    most = std::max(most, std::abs(change[i]));
  }
  if (!(size > 0) || !(most > 0)) return glm::dvec3(0);
  for (glm::dvec3& e : edge) e /= size;
  return change[0] / most * glm::cross(edge[1], edge[2]) + change[1] / most * glm::cross(edge[2], edge[0]) +
         change[2] / most * glm::cross(edge[0], edge[1]);
}

glm::dvec3 unit(const glm::dvec3& direction) {
  const double size = largest(direction);
  if (!(size > 0)) return glm::dvec3(0);
  const glm::dvec3 of_size_one = direction / size;
  return of_size_one / glm::length(of_size_one);
}

float cosine_between(const glm::dvec3& ray, const glm::dvec3& normal) {
  if (normal == glm::dvec3(0)) return 1;
  return static_cast<float>(std::min(std::abs(glm::dot(ray, unit(normal))) / glm::length(ray), 1.0));
}

}  // namespace tessera::projection
