#include "volume/view_cone.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace tessera::volume {

std::vector<float> cone_distances(const scene::Camera& camera, scene::ImageSize size, const scene::PixelRect& region,
                                  const scene::GridGeometry& geometry, const BrickLayout& layout) {
  const scene::ViewBasis basis = scene::view_basis(camera);
  const bool perspective = camera.projection == scene::ProjectionKind::perspective;
  const double half_height = perspective ? std::tan(glm::radians(camera.view_angle / 2)) : camera.parallel_scale;
  const double pixel = 2 * half_height / size.height;
  const glm::dvec2 middle{(region.x0 + region.x1) / 2.0 - size.width / 2.0,
                          size.height / 2.0 - (region.y0 + region.y1) / 2.0};
  const glm::dvec3 shift = (basis.right * middle.x + basis.up * middle.y) * pixel;
  const double radius = 0.5 * pixel * std::hypot(region.x1 - region.x0, region.y1 - region.y0);
  const glm::dvec3 apex = perspective ? camera.position : camera.position + shift;
  const glm::dvec3 axis = perspective ? glm::normalize(basis.forward + shift) : basis.forward;
  const double slope = perspective ? radius : 0, across = perspective ? 0 : radius;
  std::vector<float> distances(layout.count());
  for (std::size_t brick = 0; brick < distances.size(); ++brick) {
    const scene::SampleBox box = layout.box(layout.place(brick));
    glm::dvec3 centre;
    for (int a = 0; a < 3; ++a)
      centre[a] =
          0.5 * static_cast<double>(box.low[static_cast<std::size_t>(a)] + box.high[static_cast<std::size_t>(a)] - 1);
    const glm::dvec3 from_apex = scene::world_of_index(geometry, centre) - apex;
    const double along = glm::dot(from_apex, axis), off = glm::length(from_apex - axis * along);
    const double outside = (off - across - slope * along) / std::sqrt(1 + slope * slope);
    // Behind the apex the apex itself is nearest.
    distances[brick] =
        static_cast<float>(perspective && along + slope * off < 0 ? glm::length(from_apex) : std::max(0.0, outside));
  }
  return distances;
}

}  // namespace tessera::volume
