// Packets of rays through one chunk of 32 slabs; included once per instruction set.
//
// In a slab a ray (|bx|, |by| <= 1) crosses at most one plane of either other axis: three stretches at most, each in
// one voxel. Where the whole window of samples that a packet may meet lies in one interval of the transfer function,
// its stretches go the short way (add_uniform), and if that interval shows nothing they are left out, which adds the
// same as integrating them: nothing.
//
// Numbers  positions are float, relative to the voxel in which the ray is at the chunk's first plane, from double at
//          each chunk: 2e-6 voxel at most. So they depend on ray and chunk only.

#if defined(TESSERA_VOLUME_CAST_SLABS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_CAST_SLABS_INL_H_
#undef TESSERA_VOLUME_CAST_SLABS_INL_H_
#else
#define TESSERA_VOLUME_CAST_SLABS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "volume/fill_block-inl.h"
#include "volume/frame_view.hpp"
#include "volume/ray_piece-inl.h"
#include "volume/shading-inl.h"
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
    uniform_.extinction = 2 * uniform_.row[LaneTable::half_extinction];
    if (slope > 0) uniform_.extinction += slope * (high_ - low_);
    uniform_.dimming_bound =
        uniform_.extinction * (uniform_.independent ? 1 : uniform_.extinction) * color_slope / frame_.piece_tolerance;
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
  VF light_view;                        ///< shading: cosine between light and view
  VF length, bends;                     ///< of the ray per slab; bx by
  int i_base, j_base;
  bool whole;  ///< all lanes go from the chunk's first plane to its last
};

/// A lane's way through one voxel of a slab: the voxel, relative to (i, j) of the chunk's first plane, and where it
/// begins and ends, 0 to 1 from plane to plane.
struct Stretch {
  VF i, j, begin, end;
};

/// A packet's way through a slab.
struct SlabPath {
  VF k, x, y;             ///< the front plane, and where the rays meet it
  VF from, to;            ///< the part of the slab that counts
  Stretch stretches[3];   ///< front to back
  VF i_offset, j_offset;  ///< of a voxel in the window
};

HWY_INLINE SlabPath path_of(const Lanes& lanes, int n, int i_window, int j_window) {
  const DF d;
  const VF zero = HN::Zero(d), one = HN::Set(d, 1.0f);
  SlabPath path;
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
  path.k = k, path.x = x, path.y = y, path.from = from, path.to = to;
  path.stretches[0] = {i_0, j_0, from, u_1};
  path.stretches[1] = {HN::IfThenElse(i_first, i_1, i_0), HN::IfThenElse(i_first, j_0, j_1), u_1, u_2};
  path.stretches[2] = {i_1, j_1, u_2, to};
  path.i_offset = HN::Sub(lanes.i, HN::Set(d, static_cast<float>(i_window - lanes.i_base)));
  path.j_offset = HN::Sub(lanes.j, HN::Set(d, static_cast<float>(j_window - lanes.j_base)));
  return path;
}

template <class Window>
HWY_INLINE VI window_index(const Window& window, const SlabPath& path, const Stretch& stretch) {
  VF i = HN::Add(stretch.i, path.i_offset), j = HN::Add(stretch.j, path.j_offset);
  if constexpr (std::is_same_v<Window, GatherWindow>) {
    // Lanes without a stretch may be anywhere.
    const MF there = HN::Gt(path.to, path.from);
    i = HN::IfThenElseZero(there, i);
    j = HN::IfThenElseZero(there, j);
  }
  return window.index(i, j);
}

/// The trilinear field of a lane's voxel along its ray: a + u c, where a and c are bilinear in (x, y).
struct VoxelField {
  VF a00, ai, aj, aij, c00, ci, cj, cij;
  VF x, y;  ///< at u = 0, from the voxel's corner

  HWY_INLINE VoxelField(const Corners& s, VF x_in, VF y_in) : x(x_in), y(y_in) {
    a00 = s.a00;
    ai = HN::Sub(s.a10, s.a00), aj = HN::Sub(s.a01, s.a00), aij = HN::Sub(HN::Sub(s.a11, s.a01), ai);
    const VF c10 = HN::Sub(s.b10, s.a10), c01 = HN::Sub(s.b01, s.a01), c11 = HN::Sub(s.b11, s.a11);
    c00 = HN::Sub(s.b00, s.a00);
    ci = HN::Sub(c10, c00), cj = HN::Sub(c01, c00), cij = HN::Sub(HN::Sub(c11, c01), ci);
  }
  HWY_INLINE VF at(VF u, VF bx, VF by) const {
    const VF fx = HN::MulAdd(u, bx, x), fy = HN::MulAdd(u, by, y);
    const VF a = HN::MulAdd(fy, HN::MulAdd(fx, aij, aj), HN::MulAdd(fx, ai, a00));
    const VF c = HN::MulAdd(fy, HN::MulAdd(fx, cij, cj), HN::MulAdd(fx, ci, c00));
    return HN::MulAdd(u, c, a);
  }
  /// Changes per voxel along i, j and k.
  HWY_INLINE void gradient(VF u, VF bx, VF by, VF& g_i, VF& g_j, VF& g_k) const {
    const VF fx = HN::MulAdd(u, bx, x), fy = HN::MulAdd(u, by, y);
    g_i = HN::MulAdd(fy, HN::MulAdd(u, cij, aij), HN::MulAdd(u, ci, ai));
    g_j = HN::MulAdd(fx, HN::MulAdd(u, cij, aij), HN::MulAdd(u, cj, aj));
    g_k = HN::MulAdd(fy, HN::MulAdd(fx, cij, cj), HN::MulAdd(fx, ci, c00));
  }
  /// At u = 0.
  HWY_INLINE VF at_front() const { return HN::MulAdd(y, HN::MulAdd(x, aij, aj), HN::MulAdd(x, ai, a00)); }
  /// At u = 1, where the ray is at (x_1, y_1) relative to the chunk's voxel, and this one at (i, j).
  HWY_INLINE VF at_back(VF x_1, VF y_1, VF i, VF j) const {
    const VF fx = HN::Sub(x_1, i), fy = HN::Sub(y_1, j);
    const VF a = HN::MulAdd(fy, HN::MulAdd(fx, aij, aj), HN::MulAdd(fx, ai, a00));
    return HN::Add(a, HN::MulAdd(fy, HN::MulAdd(fx, cij, cj), HN::MulAdd(fx, ci, c00)));
  }
  /// Value at the middle u of a stretch of extent e, and the mean over it: every product of two of x, y and u adds a
  /// twelfth of the product of their changes. `ee` is e^2 / 12.
  HWY_INLINE void middle_and_mean(VF u, VF ee, VF bx, VF by, VF bends, VF& middle, VF& mean) const {
    const VF fx = HN::MulAdd(u, bx, x), fy = HN::MulAdd(u, by, y);
    const VF a_y = HN::MulAdd(fx, aij, aj), c_y = HN::MulAdd(fx, cij, cj), c_x = HN::MulAdd(fy, cij, ci);
    const VF a = HN::MulAdd(fy, a_y, HN::MulAdd(fx, ai, a00)), c = HN::MulAdd(fy, c_y, HN::MulAdd(fx, ci, c00));
    middle = HN::MulAdd(u, c, a);
    const VF twist = HN::MulAdd(bends, HN::MulAdd(u, cij, aij), HN::MulAdd(bx, c_x, HN::Mul(by, c_y)));
    mean = HN::MulAdd(ee, twist, middle);
  }
};

/// Voxel by voxel, for the lanes that are `wanted`.
template <bool cell_data, class Window, class Lookup>
HWY_NOINLINE void cast_voxels(const FrameView& frame, const RayAxes& axes, const Lookup& lookup, const Lanes& lanes,
                              const SlabPath& path, const Window& window, const UniformLookup* uniform, MF wanted,
                              Progress& progress, FirstLight& first, TileCounts& counts) {
  const DF d;
  const VF half = HN::Set(d, 0.5f), zero = HN::Zero(d), one = HN::Set(d, 1.0f);
  const bool lit_part = frame.shading != nullptr && !cell_data;
  for (const Stretch& stretch : path.stretches) {
    const VF extent = HN::Sub(stretch.end, stretch.begin);
    const MF there = HN::And(wanted, HN::Gt(extent, HN::Zero(d)));
    const std::size_t voxels = HN::CountTrue(d, there);
    if (voxels == 0) continue;
    const VI index = window_index(window, path, stretch);
    Piece piece;
    Lit lit{one, zero};
    piece.begin = HN::Add(stretch.begin, path.k);
    piece.extent = extent;
    piece.length = HN::IfThenElseZero(there, HN::Mul(extent, lanes.length));
    if constexpr (cell_data) {
      piece.s_0 = piece.s_mid = piece.s_1 = window.front(index);
      piece.p_3 = HN::Zero(d);
    } else {
      const VoxelField field(window.corners(index), HN::Sub(path.x, stretch.i), HN::Sub(path.y, stretch.j));
      piece.s_0 = field.at(stretch.begin, lanes.bx, lanes.by);
      piece.s_mid = field.at(HN::Mul(half, HN::Add(stretch.begin, stretch.end)), lanes.bx, lanes.by);
      piece.s_1 = field.at(stretch.end, lanes.bx, lanes.by);
      piece.p_3 = HN::Mul(HN::Mul(field.cij, lanes.bends), HN::Mul(extent, HN::Mul(extent, extent)));
      if (lit_part) {
        VF g_i, g_j, g_k;
        field.gradient(HN::Mul(half, HN::Add(stretch.begin, stretch.end)), lanes.bx, lanes.by, g_i, g_j, g_k);
        const auto kept = [&](VF v) HWY_ATTR { return HN::IfThenElseZero(HN::And(there, HN::Eq(v, v)), v); };
        g_i = kept(g_i), g_j = kept(g_j), g_k = kept(g_k);
        const VF slope = HN::MulAdd(lanes.bx, g_i, HN::MulAdd(lanes.by, g_j, g_k));
        const VF per_length =
            HN::Div(HN::Set(d, static_cast<float>(frame.shading->unit / frame.length_unit)), lanes.length);
        lit = shade(*frame.shading, axes, g_i, g_j, g_k, slope, per_length, lanes.light_view);
      }
    }
    Progress part{zero, one, zero, zero, zero, zero};
    Progress& target = lit_part ? part : progress;
    if (uniform != nullptr && HWY_LIKELY(add_uniform<cell_data>(*uniform, piece, target))) {
      counts.samples += voxels;
      if (HWY_UNLIKELY(!HN::AllTrue(d, first.seen))) note_first_light(target, piece.begin, first);
    } else {
      add_any(lookup, frame.piece_tolerance, frame.largest_color, piece, target, first, counts.samples);
    }
    if (lit_part) {
      put_behind(part, lit, progress);
      // Within the stretch light is measured from its own front.
      note_first_light(progress, piece.begin, first);
    }
  }
}

/// Where a packet's rays meet a slab's front plane: place, voxel, and the field there. Carried from slab to slab while
/// all lanes go on.
struct PlaneState {
  VF x, y, i, j, s;
  int n = -1;  ///< the plane; -1: nothing carried
};

/// The slab as a whole, as far as it is smooth: see cast_slab. The field stays within rho of the line from s_0 to s_1.
struct SlabLine {
  VF s_0, s_1, mean, rho;
};

/// What a stretch's cubic is besides the chord between its ends: the even part's height and a quarter of the odd one's
/// coefficient (ray_piece-inl.h), which bound it together.
HWY_INLINE VF bump_of(VF s_0, VF middle, VF s_1, VF p_3) {
  const DF d;
  const VF even = HN::NegMulAdd(HN::Set(d, 0.5f), HN::Add(s_0, s_1), middle);
  return HN::MulAdd(HN::Set(d, 0.25f), HN::Abs(p_3), HN::Abs(even));
}

/// The cubic at a stretch's other end: Simpson's rule is exact, mean = (s_0 + 4 middle + s_1) / 6.
HWY_INLINE VF other_end(VF s, VF middle, VF mean) {
  const DF d;
  return HN::Sub(HN::MulAdd(HN::Set(d, 6.0f), mean, HN::Mul(HN::Set(d, -4.0f), middle)), s);
}

/// Bound of the field's distance from the slab's line: the borders', and the bumps between. Not a number where the
/// field is not.
HWY_INLINE VF distance_bound(VF border_1, VF line_1, VF border_2, VF line_2, const VF (&bump)[3]) {
  const VF borders = HN::Max(HN::Abs(HN::Sub(border_1, line_1)), HN::Abs(HN::Sub(border_2, line_2)));
  const VF bumps = HN::Max(HN::Max(bump[0], bump[1]), bump[2]);
  const VF any = HN::Add(HN::Add(bump[0], bump[1]), HN::Add(bump[2], HN::Add(border_1, border_2)));
  return HN::MulAdd(HN::Zero(DF()), any, HN::Add(borders, bumps));
}

/// The line of a slab that all lanes cross from plane to plane, in the packet's window.
template <bool inner, class Window>
HWY_INLINE SlabLine whole_line(const Lanes& lanes, const Window& window, int n, int i_window, int j_window,
                               PlaneState& plane, VF& crossings) {
  const DF d;
  const VF one = HN::Set(d, 1.0f), half = HN::Set(d, 0.5f), twelfth = HN::Set(d, 1 / 12.0f);
  const auto cell = [&](VF position, VF least, VF most) HWY_ATTR {
    const VF floor = HN::Floor(position);
    return inner ? floor : HN::Min(HN::Max(floor, least), most);
  };
  const bool carried = plane.n == n;
  if (!carried) {
    const VF k = HN::Set(d, static_cast<float>(n));
    plane.x = HN::MulAdd(k, lanes.bx, lanes.x), plane.y = HN::MulAdd(k, lanes.by, lanes.y);
    plane.i = cell(plane.x, lanes.i_least, lanes.i_most), plane.j = cell(plane.y, lanes.j_least, lanes.j_most);
  }
  const VF x = plane.x, y = plane.y, i_0 = plane.i, j_0 = plane.j;
  const VF next = HN::Set(d, static_cast<float>(n + 1));
  const VF x_1 = HN::MulAdd(next, lanes.bx, lanes.x), y_1 = HN::MulAdd(next, lanes.by, lanes.y);
  // By rounding a ray may seem to cross two planes; the second is at its very end.
  const auto next_cell = [&](VF first, VF last)
                             HWY_ATTR { return HN::Min(HN::Max(last, HN::Sub(first, one)), HN::Add(first, one)); };
  const VF i_1 = next_cell(i_0, cell(x_1, lanes.i_least, lanes.i_most)),
           j_1 = next_cell(j_0, cell(y_1, lanes.j_least, lanes.j_most));
  // Rounding may put a crossing a little before or behind the slab: what one stretch has too much, the next has too
  // little.
  const auto crossing = [&](VF c_0, VF c_1, VF position, VF per_slope) HWY_ATTR {
    return HN::IfThenElse(HN::Eq(c_0, c_1), one, HN::Mul(HN::Sub(HN::Max(c_0, c_1), position), per_slope));
  };
  const VF u_i = crossing(i_0, i_1, x, lanes.per_bx), u_j = crossing(j_0, j_1, y, lanes.per_by);
  const VF u_1 = HN::Min(u_i, u_j), u_2 = HN::Max(u_i, u_j);
  const MF i_first = HN::Lt(u_i, u_j);
  const VF i_mid = HN::IfThenElse(i_first, i_1, i_0), j_mid = HN::IfThenElse(i_first, j_0, j_1);
  crossings = HN::Add(crossings, HN::Add(HN::Abs(HN::Sub(i_1, i_0)), HN::Abs(HN::Sub(j_1, j_0))));

  const VF i_offset = HN::Sub(lanes.i, HN::Set(d, static_cast<float>(i_window - lanes.i_base))),
           j_offset = HN::Sub(lanes.j, HN::Set(d, static_cast<float>(j_window - lanes.j_base)));
  const auto field_of = [&](VF i, VF j) HWY_ATTR {
    return VoxelField(window.corners(window.index(HN::Add(i, i_offset), HN::Add(j, j_offset))), HN::Sub(x, i),
                      HN::Sub(y, j));
  };
  SlabLine line;
  VF bump[3], border[2], middle, mean;
  {
    const VoxelField field = field_of(i_0, j_0);
    line.s_0 = carried ? plane.s : field.at_front();
    const VF ee = HN::Mul(u_1, u_1);
    field.middle_and_mean(HN::Mul(half, u_1), HN::Mul(ee, twelfth), lanes.bx, lanes.by, lanes.bends, middle, mean);
    line.mean = HN::Mul(u_1, mean);
    border[0] = other_end(line.s_0, middle, mean);
    bump[0] = bump_of(line.s_0, middle, border[0], HN::Mul(HN::Mul(field.cij, lanes.bends), HN::Mul(ee, u_1)));
  }
  {
    const VoxelField field = field_of(i_1, j_1);
    const VF e = HN::Sub(one, u_2), ee = HN::Mul(e, e);
    field.middle_and_mean(HN::MulAdd(half, u_2, half), HN::Mul(ee, twelfth), lanes.bx, lanes.by, lanes.bends, middle,
                          mean);
    line.mean = HN::MulAdd(e, mean, line.mean);
    line.s_1 = field.at_back(x_1, y_1, i_1, j_1);
    border[1] = other_end(line.s_1, middle, mean);
    bump[2] = bump_of(border[1], middle, line.s_1, HN::Mul(HN::Mul(field.cij, lanes.bends), HN::Mul(ee, e)));
  }
  {
    const VoxelField field = field_of(i_mid, j_mid);
    const VF e = HN::Sub(u_2, u_1), ee = HN::Mul(e, e);
    field.middle_and_mean(HN::Mul(half, HN::Add(u_1, u_2)), HN::Mul(ee, twelfth), lanes.bx, lanes.by, lanes.bends,
                          middle, mean);
    line.mean = HN::MulAdd(e, mean, line.mean);
    bump[1] = bump_of(border[0], middle, border[1], HN::Mul(HN::Mul(field.cij, lanes.bends), HN::Mul(ee, e)));
  }
  const VF span = HN::Sub(line.s_1, line.s_0);
  line.rho =
      distance_bound(border[0], HN::MulAdd(u_1, span, line.s_0), border[1], HN::MulAdd(u_2, span, line.s_0), bump);
  plane = {x_1, y_1, i_1, j_1, line.s_1, n + 1};
  return line;
}

/// The line of a slab that lanes may enter or leave anywhere. Lanes that are not there give anything.
template <class Window>
HWY_INLINE SlabLine part_line(const Lanes& lanes, const SlabPath& path, const Window& window) {
  const DF d;
  const VF half = HN::Set(d, 0.5f);
  const VF extent = HN::Sub(path.to, path.from);
  const VF per_extent = HN::Div(HN::Set(d, 1.0f), extent);
  SlabLine line;
  VF middle[3], mean[3], p_3[3];
  line.mean = line.s_0 = line.s_1 = HN::Zero(d);
  for (int p = 0; p < 3; ++p) {
    const Stretch& stretch = path.stretches[p];
    const VoxelField field(window.corners(window_index(window, path, stretch)), HN::Sub(path.x, stretch.i),
                           HN::Sub(path.y, stretch.j));
    const VF e = HN::Sub(stretch.end, stretch.begin), ee = HN::Mul(e, e);
    field.middle_and_mean(HN::Mul(half, HN::Add(stretch.begin, stretch.end)), HN::Mul(ee, HN::Set(d, 1 / 12.0f)),
                          lanes.bx, lanes.by, lanes.bends, middle[p], mean[p]);
    p_3[p] = HN::Mul(HN::Mul(field.cij, lanes.bends), HN::Mul(ee, e));
    line.mean = HN::MulAdd(HN::Mul(e, per_extent), mean[p], line.mean);
    if (p == 0) line.s_0 = field.at(stretch.begin, lanes.bx, lanes.by);
    if (p == 2) line.s_1 = field.at(stretch.end, lanes.bx, lanes.by);
  }
  const VF slope = HN::Mul(HN::Sub(line.s_1, line.s_0), per_extent);
  const VF border_1 = other_end(line.s_0, middle[0], mean[0]), border_2 = other_end(line.s_1, middle[2], mean[2]);
  const VF bump[3] = {bump_of(line.s_0, middle[0], border_1, p_3[0]), bump_of(border_1, middle[1], border_2, p_3[1]),
                      bump_of(border_2, middle[2], line.s_1, p_3[2])};
  const auto on_line = [&](VF at) HWY_ATTR { return HN::MulAdd(HN::Sub(at, path.from), slope, line.s_0); };
  line.rho =
      distance_bound(border_1, on_line(path.stretches[1].begin), border_2, on_line(path.stretches[2].begin), bump);
  return line;
}

/// A slab whose lanes are in several intervals, or cross knots.
template <class Window, class Lookup>
HWY_NOINLINE void cast_mixed(const FrameView& frame, const RayAxes& axes, const Lookup& lookup, const Lanes& lanes,
                             const SlabPath& path, const SlabLine& line, const Window& window, Progress& progress,
                             FirstLight& first, TileCounts& counts) {
  const DF d;
  const VF zero = HN::Zero(d), half = HN::Set(d, 0.5f);
  const MF there = HN::Gt(path.to, path.from);
  const VF span = HN::Sub(line.s_1, line.s_0), m = HN::NegMulAdd(half, HN::Add(line.s_0, line.s_1), line.mean);
  const VF length = HN::Mul(lanes.length, HN::Sub(path.to, path.from));
  const VF spread = HN::Mul(HN::Mul(length, line.rho), HN::MulAdd(HN::Abs(span), HN::Set(d, 0.25f), line.rho));
  const VF low = HN::Sub(HN::Min(line.s_0, line.s_1), line.rho), high = HN::Add(HN::Max(line.s_0, line.s_1), line.rho);
  const VI interval = lookup.locate(low, HN::Eq(zero, zero));
  const auto index = lookup.index(interval, there);
  const VF edge = lookup.far_edge(interval, index, HN::Set(DI(), 1));
  const VF kappa_slope = HN::Abs(
      HN::Add(lookup.at(LaneTable::half_extinction_slope, index), lookup.at(LaneTable::half_extinction_slope, index)));
  const VF color_slope = HN::Max(
      HN::Max(HN::Abs(lookup.at(LaneTable::red_slope, index)), HN::Abs(lookup.at(LaneTable::green_slope, index))),
      HN::Abs(lookup.at(LaneTable::blue_slope, index)));
  const VF scale =
      HN::Mul(HN::Mul(kappa_slope, HN::Set(d, 1 / frame.piece_tolerance)),
              HN::MulAdd(HN::Mul(length, kappa_slope), HN::Set(d, 0.03f * frame.largest_color), color_slope));
  const VF extinction = HN::Max(extinction_at(lookup, index, low), extinction_at(lookup, index, high));
  const VF dimming = HN::Mul(HN::Mul(length, extinction), lookup.independent ? length : HN::Mul(length, extinction));
  const VF dimmed =
      HN::Mul(HN::Mul(dimming, color_slope), HN::Mul(line.rho, HN::Set(d, 1 / (9 * frame.piece_tolerance))));
  const MF together =
      HN::And(HN::And(there, HN::Lt(high, edge)), HN::Le(HN::MulAdd(spread, scale, dimmed), HN::Set(d, 1.0f)));
  if (!HN::AllFalse(d, together)) {
    const auto kept = [&](VF v) HWY_ATTR { return HN::IfThenElseZero(together, v); };
    CL::lanes::add_piece<false>(lookup, index, kept(HN::Add(line.s_0, m)), kept(HN::Add(line.s_1, m)), kept(span),
                                kept(length), progress);
    counts.samples += HN::CountTrue(d, together);
    note_first_light(progress, HN::Add(path.from, path.k), first);
  }
  const MF apart = HN::AndNot(together, there);
  if (!HN::AllFalse(d, apart))
    cast_voxels<false>(frame, axes, lookup, lanes, path, window, nullptr, apart, progress, first, counts);
}

/// A slab, voxel by voxel.
template <class Window, class Lookup>
HWY_NOINLINE void cast_shaded(const ChunkView& chunk, const Lookup& lookup, const Lanes& lanes, int n, int i_window,
                              int j_window, const UniformLookup* uniform, const Window& window, Progress& progress,
                              FirstLight& first, TileCounts& counts) {
  const DF d;
  const SlabPath path = path_of(lanes, n, i_window, j_window);
  for (const Stretch& stretch : path.stretches)
    counts.voxels_visited += HN::CountTrue(d, HN::Gt(stretch.end, stretch.begin));
  cast_voxels<false>(chunk.frame, chunk.axes, lookup, lanes, path, window, uniform, HN::Gt(path.to, path.from),
                     progress, first, counts);
}

/// One slab. Where the field along a lane's ray is smooth over all its voxels in the slab and in one interval of the
/// transfer function, they are integrated together: as a line between the slab's ends, moved to the mean of the cubics.
/// The rest r is then not even about the middle, and what it leaves of the product of extinction and colour is below
/// |k' c'| l rho (rho + |s_1 - s_0| / 4), where rho bounds |r|: the line's distance from the field at the borders
/// between voxels, and what the cubics add between. Dimming (ray_piece-inl.h) meets the rest's first moment, at most
/// rho / 9 for two bends: |c'| (k l)^2 rho / 9.
template <bool cell_data, class Window, class Lookup>
HWY_INLINE void cast_slab(const ChunkView& chunk, const Lookup& lookup, const Lanes& lanes, int n, int i_window,
                          int j_window, bool inner, CurrentInterval& current, PlaneState& plane, VF& crossings,
                          Progress& progress, FirstLight& first, TileCounts& counts) {
  const DF d;
  const VF half = HN::Set(d, 0.5f);
  const float* const front = chunk.block.at(n, i_window, j_window);
  const float* const back = cell_data ? front : chunk.block.at(n + 1, i_window, j_window);
  const Window window(front, back, chunk.block.pitch);
  const bool uniform = current.holds(window, *front);
  if (uniform && current.clear()) return;
  const UniformLookup& table = current.uniform();
  if constexpr (cell_data) {
    const SlabPath path = path_of(lanes, n, i_window, j_window);
    for (const Stretch& stretch : path.stretches)
      counts.voxels_visited += HN::CountTrue(d, HN::Gt(stretch.end, stretch.begin));
    cast_voxels<cell_data>(chunk.frame, chunk.axes, lookup, lanes, path, window, uniform ? &table : nullptr,
                           HN::Gt(path.to, path.from), progress, first, counts);
  } else {
    const auto smooth = [&](const SlabLine& line, VF span, VF length) HWY_ATTR {
      const VF spread = HN::Mul(HN::Mul(length, line.rho), HN::MulAdd(HN::Abs(span), HN::Set(d, 0.25f), line.rho));
      const VF scale = HN::MulAdd(length, HN::Set(d, table.shadow_bound), HN::Set(d, 10 * table.product_bound));
      const VF dimmed = HN::Mul(HN::Mul(length, HN::Set(d, table.dimming_bound / 9)), HN::Mul(length, line.rho));
      return HN::AllFalse(d, HN::Gt(HN::MulAdd(spread, scale, dimmed), HN::Set(d, 1.0f)));
    };
    if (HWY_LIKELY(lanes.whole && chunk.frame.shading == nullptr)) {
      counts.voxels_visited += HN::Lanes(d);
      const SlabLine line = inner ? whole_line<true>(lanes, window, n, i_window, j_window, plane, crossings)
                                  : whole_line<false>(lanes, window, n, i_window, j_window, plane, crossings);
      const VF span = HN::Sub(line.s_1, line.s_0);
      if (HWY_LIKELY(uniform) && HWY_LIKELY(smooth(line, span, lanes.length))) {
        const VF m = HN::NegMulAdd(half, HN::Add(line.s_0, line.s_1), line.mean);
        CL::lanes::add_piece<false>(table, 0, HN::Add(line.s_0, m), HN::Add(line.s_1, m), span, lanes.length, progress);
        counts.samples += HN::Lanes(d);
        if (HWY_UNLIKELY(!HN::AllTrue(d, first.seen)))
          note_first_light(progress, HN::Set(d, static_cast<float>(n)), first);
        return;
      }
      const SlabPath path = path_of(lanes, n, i_window, j_window);
      if (uniform)
        cast_voxels<cell_data>(chunk.frame, chunk.axes, lookup, lanes, path, window, &table, HN::Gt(path.to, path.from),
                               progress, first, counts);
      else
        cast_mixed(chunk.frame, chunk.axes, lookup, lanes, path, line, window, progress, first, counts);
      return;
    }
    plane.n = -1;
    if (chunk.frame.shading != nullptr) {
      cast_shaded(chunk, lookup, lanes, n, i_window, j_window, uniform ? &table : nullptr, window, progress, first,
                  counts);
      return;
    }
    const SlabPath path = path_of(lanes, n, i_window, j_window);
    for (const Stretch& stretch : path.stretches)
      counts.voxels_visited += HN::CountTrue(d, HN::Gt(stretch.end, stretch.begin));
    const SlabLine line = part_line(lanes, path, window);
    cast_mixed(chunk.frame, chunk.axes, lookup, lanes, path, line, window, progress, first, counts);
  }
}

/// Lanes [ray, ray + Lanes()) at the chunk's first plane; voxels relative to (i_base, j_base).
HWY_INLINE Lanes lanes_of(const ChunkView& chunk, int ray, int i_base, int j_base, const TileRays& rays) {
  const DF d;
  const FrameView& frame = chunk.frame;
  constexpr std::size_t most = HN::MaxLanes(DF());
  const std::size_t lane_count = HN::Lanes(d);
  const int voxels_i = static_cast<int>(frame.voxels[static_cast<std::size_t>(chunk.axes.i)]),
            voxels_j = static_cast<int>(frame.voxels[static_cast<std::size_t>(chunk.axes.j)]);
  const auto first_k = static_cast<double>(chunk.first_k);
  Lanes lanes;
  const VF one = HN::Set(d, 1.0f);
  // In double up to here.
  HWY_ALIGN float x[most], y[most], i[most], j[most], bx[most], by[most], k_in[most], k_out[most];
  const HN::Rebind<double, HN::Half<DF>> dd;
  const HN::Rebind<float, decltype(dd)> dh;
  const auto k_0 = HN::Set(dd, first_k);
  for (std::size_t l = 0; l < lane_count; l += HN::Lanes(dd)) {
    const std::size_t r = static_cast<std::size_t>(ray) + l;
    const auto axis = [&](const double* a, const double* b, int base, float* place, float* cell,
                          float* slope) HWY_ATTR {
      const auto slopes = HN::Load(dd, b + r), places = HN::MulAdd(slopes, k_0, HN::Load(dd, a + r));
      const auto floors = HN::Floor(places);
      HN::Store(HN::DemoteTo(dh, HN::Sub(places, floors)), dh, place + l);
      HN::Store(HN::DemoteTo(dh, HN::Sub(floors, HN::Set(dd, base))), dh, cell + l);
      HN::Store(HN::DemoteTo(dh, slopes), dh, slope + l);
    };
    axis(rays.ax, rays.bx, i_base, x, i, bx);
    axis(rays.ay, rays.by, j_base, y, j, by);
    const auto end = [&](const double* k, float* out) HWY_ATTR {
      const auto relative = HN::Sub(HN::Load(dd, k + r), k_0);
      HN::Store(HN::DemoteTo(dh, HN::Min(HN::Max(relative, HN::Set(dd, -1.0)), HN::Set(dd, SlabBlock::slabs + 4.0))),
                dh, out + l);
    };
    end(rays.k_in, k_in);
    end(rays.k_out, k_out);
  }
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
  lanes.light_view = frame.shading != nullptr ? HN::LoadU(d, rays.light_view + ray) : one;
  lanes.bends = HN::Mul(lanes.bx, lanes.by);
  lanes.i_base = i_base, lanes.j_base = j_base;
  return lanes;
}

/// A packet's work in a group of eight slabs, for the tally.
struct GroupWork {
  int first;
  VF k_out, depth_before;
  std::uint64_t samples_before;

  /// As the work stands before slab `next`, or where the packet stopped.
  HWY_NOINLINE void add_to(const ChunkView& chunk, const Lanes& lanes, const Reach& reach, int next,
                           const Progress& progress, const TileCounts& counts) const {
    const DF d;
    const VF begin = HN::Max(lanes.k_in, HN::Set(d, static_cast<float>(first))),
             end = HN::Min(k_out, HN::Set(d, static_cast<float>(std::min(next, first + 8))));
    const float slabs = HN::GetLane(HN::SumOfLanes(d, HN::Max(HN::Zero(d), HN::Sub(end, begin))));
    if (!(slabs > 0)) return;
    const VF depth = HN::Div(HN::Sub(progress.optical_depth, depth_before), lanes.length);
    const float thick = HN::GetLane(HN::SumOfLanes(d, HN::Min(HN::Max(depth, HN::Zero(d)), HN::Set(d, 1e4f))));
    const float along = (static_cast<float>(first) + 4) / SlabBlock::slabs;
    const auto middle = [&](const float(&low)[2], const float(&high)[2]) {
      return static_cast<std::int64_t>(0.5f * ((low[0] + high[0]) * (1 - along) + (low[1] + high[1]) * along));
    };
    const std::int64_t k = std::min<std::int64_t>(chunk.first_k + first + 4,
                                                  chunk.frame.voxels[static_cast<std::size_t>(chunk.axes.k)] - 1);
    std::int64_t place[3];
    place[chunk.axes.i] = middle(reach.x_low, reach.x_high);
    place[chunk.axes.j] = middle(reach.y_low, reach.y_high);
    place[chunk.axes.k] = chunk.axes.mirrored ? chunk.frame.voxels[static_cast<std::size_t>(chunk.axes.k)] - 1 - k : k;
    chunk.frame.tally->add(chunk.frame.tally->cells().number(place[0], place[1], place[2]),
                           counts.samples - samples_before, slabs, thick);
  }
};

/// Lanes [lane, lane + Lanes()) of a packet through the chunk.
template <bool cell_data, class Lookup>
HWY_INLINE void cast_lanes(const ChunkView& chunk, const Lookup& lookup, int ray, const Reach& reach,
                           CurrentInterval& current, TileRays& rays, TileCounts& counts) {
  const DF d;
  const FrameView& frame = chunk.frame;
  constexpr std::size_t most = HN::MaxLanes(DF());
  const std::size_t lane_count = HN::Lanes(d);
  const VF one = HN::Set(d, 1.0f), zero = HN::Zero(d);
  const int voxels_i = static_cast<int>(frame.voxels[static_cast<std::size_t>(chunk.axes.i)]),
            voxels_j = static_cast<int>(frame.voxels[static_cast<std::size_t>(chunk.axes.j)]);
  int i_base = 0, j_base = 0, unused = 0;
  slab_range(reach.x_low, reach.x_high, 0, voxels_i, i_base, unused);
  slab_range(reach.y_low, reach.y_high, 0, voxels_j, j_base, unused);
  const auto first_k = static_cast<double>(chunk.first_k);
  Lanes lanes = lanes_of(chunk, ray, i_base, j_base, rays);
  const VF before = HN::LoadU(d, rays.transmittance + ray), least = HN::Set(d, frame.least_transmittance);
  lanes.k_out = HN::IfThenElse(HN::Lt(before, least), HN::Set(d, -1.0f), lanes.k_out);
  const auto find_whole = [&]() HWY_ATTR {
    return HN::AllTrue(
        d, HN::And(HN::Le(lanes.k_in, zero), HN::Ge(lanes.k_out, HN::Set(d, static_cast<float>(chunk.slabs)))));
  };
  lanes.whole = find_whole();
  FirstLight first;
  const VF alpha_before = HN::LoadU(d, rays.alpha + ray);
  first.seen = HN::Gt(alpha_before, zero);
  first.place = HN::Set(d, -1.0f);
  const MF seen_before = first.seen;
  Progress progress{zero, one, zero, zero, zero, zero};
  PlaneState plane;
  VF crossings = zero;

  const bool tallies = frame.tally != nullptr;
  GroupWork group{};
  for (int n = 0; n < chunk.slabs; ++n) {
    if (HWY_UNLIKELY(tallies) && n % 8 == 0) {
      if (n > 0) group.add_to(chunk, lanes, reach, n, progress, counts);
      group = {n, lanes.k_out, progress.optical_depth, counts.samples};
    }
    if (n % 4 == 0) {
      // Rays that let nothing through any more, or have left the volume, are done.
      const VF left = HN::Mul(before, progress.transmittance);
      lanes.k_out = HN::IfThenElse(HN::Lt(left, least), HN::Set(d, -1.0f), lanes.k_out);
      lanes.whole = find_whole();
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
    const bool inner = i_first > 0 && i_last < voxels_i - 1 && j_first > 0 && j_last < voxels_j - 1;
    // A window may not reach beyond what both slices hold.
    const auto cast = [&]<class Window>(int columns, int rows) HWY_ATTR {
      const int i_window = std::max(block.slab_i[s], std::min(i_first, block.slab_i_last[s] - columns + 1)),
                j_window = std::max(block.slab_j[s], std::min(j_first, block.slab_j_last[s] - rows + 1));
      cast_slab<cell_data, Window>(chunk, lookup, lanes, n, i_window, j_window, inner, current, plane, crossings,
                                   progress, first, counts);
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

  if (HWY_UNLIKELY(tallies)) group.add_to(chunk, lanes, reach, chunk.slabs, progress, counts);
  counts.voxels_visited += static_cast<std::uint64_t>(HN::GetLane(HN::SumOfLanes(d, crossings)));
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
