// SPDX-License-Identifier: BSD-3-Clause
// A packet's rays in one chunk of 32 slabs: their bounds, their positions, and their paths through a slab voxel by
// voxel. Included once per instruction set (Highway's include guard idiom).
//
// What      Along axis k a ray passes from slab to slab; along i and j it is at (x, y) + (bx, by) k.
// How       |bx|, |by| <= 1, so in a slab a ray crosses at most one plane of each other axis. This makes at most three
//           stretches, each in one voxel.
// Accuracy  Positions are floats relative to the voxel that contains the ray at the chunk's first plane, computed in
//           double precision for each chunk: the error is at most 2e-6 voxels.
// Bits      Therefore positions depend on ray and chunk only.
// Ends      Crossings are clamped to the part of the slab that is in the ray's range: no stretch has a negative length.

#if defined(TESSERA_VOLUME_PACKET_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_PACKET_LANES_INL_H_
#undef TESSERA_VOLUME_PACKET_LANES_INL_H_
#else
#define TESSERA_VOLUME_PACKET_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "volume/lanes/chunk_view.hpp"
#include "volume/lanes/windows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// Voxels along an axis.
struct VoxelRange {
  int first, last;
};

/// Returns the voxels of `box` in which rays may be in slab n. The rays are between `low` and `high` at the chunk's
/// first and last plane.
HWY_INLINE VoxelRange slab_range(const float (&low)[2], const float (&high)[2], int n, const VoxelRange& box) {
  constexpr float each = 1.0f / SlabBlock::slabs, slack = 2e-3f;
  const float l0 = low[0] + (low[1] - low[0]) * (each * static_cast<float>(n)),
              l1 = low[0] + (low[1] - low[0]) * (each * static_cast<float>(n + 1)),
              h0 = high[0] + (high[1] - high[0]) * (each * static_cast<float>(n)),
              h1 = high[0] + (high[1] - high[0]) * (each * static_cast<float>(n + 1));
  const float begin = static_cast<float>(box.first), end = static_cast<float>(box.last);
  return {static_cast<int>(std::min(std::max(std::min(l0, l1) - slack, begin), end)),
          static_cast<int>(std::min(std::max(std::max(h0, h1) + slack, begin), end))};
}

/// A packet's lanes in one chunk.
struct Lanes {
  VF bx, by, per_bx, per_by;            ///< slopes and their inverses
  VF x, y;                              ///< position at the chunk's first plane, relative to voxel (i, j)
  VF i, j;                              ///< the voxel at that position, relative to (i_base, j_base)
  VF i_least, i_most, j_least, j_most;  ///< voxels of the box, relative to (i, j)
  VF k_in, k_out;                       ///< relative to the chunk's first plane
  VF light_view;                        ///< shading: cosine between light and view
  VF length, bends;                     ///< length of the ray per slab; product of bx and by
  int i_base, j_base;
};

/// A lane's path through one voxel of a slab: the voxel, relative to voxel (i, j) at the chunk's first plane, and where
/// the path begins and ends, from 0 at the front plane to 1 at the back plane.
struct Stretch {
  VF i, j, begin, end;
};

/// A packet's path through a slab.
struct SlabPath {
  VF k, x, y;             ///< k of the front plane, and the rays' positions there
  VF from, to;            ///< the part of the slab that is in the ray's range
  Stretch stretches[3];   ///< front to back
  VF i_offset, j_offset;  ///< from a voxel to the voxel's position in the window
};

HWY_INLINE SlabPath path_of(const Lanes& lanes, int n, int i_window, int j_window) {
  const DF d;
  const VF zero = Zero(d), one = Set(d, 1.0f);
  SlabPath path;
  const VF k = Set(d, static_cast<float>(n));
  const VF from = Min(Max(lanes.k_in - k, zero), one), to = Max(Min(lanes.k_out - k, one), from);
  const VF x = MulAdd(k, lanes.bx, lanes.x), y = MulAdd(k, lanes.by, lanes.y);
  const auto cell = [&](VF position, VF slope, VF u, VF least, VF most)
                        HWY_ATTR { return Min(Max(Floor(MulAdd(u, slope, position)), least), most); };
  // Because of rounding, a ray may seem to cross two planes; the second crossing is then at its end.
  const auto next_cell = [&](VF first_cell, VF last_cell)
                             HWY_ATTR { return Min(Max(last_cell, first_cell - one), first_cell + one); };
  const VF i_0 = cell(x, lanes.bx, from, lanes.i_least, lanes.i_most),
           i_1 = next_cell(i_0, cell(x, lanes.bx, to, lanes.i_least, lanes.i_most)),
           j_0 = cell(y, lanes.by, from, lanes.j_least, lanes.j_most),
           j_1 = next_cell(j_0, cell(y, lanes.by, to, lanes.j_least, lanes.j_most));
  const auto crossing = [&](VF c_0, VF c_1, VF position, VF per_slope) HWY_ATTR {
    const VF u = (Max(c_0, c_1) - position) * per_slope;
    return IfThenElse(c_0 == c_1, to, Min(Max(u, from), to));
  };
  const VF u_i = crossing(i_0, i_1, x, lanes.per_bx), u_j = crossing(j_0, j_1, y, lanes.per_by);
  const VF u_1 = Min(u_i, u_j), u_2 = Max(u_i, u_j);
  const MF i_first = u_i < u_j;
  path.k = k, path.x = x, path.y = y, path.from = from, path.to = to;
  path.stretches[0] = {i_0, j_0, from, u_1};
  path.stretches[1] = {IfThenElse(i_first, i_1, i_0), IfThenElse(i_first, j_0, j_1), u_1, u_2};
  path.stretches[2] = {i_1, j_1, u_2, to};
  path.i_offset = lanes.i - Set(d, static_cast<float>(i_window - lanes.i_base));
  path.j_offset = lanes.j - Set(d, static_cast<float>(j_window - lanes.j_base));
  return path;
}

template <class Window>
HWY_INLINE VI window_index(const Window& window, const SlabPath& path, const Stretch& stretch) {
  VF i = stretch.i + path.i_offset, j = stretch.j + path.j_offset;
  if constexpr (std::is_same_v<Window, GatherWindow>) {
    // Lanes without a stretch may have any position.
    const MF there = path.to > path.from;
    i = IfThenElseZero(there, i);
    j = IfThenElseZero(there, j);
  }
  return window.index(i, j);
}

/// Sets up lanes [ray, ray + Lanes()) at the chunk's first plane; voxels are relative to (i_base, j_base).
HWY_INLINE Lanes lanes_of(const ChunkView& chunk, int ray, int i_base, int j_base, const TileRays& rays) {
  const DF d;
  const FrameView& frame = chunk.frame;
  constexpr std::size_t most = MaxLanes(DF());
  const std::size_t lane_count = hn::Lanes(d);
  const ChunkBox& box = chunk.box;
  const auto first_k = static_cast<double>(box.first_k);
  Lanes lanes;
  const VF one = Set(d, 1.0f);
  // Computed in double precision, then converted to float.
  HWY_ALIGN float x[most], y[most], i[most], j[most], bx[most], by[most], k_in[most], k_out[most];
  const hn::Rebind<double, hn::Half<DF>> dd;
  const hn::Rebind<float, decltype(dd)> dh;
  const auto k_0 = Set(dd, first_k);
  for (std::size_t l = 0; l < lane_count; l += hn::Lanes(dd)) {
    const std::size_t r = static_cast<std::size_t>(ray) + l;
    const auto axis = [&](const double* a, const double* b, int base, float* place, float* cell, float* slope)
                          HWY_ATTR {
                            const auto slopes = Load(dd, b + r), places = MulAdd(slopes, k_0, Load(dd, a + r));
                            const auto floors = Floor(places);
                            Store(DemoteTo(dh, places - floors), dh, place + l);
                            Store(DemoteTo(dh, floors - Set(dd, base)), dh, cell + l);
                            Store(DemoteTo(dh, slopes), dh, slope + l);
                          };
    axis(rays.ax, rays.bx, i_base, x, i, bx);
    axis(rays.ay, rays.by, j_base, y, j, by);
    const auto end = [&](const double* k, float* out) HWY_ATTR {
      const auto relative = Load(dd, k + r) - k_0;
      Store(DemoteTo(dh, Min(Max(relative, Set(dd, -1.0)), Set(dd, SlabBlock::slabs + 4.0))), dh, out + l);
    };
    end(rays.from, k_in);
    end(rays.to, k_out);
  }
  lanes.bx = Load(d, bx), lanes.by = Load(d, by);
  lanes.per_bx = one / lanes.bx, lanes.per_by = one / lanes.by;
  lanes.x = Load(d, x), lanes.y = Load(d, y);
  lanes.i = Load(d, i), lanes.j = Load(d, j);
  lanes.i_least = Set(d, static_cast<float>(box.i_low - i_base)) - lanes.i;
  lanes.j_least = Set(d, static_cast<float>(box.j_low - j_base)) - lanes.j;
  lanes.i_most = lanes.i_least + Set(d, static_cast<float>(box.i_last - box.i_low));
  lanes.j_most = lanes.j_least + Set(d, static_cast<float>(box.j_last - box.j_low));
  lanes.k_in = Load(d, k_in), lanes.k_out = Load(d, k_out);
  lanes.length = LoadU(d, rays.length_k + ray);
  lanes.light_view = frame.shading != nullptr ? LoadU(d, rays.light_view + ray) : one;
  lanes.bends = lanes.bx * lanes.by;
  lanes.i_base = i_base, lanes.j_base = j_base;
  return lanes;
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
