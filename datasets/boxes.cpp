// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/boxes.hpp"

#include <cmath>

#include "datasets/fields.hpp"
#include "datasets/kuhn.hpp"
#include "datasets/random.hpp"
#include "datasets/require.hpp"

namespace tessera::datasets {
namespace {

std::uint32_t u32(int n) { return static_cast<std::uint32_t>(n); }

/// Returns a mesh with the vertices of a lattice at place(i, j, k), and scalars from smooth_field.
template <class Place>
scene::TetMesh fill(const Lattice& lattice, Place&& place) {
  scene::TetMesh mesh;
  mesh.positions.reserve(lattice.vertices());
  for (std::uint32_t i = 0; i < lattice.columns(); ++i)
    for (std::uint32_t j = 0; j <= lattice.ny; ++j)
      for (std::uint32_t k = 0; k <= lattice.nz; ++k) mesh.positions.push_back(place(i, j, k));
  sample_smooth_field(mesh);
  mesh.tets = lattice.tets();
  return mesh;
}

}  // namespace

scene::TetMesh cube(int n, double jitter, std::uint64_t seed) {
  require(n >= 1 && n <= 1000, "cube", "n must be in 1 .. 1000");
  require(jitter >= 0 && jitter <= 0.25, "cube", "jitter must be in 0 .. 0.25");
  Random random(seed);
  const std::uint32_t last = u32(n);
  const auto inner = [&](std::uint32_t i) { return i > 0 && i < last; };
  scene::TetMesh mesh = fill(Lattice{last, last, last}, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    glm::dvec3 g(i, j, k);
    if (inner(i) && inner(j) && inner(k))
      for (int axis = 0; axis < 3; ++axis) g[axis] += random.uniform(-jitter, jitter);
    return glm::dvec3(glm::vec3(g / static_cast<double>(n) * 2.0 - 1.0));
  });
  for (double& s : mesh.scalars) s = static_cast<float>(s);
  return mesh;
}

scene::TetMesh regular_split(int nx, int ny, int nz, const glm::dvec3& spacing, const glm::dvec3& origin) {
  for (const int n : {nx, ny, nz}) require(n >= 1 && n <= 1000, "regular", "nx, ny, nz must be in 1 .. 1000");
  require(spacing.x > 0 && spacing.y > 0 && spacing.z > 0, "regular", "spacing must be positive");
  scene::TetMesh mesh =
      fill(Lattice{u32(nx), u32(ny), u32(nz)},
           [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) { return origin + glm::dvec3(i, j, k) * spacing; });
  const glm::dvec3 size = glm::dvec3(nx, ny, nz) * spacing;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    mesh.scalars[v] = smooth_field((mesh.positions[v] - origin) / size * 2.0 - 1.0);
  return mesh;
}

scene::TetMesh graded(int n, double volume_ratio) {
  require(n >= 4 && n <= 1000 && n % 2 == 0, "graded", "n must be even and in 4 .. 1000");
  require(volume_ratio >= 1 && volume_ratio <= 1e15, "graded", "volume-ratio must be in 1 .. 1e15");
  // The n / 2 edges from the centre outwards are each `growth` times as long as the previous one; the ratio of volumes
  // is the cube of the ratio of edges.
  const int half = n / 2;
  const double growth = std::pow(std::cbrt(volume_ratio), 1.0 / (half - 1));
  std::vector<double> at(static_cast<std::size_t>(n) + 1, 0.0);
  double sum = 0, edge = 1;
  for (int i = 1; i <= half; ++i, edge *= growth)
    at[static_cast<std::size_t>(half) + static_cast<std::size_t>(i)] = sum += edge;
  for (int i = 1; i <= half; ++i) {
    const auto middle = static_cast<std::size_t>(half), away = static_cast<std::size_t>(i);
    const std::size_t high = middle + away, low = middle - away;
    at[high] /= sum;
    at[low] = -at[high];
  }
  const std::uint32_t count = u32(n);
  return fill(Lattice{count, count, count},
              [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) { return glm::dvec3(at[i], at[j], at[k]); });
}

scene::TetMesh slivers(int n, double aspect) {
  require(n >= 2 && n <= 500, "slivers", "n must be in 2 .. 500");
  require(aspect >= static_cast<double>(n) * n && aspect <= 1e15, "slivers", "aspect must be in n * n .. 1e15");
  // Interface k is the saddle z = +-e (i - n/2) (j - n/2): all its squares bend in the same direction, so the four
  // corners of each span a tet whose upper edge is one diagonal and whose lower edge is the other. The slabs on both
  // sides use these edges: slab k is a Kuhn split, mirrored in x if k is odd, which alternates the diagonal.
  const double step = 2.0 / n, bend = step / aspect;
  const std::uint32_t last = u32(n);
  const Lattice lattice{last, last, last};
  scene::TetMesh mesh = fill(lattice, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    glm::dvec3 p = glm::dvec3(i, j, k) * step - 1.0;
    if (k > 0 && k < last) p.z += (k % 2 == 1 ? -bend : bend) * (i - 0.5 * n) * (j - 0.5 * n);
    return p;
  });
  mesh.tets.clear();
  for (std::uint32_t k = 0; k < last; ++k)
    for (std::uint32_t i = 0; i < last; ++i)
      for (std::uint32_t j = 0; j < last; ++j) {
        auto c = lattice.corners(i, j, k);
        if (k > 0) mesh.tets.push_back({c[0], c[1], c[2], c[3]});
        if (k % 2 == 1)
          for (std::size_t b = 0; b < 8; b += 2) std::swap(c[b], c[b + 1]);
        append_kuhn(c, mesh.tets);
      }
  orient(mesh);
  return mesh;
}

scene::TetMesh thin_stack(int layers, double width, double thickness) {
  require(layers >= 1 && layers <= 10000000, "stack", "layers must be in 1 .. 10000000");
  require(width > 0 && width <= 0.4, "stack", "width must be in 0 .. 0.4");
  require(thickness > 0 && thickness <= 1e6, "stack", "thickness must be in 0 .. 1e6");
  const double half = 0.5 * width;
  scene::TetMesh mesh = fill(Lattice{1, 1, u32(layers)}, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return glm::dvec3(i == 0 ? -half : half, j == 0 ? -half : half,
                      thickness * (static_cast<double>(k) / layers - 0.5));
  });
  for (std::size_t v = 0; v < mesh.scalars.size(); ++v) {
    const double k = static_cast<double>(v % (static_cast<std::size_t>(layers) + 1));
    mesh.scalars[v] = 0.5 + 0.5 * std::sin(2.3999632297286533 * k);  // the golden angle: neighbours differ
  }

  // The plate has grid lines at the hole's sides, and three more on either side of the hole.
  const double hole = 0.6 * width;
  const std::array<double, 9> lines{-1.0, -0.7, -0.4, -hole, 0, hole, 0.4, 0.7, 1.0};
  const Lattice plate{8, 8, 1};
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const scene::TetMesh shallow = fill(plate, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return glm::dvec3(lines[i], lines[j], (k == 0 ? -0.02 : 0.02) * thickness);
  });
  mesh.positions.insert(mesh.positions.end(), shallow.positions.begin(), shallow.positions.end());
  mesh.scalars.insert(mesh.scalars.end(), shallow.scalars.begin(), shallow.scalars.end());
  for (std::uint32_t i = 0; i < 8; ++i)
    for (std::uint32_t j = 0; j < 8; ++j) {
      if ((i == 3 || i == 4) && (j == 3 || j == 4)) continue;
      auto corners = plate.corners(i, j, 0);
      for (std::uint32_t& c : corners) c += first;
      append_kuhn(corners, mesh.tets);
    }
  return mesh;
}

}  // namespace tessera::datasets
