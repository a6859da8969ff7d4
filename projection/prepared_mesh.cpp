#include "projection/prepared_mesh.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "scene/error.hpp"

namespace tessera::projection {

PreparedMesh::PreparedMesh(const scene::TetMesh& mesh) : mesh_(&mesh), permutation_(mesh.tets.size()) {
  if (mesh.tets.size() > std::numeric_limits<std::uint32_t>::max())
    throw scene::bad_input("mesh: more than 4294967295 tets in one process; split it into pieces");
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    const glm::dvec3 &p = mesh.positions[a], &q = mesh.positions[b];
    return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.tets.size(), 4096), [&](const auto& range) {
    for (std::size_t t = range.begin(); t != range.end(); ++t) {
      const scene::Tet& tet = mesh.tets[t];
      std::array<std::uint8_t, 4> corner{0, 1, 2, 3};
      const auto order = [&](int i, int j) {
        if (before(tet[corner[j]], tet[corner[i]])) std::swap(corner[i], corner[j]);
      };
      order(0, 1), order(2, 3), order(0, 2), order(1, 3), order(1, 2);
      permutation_[t] = static_cast<std::uint8_t>(corner[0] | (corner[1] << 2) | (corner[2] << 4) | (corner[3] << 6));
    }
  });
  block_bounds_.resize((mesh.tets.size() + block_tets - 1) / block_tets);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, block_bounds_.size(), 64), [&](const auto& range) {
    for (std::size_t b = range.begin(); b != range.end(); ++b) {
      std::array<double, 2> bounds = scalar_bounds(b * block_tets);
      const std::size_t end = std::min((b + 1) * block_tets, mesh.tets.size());
      for (std::size_t t = b * block_tets + 1; t < end; ++t) {
        const auto [low, high] = scalar_bounds(t);
        bounds = {std::min(bounds[0], low), std::max(bounds[1], high)};
      }
      block_bounds_[b] = bounds;
    }
  });
  scalars_are_floats_ = std::all_of(mesh.scalars.begin(), mesh.scalars.end(),
                                    [](double s) { return static_cast<double>(static_cast<float>(s)) == s; });
}

std::array<double, 2> PreparedMesh::scalar_bounds(std::size_t tet) const {
  if (mesh_->association == scene::Association::cell) return {mesh_->scalars[tet], mesh_->scalars[tet]};
  const scene::Tet& t = mesh_->tets[tet];
  const auto [low, high] =
      std::minmax({mesh_->scalars[t[0]], mesh_->scalars[t[1]], mesh_->scalars[t[2]], mesh_->scalars[t[3]]});
  return {low, high};
}

}  // namespace tessera::projection
