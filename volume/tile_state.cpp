// SPDX-License-Identifier: BSD-3-Clause
#include "volume/tile_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "volume/tile_caster.hpp"

namespace tessera::volume {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns the packets of a tile that a pilot pass casts: the first `count` of an ordered dither, which is shifted from
/// tile to tile.
std::uint64_t pilot_packets_of(int tile_x, int tile_y, int count) {
  std::uint64_t packets = 0;
  for (int p = 0; p < TileRays::packets; ++p) {
    const int x = (p + 3 * tile_x + 5 * tile_y) % 8, y = (p / 8 + 5 * tile_x + 2 * tile_y) % 8;
    int order = 0;
    for (int bit = 0; bit < 3; ++bit) order = order << 2 | ((x ^ y) >> bit & 1) << 1 | (y >> bit & 1);
    if (order < count) packets |= std::uint64_t{1} << p;
  }
  return packets;
}

std::uint64_t packets_in(int x0, int y0, const scene::PixelRect& region) {
  static_assert(TileRays::packets == 64);
  std::uint64_t wanted = 0;
  for (int p = 0; p < TileRays::packets; ++p) {
    const int x = x0 + TileRays::pixel_x(p * TileRays::packet_rays),
              y = y0 + TileRays::pixel_y(p * TileRays::packet_rays);
    if (x < region.x1 && x + TileRays::packet_side > region.x0 && y < region.y1 &&
        y + TileRays::packet_side > region.y0)
      wanted |= std::uint64_t{1} << p;
  }
  return wanted;
}

bool has_all(const VoxelBox& chunk, const scene::GridIndex& voxels) {
  return chunk.low == scene::GridIndex{0, 0, 0} && chunk.high == voxels;
}

}  // namespace

void TileState::begin(const FrameView& frame, int x0, int y0, const scene::PixelRect& region, TileCounts& counts) {
  x0_ = x0, y0_ = y0, region_ = region;
  wanted_ = packets_in(x0, y0, region);
  if (frame.tally != nullptr)
    wanted_ &= pilot_packets_of(x0 / TileRays::side, y0 / TileRays::side, frame.pilot_packets);
  codes_ = axis_codes_of_tile(*frame.rays, x0, y0);
  for (int code = 0; code < RayAxes::codes; ++code) {
    if ((codes_ >> code & 1) == 0) continue;
    std::unique_ptr<TileRays>& of_code = rays_[static_cast<std::size_t>(code)];
    if (!of_code) of_code = std::make_unique<TileRays>();
    TileRays& rays = *of_code;
    set_up_tile(frame, x0, y0, code, rays);
    rays.clear_light();
    std::fill_n(rays.carried, TileRays::count, std::numeric_limits<float>::quiet_NaN());
    std::fill_n(rays.reached, TileRays::count, -infinity);
    std::fill_n(rays.passed, TileRays::count, 1.0f);
    std::fill_n(rays.closed, TileRays::count, std::uint8_t{0});
    for (int r = 0; r < TileRays::count; ++r)
      if (rays.k_in[r] < rays.k_out[r]) counts.rays += wanted_ >> (r / TileRays::packet_rays) & 1;
  }
}

bool TileState::enter(const FrameView& frame, const VoxelBox& chunk, int code) {
  TileRays& rays = this->rays(code);
  const RayAxes axes = RayAxes::of(code);
  const auto i = static_cast<std::size_t>(axes.i), j = static_cast<std::size_t>(axes.j),
             k = static_cast<std::size_t>(axes.k);
  const auto number = [](std::int64_t n) { return static_cast<double>(n); };
  const double end_k = number(frame.voxels[k]);
  const double low_k = axes.mirrored ? end_k - number(chunk.high[k]) : number(chunk.low[k]),
               high_k = axes.mirrored ? end_k - number(chunk.low[k]) : number(chunk.high[k]);
  const bool all = has_all(chunk, frame.voxels);
  bool any = false;
  for (int r = 0; r < TileRays::count; ++r) {
    double from = rays.k_in[r], to = rays.closed[r] != 0 ? -1 : rays.k_out[r];
    // Clips [from, to) to where a + b k is in the chunk. Chunks that share a plane compute the same k for this plane. A
    // ray in the plane belongs to the chunk above the plane; at the volume's last plane, to the chunk below it.
    const auto cut = [&](double a, double b, std::size_t axis) {
      const double low = number(chunk.low[axis]), high = number(chunk.high[axis]), end = number(frame.voxels[axis]);
      if (b == 0) {
        if (a < low || (a >= high && high < end)) to = -1;
        return;
      }
      const double at_low = (low - a) / b, at_high = (high - a) / b;
      // k_in and k_out already clip to the ends of the volume.
      if (low > 0) (b > 0 ? from : to) = b > 0 ? std::max(from, at_low) : std::min(to, at_low);
      if (high < end) (b > 0 ? to : from) = b > 0 ? std::min(to, at_high) : std::max(from, at_high);
    };
    if (!all && from < to) {
      from = std::max(from, low_k), to = std::min(to, high_k);
      cut(rays.ax[r], rays.bx[r], i);
      cut(rays.ay[r], rays.by[r], j);
    }
    rays.from[r] = from, rays.to[r] = to;
    if (!(from < to)) continue;
    any = true;
    rays.begun[r] = std::min(rays.begun[r], from), rays.reached[r] = std::max(rays.reached[r], to);
  }
  return any;
}

namespace {

bool is_open(const FrameView& frame, const TileRays& rays, int r) {
  return rays.k_in[r] < rays.k_out[r] && rays.closed[r] == 0 && rays.reached[r] < rays.k_out[r] &&
         rays.passed[r] * rays.transmittance[r] >= frame.least_transmittance;
}

}  // namespace

template <class F>
void TileState::with_ray(int x, int y, const F& f) const {
  const int ray = TileRays::ray_of(x - x0_, y - y0_);
  for (std::size_t code = 0; code < RayAxes::codes; ++code)
    if ((codes_ >> code & 1) != 0 && rays_[code]->k_in[ray] < rays_[code]->k_out[ray]) return f(*rays_[code], ray);
}

bool TileState::open(const FrameView& frame, int x, int y) const {
  bool open = false;
  with_ray(x, y, [&](const TileRays& rays, int r) { open = is_open(frame, rays, r); });
  return open;
}

bool TileState::any_open(const FrameView& frame) const {
  const scene::PixelRect inside = pixels();
  for (int y = inside.y0; y < inside.y1; ++y)
    for (int x = inside.x0; x < inside.x1; ++x)
      if (open(frame, x, y)) return true;
  return false;
}

float TileState::transmittance(int x, int y) const {
  float through = 1;
  with_ray(x, y, [&](const TileRays& rays, int r) { through = rays.passed[r] * rays.transmittance[r]; });
  return through;
}

void TileState::close(int x, int y) {
  with_ray(x, y, [](TileRays& rays, int r) { rays.closed[r] = 1; });
}

scene::PixelRect TileState::pixels() const {
  return {std::max(x0_, region_.x0), std::max(y0_, region_.y0), std::min(x0_ + TileRays::side, region_.x1),
          std::min(y0_ + TileRays::side, region_.y1)};
}

void TileState::fragments(const FrameView& frame, std::vector<RayFragment>& certain,
                          std::vector<UncertainRay>& uncertain) const {
  const scene::PixelRect inside = pixels();
  for (std::size_t code = 0; code < RayAxes::codes; ++code) {
    if ((codes_ >> code & 1) == 0) continue;
    const TileRays& rays = *rays_[code];
    const auto depth = [&](int r, double k) { return rays.depth_0[r] + rays.depth_k[r] * k; };
    for (int r = 0; r < TileRays::count; ++r) {
      const int x = x0_ + TileRays::pixel_x(r), y = y0_ + TileRays::pixel_y(r);
      if (x < inside.x0 || x >= inside.x1 || y < inside.y0 || y >= inside.y1 || !(rays.begun[r] < rays.reached[r]))
        continue;
      const float error_bound = rays.error_bound[r] + std::sqrt(rays.rough[r]);
      if (!(error_bound <= frame.error_tolerance)) {
        uncertain.push_back({x, y, rays.begun[r] > rays.k_in[r] ? depth(r, rays.begun[r]) : -infinity,
                             rays.reached[r] < rays.k_out[r] ? depth(r, rays.reached[r]) : infinity, error_bound});
        continue;
      }
      const float z_front = rays.first_k[r] >= 0 ? static_cast<float>(depth(r, rays.first_k[r]))
                                                 : std::numeric_limits<float>::quiet_NaN();
      certain.push_back({x, y, z_front, static_cast<float>(depth(r, rays.reached[r])), rays.red[r], rays.green[r],
                         rays.blue[r], rays.alpha[r], error_bound});
    }
  }
}

void TileState::restart() {
  for (std::size_t code = 0; code < RayAxes::codes; ++code) {
    if ((codes_ >> code & 1) == 0) continue;
    TileRays& rays = *rays_[code];
    for (int r = 0; r < TileRays::count; ++r) rays.passed[r] *= rays.transmittance[r];
    rays.clear_light();
  }
}

}  // namespace tessera::volume
