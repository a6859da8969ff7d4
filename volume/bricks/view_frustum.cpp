// SPDX-License-Identifier: BSD-3-Clause
#include "volume/bricks/view_frustum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

namespace tessera::volume {
namespace {

struct BrickPlace {
  glm::dvec3 centre;
  std::array<glm::dvec3, 3> half_sides;
};

/// Returns a brick's place in world units. A cell's sample counts as located at the cell's low corner, and the box
/// extends to the next corner.
BrickPlace place_of(std::size_t brick, const scene::GridGeometry& geometry, const BrickLayout& layout) {
  const scene::SampleBox box = layout.box(layout.place(brick));
  BrickPlace place;
  glm::dvec3 centre;
  for (int a = 0; a < 3; ++a) {
    const auto low = static_cast<double>(box.low[static_cast<std::size_t>(a)]),
               high = static_cast<double>(box.high[static_cast<std::size_t>(a)]) - static_cast<double>(layout.shared);
    centre[a] = 0.5 * (low + high);
    place.half_sides[static_cast<std::size_t>(a)] = geometry.direction[a] * (geometry.spacing[a] * 0.5 * (high - low));
  }
  place.centre = scene::world_of_index(geometry, centre);
  return place;
}

/// Half the height of the view in world units: at distance 1 from the eye; in parallel views, at any distance.
double half_height_of(const scene::Camera& camera) {
  return camera.projection == scene::ProjectionKind::perspective ? std::tan(glm::radians(camera.view_angle / 2))
                                                                 : camera.parallel_scale;
}

}  // namespace

std::vector<float> frustum_distances(const scene::Camera& camera, scene::ImageSize size, const scene::PixelRect& region,
                                     const scene::GridGeometry& geometry, const BrickLayout& layout) {
  const scene::ViewBasis basis = scene::view_basis(camera);
  const bool perspective = camera.projection == scene::ProjectionKind::perspective;
  const double pixel = 2 * half_height_of(camera) / size.height;
  const double left = (region.x0 - size.width / 2.0) * pixel, right = (region.x1 - size.width / 2.0) * pixel,
               low = (size.height / 2.0 - region.y1) * pixel, high = (size.height / 2.0 - region.y0) * pixel;
  // Unit normals that point inwards, of planes through the eye or parallel to the view direction.
  const auto normal = [&](const glm::dvec3& across, double edge) {
    return perspective ? glm::normalize(basis.forward * edge - across) : -across;
  };
  const std::array<glm::dvec3, 5> normals{normal(basis.right, right), normal(-basis.right, -left),
                                          normal(basis.up, high), normal(-basis.up, -low), basis.forward};
  const std::array<double, 5> offsets =
      perspective ? std::array<double, 5>{} : std::array<double, 5>{right, -left, high, -low, 0};
  std::vector<float> distances(layout.count());
  for (std::size_t brick = 0; brick < distances.size(); ++brick) {
    const BrickPlace place = place_of(brick, geometry, layout);
    double outside = -std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < normals.size(); ++n) {
      double inside = glm::dot(normals[n], place.centre - camera.position) + offsets[n];
      for (const glm::dvec3& side : place.half_sides) inside += std::abs(glm::dot(normals[n], side));
      outside = std::max(outside, -inside);
    }
    distances[brick] = static_cast<float>(outside);
  }
  return distances;
}

}  // namespace tessera::volume
