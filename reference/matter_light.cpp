// SPDX-License-Identifier: BSD-3-Clause
#include "reference/matter_light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "reference/mesh/surface_on_ray.hpp"
#include "scene/error.hpp"

namespace tessera::reference {

MatterLight::MatterLight(const scene::Shading& shading, const scene::Camera& camera, scene::Emission emission)
    : shading_(shading), to_light_(shading.to_light) {
  if (emission != scene::Emission::absorption)
    throw scene::bad_input("shading needs emission in proportion to extinction");
  if (!(glm::length(to_light_) > 0)) throw scene::bad_input("the direction to the light has no length");
  if (shading_.camera_light) {
    const glm::dvec3 forward = glm::normalize(camera.focal_point - camera.position),
                     right = glm::normalize(glm::cross(forward, camera.view_up));
    to_light_ = right * to_light_.x + glm::cross(right, forward) * to_light_.y - forward * to_light_.z;
  }
  to_light_ = glm::normalize(to_light_);
}

Integral::Light MatterLight::in(const scene::TetMeshView& mesh, std::size_t tet, const glm::dvec3& ray) const {
  if (mesh.association == scene::Association::cell) return {};
  constexpr double nothing = 1e-12;
  const scene::Tet& t = mesh.tets[tet];
  const auto [low, high] =
      std::minmax({mesh.scalars[t[0]], mesh.scalars[t[1]], mesh.scalars[t[2]], mesh.scalars[t[3]]});
  if (!(high - low > nothing * std::max(std::abs(low), std::abs(high)))) return {};
  const glm::dvec3 gradient = gradient_in(mesh, tet);
  if (gradient == glm::dvec3(0)) return {};
  const glm::dvec3 normal = glm::normalize(gradient), half = to_light_ - glm::normalize(ray);
  const double n_l = std::abs(glm::dot(normal, to_light_));
  // If the light is exactly opposite to the eye, there is no halfway vector.
  const double n_h = glm::length(half) > nothing ? std::abs(glm::dot(normal, glm::normalize(half))) : 0;
  return {shading_.ambient + shading_.diffuse * n_l, shading_.specular * std::pow(n_h, shading_.shininess)};
}

}  // namespace tessera::reference
