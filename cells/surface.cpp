// SPDX-License-Identifier: BSD-3-Clause
#include "cells/surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>

#include "cells/polygon_triangles.hpp"
#include "scene/error.hpp"

namespace tessera::cells {
namespace {

struct PositionHash {
  std::size_t operator()(const glm::dvec3& p) const {
    std::size_t h = 0;
    for (int k = 0; k < 3; ++k) h = (h ^ std::bit_cast<std::uint64_t>(p[k])) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
    return h;
  }
};

/// Whether corners are in one plane within 10^-8 of their distance, which is TetGen's own tolerance.
bool is_flat(const Polygon& polygon, const std::vector<glm::dvec3>& points) {
  const glm::dvec3 first = points[polygon.front()];
  glm::dvec3 area(0);
  double longest = 0;
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    const glm::dvec3 a = points[polygon[k]] - first, b = points[polygon[k + 1]] - first;
    area += glm::cross(a, b);
    longest = std::max({longest, glm::length(a), glm::length(b)});
  }
  const double length = glm::length(area);
  return std::ranges::all_of(
      polygon, [&](std::uint32_t v) { return std::abs(glm::dot(area, points[v] - first)) <= 1e-8 * longest * length; });
}

}  // namespace

void cut_warped_facets(Surface& surface) {
  PolygonTriangles cutter;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Facet> facets;
  facets.reserve(surface.facets.size());
  for (Facet& facet : surface.facets) {
    if (facet.polygons.size() != 1 || facet.polygons.front().size() < 4 || !facet.holes.empty() ||
        is_flat(facet.polygons.front(), surface.points)) {
      facets.push_back(std::move(facet));
      continue;
    }
    triangles.clear();
    cutter.cut(facet.polygons.front(), surface.points, triangles);
    for (const auto& t : triangles) facets.push_back({{{t[0], t[1], t[2]}}, {}});
  }
  surface.facets = std::move(facets);
}

void merge_coincident_points(Surface& surface) {
  std::unordered_map<glm::dvec3, std::uint32_t, PositionHash> place;
  place.reserve(surface.points.size());
  std::vector<std::uint32_t> merged(surface.points.size());
  std::vector<std::uint32_t> kept;
  for (std::uint32_t v = 0; v < merged.size(); ++v) {
    const auto [found, is_new] = place.try_emplace(surface.points[v] + 0.0, static_cast<std::uint32_t>(kept.size()));
    if (is_new) kept.push_back(v);
    merged[v] = found->second;
  }
  for (std::size_t k = 0; k < kept.size(); ++k) {
    surface.points[k] = surface.points[kept[k]] + 0.0;
    for (std::vector<double>& values : surface.attributes) values[k] = values[kept[k]];
  }
  surface.points.resize(kept.size());
  for (std::vector<double>& values : surface.attributes) values.resize(kept.size());

  for (Facet& facet : surface.facets)
    for (Polygon& polygon : facet.polygons) {
      for (std::uint32_t& v : polygon) v = merged[v];
      polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
      while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
    }
  std::erase_if(surface.facets, [](const Facet& f) { return f.polygons.size() == 1 && f.polygons.front().size() < 3; });
}

void require_closed(const Surface& surface, const std::string& source) {
  std::unordered_map<std::uint64_t, std::uint32_t> uses;
  for (const Facet& facet : surface.facets) {
    if (facet.polygons.size() != 1 || !facet.holes.empty()) return;
    const Polygon& polygon = facet.polygons.front();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::uint64_t a = polygon[k], b = polygon[(k + 1) % polygon.size()];
      ++uses[std::min(a, b) << 32 | std::max(a, b)];
    }
  }
  std::uint64_t open = 0, first = UINT64_MAX;
  for (const auto& [edge, count] : uses)
    if (count == 1) {
      ++open;
      first = std::min(first, edge);
    }
  if (open == 0) return;
  const glm::dvec3 p = surface.points[first >> 32], q = surface.points[first & UINT32_MAX];
  throw scene::bad_input(
      fmt::format("{}: the surface is not closed: {} edges have only one face, one of them from ({:.6g}, {:.6g}, "
                  "{:.6g}) to ({:.6g}, {:.6g}, {:.6g}); close its holes",
                  source, open, p.x, p.y, p.z, q.x, q.y, q.z));
}

double enclosed_volume(const Surface& surface) {
  if (surface.points.empty()) return 0;
  const glm::dvec3 origin = surface.points.front();
  double six_volumes = 0;
  for (const Facet& facet : surface.facets)
    for (const Polygon& polygon : facet.polygons)
      for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
        six_volumes +=
            glm::dot(surface.points[polygon[0]] - origin,
                     glm::cross(surface.points[polygon[k]] - origin, surface.points[polygon[k + 1]] - origin));
  return std::abs(six_volumes) / 6;
}

}  // namespace tessera::cells
