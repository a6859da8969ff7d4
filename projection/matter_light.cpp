// SPDX-License-Identifier: BSD-3-Clause
#include "projection/matter_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>
#include <unordered_set>
#include <vector>

#include "projection/surface_crossings.hpp"

namespace tessera::projection {
namespace {

constexpr double nothing = MatterLight::nothing;  // limit of a length, see matter_light.hpp

/// A power with a whole exponent; takes a third of the time of std::pow.
double whole_power(double base, int exponent) {
  double result = 1;
  for (; exponent > 0; exponent /= 2, base *= base)
    if (exponent % 2 != 0) result *= base;
  return result;
}

double brightest_color(const scene::Shading& shading, double color) {
  return color * std::max(shading.ambient + shading.diffuse, 1.0) + shading.specular;
}

}  // namespace

glm::vec3 MeshNormals::of(std::uint32_t tet) const {
  if (mesh_.association == scene::Association::cell) return glm::vec3(0);
  scene::Tet corners = mesh_.tets[tet];
  const auto [low, high] = std::minmax(
      {mesh_.scalars[corners[0]], mesh_.scalars[corners[1]], mesh_.scalars[corners[2]], mesh_.scalars[corners[3]]});
  if (!(high - low > nothing * std::max(std::abs(low), std::abs(high)))) return glm::vec3(0);
  std::sort(corners.begin(), corners.end(), [&](std::uint32_t i, std::uint32_t j) {
    const glm::dvec3 &p = mesh_.positions[i], &q = mesh_.positions[j];
    return std::tuple(p.x, p.y, p.z, mesh_.scalars[i]) < std::tuple(q.x, q.y, q.z, mesh_.scalars[j]);
  });
  return {unit(gradient_direction(mesh_, corners))};
}

void SentNormals::forget(const RaySegments& left) {
  constexpr std::size_t few = 1 << 14;
  if (normals_.size() < 2 * kept_ + few) return;
  std::unordered_map<std::uint32_t, glm::vec3> needed;
  for (std::size_t i = 0; i < left.size; ++i)
    if (const auto found = normals_.find(left.tet(i)); found != normals_.end()) needed.insert(*found);
  normals_ = std::move(needed);
  kept_ = normals_.size();
}

MatterLight::MatterLight(const scene::Shading& shading, const scene::Camera& camera)
    : shading_(shading), to_light_(glm::normalize(shading.to_light)) {
  const scene::ViewBasis basis = scene::view_basis(camera);
  if (shading.camera_light)
    to_light_ = basis.right * to_light_.x + basis.up * to_light_.y - basis.forward * to_light_.z;
  if (shading.shininess == std::floor(shading.shininess) && shading.shininess <= 1024)
    whole_shininess_ = static_cast<int>(shading.shininess);
}

MatterLight::Light MatterLight::on(const glm::vec3& normal, const glm::dvec3& ray) const {
  if (normal == glm::vec3(0)) return {};
  const glm::dvec3 n(normal), half = to_light_ - glm::normalize(ray);
  const double length = glm::length(half), n_l = std::min(std::abs(glm::dot(n, to_light_)), 1.0);
  // A light exactly behind the scene has no halfway vector.
  const double n_h = length > nothing ? std::min(std::abs(glm::dot(n, half)) / length, 1.0) : 0;
  const double shine = whole_shininess_ >= 0 ? whole_power(n_h, whole_shininess_) : std::pow(n_h, shading_.shininess);
  return {shading_.ambient + shading_.diffuse * n_l, shading_.specular * shine};
}

double MatterLight::brightest(double color) const { return brightest_color(shading_, color); }

scene::TransferFunction brightest(const scene::Shading& shading, const scene::TransferFunction& function) {
  std::vector<scene::Knot> knots(function.knots().begin(), function.knots().end());
  for (scene::Knot& knot : knots)
    for (int c = 0; c < 3; ++c) knot.color[c] = brightest_color(shading, knot.color[c]);
  return scene::TransferFunction(std::move(knots));
}

}  // namespace tessera::projection
