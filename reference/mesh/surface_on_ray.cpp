// SPDX-License-Identifier: BSD-3-Clause
#include "reference/mesh/surface_on_ray.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

namespace tessera::reference {
namespace {

// Tolerance, relative to the field's magnitude in a cell, within which the field on a clipping plane counts as equal to
// a surface's value. A ray meets the plane with an error of 1e-12 of the depth, because vertices are projected to
// pixels in double.
constexpr double level = 1e-10;

using Vector = glm::vec<3, long double>;

/// Returns the gradient times six times the tet's volume, with either sign, by Cramer's rule for the system whose rows
/// are the tet's edges from one corner.
Vector scaled_gradient(const scene::TetMeshView& mesh, std::size_t tet) {
  const scene::Tet& t = mesh.tets[tet];
  const Vector a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]), d(mesh.positions[t[3]]);
  // The barycentric coordinate of each corner increases along the normal of the opposite face, in proportion to the
  // area of the face. The sum of all four coordinates is constant.
  const auto above_first = [&](std::size_t i) {
    return static_cast<long double>(mesh.scalars[t[i]]) - mesh.scalars[t[0]];
  };
  return above_first(1) * glm::cross(c - a, d - a) + above_first(2) * glm::cross(d - a, b - a) +
         above_first(3) * glm::cross(b - a, c - a);
}

}  // namespace

std::vector<SurfaceOfValue> by_value(const Surfaces& surfaces, const scene::TransferFunction& function) {
  std::vector<SurfaceOfValue> sorted;
  for (const IsoSurface& iso : surfaces.iso)
    sorted.push_back({iso.value, iso.color.value_or(function.evaluate(iso.value).color), iso.opacity});
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const SurfaceOfValue& a, const SurfaceOfValue& b) { return a.value < b.value; });
  return sorted;
}

std::vector<SurfaceCrossing> surface_crossings(std::span<const SurfaceOfValue> surfaces,
                                               const std::array<Corner, 4>& corners, double x, double y,
                                               const KeptDepths& kept) {
  std::vector<SurfaceCrossing> found;
  const auto [low, high] = std::minmax({corners[0].scalar, corners[1].scalar, corners[2].scalar, corners[3].scalar});
  const double size = std::max(std::abs(low), std::abs(high));
  const auto is_at = [](double depth, double plane) {
    return std::abs(depth - plane) <= 1e-12 * (std::abs(depth) + std::abs(plane));
  };
  bool falls = false;
  for (const SurfaceOfValue& surface : surfaces) {
    if (!(low - level * size < surface.value && surface.value <= high + level * size)) continue;
    std::array<Corner, 4> relative = corners;
    for (Corner& c : relative) c.scalar -= surface.value;
    const std::optional<Stretch> whole = intersect(relative, x, y);
    std::optional<Stretch> seen = whole ? clipped(*whole, kept.nearest, kept.farthest) : std::nullopt;
    if (!seen) continue;
    if (kept.nearest_cut && is_at(seen->front, kept.nearest) && std::abs(seen->scalar_front) <= level * size)
      seen->scalar_front = 0;
    if (kept.farthest_cut && is_at(seen->back, kept.farthest) && std::abs(seen->scalar_back) <= level * size)
      seen->scalar_back = 0;
    if ((seen->scalar_front < 0) == (seen->scalar_back < 0)) continue;
    falls = seen->scalar_back < 0;
    found.push_back({seen->scalar_front / (seen->scalar_front - seen->scalar_back), &surface});
  }
  if (falls) std::reverse(found.begin(), found.end());
  for (std::size_t i = 1; i < found.size(); ++i) found[i].part = std::max(found[i].part, found[i - 1].part);
  return found;
}

namespace {

std::array<double, 3> lit_at(const glm::dvec3& color, const SurfaceLight& light, double cosine) {
  const double matte = light.ambient + light.diffuse * cosine;
  const double shine = light.specular * std::pow(cosine, light.shininess);
  return {color.x * matte + shine, color.y * matte + shine, color.z * matte + shine};
}

std::array<double, 3> lit_along(const glm::dvec3& color, const SurfaceLight& light, const glm::dvec3& ray,
                                Vector normal) {
  const long double size = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
  double cosine = 1;
  if (size > 0) {
    normal /= size;
    const Vector along = glm::normalize(Vector(ray));
    cosine = static_cast<double>(std::min(std::abs(glm::dot(along, normal)) / glm::length(normal), 1.0L));
  }
  return lit_at(color, light, cosine);
}

}  // namespace

std::array<double, 3> lit(const SurfaceOfValue& surface, const SurfaceLight& light, double cosine) {
  return lit_at(surface.color, light, cosine);
}

std::array<double, 3> lit(const SurfaceOfValue& surface, const SurfaceLight& light, const glm::dvec3& ray,
                          const scene::TetMeshView& mesh, std::size_t tet) {
  return lit_along(surface.color, light, ray, scaled_gradient(mesh, tet));
}

std::array<double, 3> lit(const glm::dvec3& color, const SurfaceLight& light, const glm::dvec3& ray,
                          const glm::dvec3& normal) {
  return lit_along(color, light, ray, Vector(normal));
}

glm::dvec3 gradient_in(const scene::TetMeshView& mesh, std::size_t tet) {
  const Vector gradient = scaled_gradient(mesh, tet);
  const long double size = std::max({std::abs(gradient.x), std::abs(gradient.y), std::abs(gradient.z)});
  return size > 0 ? glm::dvec3(gradient / size) : glm::dvec3(0);
}

glm::dvec3 normal_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  Vector u = Vector(b) - Vector(a), v = Vector(c) - Vector(a);
  for (Vector* edge : {&u, &v}) {
    const long double size = std::max({std::abs(edge->x), std::abs(edge->y), std::abs(edge->z)});
    if (size > 0) *edge /= size;
  }
  Vector normal = glm::cross(u, v);
  const long double size = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
  return size > 0 ? glm::dvec3(normal / size) : glm::dvec3(0);
}

std::vector<std::uint8_t> open_faces(const scene::TetMeshView& mesh) {
  using Place = std::array<double, 3>;
  struct Face {
    std::array<Place, 3> corners;
    std::size_t tet;
    int opposite;
  };
  std::vector<Face> faces;
  for (std::size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    std::array<Place, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) {
      const glm::dvec3& p = mesh.positions[mesh.tets[tet][i]];
      corners[i] = {p.x, p.y, p.z};
    }
    std::sort(corners.begin(), corners.end());
    for (std::size_t out = 0; out < 4; ++out) {
      Face face{{}, tet, static_cast<int>(out)};
      for (std::size_t i = 0, k = 0; i < 4; ++i)
        if (i != out) face.corners[k++] = corners[i];
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.corners < b.corners; });
  std::vector<std::uint8_t> open(mesh.tets.size(), 0);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const bool before = i > 0 && faces[i - 1].corners == faces[i].corners;
    const bool behind = i + 1 < faces.size() && faces[i + 1].corners == faces[i].corners;
    if (!before && !behind) open[faces[i].tet] |= static_cast<std::uint8_t>(1 << faces[i].opposite);
  }
  return open;
}

}  // namespace tessera::reference
