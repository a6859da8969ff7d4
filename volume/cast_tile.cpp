#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "volume/tile_caster.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/cast_tile.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "volume/cast_slabs-inl.h"
#include "volume/fill_block-inl.h"
#include "volume/ray_setup-inl.h"
#include "volume/sample_slabs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// Where a packet's rays may be in the chunk that begins at first_k; `any` if there are any that it may add to.
HWY_INLINE Reach reach_of(const FrameView& frame, const TileRays& rays, int packet, double first_k, double last_k) {
  namespace HN = hwy::HWY_NAMESPACE;
  const HN::ScalableTag<double> d;
  const auto most = HN::Set(d, 1e30), least = HN::Set(d, -1e30);
  auto x_low_0 = most, x_low_1 = most, y_low_0 = most, y_low_1 = most;
  auto x_high_0 = least, x_high_1 = least, y_high_0 = least, y_high_1 = least;
  const auto k_0 = HN::Set(d, first_k), k_1 = HN::Set(d, first_k + SlabBlock::slabs);
  const auto first = static_cast<std::size_t>(packet) * TileRays::packet_rays;
  bool any = false;
  for (std::size_t r = first; r < first + TileRays::packet_rays; r += HN::Lanes(d)) {
    const auto through = HN::PromoteTo(d, HN::LoadU(HN::Rebind<float, decltype(d)>(), rays.transmittance + r));
    const auto here = HN::And(
        HN::And(HN::Lt(HN::Load(d, rays.k_in + r), HN::Set(d, last_k)), HN::Gt(HN::Load(d, rays.k_out + r), k_0)),
        HN::Ge(through, HN::Set(d, static_cast<double>(frame.least_transmittance))));
    any = any || !HN::AllFalse(d, here);
    const auto widen = [&](const double* a, const double* b, auto k, auto& low, auto& high) HWY_ATTR {
      const auto place = HN::MulAdd(HN::Load(d, b + r), k, HN::Load(d, a + r));
      low = HN::Min(low, HN::IfThenElse(here, place, most));
      high = HN::Max(high, HN::IfThenElse(here, place, least));
    };
    widen(rays.ax, rays.bx, k_0, x_low_0, x_high_0);
    widen(rays.ax, rays.bx, k_1, x_low_1, x_high_1);
    widen(rays.ay, rays.by, k_0, y_low_0, y_high_0);
    widen(rays.ay, rays.by, k_1, y_low_1, y_high_1);
  }
  Reach reach;
  const auto lowest = [&](auto v) HWY_ATTR { return static_cast<float>(HN::GetLane(HN::MinOfLanes(d, v))); };
  const auto highest = [&](auto v) HWY_ATTR { return static_cast<float>(HN::GetLane(HN::MaxOfLanes(d, v))); };
  if (any) {
    reach.x_low[0] = lowest(x_low_0), reach.x_low[1] = lowest(x_low_1);
    reach.x_high[0] = highest(x_high_0), reach.x_high[1] = highest(x_high_1);
    reach.y_low[0] = lowest(y_low_0), reach.y_low[1] = lowest(y_low_1);
    reach.y_high[0] = highest(y_high_0), reach.y_high[1] = highest(y_high_1);
  }
  reach.any = any;
  return reach;
}

/// Lays out slabs and slices round all that the packets may meet; false if the transfer function hides all of it.
HWY_INLINE bool lay_out(const FrameView& frame, const RayAxes& axes, const Reach& tile, std::int64_t first_k, int slabs,
                        int slices, SlabBlock& block) {
  const auto ia = static_cast<std::size_t>(axes.i), ja = static_cast<std::size_t>(axes.j),
             ka = static_cast<std::size_t>(axes.k);
  const int corner = frame.cell_data ? 0 : 1;
  std::int64_t low[3] = {1 << 30, 1 << 30, 1 << 30}, high[3] = {-1, -1, -1};
  for (int n = 0; n < slabs; ++n) {
    const auto s = static_cast<std::size_t>(n);
    slab_range(tile.x_low, tile.x_high, n, static_cast<int>(frame.voxels[ia]), block.slab_i[s], block.slab_i_last[s]);
    slab_range(tile.y_low, tile.y_high, n, static_cast<int>(frame.voxels[ja]), block.slab_j[s], block.slab_j_last[s]);
    low[ia] = std::min<std::int64_t>(low[ia], block.slab_i[s]);
    high[ia] = std::max<std::int64_t>(high[ia], block.slab_i_last[s]);
    low[ja] = std::min<std::int64_t>(low[ja], block.slab_j[s]);
    high[ja] = std::max<std::int64_t>(high[ja], block.slab_j_last[s]);
    block.slab_i_last[s] = std::max(block.slab_i_last[s] + corner, block.slab_i[s] + 7);
    block.slab_j_last[s] = std::max(block.slab_j_last[s] + corner, block.slab_j[s] + 7);
  }
  low[ka] = axes.mirrored ? frame.voxels[ka] - first_k - slabs : first_k;
  high[ka] = low[ka] + slabs - 1;
  if (!any_visible(frame, low, high)) return false;
  block.pitch = block.rows = 0;
  for (int n = 0; n < slices; ++n) {
    const auto a = static_cast<std::size_t>(std::max(0, n - 1)), b = static_cast<std::size_t>(std::min(n, slabs - 1)),
               s = static_cast<std::size_t>(n);
    block.low_i[s] = std::min(block.slab_i[a], block.slab_i[b]);
    block.low_j[s] = std::min(block.slab_j[a], block.slab_j[b]);
    block.pitch = std::max<std::ptrdiff_t>(block.pitch,
                                           std::max(block.slab_i_last[a], block.slab_i_last[b]) - block.low_i[s] + 1);
    block.rows =
        std::max<std::ptrdiff_t>(block.rows, std::max(block.slab_j_last[a], block.slab_j_last[b]) - block.low_j[s] + 1);
  }
  block.reserve();
  return true;
}

/// Packets that `wanted` leaves out are laid out, as what others find must not depend on them, but not cast.
HWY_INLINE void cast_rays(const FrameView& frame, const RayAxes& axes, std::uint64_t wanted, TileMemory& memory,
                          TileCounts& counts) {
  TileRays& rays = memory.rays;
  double first = 1e30, last = -1e30;
  for (int r = 0; r < TileRays::count; ++r) {
    if (!(rays.k_in[r] < rays.k_out[r])) continue;
    first = std::min(first, rays.k_in[r]), last = std::max(last, rays.k_out[r]);
    counts.rays += wanted >> (r / TileRays::packet_rays) & 1;
  }
  const std::int64_t end_k = frame.voxels[static_cast<std::size_t>(axes.k)];
  if (!(first < last)) return;
  Reach reach[TileRays::packets];
  for (std::int64_t k = static_cast<std::int64_t>(first) / SlabBlock::slabs * SlabBlock::slabs;
       k < end_k && static_cast<double>(k) < last; k += SlabBlock::slabs) {
    const int slabs = static_cast<int>(std::min<std::int64_t>(SlabBlock::slabs, end_k - k));
    Reach tile{{1e30f, 1e30f}, {-1e30f, -1e30f}, {1e30f, 1e30f}, {-1e30f, -1e30f}, false};
    for (int p = 0; p < TileRays::packets; ++p) {
      const auto first_k = static_cast<double>(k);
      reach[p].any = false;
      if (frame.tally != nullptr && (wanted >> p & 1) == 0) continue;  // a pilot pass makes no light
      reach[p] = reach_of(frame, rays, p, first_k, first_k + slabs);
      if (!reach[p].any) continue;
      tile.any = true;
      for (int e = 0; e < 2; ++e) {
        tile.x_low[e] = std::min(tile.x_low[e], reach[p].x_low[e]);
        tile.x_high[e] = std::max(tile.x_high[e], reach[p].x_high[e]);
        tile.y_low[e] = std::min(tile.y_low[e], reach[p].y_low[e]);
        tile.y_high[e] = std::max(tile.y_high[e], reach[p].y_high[e]);
      }
    }
    const int slices = slabs + (frame.cell_data ? 0 : 1);
    if (!tile.any || !lay_out(frame, axes, tile, k, slabs, slices, memory.block)) continue;
    bool any = false;
    for (int p = 0; p < TileRays::packets; ++p) {
      reach[p].any = reach[p].any && (wanted >> p & 1) != 0;
      any = any || reach[p].any;
    }
    if (!any) continue;
    fill_block(frame, axes, k, slices, memory.row, memory.block);
    const ChunkView chunk{frame, axes, memory.block, k, slabs, reach};
    if (frame.step > 0 && frame.tally == nullptr)
      sample_chunk(chunk, rays, counts);
    else
      cast_chunk(chunk, rays, counts);
  }
}

/// The packets of a tile that a pilot pass casts: the first `count` of an ordered dither, shifted from tile to tile.
HWY_INLINE std::uint64_t pilot_packets_of(int tile_x, int tile_y, int count) {
  std::uint64_t packets = 0;
  for (int p = 0; p < TileRays::packets; ++p) {
    const int x = (p + 3 * tile_x + 5 * tile_y) % 8, y = (p / 8 + 5 * tile_x + 2 * tile_y) % 8;
    int order = 0;
    for (int bit = 0; bit < 3; ++bit) order = order << 2 | ((x ^ y) >> bit & 1) << 1 | (y >> bit & 1);
    if (order < count) packets |= std::uint64_t{1} << p;
  }
  return packets;
}

void cast_tile_here(const FrameView& frame, int x0, int y0, const scene::PixelRect& region, TileMemory& memory,
                    scene::Image* image, TileCounts& counts, float* error_bounds) {
  TileRays& rays = memory.rays;
  for (int r = 0; r < TileRays::count; ++r) {
    rays.alpha[r] = rays.red[r] = rays.green[r] = rays.blue[r] = 0;
    rays.transmittance[r] = 1;
    rays.error_bound[r] = rays.rough[r] = 0;
    rays.carried[r] = std::numeric_limits<float>::quiet_NaN();
    rays.first_k[r] = std::numeric_limits<double>::quiet_NaN();
  }
  static_assert(TileRays::packets == 64);
  std::uint64_t wanted = 0;
  for (int p = 0; p < TileRays::packets; ++p) {
    const int x = x0 + TileRays::pixel_x(p * TileRays::packet_rays),
              y = y0 + TileRays::pixel_y(p * TileRays::packet_rays);
    if (x < region.x1 && x + TileRays::packet_side > region.x0 && y < region.y1 &&
        y + TileRays::packet_side > region.y0)
      wanted |= std::uint64_t{1} << p;
  }
  if (frame.tally != nullptr) wanted &= pilot_packets_of(x0 / TileRays::side, y0 / TileRays::side, frame.pilot_packets);
  const unsigned codes = axis_codes(*frame.rays, x0, y0);
  for (int code = 0; code < 6; ++code) {
    if ((codes >> code & 1) == 0) continue;
    set_up_rays(frame, x0, y0, code, rays);
    cast_rays(frame, RayAxes::of(code), wanted, memory, counts);
    for (int r = 0; image != nullptr && r < TileRays::count; ++r) {
      const int x = x0 + TileRays::pixel_x(r), y = y0 + TileRays::pixel_y(r);
      if (x < region.x0 || x >= region.x1 || y < region.y0 || y >= region.y1 || !(rays.k_in[r] < rays.k_out[r]))
        continue;
      const float error_bound = rays.error_bound[r] + std::sqrt(rays.rough[r]);
      if (error_bounds != nullptr) error_bounds[image->index(x, y)] = error_bound;
      if (!(error_bound <= frame.error_tolerance)) {
        memory.uncertain.push_back({x, y});
        continue;
      }
      const std::size_t pixel = image->index(x, y);
      float* const rgba = &image->rgba[4 * pixel];
      rgba[0] = std::max(0.0f, rays.red[r]), rgba[1] = std::max(0.0f, rays.green[r]);
      rgba[2] = std::max(0.0f, rays.blue[r]), rgba[3] = std::min(1.0f, std::max(0.0f, rays.alpha[r]));
      if (rgba[3] > 0 && rays.first_k[r] >= 0)
        image->depth[pixel] = static_cast<float>(rays.depth_0[r] + rays.depth_k[r] * rays.first_k[r]);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::volume {
HWY_EXPORT(cast_tile_here);
void cast_tile(const FrameView& frame, int x0, int y0, const scene::PixelRect& region, TileMemory& memory,
               scene::Image* image, TileCounts& counts, float* error_bounds) {
  HWY_DYNAMIC_DISPATCH(cast_tile_here)(frame, x0, y0, region, memory, image, counts, error_bounds);
}
}  // namespace tessera::volume
#endif  // HWY_ONCE
