// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "datasets/kuhn.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::datasets {

inline double volume(const scene::TetMesh& mesh) {
  double sum = 0;
  for (const scene::Tet& tet : mesh.tets) sum += signed_volume_6(mesh, tet);
  return sum / 6;
}

inline double smallest_volume(const scene::TetMesh& mesh) {
  double least = 1e300;
  for (const scene::Tet& tet : mesh.tets) least = std::min(least, signed_volume_6(mesh, tet) / 6);
  return least;
}

/// Number of faces that belong to one, two and more tets; vertices at different positions count as different.
struct FaceCount {
  std::size_t boundary = 0, shared = 0, wrong = 0;
};

inline FaceCount count_faces(const scene::TetMesh& mesh) {
  std::map<std::tuple<double, double, double>, std::uint32_t> by_place;
  std::vector<std::uint32_t> id;
  for (const glm::dvec3& p : mesh.positions)
    id.push_back(
        by_place.emplace(std::tuple(p.x, p.y, p.z), static_cast<std::uint32_t>(by_place.size())).first->second);
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (const scene::Tet& tet : mesh.tets)
    for (std::size_t skip = 0; skip < 4; ++skip) {
      std::array<std::uint32_t, 3> face{};
      for (std::size_t i = 0, n = 0; i < 4; ++i)
        if (i != skip) face[n++] = id[tet[i]];
      std::sort(face.begin(), face.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end());
  FaceCount count;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t j = i;
    while (j < faces.size() && faces[j] == faces[i]) ++j;
    ++(j - i == 1 ? count.boundary : j - i == 2 ? count.shared : count.wrong);
    i = j;
  }
  return count;
}

}  // namespace tessera::datasets
