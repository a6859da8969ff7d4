// SPDX-License-Identifier: BSD-3-Clause
// Data of a chunk that a packet's lanes share: the voxels that they may meet in each slab, and their work for the
// tally. Included once per instruction set (Highway's include guard idiom).
//
// What      For each slab, the range of voxels along i and j, the position in the block of the window that contains
//           their corners, and whether the range reaches the box's border.
// How       Rays are straight, so the packet's bounds at the chunk's first and last plane (Reach) give bounds in
//           between.

#if defined(TESSERA_VOLUME_PACKET_SLABS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_PACKET_SLABS_INL_H_
#undef TESSERA_VOLUME_PACKET_SLABS_INL_H_
#else
#define TESSERA_VOLUME_PACKET_SLABS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "volume/bricks/fill_block-inl.h"
#include "volume/lanes/packet_lanes-inl.h"
#include "volume/lanes/ray_piece-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// The voxels that a packet may meet in each slab of the chunk, and the windows that contain their corners.
struct PacketSlabs {
  static constexpr int slabs = SlabBlock::slabs;
  HWY_ALIGN int i_first[slabs], i_last[slabs], j_first[slabs], j_last[slabs];
  int widest_i = 0, widest_j = 0;  ///< largest last - first
  HWY_ALIGN int i_window[slabs], j_window[slabs], front[slabs], back[slabs], border[slabs];
  HWY_ALIGN float origin[slabs];

  HWY_INLINE PacketSlabs(const Reach& reach, const ChunkBox& box) {
    for (int n = 0; n < slabs; ++n) {
      const VoxelRange range = slab_range(reach.x_low, reach.x_high, n, {box.i_low, box.i_last});
      i_first[n] = range.first, i_last[n] = range.last;
    }
    for (int n = 0; n < slabs; ++n) {
      const VoxelRange range = slab_range(reach.y_low, reach.y_high, n, {box.j_low, box.j_last});
      j_first[n] = range.first, j_last[n] = range.last;
    }
    for (int n = 0; n < slabs; ++n) {
      widest_i = std::max(widest_i, i_last[n] - i_first[n]);
      widest_j = std::max(widest_j, j_last[n] - j_first[n]);
      border[n] =
          i_first[n] <= box.i_low || i_last[n] >= box.i_last || j_first[n] <= box.j_low || j_last[n] >= box.j_last;
    }
  }

  /// Computes the positions of the windows in the block. A window must be inside the samples of both slices.
  template <class Window>
  HWY_INLINE void place_windows(const SlabBlock& block, int slab_count) {
    constexpr bool gathers = std::is_same_v<Window, GatherWindow>;
    const auto pitch = static_cast<int>(block.pitch), rows = static_cast<int>(block.rows);
    const int columns = gathers ? pitch : Window::columns;
    for (int n = 0; n < slab_count; ++n) {
      const auto s = static_cast<std::size_t>(n);
      i_window[n] = std::max(block.slab_i[s], std::min(i_first[n], block.slab_i_last[s] - Window::columns + 1));
      j_window[n] = std::max(block.slab_j[s], std::min(j_first[n], block.slab_j_last[s] - Window::rows + 1));
      front[n] = (n * rows + j_window[n] - block.low_j[s]) * pitch + i_window[n] - block.low_i[s];
      back[n] = ((n + 1) * rows + j_window[n] - block.low_j[s + 1]) * pitch + i_window[n] - block.low_i[s + 1];
      origin[n] = static_cast<float>(i_first[0] - i_window[n] + columns * (j_first[0] - j_window[n]));
    }
  }
};

/// A packet's work in a group of eight slabs, for the tally.
struct GroupWork {
  int first;
  VF k_out, depth_before;
  std::uint64_t samples_before;

  /// Adds the work up to slab `next`, or up to where the packet stopped.
  HWY_NOINLINE void add_to(const ChunkView& chunk, const Lanes& lanes, const Reach& reach, int next,
                           const Progress& progress, const TileCounts& counts) const {
    const DF d;
    const VF begin = Max(lanes.k_in, Set(d, static_cast<float>(first))),
             end = Min(k_out, Set(d, static_cast<float>(std::min(next, first + 8))));
    const float slabs = GetLane(SumOfLanes(d, Max(Zero(d), end - begin)));
    if (!(slabs > 0)) return;
    const VF depth = (progress.optical_depth - depth_before) / lanes.length;
    const float thick = GetLane(SumOfLanes(d, Min(Max(depth, Zero(d)), Set(d, 1e4f))));
    const float along = (static_cast<float>(first) + 4) / SlabBlock::slabs;
    const auto middle = [&](const float(&low)[2], const float(&high)[2]) {
      return static_cast<std::int64_t>(0.5f * ((low[0] + high[0]) * (1 - along) + (low[1] + high[1]) * along));
    };
    const std::int64_t k = std::min<std::int64_t>(chunk.box.first_k + first + 4,
                                                  chunk.frame.voxels[static_cast<std::size_t>(chunk.axes.k)] - 1);
    std::int64_t place[3];
    place[chunk.axes.i] = middle(reach.x_low, reach.x_high);
    place[chunk.axes.j] = middle(reach.y_low, reach.y_high);
    place[chunk.axes.k] = chunk.axes.mirrored ? chunk.frame.voxels[static_cast<std::size_t>(chunk.axes.k)] - 1 - k : k;
    chunk.frame.tally->add(chunk.frame.tally->cells().number(place[0], place[1], place[2]),
                           counts.samples - samples_before, slabs, thick);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
