#include "projection/pixel_space.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "projection/project_lanes.hpp"

namespace tessera::projection {
namespace {

double on_grid(double pixel) {
  constexpr double cells = 4294967296.0;  // 2^32; beyond 2^20 pixels the rounding changes nothing
  const double scaled = pixel * cells;
  return std::isfinite(scaled) ? std::nearbyint(scaled) / cells : pixel;
}

/// The power of two at or below a positive number; 0 of a subnormal one.
double power_of_two(double v) { return std::bit_cast<double>(std::bit_cast<std::uint64_t>(v) & 0x7ff0000000000000u); }

/// The nearest multiple of a power of two, of |v| < 2^51 times it.
double nearest_multiple(double v, double step) {
  const double magic = 0x1.8p52 * step;
  return (v + magic) - magic;
}

/// (x, y, w) in homogeneous pixel coordinates to a rounded position. As project_lanes.cpp has it.
PixelVertex perspective_vertex(double x, double y, double depth, double pixels_per_unit) {
  const double px = x / depth, py = y / depth, reach = std::max(std::abs(px), std::abs(py));
  if (reach < eye_plane_reach) {
    const double step = std::max(finest_step, power_of_two(std::max(reach, pixels_per_unit)) * position_precision);
    return {nearest_multiple(px, step), nearest_multiple(py, step), depth, depth};
  }
  const double step = power_of_two(std::max(std::abs(x), std::abs(y))) * direction_precision;
  return {nearest_multiple(x, step), nearest_multiple(y, step), 0, depth};
}

}  // namespace

PixelSpace::PixelSpace(const scene::Camera& camera, scene::ImageSize size) : size_(size) {
  scene::validate(camera);
  scene::validate(size);
  basis_ = scene::view_basis(camera);
  position_ = camera.position;
  perspective_ = camera.projection == scene::ProjectionKind::perspective;
  const double half_height = 0.5 * size.height;
  pixels_per_unit_ =
      half_height / (perspective_ ? std::tan(camera.view_angle * (std::numbers::pi / 360)) : camera.parallel_scale);
  near_ = camera.clipping_range ? std::max(0.0, camera.clipping_range->near_distance) : 0;
  far_ = camera.clipping_range ? camera.clipping_range->far_distance : std::numeric_limits<double>::infinity();
}

PixelVertex PixelSpace::project(const glm::dvec3& p_world) const {
  const glm::dvec3 p = p_world - position_;
  const double across = glm::dot(basis_.right, p), upward = glm::dot(basis_.up, p), depth = glm::dot(basis_.forward, p);
  const double half_width = 0.5 * size_.width, half_height = 0.5 * size_.height;
  if (!perspective_)
    return {on_grid(half_width + across * pixels_per_unit_), on_grid(half_height - upward * pixels_per_unit_), 1,
            depth};
  return perspective_vertex(half_width * depth + across * pixels_per_unit_,
                            half_height * depth - upward * pixels_per_unit_, depth, pixels_per_unit_);
}

void PixelSpace::project(std::span<const glm::dvec3> p_world, std::span<PixelVertex> out) const {
  const LinearMap map{{position_.x, position_.y, position_.z},
                      {basis_.right.x, basis_.right.y, basis_.right.z},
                      {basis_.up.x, basis_.up.y, basis_.up.z},
                      {basis_.forward.x, basis_.forward.y, basis_.forward.z},
                      0.5 * size_.width,
                      0.5 * size_.height,
                      pixels_per_unit_,
                      perspective_};
  const std::size_t done = project_lanes(map, p_world, out);
  for (std::size_t i = done; i < p_world.size(); ++i) out[i] = project(p_world[i]);
}

double PixelSpace::length_per_depth(double x, double y) const {
  if (!perspective_) return 1;
  const double tx = (x - 0.5 * size_.width) / pixels_per_unit_, ty = (y - 0.5 * size_.height) / pixels_per_unit_;
  return std::sqrt(1 + tx * tx + ty * ty);
}

}  // namespace tessera::projection
