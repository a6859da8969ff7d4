#include "projection/lattice_rasterizer.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/lattice_rasterizer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "projection/lattice_small-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::projection {
namespace HWY_NAMESPACE {

bool available() { return HWY_TARGET != HWY_SCALAR; }

#if HWY_TARGET == HWY_SCALAR
void rasterize(const LatticeView&, std::span<const TileEntry>, std::span<const TileEntry>, const PixelRect&,
               const OpenPixels&, LatticeScratch&, SegmentStream&, RasterCounts&) {}
#else
using D4 = hn::FixedTag<std::int32_t, 4>;
using V4 = hn::Vec<D4>;

// A block of pixels is a vector of lanes: 4 x 4, 4 x 2 or 2 x 2.
constexpr int block_width = lanes >= 8 ? 4 : 2, block_height = lanes / block_width;
static_assert(block_width * block_height == lanes);

HWY_INLINE VI lane_column() { return hn::And(hn::Iota(I(), 0), hn::Set(I(), block_width - 1)); }
HWY_INLINE VI lane_row() { return hn::ShiftRight < block_width == 4 ? 2 : 1 > (hn::Iota(I(), 0)); }

/// x * column + y * row for every lane, given x, 2 x, y and 2 y: by adding bits, as a 32-bit multiplication costs ten
/// times an addition.
HWY_INLINE VI block_steps(std::int32_t x, std::int32_t x2, std::int32_t y, std::int32_t y2) {
  const I d;
  const auto bit = [&](VI number, int b) HWY_ATTR { return hn::Ne(hn::And(number, hn::Set(d, b)), hn::Zero(d)); };
  const VI column = lane_column(), row = lane_row();
  VI sum = hn::IfThenElseZero(bit(column, 1), hn::Set(d, x));
  if constexpr (block_width == 4) sum = hn::IfThenElse(bit(column, 2), hn::Add(sum, hn::Set(d, x2)), sum);
  sum = hn::IfThenElse(bit(row, 1), hn::Add(sum, hn::Set(d, y)), sum);
  if constexpr (block_height == 4) sum = hn::IfThenElse(bit(row, 2), hn::Add(sum, hn::Set(d, y2)), sum);
  return sum;
}

/// settle_pixel() for the lanes of a block. Returns those whose ray touches.
HWY_NOINLINE std::uint64_t settle(const LatticeView& view, const CellBatch& batch, int t, unsigned uncertain,
                                  int corner_x, int corner_y, float (*edges)[lanes], RasterCounts& counts) {
  std::uint64_t touching = 0;
  for (; uncertain != 0; uncertain &= uncertain - 1) {
    const int lane = __builtin_ctz(uncertain);
    const int x = corner_x + lane % block_width, y = corner_y + lane / block_width;
    if (settle_pixel(view, batch, t, x + 0.5, y + 0.5, edges[0] + lane, lanes, counts))
      touching |= std::uint64_t{1} << lane;
  }
  return touching;
}

/// Depth (steps) and scalar where the lanes' rays pass one side of the cell.
struct Crossing {
  VI depth;
  VF scalar;
};

/// The planes of one face over the block, advanced from block to block.
struct FaceSteps {
  VI depth, scalar, weight;
};

template <bool perspective, bool per_cell>
struct CellRaster {
  const LatticeView& view;
  const CellBatch& batch;
  int t;
  const Roles& roles;
  FaceSteps steps[4];
  // The planes at the block's first pixel, of faces 0 to 3.
  alignas(16) std::int32_t depth[4], scalar[4], weight[4];

  /// The steps of one quantity's four planes.
  template <class Put>
  HWY_INLINE void prepare(const std::int32_t* x, const std::int32_t* y, Put put) {
    const D4 d4;
    alignas(16) std::int32_t x2[4], y2[4];
    hn::Store(hn::ShiftLeft<1>(hn::Load(d4, x)), d4, x2), hn::Store(hn::ShiftLeft<1>(hn::Load(d4, y)), d4, y2);
    for (int k = 0; k < 4; ++k) {
      const int f = roles.face[k];
      put(k, block_steps(x[f], x2[f], y[f], y2[f]));
    }
  }
  HWY_INLINE void prepare() {
    prepare(batch.depth_x[t], batch.depth_y[t], [&](int k, VI v) HWY_ATTR { steps[k].depth = v; });
    if constexpr (!per_cell)
      prepare(batch.scalar_x[t], batch.scalar_y[t], [&](int k, VI v) HWY_ATTR { steps[k].scalar = v; });
    if constexpr (perspective)
      prepare(batch.weight_x[t], batch.weight_y[t], [&](int k, VI v) HWY_ATTR { steps[k].weight = v; });
  }

  /// One plane of the face that a lane's ray passes.
  template <class Plane>
  HWY_INLINE static VI choose2(MF first, Plane plane, int a, int b) {
    return hn::IfThenElse(hn::RebindMask(I(), first), plane(a), plane(b));
  }

  template <class Plane>
  HWY_INLINE static VI choose3(MF first, MF second, Plane plane) {
    return hn::IfThenElse(hn::RebindMask(I(), first), plane(1),
                          hn::IfThenElse(hn::RebindMask(I(), second), plane(2), plane(3)));
  }

  template <class Choose>
  HWY_INLINE Crossing crossing(Choose choose, VF cell_scalar) const {
    const I d;
    const F df;
    const VI z = choose([&](int k) HWY_ATTR { return hn::Add(steps[k].depth, hn::Set(d, depth[roles.face[k]])); });
    Crossing c;
    c.scalar = cell_scalar;
    if constexpr (!perspective) {
      c.depth = z;
      if constexpr (!per_cell)
        c.scalar = hn::ConvertTo(
            df, choose([&](int k) HWY_ATTR { return hn::Add(steps[k].scalar, hn::Set(d, scalar[roles.face[k]])); }));
    } else {
      const VF inverse = inverse_weight(
          choose([&](int k) HWY_ATTR { return hn::Add(steps[k].weight, hn::Set(d, weight[roles.face[k]])); }));
      const VI behind = hn::NearestInt(hn::Mul(hn::ConvertTo(df, z), inverse));
      c.depth = hn::Add(behind, choose([&](int k) HWY_ATTR { return hn::Set(d, batch.depth_c[t][roles.face[k]]); }));
      if constexpr (!per_cell) {
        const VI s =
            choose([&](int k) HWY_ATTR { return hn::Add(steps[k].scalar, hn::Set(d, scalar[roles.face[k]])); });
        const VF s_c = hn::BitCast(
            df, choose([&](int k) HWY_ATTR { return hn::BitCast(d, hn::Set(df, batch.scalar_c[t][roles.face[k]])); }));
        c.scalar = hn::MulAdd(hn::ConvertTo(df, s), inverse, s_c);
      }
    }
    return c;
  }

  template <bool three>
  HWY_INLINE void run(const PixelRect& rect, const PixelRect& square, SegmentStream& out, RasterCounts& counts) {
    const I d;
    const F df;
    const VI column = lane_column(), row = lane_row();
    const VF zero = hn::Zero(df), one = hn::Set(df, 1.0f), minus_one = hn::Set(df, -1.0f);
    const VF cell_scalar = hn::Set(df, per_cell ? batch.cell_scalar[t] : 0.0f);
    const int x0 = batch.x0[t], x1 = batch.x1[t], y0 = batch.y0[t], y1 = batch.y1[t];
    prepare();
    const VI right = hn::Set(d, x1), bottom = hn::Set(d, y1);
    const auto edge = [&](int e, VF x, VF y) HWY_ATTR {
      return hn::MulAdd(hn::Set(df, batch.edge_x[e][t]), x,
                        hn::MulAdd(hn::Set(df, batch.edge_y[e][t]), y, hn::Set(df, batch.edge[e][t])));
    };
    const VI first_pixel =
        hn::Set(d, (rect.y0 - square.y0) * rect.width() + (rect.x0 - square.x0));  // of the square, in the rectangle
    const D4 d4;
    constexpr int log_width = block_width == 4 ? 2 : 1;
    const V4 depth_advance = hn::ShiftLeft<log_width>(hn::Load(d4, batch.depth_x[t]));
    V4 scalar_advance = depth_advance, weight_advance = depth_advance;
    if constexpr (!per_cell) scalar_advance = hn::ShiftLeft<log_width>(hn::Load(d4, batch.scalar_x[t]));
    if constexpr (perspective) weight_advance = hn::ShiftLeft<log_width>(hn::Load(d4, batch.weight_x[t]));
    for (int by = y0; by < y1; by += block_height) {
      const VI py = hn::Add(row, hn::Set(d, by));
      const VF y = hn::ConvertTo(df, hn::Sub(py, hn::Set(d, CellBatch::center)));
      const auto in_rows = hn::Lt(py, bottom);
      const VI row_start = hn::Sub(hn::Mul(py, hn::Set(d, rect.width())), first_pixel);
      V4 block_depth = at(batch.depth[t], batch.depth_x[t], batch.depth_y[t], x0, by), block_scalar = block_depth,
         block_weight = block_depth;
      if constexpr (!per_cell) block_scalar = at(batch.scalar[t], batch.scalar_x[t], batch.scalar_y[t], x0, by);
      if constexpr (perspective) block_weight = at(batch.weight[t], batch.weight_x[t], batch.weight_y[t], x0, by);
      const auto advance = [&]() HWY_ATTR {
        block_depth = hn::Add(block_depth, depth_advance);
        if constexpr (!per_cell) block_scalar = hn::Add(block_scalar, scalar_advance);
        if constexpr (perspective) block_weight = hn::Add(block_weight, weight_advance);
      };
      for (int bx = x0; bx < x1; bx += block_width, advance()) {
        const VI px = hn::Add(column, hn::Set(d, bx));
        const VF x = hn::ConvertTo(df, hn::Sub(px, hn::Set(d, CellBatch::center)));
        VF outline[4];
        for (int k = 0; k < (three ? 3 : 4); ++k) outline[k] = edge(roles.outline[k], x, y);
        VF least = hn::Min(hn::Min(outline[0], outline[1]), outline[2]);
        if constexpr (!three) least = hn::Min(least, outline[3]);
        const auto in_box = hn::RebindMask(df, hn::And(in_rows, hn::Lt(px, right)));
        const MF possible = hn::And(in_box, hn::Gt(least, minus_one));
        if (hn::AllFalse(df, possible)) continue;

        VF inner[3];
        for (int k = 0; k < (three ? 3 : 2); ++k) inner[k] = edge(roles.inner[k], x, y);
        VF sure = hn::Min(hn::Min(hn::Abs(inner[0]), hn::Abs(inner[1])), least);
        if constexpr (three) sure = hn::Min(sure, hn::Abs(inner[2]));
        MF hit = possible;
        std::uint64_t touching = 0;
        const MF uncertain = hn::And(possible, hn::Le(sure, one));
        if (HWY_UNLIKELY(!hn::AllFalse(df, uncertain))) {
          alignas(64) float edges[6][lanes];
          for (int e = 0; e < 6; ++e) hn::Store(edge(e, x, y), df, edges[e]);
          touching = settle(view, batch, t, lane_bits(uncertain), square.x0 + bx, square.y0 + by, edges, counts);
          least = hn::Load(df, edges[roles.outline[0]]);
          for (int k = 1; k < (three ? 3 : 4); ++k) least = hn::Min(least, hn::Load(df, edges[roles.outline[k]]));
          for (int k = 0; k < (three ? 3 : 2); ++k) inner[k] = hn::Load(df, edges[roles.inner[k]]);
          hit = hn::And(possible, hn::Gt(least, zero));
        }
        hn::Store(block_depth, d4, depth);
        if constexpr (!per_cell) hn::Store(block_scalar, d4, scalar);
        if constexpr (perspective) hn::Store(block_weight, d4, weight);
        Crossing first, second;
        if constexpr (three) {
          const MF is0 = hn::And(hn::Gt(inner[0], zero), hn::Gt(inner[1], zero)), is1 = hn::Gt(inner[2], zero);
          first = crossing([&](auto plane) HWY_ATTR { return plane(0); }, cell_scalar);
          second = crossing([&](auto plane) HWY_ATTR { return choose3(is0, is1, plane); }, cell_scalar);
        } else {
          const MF is0 = hn::Gt(inner[0], zero), is2 = hn::Gt(inner[1], zero);
          first = crossing([&](auto plane) HWY_ATTR { return choose2(is0, plane, 0, 1); }, cell_scalar);
          second = crossing([&](auto plane) HWY_ATTR { return choose2(is2, plane, 2, 3); }, cell_scalar);
        }
        if (HWY_UNLIKELY(touching != 0)) {
          const std::uint8_t bits[8] = {static_cast<std::uint8_t>(touching), static_cast<std::uint8_t>(touching >> 8)};
          second.depth = hn::IfThenElse(hn::LoadMaskBits(d, bits), first.depth, second.depth);
        }
        const VF scalar_front = three && roles.single_behind ? second.scalar : first.scalar;
        const VF scalar_back = three && roles.single_behind ? first.scalar : second.scalar;
        const VI pixel = hn::Add(row_start, px);
        const auto hit_int = hn::RebindMask(d, hit);
        // Packed in registers and stored as whole vectors: a compressing store is slower on several processors.
        const LanePacker pack(hit_int);
        hn::StoreU(pack(pixel), d, out.pixel.data() + out.size);
        hn::StoreU(pack(hn::Min(first.depth, second.depth)), d, out.front.data() + out.size);
        hn::StoreU(pack(hn::Max(first.depth, second.depth)), d, out.back.data() + out.size);
        hn::StoreU(pack(scalar_front), df, out.scalar_front.data() + out.size);
        hn::StoreU(pack(scalar_back), df, out.scalar_back.data() + out.size);
        out.size += pack.count();
      }
    }
  }

  /// The planes of faces 0 to 3 at a pixel of the square.
  HWY_INLINE static V4 at(const std::int32_t* start, const std::int32_t* x, const std::int32_t* y, int px, int py) {
    const D4 d4;
    return hn::Add(hn::Load(d4, start), hn::Add(hn::Mul(hn::Load(d4, x), hn::Set(d4, px - CellBatch::center)),
                                                hn::Mul(hn::Load(d4, y), hn::Set(d4, py - CellBatch::center))));
  }
};

template <bool perspective, bool per_cell>
void rasterize_cells(const LatticeView& view, const CellBatch& batch, const PixelRect& rect, const PixelRect& square,
                     const OpenPixels& open, SegmentStream& out, RasterCounts& counts) {
  const std::uint32_t all = static_cast<std::uint32_t>((std::uint64_t{1} << rect.width()) - 1) << (rect.x0 - square.x0);
  bool all_open = true;
  for (int y = rect.y0 - square.y0; y < rect.y1 - square.y0; ++y) all_open = all_open && open[y] == all;
  const auto shut = [&](int t) {
    std::uint32_t takes = 0;
    for (int y = batch.y0[t]; y < batch.y1[t]; ++y) takes |= open[y];
    const std::uint64_t columns = (std::uint64_t{1} << batch.x1[t]) - (std::uint64_t{1} << batch.x0[t]);
    return (takes & columns) == 0;
  };
  unsigned shapes[2] = {0, 0}, small = 0;
  using Small = SmallCells<perspective, per_cell>;
  for (int t = 0; t < batch.size; ++t) {
    const Roles& roles = role_table.roles[batch.front_faces(t)];
    const unsigned takes =
        roles.valid && batch.x0[t] < batch.x1[t] && batch.y0[t] < batch.y1[t] && (all_open || !shut(t));
    shapes[roles.three] |= takes << t;
  }
  for (int from = 0; from < batch.size; from += lanes) {
    const unsigned regular = (shapes[0] | shapes[1]) & ~batch.irregular;
    const unsigned here = Small::worth_while(batch, from, regular >> from & ((1u << lanes) - 1));
    if (here != 0) Small(view, batch, from, here).run(rect, square, out, counts);
    small |= here << from;
  }
  // Cells of one shape after the other, so that branches go the same way.
  for (const int three : {0, 1})
    for (unsigned cells = shapes[three] & ~(batch.irregular | small); cells != 0; cells &= cells - 1) {
      const int t = __builtin_ctz(cells);
      CellRaster<perspective, per_cell> raster{view, batch, t, role_table.roles[batch.front_faces(t)], {}, {}, {}, {}};
      if (three == 1)
        raster.template run<true>(rect, square, out, counts);
      else
        raster.template run<false>(rect, square, out, counts);
    }
}

/// An irregular cell, from double precision to the lattice.
HWY_NOINLINE void rasterize_irregular(const LatticeView& view, const TileEntry& entry, const PixelRect& rect,
                                      LatticeScratch& scratch, SegmentStream& out, RasterCounts& counts) {
  RaySegments& s = scratch.segments;
  const auto area = static_cast<std::size_t>(rect.area());
  if (s.capacity() < area) s.reserve(area);
  s.size = 0;
  rasterize_planes(view.projected, {&entry, 1}, rect, s, counts);
  for (std::size_t i = 0; i < s.size; ++i) {
    out.pixel[out.size] = static_cast<std::int32_t>(s.pixel(i));
    out.front[out.size] = view.lattice.depth_step(s.front[i]);
    out.back[out.size] = view.lattice.depth_step(s.back[i]);
    out.scalar_front[out.size] = static_cast<float>(view.lattice.scalar_step(s.scalar_front[i]));
    out.scalar_back[out.size] = static_cast<float>(view.lattice.scalar_step(s.scalar_back[i]));
    ++out.size;
  }
}

void rasterize(const LatticeView& view, std::span<const TileEntry> entries, std::span<const TileEntry> ahead,
               const PixelRect& rect, const OpenPixels& open, LatticeScratch& scratch, SegmentStream& out,
               RasterCounts& counts) {
  const PixelRect square{rect.x0 & ~(SegmentWindows::side - 1), rect.y0 & ~(SegmentWindows::side - 1), 0, 0};
  const bool per_cell = view.projected.mesh->mesh().association == scene::Association::cell;
  CellBatch batch;
  for (std::size_t from = 0; from < entries.size(); from += CellBatch::most) {
    const auto cells = entries.subspan(from, std::min<std::size_t>(CellBatch::most, entries.size() - from));
    out.reserve(out.size + cells.size() * static_cast<std::size_t>(rect.area()));
    if (from == 0) prefetch_cells(view, ahead);
    if (view.perspective)
      set_up_cells<true>(view, cells, rect, batch);
    else
      set_up_cells<false>(view, cells, rect, batch);
    for (unsigned irregular = batch.irregular; irregular != 0; irregular &= irregular - 1)
      rasterize_irregular(view, cells[static_cast<std::size_t>(__builtin_ctz(irregular))], rect, scratch, out, counts);
    if (view.perspective)
      per_cell ? rasterize_cells<true, true>(view, batch, rect, square, open, out, counts)
               : rasterize_cells<true, false>(view, batch, rect, square, open, out, counts);
    else
      per_cell ? rasterize_cells<false, true>(view, batch, rect, square, open, out, counts)
               : rasterize_cells<false, false>(view, batch, rect, square, open, out, counts);
  }
}
#endif  // HWY_SCALAR

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::projection {
HWY_EXPORT(rasterize);
HWY_EXPORT(available);

void make_lattice_vertices(std::span<const PixelVertex> vertices, std::span<const double> scalars,
                           const Lattice& lattice, bool perspective, std::span<LatticeVertex> out) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const PixelVertex& v = vertices[i];
    LatticeVertex& to = out[i];
    to = {v.x, v.y, 1, lattice.depth_step(v.depth), scalars.empty() ? 0 : lattice.scalar_step(scalars[i])};
    if (!perspective) continue;
    to.inverse_w = v.w > 0 ? 1 / v.w : 0;
    to.x *= to.inverse_w, to.y *= to.inverse_w;
  }
}

bool lattice_available() { return HWY_DYNAMIC_DISPATCH(available)(); }

void rasterize_lattice(const LatticeView& view, std::span<const TileEntry> entries, std::span<const TileEntry> ahead,
                       const PixelRect& rect, const OpenPixels& open, LatticeScratch& scratch, SegmentStream& out,
                       RasterCounts& counts) {
  HWY_DYNAMIC_DISPATCH(rasterize)(view, entries, ahead, rect, open, scratch, out, counts);
}

}  // namespace tessera::projection
#endif  // HWY_ONCE
