// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/fields.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

namespace tessera::datasets {

double smooth_field(const glm::dvec3& p) {
  const double s = 0.5 + 0.25 * std::sin(5 * p.x) * std::cos(4 * p.y + p.z) + 0.25 * std::cos(6 * glm::length(p));
  return std::clamp(s, 0.0, 1.0);
}

void sample_smooth_field(scene::TetMesh& mesh) {
  mesh.association = scene::Association::point;
  mesh.scalars.clear();
  mesh.scalars.reserve(mesh.positions.size());
  for (const glm::dvec3& p : mesh.positions) mesh.scalars.push_back(smooth_field(p));
  mesh.field_name = std::string("f");  // not assigned from the literal: g++ 12 then warns of overlap (its bug 105651)
}

}  // namespace tessera::datasets
