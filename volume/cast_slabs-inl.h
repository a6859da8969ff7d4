// Packets of rays through one chunk of 16 slabs; included once per instruction set.
//
// In a slab a ray (|bx|, |by| <= 1) crosses at most one plane of either other axis: three stretches at most, each in
// one voxel. Where the whole window of samples that a packet may meet lies in one interval of the transfer function,
// its stretches go the short way (add_uniform), and if that interval shows nothing they are left out, which adds the
// same as integrating them: nothing.
//
// Numbers  positions are float, relative to the voxel in which the ray is at the chunk's first plane, from double at
//          each chunk: 1e-6 voxel at most. So they depend on ray and chunk only.

#if defined(TESSERA_VOLUME_CAST_SLABS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_CAST_SLABS_INL_H_
#undef TESSERA_VOLUME_CAST_SLABS_INL_H_
#else
#define TESSERA_VOLUME_CAST_SLABS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "volume/frame_view.hpp"
#include "volume/fill_block-inl.h"
#include "volume/ray_piece-inl.h"
#include "volume/slab_block.hpp"
#include "volume/tile_rays.hpp"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// Where a group of rays may be at both ends of a chunk: bounds of (x, y), voxels. The rays being straight, bounds in
/// between are straight, too.
struct Reach {
  float x_low[2], x_high[2], y_low[2], y_high[2];
  bool any;
};

/// Lowest and highest voxel that rays in slab n may be in along an axis of `voxels` voxels.
HWY_INLINE void slab_range(const float (&low)[2], const float (&high)[2], int n, int voxels, int& first, int& last) {
  constexpr float each = 1.0f / SlabBlock::slabs, slack = 2e-3f;
  const float l0 = low[0] + (low[1] - low[0]) * (each * static_cast<float>(n)),
              l1 = low[0] + (low[1] - low[0]) * (each * static_cast<float>(n + 1)),
              h0 = high[0] + (high[1] - high[0]) * (each * static_cast<float>(n)),
              h1 = high[0] + (high[1] - high[0]) * (each * static_cast<float>(n + 1));
  const float end = static_cast<float>(voxels - 1);
  first = static_cast<int>(std::min(std::max(std::min(l0, l1) - slack, 0.0f), end));
  last = static_cast<int>(std::min(std::max(std::max(h0, h1) + slack, 0.0f), end));
}

/// What a chunk's slabs share.
struct ChunkView {
  const FrameView& frame;
  const RayAxes axes;
  const SlabBlock& block;
  std::int64_t first_k;
  int slabs;           ///< that lie in the volume
  const Reach* reach;  ///< by packet
};

/// The interval of the transfer function in which a packet was last, ready for use.
class CurrentInterval {
 public:
  HWY_INLINE CurrentInterval(const LaneTable& table, const FrameView& frame) : table_(table), frame_(frame) {
    uniform_.independent = table.emission == scene::Emission::independent;
    set(0);
  }
  /// Whether all samples of the window are in one interval, which then is the current one.
  template <class Window>
  HWY_INLINE bool holds(const Window& window, float some_sample) {
    if (window.all_in(low_, high_)) return true;
    const float* const knots = table_.column(LaneTable::edge) + 1;
    const auto n = static_cast<std::size_t>(std::upper_bound(knots, knots + table_.knot_count, some_sample) - knots);
    if (n == interval_) return false;
    set(n);
    return window.all_in(low_, high_);
  }
  [[nodiscard]] HWY_INLINE bool clear() const { return clear_; }
  [[nodiscard]] HWY_INLINE const UniformLookup& uniform() const { return uniform_; }

 private:
  HWY_NOINLINE void set(std::size_t n) {
    interval_ = n;
    low_ = table_.column(LaneTable::edge)[n];
    high_ = table_.column(LaneTable::edge)[n + 1];
    clear_ = true;
    for (int c = 0; c < LaneTable::column_count; ++c) {
      uniform_.row[c] = table_.column(c)[n];
      const bool color = c >= LaneTable::red;
      if (c >= LaneTable::half_extinction && (!color || uniform_.independent) && uniform_.row[c] != 0) clear_ = false;
    }
    const float slope = 2 * std::abs(uniform_.row[LaneTable::half_extinction_slope]);
    const float color_slope =
        std::max({std::abs(uniform_.row[LaneTable::red_slope]), std::abs(uniform_.row[LaneTable::green_slope]),
                  std::abs(uniform_.row[LaneTable::blue_slope])});
    uniform_.product_bound = uniform_.independent ? 0 : 0.1f * slope * color_slope / frame_.piece_tolerance;
    uniform_.shadow_bound = 0.03f * slope * slope * frame_.largest_color / frame_.piece_tolerance;
  }

  const LaneTable& table_;
  const FrameView& frame_;
  std::size_t interval_ = 0;
  float low_, high_;
  bool clear_ = false;
  UniformLookup uniform_;
};

/// A packet's lanes at one chunk.
struct Lanes {
  VF bx, by, per_bx, per_by;            ///< slopes and their inverses
  VF x, y;                              ///< at the chunk's first plane, relative to voxel (i, j)
  VF i, j;                              ///< of that voxel, relative to (i_base, j_base)
  VF i_least, i_most, j_least, j_most;  ///< voxels of the volume, relative to (i, j)
  VF k_in, k_out;                       ///< relative to the chunk's first plane
  VF length, bends;                     ///< of the ray per slab; bx by
  int i_base, j_base;
};

/// Cell and stretch of the slab for each lane.
struct Stretch {
  VF i, j, begin, end;
};

template <bool cell_data, class Window, class Lookup>
HWY_INLINE void cast_slab(const ChunkView& chunk, const Lookup& lookup, const Lanes& lanes, int n, int i_window,
                          int j_window, CurrentInterval& current, Progress& progress, FirstLight& first,
                          TileCounts& counts) {
  const DF d;
  const VF zero = HN::Zero(d), one = HN::Set(d, 1.0f), half = HN::Set(d, 0.5f);
  const float* const front = chunk.block.at(n, i_window, j_window);
  const float* const back = cell_data ? front : chunk.block.at(n + 1, i_window, j_window);
  const Window window(front, back, chunk.block.pitch);
  const bool uniform = current.holds(window, *front);
  if (uniform && current.clear()) return;

  const VF k = HN::Set(d, static_cast<float>(n));
  const VF from = HN::Min(HN::Max(HN::Sub(lanes.k_in, k), zero), one),
           to = HN::Max(HN::Min(HN::Sub(lanes.k_out, k), one), from);
  const VF x = HN::MulAdd(k, lanes.bx, lanes.x), y = HN::MulAdd(k, lanes.by, lanes.y);
  const auto cell = [&](VF position, VF slope, VF u, VF least, VF most)
                        HWY_ATTR { return HN::Min(HN::Max(HN::Floor(HN::MulAdd(u, slope, position)), least), most); };
  // By rounding a ray may seem to cross two planes; the second is at its very end.
  const auto next_cell = [&](VF first_cell, VF last_cell) HWY_ATTR {
    return HN::Min(HN::Max(last_cell, HN::Sub(first_cell, one)), HN::Add(first_cell, one));
  };
  const VF i_0 = cell(x, lanes.bx, from, lanes.i_least, lanes.i_most),
           i_1 = next_cell(i_0, cell(x, lanes.bx, to, lanes.i_least, lanes.i_most)),
           j_0 = cell(y, lanes.by, from, lanes.j_least, lanes.j_most),
           j_1 = next_cell(j_0, cell(y, lanes.by, to, lanes.j_least, lanes.j_most));
  const auto crossing = [&](VF c_0, VF c_1, VF position, VF per_slope) HWY_ATTR {
    const VF u = HN::Mul(HN::Sub(HN::Max(c_0, c_1), position), per_slope);
    return HN::IfThenElse(HN::Eq(c_0, c_1), to, HN::Min(HN::Max(u, from), to));
  };
  const VF u_i = crossing(i_0, i_1, x, lanes.per_bx), u_j = crossing(j_0, j_1, y, lanes.per_by);
  const VF u_1 = HN::Min(u_i, u_j), u_2 = HN::Max(u_i, u_j);
  const MF i_first = HN::Lt(u_i, u_j);
  const Stretch stretches[3] = {{i_0, j_0, from, u_1},
                                {HN::IfThenElse(i_first, i_1, i_0), HN::IfThenElse(i_first, j_0, j_1), u_1, u_2},
                                {i_1, j_1, u_2, to}};
  const VF i_offset = HN::Sub(lanes.i, HN::Set(d, static_cast<float>(i_window - lanes.i_base))),
           j_offset = HN::Sub(lanes.j, HN::Set(d, static_cast<float>(j_window - lanes.j_base)));
  for (const Stretch& stretch : stretches) {
    const VF extent = HN::Sub(stretch.end, stretch.begin);
    const MF there = HN::Gt(extent, zero);
    const std::size_t voxels = HN::CountTrue(d, there);
    if (voxels == 0) continue;
    counts.voxels_visited += voxels;
    VF i_there = HN::Add(stretch.i, i_offset), j_there = HN::Add(stretch.j, j_offset);
    if constexpr (std::is_same_v<Window, GatherWindow>) {
      i_there = HN::IfThenElseZero(there, i_there);
      j_there = HN::IfThenElseZero(there, j_there);
    }
    const VI index = window.index(i_there, j_there);
    Piece piece;
    piece.begin = HN::Add(stretch.begin, k);
    piece.extent = extent;
    piece.length = HN::Mul(extent, lanes.length);
    if constexpr (cell_data) {
      piece.s_0 = piece.s_mid = piece.s_1 = window.front(index);
      piece.p_3 = zero;
    } else {
      const Corners s = window.corners(index);
      const VF ai = HN::Sub(s.a10, s.a00), aj = HN::Sub(s.a01, s.a00), aij = HN::Sub(HN::Sub(s.a11, s.a01), ai);
      const VF c00 = HN::Sub(s.b00, s.a00), c10 = HN::Sub(s.b10, s.a10), c01 = HN::Sub(s.b01, s.a01),
               c11 = HN::Sub(s.b11, s.a11);
      const VF ci = HN::Sub(c10, c00), cj = HN::Sub(c01, c00), cij = HN::Sub(HN::Sub(c11, c01), ci);
      const VF x_in = HN::Sub(x, stretch.i), y_in = HN::Sub(y, stretch.j);
      const auto field = [&](VF u) HWY_ATTR {
        const VF fx = HN::MulAdd(u, lanes.bx, x_in), fy = HN::MulAdd(u, lanes.by, y_in);
        const VF a = HN::MulAdd(fy, HN::MulAdd(fx, aij, aj), HN::MulAdd(fx, ai, s.a00));
        const VF c = HN::MulAdd(fy, HN::MulAdd(fx, cij, cj), HN::MulAdd(fx, ci, c00));
        return HN::MulAdd(u, c, a);
      };
      piece.s_0 = field(stretch.begin);
      piece.s_mid = field(HN::Mul(half, HN::Add(stretch.begin, stretch.end)));
      piece.s_1 = field(stretch.end);
      piece.p_3 = HN::Mul(HN::Mul(cij, lanes.bends), HN::Mul(extent, HN::Mul(extent, extent)));
    }
    if (HWY_LIKELY(uniform) && HWY_LIKELY(add_uniform<cell_data>(current.uniform(), piece, progress))) {
      counts.samples += voxels;
      if (HWY_UNLIKELY(!HN::AllTrue(d, first.seen))) note_first_light(progress, piece.begin, first);
    } else {
      add_any(lookup, chunk.frame.piece_tolerance, chunk.frame.largest_color, piece, progress, first, counts.samples);
    }
  }
}

/// Lanes [lane, lane + Lanes()) of a packet through the chunk.
template <bool cell_data, class Lookup>
HWY_INLINE void cast_lanes(const ChunkView& chunk, const Lookup& lookup, int ray, const Reach& reach,
                           CurrentInterval& current, TileRays& rays, TileCounts& counts) {
  const DF d;
  const FrameView& frame = chunk.frame;
  constexpr std::size_t most = HN::MaxLanes(DF());
  const std::size_t lane_count = HN::Lanes(d);
  const int voxels_i = static_cast<int>(frame.voxels[static_cast<std::size_t>(chunk.axes.i)]),
            voxels_j = static_cast<int>(frame.voxels[static_cast<std::size_t>(chunk.axes.j)]);
  HWY_ALIGN float x[most], y[most], i[most], j[most], bx[most], by[most], k_in[most], k_out[most];
  int i_base = 0, j_base = 0, unused = 0;
  slab_range(reach.x_low, reach.x_high, 0, voxels_i, i_base, unused);
  slab_range(reach.y_low, reach.y_high, 0, voxels_j, j_base, unused);
  const auto first_k = static_cast<double>(chunk.first_k);
  for (std::size_t l = 0; l < lane_count; ++l) {
    const std::size_t r = static_cast<std::size_t>(ray) + l;
    const double px = rays.ax[r] + rays.bx[r] * first_k, py = rays.ay[r] + rays.by[r] * first_k;
    const double floor_x = std::floor(px), floor_y = std::floor(py);
    x[l] = static_cast<float>(px - floor_x), y[l] = static_cast<float>(py - floor_y);
    i[l] = static_cast<float>(floor_x - i_base), j[l] = static_cast<float>(floor_y - j_base);
    bx[l] = static_cast<float>(rays.bx[r]), by[l] = static_cast<float>(rays.by[r]);
    k_in[l] = static_cast<float>(std::min(std::max(rays.k_in[r] - first_k, -1.0), 20.0));
    k_out[l] = static_cast<float>(std::min(std::max(rays.k_out[r] - first_k, -1.0), 20.0));
  }
  Lanes lanes;
  const VF one = HN::Set(d, 1.0f), zero = HN::Zero(d);
  lanes.bx = HN::Load(d, bx), lanes.by = HN::Load(d, by);
  lanes.per_bx = HN::Div(one, lanes.bx), lanes.per_by = HN::Div(one, lanes.by);
  lanes.x = HN::Load(d, x), lanes.y = HN::Load(d, y);
  lanes.i = HN::Load(d, i), lanes.j = HN::Load(d, j);
  lanes.i_least = HN::Sub(HN::Set(d, static_cast<float>(-i_base)), lanes.i);
  lanes.j_least = HN::Sub(HN::Set(d, static_cast<float>(-j_base)), lanes.j);
  lanes.i_most = HN::Add(lanes.i_least, HN::Set(d, static_cast<float>(voxels_i - 1)));
  lanes.j_most = HN::Add(lanes.j_least, HN::Set(d, static_cast<float>(voxels_j - 1)));
  lanes.k_in = HN::Load(d, k_in), lanes.k_out = HN::Load(d, k_out);
  lanes.length = HN::LoadU(d, rays.length_k + ray);
  lanes.bends = HN::Mul(lanes.bx, lanes.by);
  lanes.i_base = i_base, lanes.j_base = j_base;

  const VF before = HN::LoadU(d, rays.transmittance + ray), least = HN::Set(d, frame.least_transmittance);
  lanes.k_out = HN::IfThenElse(HN::Lt(before, least), HN::Set(d, -1.0f), lanes.k_out);
  FirstLight first;
  const VF alpha_before = HN::LoadU(d, rays.alpha + ray);
  first.seen = HN::Gt(alpha_before, zero);
  first.place = HN::Set(d, -1.0f);
  const MF seen_before = first.seen;
  Progress progress{zero, one, zero, zero, zero, zero};

  for (int n = 0; n < chunk.slabs; ++n) {
    if (n % 4 == 0) {
      // Rays that let nothing through any more, or have left the volume, are done.
      const VF left = HN::Mul(before, progress.transmittance);
      lanes.k_out = HN::IfThenElse(HN::Lt(left, least), HN::Set(d, -1.0f), lanes.k_out);
      if (HN::AllFalse(d, HN::Gt(lanes.k_out, HN::Set(d, static_cast<float>(n))))) break;
    }
    if (n % 8 == 0) {
      // Eight slabs without a visible cell are passed over.
      int i_first, i_last, j_first, j_last, first_again, last_again;
      slab_range(reach.x_low, reach.x_high, n, voxels_i, i_first, i_last);
      slab_range(reach.x_low, reach.x_high, n + 7, voxels_i, first_again, last_again);
      i_first = std::min(i_first, first_again), i_last = std::max(i_last, last_again);
      slab_range(reach.y_low, reach.y_high, n, voxels_j, j_first, j_last);
      slab_range(reach.y_low, reach.y_high, n + 7, voxels_j, first_again, last_again);
      j_first = std::min(j_first, first_again), j_last = std::max(j_last, last_again);
      const std::int64_t end_k = frame.voxels[static_cast<std::size_t>(chunk.axes.k)];
      const std::int64_t k_first = chunk.first_k + n, k_last = std::min(k_first + 7, end_k - 1);
      std::int64_t low[3], high[3];
      low[chunk.axes.i] = i_first, high[chunk.axes.i] = i_last;
      low[chunk.axes.j] = j_first, high[chunk.axes.j] = j_last;
      low[chunk.axes.k] = chunk.axes.mirrored ? end_k - 1 - k_last : k_first;
      high[chunk.axes.k] = chunk.axes.mirrored ? end_k - 1 - k_first : k_last;
      if (!any_visible(frame, low, high)) {
        n += 7;
        continue;
      }
    }
    if (HN::AllFalse(d, HN::And(HN::Gt(lanes.k_out, HN::Set(d, static_cast<float>(n))),
                                HN::Lt(lanes.k_in, HN::Set(d, static_cast<float>(n + 1))))))
      continue;
    int i_first, i_last, j_first, j_last;
    slab_range(reach.x_low, reach.x_high, n, voxels_i, i_first, i_last);
    slab_range(reach.y_low, reach.y_high, n, voxels_j, j_first, j_last);
    const auto s = static_cast<std::size_t>(n);
    const SlabBlock& block = chunk.block;
    // A window may not reach beyond what both slices hold.
    const auto cast = [&]<class Window>(int columns, int rows) HWY_ATTR {
      const int i_window = std::max(block.slab_i[s], std::min(i_first, block.slab_i_last[s] - columns + 1)),
                j_window = std::max(block.slab_j[s], std::min(j_first, block.slab_j_last[s] - rows + 1));
      cast_slab<cell_data, Window>(chunk, lookup, lanes, n, i_window, j_window, current, progress, first, counts);
    };
#if HWY_TARGET <= HWY_AVX3
    if (i_last - i_first <= SmallWindow::columns - 2 && j_last - j_first <= SmallWindow::rows - 2)
      cast.template operator()<SmallWindow>(SmallWindow::columns, SmallWindow::rows);
    else if (i_last - i_first <= LargeWindow::columns - 2 && j_last - j_first <= LargeWindow::rows - 2)
      cast.template operator()<LargeWindow>(LargeWindow::columns, LargeWindow::rows);
    else
#endif
      cast.template operator()<GatherWindow>(1, 1);
  }

  const auto add = [&](float* sum, VF part)
                       HWY_ATTR { HN::StoreU(HN::MulAdd(before, part, HN::LoadU(d, sum + ray)), d, sum + ray); };
  add(rays.alpha, progress.alpha);
  add(rays.red, progress.red);
  add(rays.green, progress.green);
  add(rays.blue, progress.blue);
  HN::StoreU(HN::Mul(before, progress.transmittance), d, rays.transmittance + ray);
  if (!HN::AllFalse(d, HN::AndNot(seen_before, first.seen))) {
    HWY_ALIGN float place[most];
    HN::Store(HN::IfThenElse(seen_before, HN::Set(d, -1.0f), first.place), d, place);
    for (std::size_t l = 0; l < lane_count; ++l)
      if (place[l] >= 0) rays.first_k[static_cast<std::size_t>(ray) + l] = first_k + static_cast<double>(place[l]);
  }
}

template <bool cell_data, CL::TableForm form>
HWY_NOINLINE void cast_chunk_as(const ChunkView& chunk, TileRays& rays, TileCounts& counts) {
  const CL::Lookup<form> lookup(*chunk.frame.table);
  CurrentInterval current(*chunk.frame.table, chunk.frame);
  for (int packet = 0; packet < TileRays::packets; ++packet) {
    if (!chunk.reach[packet].any) continue;
    for (int lane = 0; lane < TileRays::packet_rays; lane += static_cast<int>(HN::Lanes(DF())))
      cast_lanes<cell_data>(chunk, lookup, packet * TileRays::packet_rays + lane, chunk.reach[packet], current, rays,
                            counts);
  }
}

HWY_INLINE void cast_chunk(const ChunkView& chunk, TileRays& rays, TileCounts& counts) {
  const auto as = [&]<CL::TableForm form>() HWY_ATTR {
    if (chunk.frame.cell_data)
      cast_chunk_as<true, form>(chunk, rays, counts);
    else
      cast_chunk_as<false, form>(chunk, rays, counts);
  };
  switch (CL::form_of(*chunk.frame.table)) {
    case CL::TableForm::one_vector:
      return as.template operator()<CL::TableForm::one_vector>();
    case CL::TableForm::two_vectors:
      return as.template operator()<CL::TableForm::two_vectors>();
    case CL::TableForm::many:
      return as.template operator()<CL::TableForm::many>();
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
