// SPDX-License-Identifier: BSD-3-Clause
#include "reference/view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tessera::reference {
namespace {

using Direction = glm::vec<3, long double>;

long double dot(const Direction& a, const Direction& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Direction cross(const Direction& a, const Direction& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Divides by the length, and before that by the largest component to prevent overflow: (0, 0, 49) gives exactly (0, 0,
/// 1).
template <class Vector>
Vector unit(const Vector& v) {
  const auto largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  const Vector scaled(v.x / largest, v.y / largest, v.z / largest);
  const auto length = std::sqrt(scaled.x * scaled.x + scaled.y * scaled.y + scaled.z * scaled.z);
  return {scaled.x / length, scaled.y / length, scaled.z / length};
}

constexpr int finest_unit = -32;  // exponents of two
constexpr int position_bits = 46, direction_bits = 40;
constexpr long double most_per_tangent = 4194304;  // 2^22

/// Returns the nearest multiple of 2^exponent.
double rounded_to(long double v, int exponent) {
  return static_cast<double>(std::ldexp(std::nearbyint(std::ldexp(v, -exponent)), exponent));
}

}  // namespace

View::View(const scene::Camera& camera, scene::ImageSize size)
    : position_(camera.position),
      half_width_(size.width / 2.0L),
      half_height_(size.height / 2.0L),
      perspective_(camera.projection == scene::ProjectionKind::perspective),
      nearest_(0),
      farthest_(std::numeric_limits<double>::infinity()) {
  depth_axis_ = unit(camera.focal_point - camera.position);
  forward_ = unit(Direction(camera.focal_point) - Direction(camera.position));
  right_ = unit(cross(forward_, unit(Direction(camera.view_up))));
  up_ = cross(right_, forward_);
  pixels_per_unit_ = perspective_ ? half_height_ / std::tan(camera.view_angle * (std::numbers::pi_v<long double> / 360))
                                  : half_height_ / camera.parallel_scale;
  if (camera.clipping_range) {
    nearest_ = std::max(0.0, camera.clipping_range->near_distance);
    farthest_ = camera.clipping_range->far_distance;
  }
}

ProjectedVertex View::project(const glm::dvec3& p_world) const {
  const Direction from_eye = Direction(p_world) - Direction(position_);
  const long double across = dot(right_, from_eye) * pixels_per_unit_;
  const long double upward = dot(up_, from_eye) * pixels_per_unit_;
  const long double depth = dot(forward_, from_eye);
  const glm::dvec3 from = p_world - position_;
  const double planar = depth_axis_.x * from.x + depth_axis_.y * from.y + depth_axis_.z * from.z;
  if (!perspective_) {
    const glm::dvec3 h(rounded_to(half_width_ + across, finest_unit), rounded_to(half_height_ - upward, finest_unit),
                       1);
    return {h, h, planar};
  }
  const long double x_times_depth = half_width_ * depth + across, y_times_depth = half_height_ * depth - upward;
  const glm::dvec3 homogeneous(x_times_depth, y_times_depth, depth);
  const long double size = std::max(std::abs(x_times_depth), std::abs(y_times_depth));
  if (planar != 0 && size < std::ldexp(std::abs(depth), position_bits)) {
    const long double largest = std::max(size / std::abs(depth), std::min(pixels_per_unit_, most_per_tangent));
    const int unit = std::max(finest_unit, std::ilogb(largest) - position_bits);
    const double x = rounded_to(x_times_depth / depth, unit), y = rounded_to(y_times_depth / depth, unit);
    return {homogeneous, planar > 0 ? glm::dvec3(x, y, 1) : glm::dvec3(-x, -y, -1), planar};
  }
  if (size == 0) return {homogeneous, {0, 0, 0}, planar};  // the eye itself
  const int unit = std::ilogb(size) - direction_bits;
  return {homogeneous, {rounded_to(x_times_depth, unit), rounded_to(y_times_depth, unit), 0}, planar};
}

View::Ray View::ray(double x, double y) const {
  const long double across = (x - half_width_) / pixels_per_unit_, upward = (half_height_ - y) / pixels_per_unit_;
  const Direction aside = right_ * across + up_ * upward;
  return perspective_ ? Ray{position_, forward_ + aside} : Ray{glm::dvec3(Direction(position_) + aside), forward_};
}

double View::length_per_depth(double x, double y) const {
  if (!perspective_) return 1;
  const long double across = (x - half_width_) / pixels_per_unit_, upward = (y - half_height_) / pixels_per_unit_;
  return static_cast<double>(std::sqrt(1 + across * across + upward * upward));
}

}  // namespace tessera::reference
