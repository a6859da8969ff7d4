#include "volume/view_cone.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace tessera::volume {
namespace {

glm::dvec3 centre_of(std::size_t brick, const scene::GridGeometry& geometry, const BrickLayout& layout) {
  const scene::SampleBox box = layout.box(layout.place(brick));
  glm::dvec3 centre;
  for (int a = 0; a < 3; ++a)
    centre[a] =
        0.5 * static_cast<double>(box.low[static_cast<std::size_t>(a)] + box.high[static_cast<std::size_t>(a)] - 1);
  return scene::world_of_index(geometry, centre);
}

/// World units at distance 1 from the eye, or in parallel views anywhere.
double half_height_of(const scene::Camera& camera) {
  return camera.projection == scene::ProjectionKind::perspective ? std::tan(glm::radians(camera.view_angle / 2))
                                                                 : camera.parallel_scale;
}

}  // namespace

std::vector<float> cone_distances(const scene::Camera& camera, scene::ImageSize size, const scene::PixelRect& region,
                                  const scene::GridGeometry& geometry, const BrickLayout& layout) {
  const scene::ViewBasis basis = scene::view_basis(camera);
  const bool perspective = camera.projection == scene::ProjectionKind::perspective;
  const double pixel = 2 * half_height_of(camera) / size.height;
  const glm::dvec2 middle{(region.x0 + region.x1) / 2.0 - size.width / 2.0,
                          size.height / 2.0 - (region.y0 + region.y1) / 2.0};
  const glm::dvec3 shift = (basis.right * middle.x + basis.up * middle.y) * pixel;
  const double radius = 0.5 * pixel * std::hypot(region.x1 - region.x0, region.y1 - region.y0);
  const glm::dvec3 apex = perspective ? camera.position : camera.position + shift;
  const glm::dvec3 axis = perspective ? glm::normalize(basis.forward + shift) : basis.forward;
  const double slope = perspective ? radius : 0, across = perspective ? 0 : radius;
  std::vector<float> distances(layout.count());
  for (std::size_t brick = 0; brick < distances.size(); ++brick) {
    const glm::dvec3 from_apex = centre_of(brick, geometry, layout) - apex;
    const double along = glm::dot(from_apex, axis), off = glm::length(from_apex - axis * along);
    const double outside = (off - across - slope * along) / std::sqrt(1 + slope * slope);
    // Behind the apex the apex itself is nearest.
    distances[brick] =
        static_cast<float>(perspective && along + slope * off < 0 ? glm::length(from_apex) : std::max(0.0, outside));
  }
  return distances;
}

std::vector<float> frustum_distances(const scene::Camera& camera, scene::ImageSize size, const scene::PixelRect& region,
                                     const scene::GridGeometry& geometry, const BrickLayout& layout) {
  const scene::ViewBasis basis = scene::view_basis(camera);
  const bool perspective = camera.projection == scene::ProjectionKind::perspective;
  const double pixel = 2 * half_height_of(camera) / size.height;
  const double left = (region.x0 - size.width / 2.0) * pixel, right = (region.x1 - size.width / 2.0) * pixel,
               low = (size.height / 2.0 - region.y1) * pixel, high = (size.height / 2.0 - region.y0) * pixel;
  // Outside of the plane through the eye, or along the view, that has all points below `edge`.
  const auto beyond = [&](double across, double along, double edge) {
    return perspective ? (across - edge * along) / std::sqrt(1 + edge * edge) : across - edge;
  };
  std::vector<float> distances(layout.count());
  for (std::size_t brick = 0; brick < distances.size(); ++brick) {
    const glm::dvec3 from_eye = centre_of(brick, geometry, layout) - camera.position;
    const double x = glm::dot(from_eye, basis.right), y = glm::dot(from_eye, basis.up),
                 along = glm::dot(from_eye, basis.forward);
    distances[brick] = static_cast<float>(std::max(
        {beyond(x, along, right), beyond(-x, along, -left), beyond(y, along, high), beyond(-y, along, -low), -along}));
  }
  return distances;
}

double half_brick(const scene::GridGeometry& geometry, const BrickLayout& layout) {
  const auto side = [&](int a) {
    return geometry.direction[a] * geometry.spacing[a] * static_cast<double>(layout.size + 1);
  };
  double longest = 0;
  for (const double j : {-1.0, 1.0})
    for (const double k : {-1.0, 1.0}) longest = std::max(longest, glm::length(side(0) + j * side(1) + k * side(2)));
  return longest / 2;
}

}  // namespace tessera::volume
