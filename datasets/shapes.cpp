// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/shapes.hpp"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "datasets/fields.hpp"
#include "datasets/kuhn.hpp"
#include "datasets/modify.hpp"
#include "datasets/require.hpp"

namespace tessera::datasets {
namespace {

/// Returns eight tets between the origin (vertex 6) and the octants of |x| + |y| + |z| = 1.
scene::TetMesh octahedron() {
  scene::TetMesh mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0, 0, 0}};
  for (std::uint32_t octant = 0; octant < 8; ++octant)
    mesh.tets.push_back({6, octant & 1, 2 + (octant >> 1 & 1), 4 + (octant >> 2 & 1)});
  orient(mesh);
  sample_smooth_field(mesh);
  return mesh;
}

/// Maps the octahedron |p|_1 <= 1 to the ball along rays: smooth and one-to-one within each octant, so no tet is
/// inverted.
glm::dvec3 to_ball(const glm::dvec3& p) {
  const double sum = std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
  return sum > 0 ? p * (sum / glm::length(p)) : p;
}

}  // namespace

scene::TetMesh single_tet() {
  scene::TetMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  sample_smooth_field(mesh);  // needed for the name of the field
  mesh.scalars = {0, 1.0 / 3, 2.0 / 3, 1};
  return mesh;
}

scene::TetMesh ball(int levels) {
  require(levels >= 0 && levels <= 7, "ball", "levels must be in 0 .. 7");
  scene::TetMesh mesh = octahedron();
  for (int level = 0; level < levels; ++level) mesh = subdivided(mesh);
  for (glm::dvec3& p : mesh.positions) p = to_ball(p);
  sample_smooth_field(mesh);
  return mesh;
}

scene::TetMesh annulus(int n, bool seam) {
  require(n >= 8 && n <= 2000, "annulus", "n must be in 8 .. 2000");
  const auto around = static_cast<std::uint32_t>(n), across = around / 8;
  const Lattice lattice{around, across, across, !seam};
  scene::TetMesh mesh;
  for (std::uint32_t i = 0; i < lattice.columns(); ++i)
    for (std::uint32_t j = 0; j <= across; ++j)
      for (std::uint32_t k = 0; k <= across; ++k) {
        // With i % around, the seam's two sides have exactly equal positions.
        const double angle = -2 * std::acos(-1.0) * (i % around) / n, radius = 0.5 + 0.5 * j / across;
        mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.5 * k / across - 0.25);
      }
  mesh.tets = lattice.tets();
  orient(mesh);
  sample_smooth_field(mesh);
  return mesh;
}

scene::TetMesh shells(int count, int levels, int layers) {
  require(count >= 1 && count <= 20, "shells", "count must be in 1 .. 20");
  require(levels >= 0 && levels <= 8, "shells", "levels must be in 0 .. 8");
  require(layers >= 1 && layers <= 1000, "shells", "layers must be in 1 .. 1000");

  // The triangles of the sphere are those of the octahedron, divided 1:4 by barycentric coordinates, with coincident
  // vertices merged.
  const std::uint32_t n = 1u << levels;
  std::vector<glm::dvec3> directions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  // A vertex is an integer point with |x| + |y| + |z| = n; a dense table maps it to its index.
  const std::size_t side = 2 * n + 1;
  std::vector<std::uint32_t> known(side * side * 2, ~0u);
  const auto vertex = [&](const glm::ivec3& q) {
    const auto shifted = [&](int c) {
      return static_cast<std::size_t>(std::int64_t{c} + static_cast<std::int64_t>(n));
    };
    std::uint32_t& index = known[(shifted(q.x) * side + shifted(q.y)) * 2 + (q.z < 0 ? 1 : 0)];
    if (index == ~0u) {
      index = static_cast<std::uint32_t>(directions.size());
      directions.push_back(glm::normalize(glm::dvec3(q)));
    }
    return index;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const glm::ivec3 sign((octant & 1) ? -1 : 1, (octant & 2) ? -1 : 1, (octant & 4) ? -1 : 1);
    const int m = static_cast<int>(n);
    const auto at = [&](int x, int y) { return vertex(sign * glm::ivec3(x, y, m - x - y)); };
    for (int x = 0; x < m; ++x)
      for (int y = 0; x + y < m; ++y) {
        triangles.push_back({at(x, y), at(x + 1, y), at(x, y + 1)});
        if (x + y + 1 < m) triangles.push_back({at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
      }
  }

  scene::TetMesh mesh;
  const auto per_sphere = static_cast<std::uint32_t>(directions.size());
  for (int shell = 0; shell < count; ++shell)
    for (int layer = 0; layer <= layers; ++layer) {
      // Shell s fills the outer half of its share of the radius, so the innermost starts at 1 / (2 count).
      const double radius = (shell + 0.5 + 0.5 * layer / layers) / count;
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const glm::dvec3& d : directions) mesh.positions.push_back(radius * d);
      if (layer == 0) continue;
      for (const auto& t : triangles) {
        std::array<std::uint32_t, 3> low{}, high{};
        for (std::size_t c = 0; c < 3; ++c) {
          high[c] = first + t[c];
          low[c] = high[c] - per_sphere;
        }
        append_prism(low, high, mesh.tets);
      }
    }
  orient(mesh);
  sample_smooth_field(mesh);
  return mesh;
}

scene::TetMesh cyclic_bars(int n) {
  require(n >= 1 && n <= 100000, "bars", "n must be in 1 .. 100000");
  // Bar b extends along a side of a triangle in the xy plane, past its corners, and rises from z = -0.3 to 0.3. At each
  // corner, the end of one bar is above the start of the next.
  scene::TetMesh mesh;
  const Lattice lattice{static_cast<std::uint32_t>(n), 1, 1};
  for (int bar = 0; bar < 3; ++bar) {
    const double angle = 2 * std::acos(-1.0) * bar / 3;
    const glm::dvec3 along(std::cos(angle), std::sin(angle), 0), aside(-along.y, along.x, 0);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j < 2; ++j)
        for (int k = 0; k < 2; ++k) {
          const double u = 2.0 * i / n - 1;
          const glm::dvec3 middle = along * (0.95 * u) - aside * 0.4 + glm::dvec3(0, 0, 0.3 * u);
          mesh.positions.push_back(middle + aside * (0.2 * j - 0.1) + glm::dvec3(0, 0, 0.2 * k - 0.1));
        }
    for (const scene::Tet& tet : lattice.tets())
      mesh.tets.push_back({first + tet[0], first + tet[1], first + tet[2], first + tet[3]});
  }
  orient(mesh);
  sample_smooth_field(mesh);
  return mesh;
}

}  // namespace tessera::datasets
