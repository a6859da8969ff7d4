#include "volume/voxel_walk.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace tessera::volume {
namespace {

constexpr std::int64_t block_side = 16, cell_side = 8;
constexpr std::size_t blocks_kept = 256;
constexpr double in_plane = 1e-9;  ///< voxels that a ray parallel to a plane may be off it, or leave it by

/// The voxel that has a place of the local frame, or is nearest.
std::int64_t voxel_along(const scene::GridGeometry& geometry, std::size_t axis, double local) {
  std::int64_t low = 0, high = geometry.points[axis] - 1;
  if (!geometry.rectilinear(axis)) {
    const double place = std::floor(local / geometry.spacing[static_cast<int>(axis)]);
    return static_cast<std::int64_t>(std::clamp(place, 0.0, static_cast<double>(high - 1)));
  }
  while (high - low > 1) {
    const std::int64_t middle = low + (high - low) / 2;
    (geometry.lattice(axis, middle) <= local ? low : high) = middle;
  }
  return low;
}

}  // namespace

VoxelRays::VoxelRays(const scene::Camera& camera, scene::ImageSize size, const scene::GridGeometry& geometry,
                     std::span<const scene::HalfSpace> clip)
    : camera_(camera),
      geometry_(geometry),
      basis_(scene::view_basis(camera)),
      to_local_(scene::world_to_local(geometry)),
      perspective_(camera.projection == scene::ProjectionKind::perspective),
      width_(size.width),
      height_(size.height) {
  const double half = perspective_ ? std::tan(camera.view_angle * std::numbers::pi / 360) : camera.parallel_scale;
  pixel_ = 2 * half / size.height;
  const scene::Box box = scene::bounds(geometry);
  for (int n = 0; n < 8; ++n) {
    const glm::dvec3 p((n & 1) != 0 ? box.high.x : box.low.x, (n & 2) != 0 ? box.high.y : box.low.y,
                       (n & 4) != 0 ? box.high.z : box.low.z);
    deepest_ = std::max(deepest_, std::abs(glm::dot(p - camera.position, basis_.forward)));
  }
  for (const scene::HalfSpace& h : clip) clip_.push_back({h.point, scene::unit_normal(h)});
}

void VoxelRays::cut(const glm::dvec3& from, const glm::dvec3& step, VoxelRay& ray) const {
  double voxel = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t last = geometry_.points[a] - 1;
    voxel = std::min(voxel, (geometry_.lattice(a, last) - geometry_.lattice(a, 0)) / static_cast<double>(last));
  }
  for (const scene::HalfSpace& h : clip_) {
    const double climb = glm::dot(h.normal, step), height = glm::dot(h.normal, from - h.point);
    if (std::abs(climb) * deepest_ >= in_plane * voxel) {
      (climb > 0 ? ray.begin : ray.end) =
          climb > 0 ? std::max(ray.begin, -height / climb) : std::min(ray.end, -height / climb);
      continue;
    }
    double side = height;
    if (std::abs(height) < in_plane * voxel) {
      const double by_x = glm::dot(h.normal, basis_.right), by_y = -glm::dot(h.normal, basis_.up);
      side = std::abs(by_x) > in_plane ? by_x : by_y;
    }
    if (side < 0) ray.end = ray.begin;
  }
}

VoxelRay VoxelRays::ray(double x, double y) const {
  const glm::dvec3 off = basis_.right * ((x - 0.5 * width_) * pixel_) + basis_.up * ((0.5 * height_ - y) * pixel_);
  const glm::dvec3 from = perspective_ ? camera_.position : camera_.position + off;
  const glm::dvec3 step = perspective_ ? basis_.forward + off : basis_.forward;
  VoxelRay ray{to_local_ * (from - geometry_.origin), to_local_ * step, glm::length(step), 0,
               std::numeric_limits<double>::infinity()};
  if (camera_.clipping_range) {
    ray.begin = std::max(0.0, camera_.clipping_range->near_distance);
    ray.end = camera_.clipping_range->far_distance;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const double low = geometry_.lattice(a, 0), high = geometry_.lattice(a, geometry_.points[a] - 1);
    const double voxel = (high - low) / static_cast<double>(geometry_.points[a] - 1);
    if (std::abs(ray.step[axis]) * deepest_ < in_plane * voxel) {
      // Rounding would have it change sides on its way.
      const double by_x = (to_local_ * basis_.right)[axis] * pixel_ * (perspective_ ? deepest_ : 1.0),
                   by_y = -(to_local_ * basis_.up)[axis];
      ray.step[axis] = 0;
      ray.aside[axis] = std::copysign(in_plane * voxel, std::abs(by_x) > in_plane * voxel ? by_x : by_y);
      const double place = ray.origin[axis] + ray.aside[axis];
      if (place < low || place >= high) {
        ray.end = ray.begin;
        continue;
      }
      const std::int64_t n = voxel_along(geometry_, a, place);
      for (const double plane : {geometry_.lattice(a, n), geometry_.lattice(a, n + 1)})
        if (std::abs(ray.origin[axis] - plane) < in_plane * voxel) ray.origin[axis] = plane;
      continue;
    }
    const double one = (low - ray.origin[axis]) / ray.step[axis], other = (high - ray.origin[axis]) / ray.step[axis];
    ray.begin = std::max(ray.begin, std::min(one, other));
    ray.end = std::min(ray.end, std::max(one, other));
  }
  cut(from, step, ray);
  return ray;
}

/// s over u in [0, 1], degree three.
struct VoxelWalk::FieldCubic {
  std::array<double, 4> c;

  [[nodiscard]] double at(double u) const { return ((c[3] * u + c[2]) * u + c[1]) * u + c[0]; }
  [[nodiscard]] double mean(double u0, double u1) const {
    const double m = (u0 + u1) / 2, h = (u1 - u0) / 2;
    return at(m) + (c[2] + 3 * c[3] * m) * h * h / 3;
  }
  /// Where the cubic, monotone from u0 to u1, takes a value between those at the ends.
  [[nodiscard]] double crossing(double u0, double u1, double value) const {
    const bool rising = at(u1) > at(u0);
    for (int n = 0; n < 60; ++n) {
      const double middle = (u0 + u1) / 2;
      ((at(middle) < value) == rising ? u0 : u1) = middle;
    }
    return u1;
  }
};

namespace {

/// Of the trilinear field from `front` on over `rise`, both in the voxel's unit cube.
std::array<double, 4> cubic_of(const std::array<double, 8>& corner, const glm::dvec3& front, const glm::dvec3& rise) {
  // Bilinear in each axis in turn, polynomials growing by a degree each.
  std::array<std::array<double, 4>, 8> p{};
  for (std::size_t n = 0; n < 8; ++n) p[n][0] = corner[n];
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t n = 0; n < (4u >> axis); ++n) {
      const std::array<double, 4> low = p[2 * n], high = p[2 * n + 1];
      for (std::size_t i = 0; i < 4; ++i) {
        p[n][i] = front[axis] == 1 ? high[i] : low[i] + (high[i] - low[i]) * front[axis];
        if (i > 0) p[n][i] += (high[i - 1] - low[i - 1]) * rise[axis];
      }
    }
  return p[0];
}

/// The places in (0, 1) where a cubic turns, after ends[0] and before a last 1.
void turning_points(const std::array<double, 4>& p, std::array<double, 4>& ends, std::size_t& count) {
  const double a = 3 * p[3], b = 2 * p[2], c = p[1], discriminant = b * b - 4 * a * c;
  if (!(discriminant > 0)) return;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
  double one = a != 0 ? q / a : -1, other = q != 0 ? c / q : -1;
  if (one > other) std::swap(one, other);
  for (const double u : {one, other})
    if (u > 0 && u < 1) ends[count++] = u;
  ends[count] = 1;
}

}  // namespace

scene::TransferFunction over_knot_numbers(const scene::TransferFunction& function) {
  std::vector<scene::Knot> knots(function.knots().begin(), function.knots().end());
  for (std::size_t k = 0; k < knots.size(); ++k) knots[k].value = static_cast<double>(k);
  return scene::TransferFunction(std::move(knots));
}

VoxelWalk::VoxelWalk(const scene::SampleSource& source, const scene::TransferFunction& function,
                     const WalkSettings& settings)
    : source_(source),
      geometry_(source.geometry()),
      settings_(settings),
      samples_(geometry_.samples()),
      shared_(geometry_.association == scene::Association::point ? 1 : 0),
      blocks_(blocks_kept),
      knots_(function.knots().begin(), function.knots().end()),
      independent_(settings.emission == scene::Emission::independent) {
  const scene::GridIndex voxels = geometry_.voxels();
  for (std::size_t a = 0; a < 3; ++a) cells_[a] = (voxels[a] + cell_side - 1) / cell_side;
}

std::array<double, 8> VoxelWalk::corners(const scene::GridIndex& voxel) {
  const scene::GridIndex place{voxel[0] / block_side, voxel[1] / block_side, voxel[2] / block_side};
  Block& block = blocks_[static_cast<std::size_t>(place[0] + 7 * place[1] + 49 * place[2]) % blocks_kept];
  if (block.place != place || block.values.empty()) fill(block, place);
  const std::int64_t width = block.box.extent(0), slice = width * block.box.extent(1);
  const double* const at = &block.values[static_cast<std::size_t>(
      (voxel[0] - block.box.low[0]) + width * (voxel[1] - block.box.low[1]) + slice * (voxel[2] - block.box.low[2]))];
  const std::int64_t i = shared_, j = shared_ * width, k = shared_ * slice;
  return {at[0], at[i], at[j], at[i + j], at[k], at[k + i], at[k + j], at[k + i + j]};
}

void VoxelWalk::fill(Block& block, const scene::GridIndex& place) {
  for (std::size_t a = 0; a < 3; ++a) {
    block.box.low[a] = place[a] * block_side;
    block.box.high[a] = std::min(block.box.low[a] + block_side + shared_, samples_[a]);
  }
  block.values.resize(static_cast<std::size_t>(block.box.count()));
  block.place = place;
  source_.read(block.box, std::span<double>(block.values));
  for (double& v : block.values) v = std::isfinite(v) ? source_.grid().value(v) : std::nan("");
  ++counts_.blocks_read;
  counts_.bytes_read += static_cast<std::uint64_t>(block.box.count()) * scene::size_of(source_.grid().type);
}

void VoxelWalk::walk(const VoxelRay& ray, WalkSink& sink) {
  if (!(ray.begin < ray.end)) return;
  // Along each axis the voxel and the depth of its far plane, each computed from the plane alone.
  scene::GridIndex voxel{}, last{}, step{};
  std::array<double, 3> next{};
  constexpr double never = std::numeric_limits<double>::infinity();
  const auto plane = [&](std::size_t a) {
    const int axis = static_cast<int>(a);
    return (geometry_.lattice(a, voxel[a] + (step[a] > 0 ? 1 : 0)) - ray.origin[axis]) / ray.step[axis];
  };
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    step[a] = ray.step[axis] < 0 ? -1 : 1;
    voxel[a] = voxel_along(geometry_, a, ray.origin[axis] + ray.begin * ray.step[axis] + ray.aside[axis]);
    last[a] = step[a] > 0 ? geometry_.points[a] - 2 : 0;
    next[a] = ray.step[axis] == 0 ? never : plane(a);
  }
  const auto forward = [&](std::size_t a) {
    if (voxel[a] == last[a]) {
      next[a] = never;
    } else {
      voxel[a] += step[a];
      next[a] = plane(a);
    }
  };
  double z = ray.begin;
  while (z < ray.end) {
    // Planes that are passed already, by rounding or at once with another.
    std::size_t a = next[0] <= next[1] && next[0] <= next[2] ? 0 : next[1] <= next[2] ? 1 : 2;
    const double end = std::min(next[a], ray.end);
    if (end > z) {
      if (sink.transmittance() < settings_.least) return;
      cross(ray, voxel, z, end, sink);
      z = end;
    }
    if (next[a] == never) return;
    forward(a);
  }
}

/// The voxel that a ray is in from depth z0 to z1.
void VoxelWalk::cross(const VoxelRay& ray, const scene::GridIndex& voxel, double z0, double z1, WalkSink& sink) {
  if (!settings_.visible.empty() &&
      settings_.visible[static_cast<std::size_t>(
          voxel[0] / cell_side + cells_[0] * (voxel[1] / cell_side + cells_[1] * (voxel[2] / cell_side)))] == 0)
    return;
  ++counts_.voxels;
  VoxelStretch stretch{z0, z1, corners(voxel), {}, {}, {}};
  const std::array<double, 8>& corner = stretch.corner;
  double low = corner[0], high = corner[0], all = 0;
  for (const double s : corner) low = std::min(low, s), high = std::max(high, s), all += s;
  if (std::isnan(all) || !shows(low, high)) return;
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const double first = geometry_.lattice(a, voxel[a]), side = geometry_.lattice(a, voxel[a] + 1) - first;
    stretch.front[axis] = (ray.origin[axis] + z0 * ray.step[axis] - first) / side;
    stretch.rise[axis] = (z1 - z0) * ray.step[axis] / side;
    stretch.side[axis] = side;
  }
  sink.enter(stretch);
  const auto first = std::lower_bound(knots_.begin(), knots_.end(), low,
                                      [](const scene::Knot& knot, double v) { return knot.value < v; });
  origin_ = first != knots_.end() && first->value <= high ? first->value : low;
  if (low == high) {  // cell data too
    const double number = knot_number(knots_above(low - origin_), low - origin_);
    return sink.line(z0, z1, number, number);
  }
  std::array<double, 8> differences;
  std::transform(corner.begin(), corner.end(), differences.begin(), [&](double s) { return s - origin_; });
  const FieldCubic field{cubic_of(differences, stretch.front, stretch.rise)};
  const double length = (z1 - z0) * ray.length_per_depth;

  std::array<double, 4> ends{0, 1, 1, 1};
  std::size_t count = 1;
  turning_points(field.c, ends, count);
  for (std::size_t e = 0; e < count; ++e) {
    double u = ends[e];
    const double stop = ends[e + 1], s_stop = field.at(stop);
    // Monotone from u to stop: knots come in order.
    while (u < stop) {
      const double s = field.at(u);
      const bool up = s_stop >= s;
      const double knot = next_knot(s, u > ends[e] ? last_knot_ : std::nan(""), up);
      const double next = (up ? knot < s_stop : knot > s_stop) ? field.crossing(u, stop, knot) : stop;
      last_knot_ = knot;
      if (next > u) add_smooth(field, u, next, length, z0, z1, 0, sink);
      if (!(next > u) && next != stop) {  // the crossing is here: past the knot
        u = std::nextafter(u, 2.0);
        continue;
      }
      u = next;
    }
  }
}

/// The first knot ahead of s; not the one just crossed. Infinite if there is none.
double VoxelWalk::next_knot(double s, double crossed, bool up) const {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (up) {
    const std::size_t k = knots_above(std::isnan(crossed) ? s : std::max(s, crossed));
    return k == knots_.size() ? none : knots_[k].value - origin_;
  }
  const double past = std::isnan(crossed) ? s : std::min(s, crossed);
  const auto k = std::lower_bound(knots_.begin(), knots_.end(), past,
                                  [&](const scene::Knot& knot, double v) { return knot.value - origin_ < v; });
  return k == knots_.begin() ? -none : std::prev(k)->value - origin_;
}

/// The first knot beyond s.
std::size_t VoxelWalk::knots_above(double s) const {
  return static_cast<std::size_t>(
      std::upper_bound(knots_.begin(), knots_.end(), s,
                       [&](double v, const scene::Knot& knot) { return v < knot.value - origin_; }) -
      knots_.begin());
}

/// Of s, which lies between the knot `above` and the one before it.
double VoxelWalk::knot_number(std::size_t above, double s) const {
  if (above == 0) return -1;
  const auto below = static_cast<double>(above - 1);
  if (above == knots_.size()) return below;
  const double low = knots_[above - 1].value - origin_, high = knots_[above].value - origin_;
  return below + std::clamp((s - low) / (high - low), 0.0, 1.0);
}

/// A monotone stretch in one interval of the transfer function: halved until a line through its mean is enough.
void VoxelWalk::add_smooth(const FieldCubic& p, double u0, double u1, double length, double z0, double z1, int halvings,
                           WalkSink& sink) const {
  const double s_0 = p.at(u0), s_1 = p.at(u1), middle = p.at((u0 + u1) / 2), e = u1 - u0;
  const std::size_t above = knots_above(middle);
  // The line that stands for the stretch is its chord, moved to the mean.
  const double shift = p.mean(u0, u1) - (s_0 + s_1) / 2;
  double low = -std::numeric_limits<double>::infinity(), high = -low, kappa = 0;
  if (above > 0) low = knots_[above - 1].value - origin_, kappa = knots_[above - 1].extinction;
  if (above < knots_.size()) high = knots_[above].value - origin_, kappa = std::max(kappa, knots_[above].extinction);
  if (above > 0 && above < knots_.size() && halvings < 12) {
    const scene::Knot &a = knots_[above - 1], &b = knots_[above];
    const double width = high - low, slope = std::abs(b.extinction - a.extinction) / width;
    const glm::dvec3 change = glm::abs(b.color - a.color) / width;
    const double color_slope = std::max({change.x, change.y, change.z});
    const double color = std::max({a.color.x, a.color.y, a.color.z, b.color.x, b.color.y, b.color.z});
    const double l = e * length, span = std::abs(s_1 - s_0), even = std::abs(middle - (s_0 + s_1) / 2);
    const double odd = std::abs(p.c[3]) * e * e * e, rho = even + odd / 4;
    const double tau = kappa * l, weight = independent_ ? l : tau;
    // Beyond the interval's ends, which lines are kept in, goes what the move takes there.
    const double cut = std::max({0.0, low - std::min(s_0, s_1) - shift, std::max(s_0, s_1) + shift - high});
    const double cut_error = l * cut * (slope * std::max(1.0, color) + (independent_ ? 1 : kappa) * color_slope);
    const double error = cut_error +
                         l * rho * (rho + 0.3 * span) * (0.1 * slope * color_slope + 0.03 * slope * slope * color * l) +
                         color_slope * weight * tau * (odd / 120 + tau * even / 90);
    if (error * sink.transmittance() > settings_.tolerance) {
      add_smooth(p, u0, (u0 + u1) / 2, length, z0, z1, halvings + 1, sink);
      add_smooth(p, (u0 + u1) / 2, u1, length, z0, z1, halvings + 1, sink);
      return;
    }
  }
  const auto depth = [&](double u) { return u == 0 ? z0 : u == 1 ? z1 : z0 + (z1 - z0) * u; };
  sink.line(depth(u0), depth(u1), knot_number(above, s_0 + shift), knot_number(above, s_1 + shift));
}

/// Whether anything between two values shows.
bool VoxelWalk::shows(double low, double high) const {
  const auto lit = [&](const scene::Knot& k) {
    return k.extinction > 0 || (independent_ && std::max({k.color.x, k.color.y, k.color.z}) > 0);
  };
  const auto first = std::upper_bound(knots_.begin(), knots_.end(), low,
                                      [](double v, const scene::Knot& knot) { return v < knot.value; });
  const auto last = std::upper_bound(knots_.begin(), knots_.end(), high,
                                     [](double v, const scene::Knot& knot) { return v < knot.value; });
  return std::any_of(first == knots_.begin() ? first : std::prev(first), last == knots_.end() ? last : std::next(last),
                     lit);
}

}  // namespace tessera::volume
