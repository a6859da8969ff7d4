// SPDX-License-Identifier: BSD-3-Clause
#include "scene/camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "scene/directions.hpp"
#include "scene/error.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

using scene::bad_input;
using scene::finite;
using scene::largest;
using scene::rotated;
using scene::unit;
using std::numbers::pi;

constexpr double least_scale = 1e-300, largest_number = 1e300;

/// Whether the size of a pixel is a double with full precision, for this half height of the view (in world units, or as
/// a tangent).
bool has_pixels(double half_height) { return half_height >= least_scale && half_height <= largest_number; }

bool in_reach(const glm::dvec3& v) { return finite(v) && largest(v) <= largest_number; }

}  // namespace

void validate(const Camera& camera) {
  for (const auto& [name, v] : {std::pair{"position", &camera.position}, std::pair{"focal_point", &camera.focal_point},
                                std::pair{"view_up", &camera.view_up}}) {
    if (!finite(*v)) throw bad_input(fmt::format("{} is not finite; give three numbers", name));
    if (!in_reach(*v)) throw bad_input(fmt::format("{} has numbers beyond 1e300; give smaller ones", name));
  }
  const glm::dvec3 direction = camera.focal_point - camera.position;
  if (!(largest(direction) > 0))
    throw bad_input("focal_point equals position, so the camera has no direction; move one of them");
  if (!(largest(camera.view_up) > 0)) throw bad_input("view_up is zero; give the direction that points up");
  if (!(glm::length(glm::cross(unit(direction), unit(camera.view_up))) > 1e-9))
    throw bad_input("view_up is parallel to the view direction; turn it away from it");
  if (camera.projection == ProjectionKind::orthographic) {
    if (!(camera.parallel_scale > 0) || !std::isfinite(camera.parallel_scale))
      throw bad_input(fmt::format("parallel_scale is {}; it must be positive", camera.parallel_scale));
    if (!has_pixels(camera.parallel_scale))
      throw bad_input(fmt::format("parallel_scale is {}; pixels of that size cannot be computed, give 1e-300 to 1e300",
                                  camera.parallel_scale));
  } else if (!(camera.view_angle > 0 && camera.view_angle < 180)) {
    throw bad_input(fmt::format("view_angle is {}; it must be above 0 and below 180 degrees", camera.view_angle));
  } else if (!has_pixels(std::tan(camera.view_angle * (pi / 360)))) {
    throw bad_input(fmt::format("view_angle is {}; pixels of that size cannot be computed, give at least 1e-297",
                                camera.view_angle));
  }
  if (camera.clipping_range) {
    const auto [near_distance, far_distance] = *camera.clipping_range;
    if (!std::isfinite(near_distance) || !std::isfinite(far_distance) || !(near_distance < far_distance))
      throw bad_input(
          fmt::format("clipping_range is {} to {}; near must be less than far", near_distance, far_distance));
  }
}

void validate(ImageSize size) {
  for (const int side : {size.width, size.height})
    if (side < 1 || side > max_image_side)
      throw bad_input(
          fmt::format("image size {}x{}: each side must be 1 to {} pixels", size.width, size.height, max_image_side));
}

ViewBasis view_basis(const Camera& camera) {
  const glm::dvec3 forward = unit(camera.focal_point - camera.position);
  const glm::dvec3 right = unit(glm::cross(forward, unit(camera.view_up)));
  return {right, glm::cross(right, forward), forward};
}

double diagonal(const Box& box) {
  if (box.empty()) return 0;
  const glm::dvec3 extent = box.high - box.low;
  const double longest = std::max({extent.x, extent.y, extent.z});
  return longest > 0 ? glm::length(extent / longest) * longest : 0;  // divided first, because 1e-200 would underflow
                                                                     // when squared
}

Camera orbit(const Camera& camera, double turn) {
  const double angle = turn * 2 * pi;
  const glm::dvec3 axis = unit(camera.view_up);
  Camera turned = camera;
  turned.position = camera.focal_point + rotated(camera.position - camera.focal_point, axis, angle);
  return turned;
}

}  // namespace v0_1
}  // namespace tessera
