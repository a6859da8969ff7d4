#include "reference/view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tessera::reference {
namespace {

double dot(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Divides by the length (and first by the largest component, against overflow): (0, 0, 49) gives exactly (0, 0, 1).
glm::dvec3 unit(const glm::dvec3& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  const glm::dvec3 scaled(v.x / largest, v.y / largest, v.z / largest);
  const double length = std::sqrt(dot(scaled, scaled));
  return {scaled.x / length, scaled.y / length, scaled.z / length};
}

double rounded_to_grid(double pixels) {
  const double cells_per_pixel = 4294967296.0;  // 2^32
  return std::nearbyint(pixels * cells_per_pixel) / cells_per_pixel;
}

}  // namespace

View::View(const scene::Camera& camera, scene::ImageSize size)
    : position_(camera.position),
      half_width_(size.width / 2.0),
      half_height_(size.height / 2.0),
      perspective_(camera.projection == scene::ProjectionKind::perspective),
      nearest_(0),
      farthest_(std::numeric_limits<double>::infinity()) {
  forward_ = unit(camera.focal_point - camera.position);
  right_ = unit(cross(forward_, unit(camera.view_up)));
  up_ = cross(right_, forward_);
  pixels_per_unit_ = perspective_ ? half_height_ / std::tan(camera.view_angle * (std::numbers::pi / 360))
                                  : half_height_ / camera.parallel_scale;
  if (camera.clipping_range) {
    nearest_ = std::max(0.0, camera.clipping_range->near_distance);
    farthest_ = camera.clipping_range->far_distance;
  }
}

ProjectedVertex View::project(const glm::dvec3& p_world) const {
  const glm::dvec3 from_eye = p_world - position_;
  const double across = dot(right_, from_eye) * pixels_per_unit_;
  const double upward = dot(up_, from_eye) * pixels_per_unit_;
  const double depth = dot(forward_, from_eye);
  if (perspective_) return {{half_width_ * depth + across, half_height_ * depth - upward, depth}, depth};
  return {{rounded_to_grid(half_width_ + across), rounded_to_grid(half_height_ - upward), 1}, depth};
}

View::Ray View::ray(double x, double y) const {
  const double across = (x - half_width_) / pixels_per_unit_, upward = (half_height_ - y) / pixels_per_unit_;
  const glm::dvec3 aside = right_ * across + up_ * upward;
  return perspective_ ? Ray{position_, forward_ + aside} : Ray{position_ + aside, forward_};
}

double View::length_per_depth(double x, double y) const {
  if (!perspective_) return 1;
  const double across = (x - half_width_) / pixels_per_unit_, upward = (y - half_height_) / pixels_per_unit_;
  return std::sqrt(1 + across * across + upward * upward);
}

}  // namespace tessera::reference
