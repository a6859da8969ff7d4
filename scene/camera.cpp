#include "scene/camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "scene/error.hpp"

namespace tessera {
namespace {

using scene::bad_input;

using std::numbers::pi;

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Unit vector. Scaled first, so that 1e-200 and 1e200 neither underflow nor overflow; divided by the length rather
/// than multiplied by its inverse, so that (0, 0, 49) becomes exactly (0, 0, 1).
glm::dvec3 unit(const glm::dvec3& v) {
  const glm::dvec3 scaled = v / largest(v);
  return scaled / glm::length(scaled);
}

glm::dvec3 rotated(const glm::dvec3& v, const glm::dvec3& axis, double angle) {
  // Rodrigues' formula.
  return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
         axis * (glm::dot(axis, v) * (1 - std::cos(angle)));
}

}  // namespace

void validate(const Camera& camera) {
  if (!finite(camera.position)) throw bad_input("position is not finite; give three numbers");
  if (!finite(camera.focal_point)) throw bad_input("focal_point is not finite; give three numbers");
  if (!finite(camera.view_up)) throw bad_input("view_up is not finite; give three numbers");
  const glm::dvec3 direction = camera.focal_point - camera.position;
  if (!(largest(direction) > 0) || !finite(direction))
    throw bad_input("focal_point equals position, the camera has no direction; move one of them");
  if (!(largest(camera.view_up) > 0)) throw bad_input("view_up is zero; give the direction that points up");
  if (!(glm::length(glm::cross(unit(direction), unit(camera.view_up))) > 1e-9))
    throw bad_input("view_up lies along the view direction; turn it away from it");
  if (camera.projection == ProjectionKind::orthographic) {
    if (!(camera.parallel_scale > 0) || !std::isfinite(camera.parallel_scale))
      throw bad_input(fmt::format("parallel_scale is {}; it must be positive", camera.parallel_scale));
  } else if (!(camera.view_angle > 0 && camera.view_angle < 180)) {
    throw bad_input(fmt::format("view_angle is {}; it must be above 0 and below 180 degrees", camera.view_angle));
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
  return longest > 0 ? glm::length(extent / longest) * longest : 0;  // 1e-200 must not underflow when squared
}

Camera frame_box(const Box& box, ImageSize size, ProjectionKind projection, bool turning) {
  Camera camera;
  camera.projection = projection;
  if (box.empty()) return camera;
  const glm::dvec3 center = box.low + (box.high - box.low) * 0.5;
  const glm::dvec3 half = (box.high - box.low) * 0.5;
  double radius = glm::length(half / std::max(largest(half), 1e-300)) * largest(half);
  if (!(radius > 0)) radius = largest(center) > 0 ? largest(center) * 1e-6 : 1;

  // Look across the two longest sides, a little from above and from the right: the shortest side points roughly at the
  // eye, so that plates show their face, and the longest of the other two lies along the picture's width.
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return half[a] > half[b]; });
  glm::dvec3 along{0}, upward{0}, toward{0};
  along[axes[0]] = 1;
  upward[axes[1]] = 1;
  toward[axes[2]] = 1;
  const glm::dvec3 to_eye = unit(toward + 0.45 * upward + 0.6 * along);
  camera.focal_point = center;
  camera.position = center + to_eye * (3 * radius);
  camera.view_up = upward;

  std::vector<glm::dvec3> outline;  // offsets from the centre that have to be in the picture
  outline.reserve(8);
  for (int corner = 0; corner < 8; ++corner)
    outline.emplace_back((corner & 1) ? half.x : -half.x, (corner & 2) ? half.y : -half.y,
                         (corner & 4) ? half.z : -half.z);
  if (turning) {
    constexpr int steps = 72;  // between two of them a corner moves out by 0.1 %, well within the margin
    for (int step = 1; step < steps; ++step)
      for (int corner = 0; corner < 8; ++corner)
        outline.push_back(rotated(outline[static_cast<std::size_t>(corner)], upward, step * 2 * pi / steps));
  }

  constexpr double margin = 1.05;
  const ViewBasis basis = view_basis(camera);
  const double aspect = static_cast<double>(size.width) / size.height;
  const double slope = std::tan(camera.view_angle / 2 * pi / 180) / margin;
  double fit = 0, distance = margin * radius;
  for (const glm::dvec3& offset : outline) {
    const double needed =
        std::max(std::abs(glm::dot(offset, basis.up)), std::abs(glm::dot(offset, basis.right)) / aspect);
    fit = std::max(fit, needed);
    // Perspective: at distance + z the window's half height is (distance + z) tan.
    distance = std::max(distance, needed / slope - glm::dot(offset, basis.forward));
  }
  camera.parallel_scale = margin * (fit > 0 ? fit : radius);
  if (projection == ProjectionKind::perspective) camera.position = center + to_eye * distance;
  return camera;
}

Camera orbit(const Camera& camera, double turn) {
  const double angle = turn * 2 * pi;
  const glm::dvec3 axis = unit(camera.view_up);
  Camera turned = camera;
  turned.position = camera.focal_point + rotated(camera.position - camera.focal_point, axis, angle);
  return turned;
}

}  // namespace tessera
