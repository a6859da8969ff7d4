// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "reference/integral.hpp"
#include "scene/camera.hpp"
#include "scene/shading.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::reference {

/// Shading of tets by the gradient of the field in each tet (scene/shading.hpp), implemented separately for the
/// reference.
class MatterLight {
 public:
  /// Throws scene::Error(bad_input) if the direction to the light has length zero, or for light that does not depend on
  /// extinction.
  MatterLight(const scene::Shading& shading, const scene::Camera& camera, scene::Emission emission);

  /// Returns the light in a tet of point data, seen along the direction `ray`, whose length does not matter.
  [[nodiscard]] Integral::Light in(const scene::TetMeshView& mesh, std::size_t tet, const glm::dvec3& ray) const;

 private:
  scene::Shading shading_;
  glm::dvec3 to_light_;  ///< direction to the light in the world, unit length
};

}  // namespace tessera::reference
