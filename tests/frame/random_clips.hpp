// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "api/random_cases.hpp"
#include "scene/selection.hpp"

namespace tessera::frame {

inline glm::dvec3 any_vertex(Random& random, const scene::TetMesh& mesh) {
  return mesh.positions[static_cast<std::size_t>(random.below(static_cast<int>(mesh.positions.size())))];
}

struct RandomView {
  scene::Camera camera;
  double extent;  ///< diagonal of the mesh's box
};

/// A view from a random place outside the mesh. The mesh fills much of the image.
inline RandomView random_view(Random& random, const scene::TetMesh& mesh) {
  const scene::Box box = scene::bounds(mesh);
  RandomView view{{}, glm::length(box.high - box.low)};
  scene::Camera& camera = view.camera;
  camera.focal_point = (box.low + box.high) / 2.0;
  camera.position = camera.focal_point + 4 * view.extent * random.direction();
  camera.view_up = random.direction();
  camera.projection = random.chance(0.5) ? scene::ProjectionKind::perspective : scene::ProjectionKind::orthographic;
  camera.parallel_scale = view.extent * random.uniform(0.4, 0.8);
  camera.view_angle = random.uniform(12, 26);
  return view;
}

/// Half-spaces of some kind that cut a mesh in [-1, 1]^3, or miss it; `words` describes the kind.
inline std::vector<HalfSpace> random_clip(Random& random, const scene::TetMesh& mesh, std::string& words) {
  std::vector<HalfSpace> clip;
  const auto add_box = [&](const glm::dvec3& low, const glm::dvec3& high) {
    for (const HalfSpace& side : half_spaces_of({low, high})) clip.push_back(side);
  };
  switch (random.below(6)) {
    case 0:
      words = std::string("a plane");
      clip.push_back({random.uniform(0, 0.8) * random.direction(), random.power(-3, 3) * random.direction()});
      break;
    case 1:
      words = std::string("planes through vertices");
      for (int plane = 0; plane < 2; ++plane) clip.push_back({any_vertex(random, mesh), random.direction()});
      break;
    case 2: {
      words = std::string("a plane in a face");
      const scene::Tet& tet = mesh.tets[static_cast<std::size_t>(random.below(static_cast<int>(mesh.tets.size())))];
      const glm::dvec3 a = mesh.positions[tet[0]], b = mesh.positions[tet[1]], c = mesh.positions[tet[2]];
      clip.push_back({a, glm::cross(b - a, c - a)});
      break;
    }
    case 3:
      words = std::string("planes that miss");
      clip.push_back({{2, 2, 2}, {-1, -1, -1}});
      clip.push_back({{-1, -1, -1}, {0, 1, 0}});
      break;
    case 4: {
      words = std::string("a box");
      const glm::dvec3 a = random.uniform(0.1, 0.9) * random.direction(), half(random.uniform(0.05, 0.7));
      add_box(a - half, a + half);
      break;
    }
    default: {
      words = std::string("a small box");
      const glm::dvec3 a = any_vertex(random, mesh) * 0.9, half(random.power(-5, -1));
      add_box(a - half, a + half);
      if (random.chance(0.5)) clip.push_back({a, random.direction()});
      break;
    }
  }
  return clip;
}

}  // namespace tessera::frame
