#include "reference/surface_on_ray.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

namespace tessera::reference {
namespace {

using Vector = glm::vec<3, long double>;

/// The gradient times six times the tet's volume, with either sign: by Cramer's rule for the system whose rows are the
/// tet's edges from one corner.
Vector scaled_gradient(const scene::TetMeshView& mesh, std::size_t tet) {
  const scene::Tet& t = mesh.tets[tet];
  const Vector a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]), d(mesh.positions[t[3]]);
  // Each corner's share of the field grows along the normal of the face opposite to it, as fast as that is large; all
  // four together do not grow.
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
                                               const std::array<Corner, 4>& corners, double x, double y, double nearest,
                                               double farthest) {
  std::vector<SurfaceCrossing> found;
  const auto [low, high] = std::minmax({corners[0].scalar, corners[1].scalar, corners[2].scalar, corners[3].scalar});
  bool falls = false;
  for (const SurfaceOfValue& surface : surfaces) {
    if (!(low < surface.value && surface.value <= high)) continue;
    std::array<Corner, 4> relative = corners;
    for (Corner& c : relative) c.scalar -= surface.value;
    const std::optional<Stretch> whole = intersect(relative, x, y);
    const std::optional<Stretch> seen = whole ? clipped(*whole, nearest, farthest) : std::nullopt;
    if (!seen || (seen->scalar_front < 0) == (seen->scalar_back < 0)) continue;
    falls = seen->scalar_back < 0;
    found.push_back({seen->scalar_front / (seen->scalar_front - seen->scalar_back), &surface});
  }
  if (falls) std::reverse(found.begin(), found.end());
  for (std::size_t i = 1; i < found.size(); ++i) found[i].part = std::max(found[i].part, found[i - 1].part);
  return found;
}

std::array<double, 3> lit(const SurfaceOfValue& surface, const SurfaceLight& light, const glm::dvec3& ray,
                          const scene::TetMeshView& mesh, std::size_t tet) {
  Vector normal = scaled_gradient(mesh, tet);
  const long double size = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
  double cosine = 1;
  if (size > 0) {
    normal /= size;
    const Vector along = glm::normalize(Vector(ray));
    cosine = static_cast<double>(std::min(std::abs(glm::dot(along, normal)) / glm::length(normal), 1.0L));
  }
  const double matte = light.ambient + light.diffuse * cosine;
  const double shine = light.specular * std::pow(cosine, light.shininess);
  return {surface.color.x * matte + shine, surface.color.y * matte + shine, surface.color.z * matte + shine};
}

}  // namespace tessera::reference
