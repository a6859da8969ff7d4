// SPDX-License-Identifier: BSD-3-Clause
#include "projection/prepared_mesh.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <tuple>

#include "scene/error.hpp"

namespace tessera::projection {
namespace {

constexpr std::size_t tets_a_task = 4096;

/// Canonical order of corners; equal positions are ordered by index.
class CornerOrder {
 public:
  explicit CornerOrder(const scene::TetMeshView& mesh) : positions_(mesh.positions) {}
  bool operator()(std::uint32_t a, std::uint32_t b) const {
    const glm::dvec3 &p = positions_[a], &q = positions_[b];
    return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
  }

 private:
  std::span<const glm::dvec3> positions_;
};

void order(std::span<scene::Tet> tets, const CornerOrder& before) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tets.size(), tets_a_task), [&](const auto& range) {
    for (std::size_t t = range.begin(); t != range.end(); ++t) {
      scene::Tet& tet = tets[t];
      const auto exchange = [&](int i, int j) {
        if (before(tet[j], tet[i])) std::swap(tet[i], tet[j]);
      };
      exchange(0, 1), exchange(2, 3), exchange(0, 2), exchange(1, 3), exchange(1, 2);
    }
  });
}

bool ordered(std::span<const scene::Tet> tets, const CornerOrder& before) {
  std::atomic<bool> all = true;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tets.size(), tets_a_task), [&](const auto& range) {
    for (std::size_t t = range.begin(); t != range.end() && all.load(std::memory_order_relaxed); ++t)
      if (!std::is_sorted(tets[t].begin(), tets[t].end(), before)) all.store(false, std::memory_order_relaxed);
  });
  return all;
}

}  // namespace

void order_corners(scene::TetMesh& mesh) { order(mesh.tets, CornerOrder(mesh)); }

PreparedMesh::PreparedMesh(const scene::TetMeshView& mesh) : mesh_(mesh), tets_(mesh.tets) {
  if (mesh.tets.size() > std::numeric_limits<std::uint32_t>::max())
    throw scene::bad_input("mesh: more than 4294967295 tets in one process; split it into pieces");
  const CornerOrder before(mesh);
  if (!ordered(mesh.tets, before)) {
    ordered_.assign(mesh.tets.begin(), mesh.tets.end());
    order(ordered_, before);
    tets_ = ordered_;
  }
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
  if (mesh_.association == scene::Association::cell) return {mesh_.scalars[tet], mesh_.scalars[tet]};
  const scene::Tet& t = mesh_.tets[tet];
  const double a = mesh_.scalars[t[0]], b = mesh_.scalars[t[1]], c = mesh_.scalars[t[2]], d = mesh_.scalars[t[3]];
  // This avoids std::minmax of a list, which has unpredictable branches.
  return {std::min(std::min(a, b), std::min(c, d)), std::max(std::max(a, b), std::max(c, d))};
}

}  // namespace tessera::projection
