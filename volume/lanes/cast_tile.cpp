// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "volume/tile_caster.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/lanes/cast_tile.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "volume/bricks/fill_block-inl.h"
#include "volume/lanes/packet_lanes-inl.h"
#include "volume/lanes/ray_setup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// Returns bounds of a packet's rays in the chunk that begins at first_k. `any` states whether light may be added to
/// any of these rays.
HWY_INLINE Reach reach_of(const FrameView& frame, const TileRays& rays, int packet, double first_k, double last_k) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::ScalableTag<double> d;
  const auto most = Set(d, 1e30), least = Set(d, -1e30);
  auto x_low_0 = most, x_low_1 = most, y_low_0 = most, y_low_1 = most;
  auto x_high_0 = least, x_high_1 = least, y_high_0 = least, y_high_1 = least;
  const auto k_0 = Set(d, first_k), k_1 = Set(d, first_k + SlabBlock::slabs);
  const auto first = static_cast<std::size_t>(packet) * TileRays::packet_rays;
  bool any = false;
  for (std::size_t r = first; r < first + TileRays::packet_rays; r += hn::Lanes(d)) {
    const auto through = PromoteTo(d, LoadU(hn::Rebind<float, decltype(d)>(), rays.transmittance + r));
    const auto here = And(And(Load(d, rays.from + r) < Set(d, last_k), Load(d, rays.to + r) > k_0),
                          through >= Set(d, static_cast<double>(frame.least_transmittance)));
    any = any || !AllFalse(d, here);
    const auto widen = [&](const double* a, const double* b, auto k, auto& low, auto& high) HWY_ATTR {
      const auto place = MulAdd(Load(d, b + r), k, Load(d, a + r));
      low = Min(low, IfThenElse(here, place, most));
      high = Max(high, IfThenElse(here, place, least));
    };
    widen(rays.ax, rays.bx, k_0, x_low_0, x_high_0);
    widen(rays.ax, rays.bx, k_1, x_low_1, x_high_1);
    widen(rays.ay, rays.by, k_0, y_low_0, y_high_0);
    widen(rays.ay, rays.by, k_1, y_low_1, y_high_1);
  }
  Reach reach;
  const auto lowest = [&](auto v) HWY_ATTR { return static_cast<float>(GetLane(MinOfLanes(d, v))); };
  const auto highest = [&](auto v) HWY_ATTR { return static_cast<float>(GetLane(MaxOfLanes(d, v))); };
  if (any) {
    reach.x_low[0] = lowest(x_low_0), reach.x_low[1] = lowest(x_low_1);
    reach.x_high[0] = highest(x_high_0), reach.x_high[1] = highest(x_high_1);
    reach.y_low[0] = lowest(y_low_0), reach.y_low[1] = lowest(y_low_1);
    reach.y_high[0] = highest(y_high_0), reach.y_high[1] = highest(y_high_1);
  }
  reach.any = any;
  return reach;
}

/// Lays out slabs and slices around all voxels that the packets may meet. Returns false if all of these voxels are
/// invisible.
HWY_INLINE bool lay_out(const FrameView& frame, const RayAxes& axes, const Reach& tile, const ChunkBox& box,
                        SlabBlock& block) {
  const auto ia = static_cast<std::size_t>(axes.i), ja = static_cast<std::size_t>(axes.j),
             ka = static_cast<std::size_t>(axes.k);
  const int corner = frame.cell_data ? 0 : 1, slabs = box.slabs, slices = slabs + corner;
  std::int64_t low[3] = {1 << 30, 1 << 30, 1 << 30}, high[3] = {-1, -1, -1};
  for (int n = 0; n < slabs; ++n) {
    const auto s = static_cast<std::size_t>(n);
    const VoxelRange i = slab_range(tile.x_low, tile.x_high, n, {box.i_low, box.i_last}),
                     j = slab_range(tile.y_low, tile.y_high, n, {box.j_low, box.j_last});
    block.slab_i[s] = i.first, block.slab_i_last[s] = i.last;
    block.slab_j[s] = j.first, block.slab_j_last[s] = j.last;
    low[ia] = std::min<std::int64_t>(low[ia], block.slab_i[s]);
    high[ia] = std::max<std::int64_t>(high[ia], block.slab_i_last[s]);
    low[ja] = std::min<std::int64_t>(low[ja], block.slab_j[s]);
    high[ja] = std::max<std::int64_t>(high[ja], block.slab_j_last[s]);
    block.slab_i_last[s] = std::max(block.slab_i_last[s] + corner, block.slab_i[s] + 7);
    block.slab_j_last[s] = std::max(block.slab_j_last[s] + corner, block.slab_j[s] + 7);
  }
  const std::int64_t first = box.first_k + box.first_slab, last = box.first_k + slabs - 1;
  low[ka] = axes.mirrored ? frame.voxels[ka] - 1 - last : first;
  high[ka] = axes.mirrored ? frame.voxels[ka] - 1 - first : last;
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
  block.has_rest = frame.has_rest;
  block.reserve();
  return true;
}

HWY_INLINE void cast_by_form(const ChunkView& chunk, TileRays& rays, TileCounts& counts) {
  // A pilot pass measures the work of exact integrals.
  if (chunk.frame.step > 0 && chunk.frame.tally == nullptr) return cast_chunk_in_steps(chunk, rays, counts);
  switch (CL::form_of(*chunk.frame.table)) {
    case CL::TableForm::one_vector:
      return cast_chunk_one_vector(chunk, rays, counts);
    case CL::TableForm::two_vectors:
      return cast_chunk_two_vectors(chunk, rays, counts);
    case CL::TableForm::many:
      return cast_chunk_many(chunk, rays, counts);
  }
}

/// Casts rays of one axis code through a chunk of the volume. Packets that are not wanted are laid out, so that the
/// bits of other packets do not depend on which packets are wanted, but they are not cast.
void cast_rays(const FrameView& frame, const VoxelBox& voxels, TileState& tile, int code, TileMemory& memory,
               TileCounts& counts) {
  const RayAxes axes = RayAxes::of(code);
  const std::uint64_t wanted = tile.wanted();
  TileRays& rays = tile.rays(code);
  double first = 1e30, last = -1e30;
  for (int r = 0; r < TileRays::count; ++r) {
    if (!(rays.from[r] < rays.to[r])) continue;
    first = std::min(first, rays.from[r]), last = std::max(last, rays.to[r]);
  }
  if (!(first < last)) return;
  const auto ia = static_cast<std::size_t>(axes.i), ja = static_cast<std::size_t>(axes.j),
             ka = static_cast<std::size_t>(axes.k);
  const std::int64_t begin_k = axes.mirrored ? frame.voxels[ka] - voxels.high[ka] : voxels.low[ka],
                     end_k = axes.mirrored ? frame.voxels[ka] - voxels.low[ka] : voxels.high[ka];
  ChunkBox box{0,
               0,
               0,
               static_cast<int>(voxels.low[ia]),
               static_cast<int>(voxels.high[ia]) - 1,
               static_cast<int>(voxels.low[ja]),
               static_cast<int>(voxels.high[ja]) - 1,
               voxels.low,
               voxels.high};
  Reach reach[TileRays::packets];
  for (std::int64_t k = static_cast<std::int64_t>(first) / SlabBlock::slabs * SlabBlock::slabs;
       k < end_k && static_cast<double>(k) < last; k += SlabBlock::slabs) {
    box.first_k = k;
    box.first_slab = static_cast<int>(std::max<std::int64_t>(0, begin_k - k));
    box.slabs = static_cast<int>(std::min<std::int64_t>(SlabBlock::slabs, end_k - k));
    Reach all{{1e30f, 1e30f}, {-1e30f, -1e30f}, {1e30f, 1e30f}, {-1e30f, -1e30f}, false};
    for (int p = 0; p < TileRays::packets; ++p) {
      const auto first_k = static_cast<double>(k);
      reach[p].any = false;
      if (frame.tally != nullptr && (wanted >> p & 1) == 0) continue;  // a pilot pass produces no light
      reach[p] = reach_of(frame, rays, p, first_k, first_k + box.slabs);
      if (!reach[p].any) continue;
      all.any = true;
      for (int e = 0; e < 2; ++e) {
        all.x_low[e] = std::min(all.x_low[e], reach[p].x_low[e]);
        all.x_high[e] = std::max(all.x_high[e], reach[p].x_high[e]);
        all.y_low[e] = std::min(all.y_low[e], reach[p].y_low[e]);
        all.y_high[e] = std::max(all.y_high[e], reach[p].y_high[e]);
      }
    }
    if (!all.any) continue;
    if (!lay_out(frame, axes, all, box, memory.block)) {
      if (frame.preintegrated != nullptr) skip_chunk_in_steps({frame, axes, memory.block, box, reach}, rays);
      continue;
    }
    bool any = false;
    for (int p = 0; p < TileRays::packets; ++p) {
      reach[p].any = reach[p].any && (wanted >> p & 1) != 0;
      any = any || reach[p].any;
    }
    if (!any) continue;
    fill_block(frame, axes, box, memory.row, memory.block);
    const ChunkView chunk{frame, axes, memory.block, box, reach};
    cast_by_form(chunk, rays, counts);
  }
}

unsigned axis_codes_here(const PixelRays& rays, int x0, int y0) { return axis_codes(rays, x0, y0); }

void set_up_here(const FrameView& frame, int x0, int y0, int code, TileRays& rays) {
  set_up_rays(frame, x0, y0, code, rays);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::volume {

HWY_EXPORT(cast_rays);
HWY_EXPORT(axis_codes_here);
HWY_EXPORT(set_up_here);

void cast_tile(const FrameView& frame, const VoxelBox& chunk, TileState& tile, TileMemory& memory, TileCounts& counts) {
  for (int code = 0; code < RayAxes::codes; ++code)
    if ((tile.codes() >> code & 1) != 0 && tile.enter(frame, chunk, code))
      HWY_DYNAMIC_DISPATCH(cast_rays)(frame, chunk, tile, code, memory, counts);
}

unsigned axis_codes_of_tile(const PixelRays& rays, int x0, int y0) {
  return HWY_DYNAMIC_DISPATCH(axis_codes_here)(rays, x0, y0);
}

void set_up_tile(const FrameView& frame, int x0, int y0, int code, TileRays& rays) {
  HWY_DYNAMIC_DISPATCH(set_up_here)(frame, x0, y0, code, rays);
}

}  // namespace tessera::volume
#endif  // HWY_ONCE
