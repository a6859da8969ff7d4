// SPDX-License-Identifier: BSD-3-Clause
#include "cells/polyhedron_split.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "cells/cell_split.hpp"
#include "cells/convex_hull.hpp"

namespace tessera::cells {

std::optional<SurfaceFill> PolyhedronSplitter::split(std::span<const std::uint32_t> faces,
                                                     std::span<const glm::dvec3> positions) {
  tets_.clear(), added_.clear();
  if (!surface_.set(faces, positions)) return std::nullopt;
  return fill(positions);
}

std::optional<SurfaceFill> PolyhedronSplitter::split_hull(std::span<const std::uint32_t> points,
                                                          std::span<const glm::dvec3> positions) {
  tets_.clear(), added_.clear();
  if (points.size() > most_hull_points) return std::nullopt;
  if (points.empty()) return SurfaceFill::from_corner;
  glm::dvec3 low = positions[points[0]], high = low;
  for (const std::uint32_t v : points) low = glm::min(low, positions[v]), high = glm::max(high, positions[v]);
  // Faces are planar up to the rounding of their corners, which may be floats; thin cells need a smaller tolerance.
  for (const double thickness : {1e-6, 1e-9, 1e-12})
    if (hull_faces(points, positions, thickness * glm::length(high - low), hull_) && surface_.set(hull_, positions))
      return fill(positions);
  return SurfaceFill::from_corner;
}

SurfaceFill PolyhedronSplitter::fill(std::span<const glm::dvec3> positions) {
  const auto own = static_cast<std::uint32_t>(surface_.points().size());
  if (fill_hexahedron()) return SurfaceFill::from_corner;
  const SurfaceFill way = filled_.fill(surface_.points(), surface_.triangles());
  for (const SurfaceTets::Inside& inside : filled_.inside()) added_.push_back(inside.place);
  const auto index = [&](std::uint32_t v) {
    return v < own ? surface_.indices()[v] : static_cast<std::uint32_t>(positions.size()) + (v - own);
  };
  for (const SurfaceTets::LocalTet& t : filled_.tets())
    tets_.push_back({index(t[0]), index(t[1]), index(t[2]), index(t[3])});
  return way;
}

/// Fills a polyhedron that is a hexahedron with the same tets as the cell type hexahedron, five if possible.
bool PolyhedronSplitter::fill_hexahedron() {
  const auto corner = surface_.as_hexahedron();
  if (!corner) return false;
  const std::vector<glm::dvec3>& p = surface_.points();
  split_cell(CellKind::hexahedron, *corner, p, tets_);
  double positive = 0, negative = 0;
  for (const scene::Tet& t : tets_) {
    const double volume = glm::dot(glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]), p[t[3]] - p[t[0]]);
    (volume > 0 ? positive : negative) += std::abs(volume);
  }
  if (std::min(positive, negative) > 1e-10 * std::max(positive, negative)) {
    tets_.clear();
    return false;
  }
  for (scene::Tet& t : tets_)
    for (std::uint32_t& v : t) v = surface_.indices()[v];
  return true;
}

void PolyhedronSplitter::add_values(std::span<const double> values, std::vector<double>& out) {
  for (std::size_t k = 0; k < added_.size(); ++k) {
    seen_places_.clear(), seen_values_.clear();
    for (const std::uint32_t v : filled_.inside()[k].seen) {
      seen_places_.push_back(surface_.points()[v]);
      seen_values_.push_back(values[surface_.indices()[v]]);
    }
    out.push_back(fitted_value(seen_places_, seen_values_, added_[k]));
  }
}

bool PolyhedronSplitter::are_fans(std::span<const std::uint32_t> faces, std::span<const glm::dvec3> positions) {
  return surface_.set(faces, positions) && surface_.are_fans();
}

}  // namespace tessera::cells
