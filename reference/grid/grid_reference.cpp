// SPDX-License-Identifier: BSD-3-Clause
#include "reference/grid/grid_reference.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>

#include "reference/grid/grid_surface.hpp"
#include "reference/kept_interval.hpp"
#include "scene/error.hpp"
#include "scene/threads.hpp"

namespace tessera::reference {
namespace {

constexpr double plane_tolerance = 1e-9;  // voxels

/// Returns p + (q - p) * (a + b u); p and q have degree two at most.
Cubic mixed(const Cubic& p, const Cubic& q, double a, double b) {
  Cubic result;
  for (std::size_t i = 0; i < 4; ++i) {
    const double difference = q.c[i] - p.c[i];
    result.c[i] += a == 1 ? q.c[i] : p.c[i] + difference * a;
    if (i < 3) result.c[i + 1] += difference * b;
  }
  return result;
}

}  // namespace

GridReference::GridReference(const scene::SampleSource& source, const scene::Camera& camera, scene::ImageSize size,
                             const scene::TransferFunction& transfer_function, scene::Emission emission,
                             const std::optional<scene::Shading>& shading, std::span<const scene::HalfSpace> kept,
                             const Surfaces& surfaces)
    : source_(&source),
      size_((scene::validate(camera), scene::validate(size), size)),
      knots_(transfer_function.knots().begin(), transfer_function.knots().end()),
      emission_(emission),
      kept_(kept.begin(), kept.end()),
      view_(camera, size),
      to_local_(scene::world_to_local(source.geometry())),
      shading_(shading),
      surfaces_(by_value(surfaces, transfer_function)),
      surface_light_(surfaces.light) {
  if (knots_.empty()) throw scene::bad_input("transfer function: it has no knots; give at least one");
  if (!shading_) return;
  if (emission_ != scene::Emission::absorption)
    throw scene::bad_input("shading needs emission in proportion to extinction");
  if (!(glm::length(shading_->to_light) > 0)) throw scene::bad_input("the direction to the light has no length");
  to_light_ = glm::normalize(shading_->to_light);
  if (shading_->camera_light) {
    const glm::dvec3 forward = glm::normalize(camera.focal_point - camera.position),
                     right = glm::normalize(glm::cross(forward, camera.view_up));
    to_light_ = right * to_light_.x + glm::cross(right, forward) * to_light_.y - forward * to_light_.z;
  }
}

GridIntegral::Light GridReference::light(const Voxel& voxel, const glm::dvec3& place,
                                         const glm::dvec3& step_world) const {
  constexpr double nothing = 1e-12;
  const glm::dvec3& side = voxel.side;
  const glm::dvec3 gradient = slopes(voxel.values, place) / side;  // local
  double largest = 0;
  for (const double v : voxel.values) largest = std::max(largest, std::abs(v));
  const double least_side = std::min({side.x, side.y, side.z});
  if (!(glm::length(gradient) * least_side > nothing * largest)) return {};
  const glm::dvec3 normal = glm::normalize(glm::transpose(to_local_) * gradient), to_eye = -glm::normalize(step_world);
  const glm::dvec3 half = to_light_ + to_eye;
  const double n_l = std::abs(glm::dot(normal, to_light_));
  // If the light is exactly opposite to the eye, there is no halfway vector.
  const double n_h = glm::length(half) > nothing ? std::abs(glm::dot(normal, glm::normalize(half))) : 0;
  return {shading_->ambient + shading_->diffuse * n_l, shading_->specular * std::pow(n_h, shading_->shininess)};
}

std::int64_t GridReference::voxel_along(std::size_t axis, double local) const {
  const scene::GridGeometry& g = source_->geometry();
  std::int64_t low = 0, high = g.points[axis] - 1;  // lattice(low) <= local < lattice(high), clamped
  while (high - low > 1) {
    const std::int64_t middle = low + (high - low) / 2;
    (g.lattice(axis, middle) <= local ? low : high) = middle;
  }
  return low;
}

GridReference::LocalRay GridReference::local_ray(double x, double y) const {
  const scene::GridGeometry& g = source_->geometry();
  const View::Ray world = view_.ray(x, y);
  const DepthInterval kept = kept_interval(view_, x, y, kept_);
  LocalRay ray{to_local_ * (world.origin - g.origin),
               to_local_ * world.step,
               {-1, -1, -1},
               kept.nearest,
               kept.farthest,
               view_.length_per_depth(x, y),
               false,
               false};
  double span = 0;  // largest planar depth in the volume; a ray that crosses no plane of an axis up to this depth
                    // counts as parallel
  const scene::Box box = scene::bounds(g);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p(corner & 1 ? box.low.x : box.high.x, corner & 2 ? box.low.y : box.high.y,
                       corner & 4 ? box.low.z : box.high.z);
    span = std::max(span, std::abs(view_.project(p).depth));
  }
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const double low = g.lattice(a, 0), high = g.lattice(a, g.points[a] - 1);
    const double voxel = (high - low) / static_cast<double>(g.points[a] - 1);
    if (std::abs(ray.step[axis]) * span < plane_tolerance * voxel) {
      const double local = ray.origin[axis];
      // Returns how far a shift of the pixel coordinates moves the ray along this axis; only the sign is used.
      const auto moved = [&](double dx, double dy) {
        const View::Ray other = view_.ray(x + dx, y + dy);
        return (to_local_ * (other.origin - world.origin) + (to_local_ * (other.step - world.step)) * span)[axis];
      };
      const double by_x = moved(1, 0), by_y = moved(0, 1);
      const double shift = std::abs(by_x) > plane_tolerance * voxel ? by_x : by_y;
      const double shifted = local + std::copysign(plane_tolerance * voxel, shift);
      ray.in_plane[a] = shifted >= low && shifted < high ? voxel_along(a, shifted) : -1;
      if (ray.in_plane[a] < 0) {
        ray.end = ray.begin;
        continue;
      }
      // A ray that is in a plane up to rounding gets the plane's coordinate.
      ray.step[axis] = 0;
      for (const std::int64_t n : {ray.in_plane[a], ray.in_plane[a] + 1})
        if (std::abs(local - g.lattice(a, n)) < plane_tolerance * voxel) ray.origin[axis] = g.lattice(a, n);
      continue;
    }
    double enter = (low - ray.origin[axis]) / ray.step[axis], leave = (high - ray.origin[axis]) / ray.step[axis];
    if (enter > leave) std::swap(enter, leave);
    ray.begin = std::max(ray.begin, enter);
    ray.end = std::min(ray.end, leave);
  }
  const auto is_at = [](double depth, double plane) {
    return std::abs(depth - plane) <= 1e-12 * (std::abs(depth) + std::abs(plane));
  };
  ray.begin_cut = kept.nearest != view_.nearest() && is_at(ray.begin, kept.nearest);
  ray.end_cut = kept.farthest != view_.farthest() && is_at(ray.end, kept.farthest);
  return ray;
}

std::vector<double> GridReference::plane_depths(const LocalRay& ray) const {
  const scene::GridGeometry& g = source_->geometry();
  if (!(ray.begin < ray.end)) return {};
  std::vector<double> depths = {ray.begin, ray.end};
  for (std::size_t a = 0; a < 3; ++a) {
    if (ray.in_plane[a] >= 0) continue;
    const int axis = static_cast<int>(a);
    const auto at = [&](double z) { return voxel_along(a, ray.origin[axis] + z * ray.step[axis]); };
    const std::int64_t one = at(ray.begin), other = at(ray.end), first = std::min(one, other),
                       last = std::max(one, other);
    for (std::int64_t i = first; i <= last + 1; ++i) {
      const double z = (g.lattice(a, i) - ray.origin[axis]) / ray.step[axis];
      if (z > ray.begin && z < ray.end) depths.push_back(z);
    }
  }
  std::sort(depths.begin(), depths.end());
  return depths;
}

bool GridReference::read_voxel(const LocalRay& ray, const glm::dvec3& middle, Voxel& voxel) const {
  const scene::Grid& grid = source_->grid();
  const scene::GridGeometry& g = grid.geometry;
  voxel.constant = g.association == scene::Association::cell;
  scene::SampleBox box;
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    box.low[a] = ray.in_plane[a] >= 0 ? ray.in_plane[a] : voxel_along(a, middle[axis]);
    box.high[a] = box.low[a] + (voxel.constant ? 1 : 2);
    voxel.low[axis] = g.lattice(a, box.low[a]);
    voxel.side[axis] = g.lattice(a, box.low[a] + 1) - voxel.low[axis];
  }
  std::array<double, 8> samples{};
  const auto count = static_cast<std::size_t>(box.count());
  source_->read(box, std::span(samples).first(count));
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(samples[i])) return false;
    voxel.values[i] = grid.value(samples[i]);
  }
  return true;
}

void GridReference::add_part(const LocalRay& ray, const Voxel& voxel, double z0, double z1,
                             GridIntegral& integral) const {
  // The cubic is computed from differences, so that voxel values that differ only in the last places keep all their
  // digits.
  const double origin = voxel.values[0];
  std::array<Cubic, 8> field;
  GridIntegral::Light lit;
  if (!voxel.constant) {
    for (std::size_t i = 0; i < 8; ++i) field[i].c[0] = voxel.values[i] - origin;
    const glm::dvec3 front = voxel.place(ray.origin + z0 * ray.step), rise = (z1 - z0) * ray.step / voxel.side;
    for (std::size_t a = 0; a < 3; ++a)  // along i first: neighbours in the box's order
      for (std::size_t i = 0; i < (8u >> (a + 1)); ++i)
        field[i] = mixed(field[2 * i], field[2 * i + 1], front[static_cast<int>(a)], rise[static_cast<int>(a)]);
    if (shading_)
      lit =
          light(voxel, voxel.place(ray.origin + ray.step * ((z0 + z1) / 2)), source_->geometry().direction * ray.step);
  }
  integral.add((z1 - z0) * ray.length_per_depth, field[0], z0, z1, lit, origin);
}

void GridReference::add_stretch(const LocalRay& ray, const Voxel& voxel, double z0, double z1,
                                GridIntegral& integral) const {
  double at = z0;
  if (!surfaces_.empty() && !voxel.constant) {
    const glm::dvec3 step_world = glm::normalize(source_->geometry().direction * ray.step);
    const VoxelStretch stretch{voxel.values, voxel.place(ray.origin + z0 * ray.step),
                               voxel.place(ray.origin + z1 * ray.step), ray.begin_cut && z0 == ray.begin,
                               ray.end_cut && z1 == ray.end};
    for (const GridCrossing& c : surface_crossings(surfaces_, stretch)) {
      const double z = z0 + (z1 - z0) * c.part;
      add_part(ray, voxel, at, z, integral);
      at = z;
      const glm::dvec3 normal = glm::transpose(to_local_) * (slopes(voxel.values, c.place) / voxel.side);
      const double steepness = glm::length(normal);
      const double cosine = steepness > 0 ? std::min(1.0, std::abs(glm::dot(normal, step_world)) / steepness) : 1;
      integral.add_surface(lit(*c.surface, surface_light_, cosine), c.surface->opacity, z);
    }
  }
  add_part(ray, voxel, at, z1, integral);
}

void GridReference::integrate(double x, double y, GridIntegral& integral, Pixel& pixel) const {
  const LocalRay ray = local_ray(x, y);
  const std::vector<double> cuts = plane_depths(ray);
  for (std::size_t c = 0; c + 1 < cuts.size() && !integral.opaque(); ++c) {
    const double z0 = cuts[c], z1 = cuts[c + 1];
    Voxel voxel;
    if (!(z1 > z0) || !read_voxel(ray, ray.origin + ray.step * ((z0 + z1) / 2), voxel)) continue;
    add_stretch(ray, voxel, z0, z1, integral);
    pixel.length += (z1 - z0) * ray.length_per_depth;
    ++pixel.segments;
  }
}

Pixel GridReference::pixel(double x, double y) const {
  GridIntegral integral(knots_, emission_);
  Pixel pixel;
  integrate(x, y, integral, pixel);
  pixel.r = integral.color()[0], pixel.g = integral.color()[1], pixel.b = integral.color()[2];
  pixel.a = integral.opacity();
  pixel.z = integral.first_visible_depth();
  return pixel;
}

std::vector<Pixel> GridReference::layers(double x, double y, const Peel& peel) const {
  GridIntegral integral(knots_, emission_, peel);
  Pixel pixel;
  integrate(x, y, integral, pixel);
  return integral.layers();
}

std::vector<std::vector<Pixel>> GridReference::layers(std::span<const PixelIndex> wanted, const Peel& peel,
                                                      int threads) const {
  std::vector<std::vector<Pixel>> result(wanted.size());
  tbb::task_arena arena(scene::threads_for(threads));
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, wanted.size(),
                      [&](std::size_t i) { result[i] = layers(wanted[i].x + 0.5, wanted[i].y + 0.5, peel); });
  });
  return result;
}

}  // namespace tessera::reference
