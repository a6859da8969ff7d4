#include "projection/lattice_rasterizer.hpp"

#include <algorithm>
#include <type_traits>

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
/// A block of pixels is a vector of lanes: as good as square, or half as high and twice as wide, or the other way
/// round, whichever takes the fewest to cover a cell's box.
struct BlockShape {
  alignas(64) std::int32_t column[lanes], row[lanes];
  std::int32_t width, height;
};
constexpr BlockShape block_of(int width) {
  BlockShape shape{{}, {}, width, lanes / width};
  for (int lane = 0; lane < lanes; ++lane) shape.column[lane] = lane % width, shape.row[lane] = lane / width;
  return shape;
}
constexpr int usual_width = lanes >= 8 ? 4 : 2;
constexpr BlockShape block_shapes[] = {block_of(usual_width), block_of(2 * usual_width), block_of(usual_width / 2)};

/// Lays blocks over the batch's cells, all cells at once. Blocks that would reach out of the rectangle move inwards:
/// what is not the cell's its edges tell. Only in the narrowest of rectangles does that not help; those are `clipped`.
template <bool perspective, bool per_cell>
HWY_INLINE void lay_blocks(const PixelRect& rect, const PixelRect& square, CellBatch& batch) {
  const I d;
  const F df;
  const auto number = [](int n) HWY_ATTR { return hn::Set(I(), n); };
  const VI right = number(rect.x1 - square.x0), bottom = number(rect.y1 - square.y0);
  const VI first_x = number(rect.x0 - square.x0), first_y = number(rect.y0 - square.y0);
  const VI width = number(rect.width()), center = number(CellBatch::center), one = number(1);
  for (int t = 0; t < CellBatch::most; t += lanes) {
    const VI x0 = hn::Load(d, batch.x0 + t), y0 = hn::Load(d, batch.y0 + t);
    const VI box_width = hn::Sub(hn::Load(d, batch.x1 + t), x0), box_height = hn::Sub(hn::Load(d, batch.y1 + t), y0);
    VI shape = hn::Zero(d), columns = shape, rows = shape, blocks = number(0x7fffffff);
    VI block_width = shape, block_height = shape;
    for (int i = 0; i < 3; ++i) {
      const BlockShape& of = block_shapes[i];
      const auto blocks_over = [&](VI box, int side) HWY_ATTR {
        return hn::ShiftRightSame(hn::Add(box, number(side - 1)), __builtin_ctz(static_cast<unsigned>(side)));
      };
      const VI across = blocks_over(box_width, of.width), down = blocks_over(box_height, of.height);
      const VI count = hn::Mul(across, down);
      const auto fewer = hn::Lt(count, blocks);
      blocks = hn::IfThenElse(fewer, count, blocks), shape = hn::IfThenElse(fewer, number(i), shape);
      columns = hn::IfThenElse(fewer, across, columns), rows = hn::IfThenElse(fewer, down, rows);
      block_width = hn::IfThenElse(fewer, number(of.width), block_width);
      block_height = hn::IfThenElse(fewer, number(of.height), block_height);
    }
    const VI across = hn::Mul(columns, block_width), down = hn::Mul(rows, block_height);
    const VI left = hn::Max(first_x, hn::Min(x0, hn::Sub(right, across)));
    const VI top = hn::Max(first_y, hn::Min(y0, hn::Sub(bottom, down)));
    const auto clipped = hn::Or(hn::Gt(hn::Add(left, across), right), hn::Gt(hn::Add(top, down), bottom));
    const VI last_column = hn::Sub(columns, one), last_pixel = hn::Mul(last_column, block_width);
    hn::Store(shape, d, batch.shape + t);
    hn::Store(left, d, batch.left + t), hn::Store(top, d, batch.top + t);
    hn::Store(columns, d, batch.columns + t), hn::Store(blocks, d, batch.blocks + t);
    hn::Store(hn::VecFromMask(d, clipped), d, batch.clipped + t);
    hn::Store(hn::Add(hn::Mul(hn::Sub(top, first_y), width), hn::Sub(left, first_x)), d, batch.pixel + t);
    hn::Store(block_width, d, batch.pixel_step[0] + t);
    hn::Store(hn::Sub(hn::Mul(block_height, width), last_pixel), d, batch.pixel_step[1] + t);
    // A sign is certain beyond 1 (2^-22 of the largest value). To sum rounds a quarter of that each time, as to make
    // the step did; beside a narrow rectangle, whose blocks reach out of it, values are up to 1.4 times as large.
    hn::Store(hn::MulAdd(hn::ConvertTo(df, blocks), hn::Set(df, 0.75f), hn::Set(df, 2.0f)), df, batch.doubtful + t);

    const VI x = hn::Sub(left, center), y = hn::Sub(top, center);
    const VF xf = hn::ConvertTo(df, x), yf = hn::ConvertTo(df, y), back = hn::ConvertTo(df, last_pixel);
    const VF across_f = hn::ConvertTo(df, block_width), down_f = hn::ConvertTo(df, block_height);
    for (int e = 0; e < 6; ++e) {
      const VF along_x = hn::Load(df, batch.edge_x[e] + t), along_y = hn::Load(df, batch.edge_y[e] + t);
      hn::Store(hn::MulAdd(along_x, xf, hn::MulAdd(along_y, yf, hn::Load(df, batch.edge[e] + t))), df,
                batch.block_edge[e] + t);
      hn::Store(hn::Mul(along_x, across_f), df, batch.edge_step[e][0] + t);
      hn::Store(hn::NegMulAdd(along_x, back, hn::Mul(along_y, down_f)), df, batch.edge_step[e][1] + t);
    }
    const auto lay = [&](CellBatch::FacePlanes& planes) HWY_ATTR {
      for (int f = 0; f < 4; ++f) {
        const VI along_x = hn::Load(d, planes.x[f] + t), along_y = hn::Load(d, planes.y[f] + t);
        hn::Store(hn::Add(hn::Load(d, planes.start[f] + t), hn::Add(hn::Mul(along_x, x), hn::Mul(along_y, y))), d,
                  planes.block[f] + t);
        hn::Store(hn::Mul(along_x, block_width), d, planes.step[f][0] + t);
        hn::Store(hn::Sub(hn::Mul(along_y, block_height), hn::Mul(along_x, last_pixel)), d, planes.step[f][1] + t);
      }
    };
    lay(batch.depth);
    if constexpr (!per_cell) lay(batch.scalar);
    if constexpr (perspective) lay(batch.weight);
  }
}

/// settle_pixel() for the lanes of a block. Returns those whose ray touches.
HWY_NOINLINE std::uint64_t settle(const LatticeView& view, const CellBatch& batch, int t, unsigned uncertain,
                                  const BlockShape& shape, int corner_x, int corner_y, float (*edges)[lanes],
                                  RasterCounts& counts) {
  std::uint64_t touching = 0;
  for (; uncertain != 0; uncertain &= uncertain - 1) {
    const int lane = __builtin_ctz(uncertain);
    const int x = corner_x + shape.column[lane], y = corner_y + shape.row[lane];
    if (settle_pixel(view, batch, t, x + 0.5, y + 0.5, edges[0] + lane, lanes, counts))
      touching |= std::uint64_t{1} << lane;
  }
  return touching;
}

/// How a cell looks: two faces against two, or one against three.
enum class Shape { two, one_in, one_behind };

template <bool perspective, bool per_cell>
struct CellRaster {
  const LatticeView& view;
  const CellBatch& batch;
  int t;
  const Roles& roles;

  /// A quantity's planes over the block, of the faces in the order of their roles.
  struct Planes {
    VI face[4];
    const std::int32_t* step[4];
  };
  Planes depth, scalar, weight;

  HWY_INLINE void start(const CellBatch::FacePlanes& all, VI column, VI row, Planes& planes) const {
    const I d;
    for (int k = 0; k < 4; ++k) {
      const int f = roles.face[k];
      planes.face[k] = hn::Add(hn::Set(d, all.block[f][t]), hn::Add(hn::Mul(column, hn::Set(d, all.x[f][t])),
                                                                    hn::Mul(row, hn::Set(d, all.y[f][t]))));
      planes.step[k] = &all.step[f][0][t];
    }
  }
  HWY_INLINE static void go_on(int wraps, Planes& planes) {
    const I d;
    for (int k = 0; k < 4; ++k)
      planes.face[k] = hn::Add(planes.face[k], hn::Set(d, planes.step[k][wraps * CellBatch::most]));
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
    const VI z = choose([&](int k) HWY_ATTR { return depth.face[k]; });
    Crossing c;
    c.scalar = cell_scalar;
    if constexpr (!perspective) {
      c.depth = z;
      if constexpr (!per_cell) c.scalar = hn::ConvertTo(df, choose([&](int k) HWY_ATTR { return scalar.face[k]; }));
    } else {
      const VF inverse = inverse_weight(choose([&](int k) HWY_ATTR { return weight.face[k]; }));
      const VI behind = hn::NearestInt(hn::Mul(hn::ConvertTo(df, z), inverse));
      c.depth = hn::Add(behind, choose([&](int k) HWY_ATTR { return hn::Set(d, batch.depth_c[roles.face[k]][t]); }));
      if constexpr (!per_cell) {
        const VI s = choose([&](int k) HWY_ATTR { return scalar.face[k]; });
        const VF s_c = hn::BitCast(
            df, choose([&](int k) HWY_ATTR { return hn::BitCast(d, hn::Set(df, batch.scalar_c[roles.face[k]][t])); }));
        c.scalar = hn::MulAdd(hn::ConvertTo(df, s), inverse, s_c);
      }
    }
    return c;
  }

  template <Shape shape>
  HWY_INLINE void run(const PixelRect& rect, const PixelRect& square, SegmentStream& out, RasterCounts& counts) {
    const I d;
    const F df;
    constexpr bool three = shape != Shape::two;
    constexpr int outlines = three ? 3 : 4, inners = 6 - outlines;
    const int columns = batch.columns[t], x0 = batch.left[t], y0 = batch.top[t];
    const bool clipped = batch.clipped[t] != 0;
    const int right = rect.x1 - square.x0, bottom = rect.y1 - square.y0;
    const BlockShape& block_shape = block_shapes[batch.shape[t]];
    const VI column = hn::Load(d, block_shape.column), row = hn::Load(d, block_shape.row);
    const VF zero = hn::Zero(df), minus_one = hn::Set(df, -1.0f), doubtful = hn::Set(df, batch.doubtful[t]);
    const VF cell_scalar = hn::Set(df, per_cell ? batch.cell_scalar[t] : 0.0f);
    const auto edge_at = [&](int e, const float* start, VF x, VF y) HWY_ATTR {
      return hn::MulAdd(hn::Set(df, batch.edge_x[e][t]), x,
                        hn::MulAdd(hn::Set(df, batch.edge_y[e][t]), y, hn::Set(df, start[t])));
    };
    start(batch.depth, column, row, depth);
    if constexpr (!per_cell) start(batch.scalar, column, row, scalar);
    if constexpr (perspective) start(batch.weight, column, row, weight);
    VF edge[outlines + inners];
    const float* edge_step[outlines + inners];
    for (int k = 0; k < outlines + inners; ++k) {
      const int e = k < outlines ? roles.outline[k] : roles.inner[k - outlines];
      edge[k] = edge_at(e, batch.block_edge[e], hn::ConvertTo(df, column), hn::ConvertTo(df, row));
      edge_step[k] = &batch.edge_step[e][0][t];
    }
    VI pixel = hn::Add(hn::Add(hn::Mul(row, hn::Set(d, rect.width())), column), hn::Set(d, batch.pixel[t]));

    // Block after block, row by row, in one loop. (How many blocks a row has is hard to predict, and to be wrong costs
    // as much as a block.)
    int left = columns;
    for (int block = 0, count = batch.blocks[t]; block < count; ++block) {
      VF least = hn::Min(hn::Min(edge[0], edge[1]), edge[2]);
      if constexpr (!three) least = hn::Min(least, edge[3]);
      VF inner[3] = {zero, zero, zero}, sure = least;
      for (int k = 0; k < inners; ++k) {
        inner[k] = edge[outlines + k];
        sure = hn::Min(sure, hn::Abs(inner[k]));
      }
      MF hit = hn::Gt(least, zero);
      if (HWY_UNLIKELY(clipped)) hit = hn::And(hit, in_rectangle(block_shape, x0, y0, block, columns, right, bottom));
      std::uint64_t touching = 0;
      // Lanes that are neither surely in nor surely out are looked at again.
      if (HWY_UNLIKELY(!hn::AllFalse(df, hn::And(hn::Le(sure, doubtful), hn::Ge(least, hn::Neg(doubtful)))))) {
        const int bx = x0 + block % columns * block_shape.width, by = y0 + block / columns * block_shape.height;
        const VF x = hn::ConvertTo(df, hn::Add(column, hn::Set(d, bx - CellBatch::center)));
        const VF y = hn::ConvertTo(df, hn::Add(row, hn::Set(d, by - CellBatch::center)));
        alignas(64) float edges[6][lanes];
        for (int e = 0; e < 6; ++e) hn::Store(edge_at(e, batch.edge[e], x, y), df, edges[e]);
        const auto load = [&](int e) HWY_ATTR { return hn::Load(df, edges[e]); };
        const auto outline = [&]() HWY_ATTR {
          const VF three_edges =
              hn::Min(hn::Min(load(roles.outline[0]), load(roles.outline[1])), load(roles.outline[2]));
          return three ? three_edges : hn::Min(three_edges, load(roles.outline[3]));
        };
        MF possible = hn::Gt(outline(), minus_one);
        if (clipped) possible = hn::And(possible, in_rectangle(block_shape, x0, y0, block, columns, right, bottom));
        VF doubt = outline();
        for (int k = 0; k < inners; ++k) doubt = hn::Min(doubt, hn::Abs(load(roles.inner[k])));
        const MF uncertain = hn::And(possible, hn::Le(doubt, hn::Set(df, 1.0f)));
        if (!hn::AllFalse(df, uncertain))
          touching =
              settle(view, batch, t, lane_bits(uncertain), block_shape, square.x0 + bx, square.y0 + by, edges, counts);
        hit = hn::And(possible, hn::Gt(outline(), zero));
        for (int k = 0; k < inners; ++k) inner[k] = load(roles.inner[k]);
      }
      const MF is0 = three ? hn::And(hn::Gt(inner[0], zero), hn::Gt(inner[1], zero)) : hn::Gt(inner[0], zero);
      const MF is1 = hn::Gt(inner[three ? 2 : 1], zero);
      // Of two against two the first side are the front faces, of one against three it is the one.
      const auto first_side = [&](auto plane) HWY_ATTR {
        if constexpr (three)
          return plane(0);
        else
          return choose2(is0, plane, 0, 1);
      };
      const auto second_side = [&](auto plane) HWY_ATTR {
        if constexpr (three)
          return choose3(is0, is1, plane);
        else
          return choose2(is1, plane, 2, 3);
      };
      const Crossing first = crossing(first_side, cell_scalar);
      Crossing second = crossing(second_side, cell_scalar);
      if (HWY_UNLIKELY(touching != 0)) {
        const std::uint8_t bits[8] = {static_cast<std::uint8_t>(touching), static_cast<std::uint8_t>(touching >> 8)};
        second.depth = hn::IfThenElse(hn::LoadMaskBits(d, bits), first.depth, second.depth);
      }
      constexpr bool swapped = shape == Shape::one_behind;
      append(hit, pixel, hn::Min(first.depth, second.depth), hn::Max(first.depth, second.depth),
             swapped ? second.scalar : first.scalar, swapped ? first.scalar : second.scalar, out);
      const int wraps = static_cast<int>(--left == 0);
      left += columns & -wraps;
      for (int k = 0; k < outlines + inners; ++k)
        edge[k] = hn::Add(edge[k], hn::Set(df, edge_step[k][wraps * CellBatch::most]));
      pixel = hn::Add(pixel, hn::Set(d, batch.pixel_step[wraps][t]));
      go_on(wraps, depth);
      if constexpr (!per_cell) go_on(wraps, scalar);
      if constexpr (perspective) go_on(wraps, weight);
    }
  }

  /// The lanes of a block that lie in the rectangle.
  HWY_NOINLINE static MF in_rectangle(const BlockShape& shape, int x0, int y0, int block, int columns, int right,
                                      int bottom) {
    const I d;
    const VI x = hn::Add(hn::Load(d, shape.column), hn::Set(d, x0 + block % columns * shape.width));
    const VI y = hn::Add(hn::Load(d, shape.row), hn::Set(d, y0 + block / columns * shape.height));
    return hn::RebindMask(F(), hn::And(hn::Lt(x, hn::Set(d, right)), hn::Lt(y, hn::Set(d, bottom))));
  }
};

template <bool perspective, bool per_cell>
void rasterize_cells(const LatticeView& view, CellBatch& batch, const PixelRect& rect, const PixelRect& square,
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
  unsigned shapes[3] = {0, 0, 0}, small = 0;
  using Small = SmallCells<perspective, per_cell>;
  for (int t = 0; t < batch.size; ++t) {
    const Roles& roles = role_table.roles[batch.front_faces(t)];
    const unsigned takes =
        roles.valid && batch.x0[t] < batch.x1[t] && batch.y0[t] < batch.y1[t] && (all_open || !shut(t));
    shapes[roles.three + roles.single_behind] |= takes << t;
  }
  for (int from = 0; from < batch.size; from += lanes) {
    const unsigned regular = (shapes[0] | shapes[1] | shapes[2]) & ~batch.irregular;
    const unsigned here = Small::worth_while(batch, from, regular >> from & ((1u << lanes) - 1));
    if (here != 0) Small(view, batch, from, here).run(rect, square, out, counts);
    small |= here << from;
  }
  // Cells of one shape after the other, so that branches go the same way.
  if (((shapes[0] | shapes[1] | shapes[2]) & ~(batch.irregular | small)) == 0) return;
  lay_blocks<perspective, per_cell>(rect, square, batch);
  const auto run = [&](auto shape) HWY_ATTR {
    for (unsigned cells = shapes[static_cast<int>(shape())] & ~(batch.irregular | small); cells != 0;
         cells &= cells - 1) {
      const int t = __builtin_ctz(cells);
      CellRaster<perspective, per_cell> raster{view, batch, t, role_table.roles[batch.front_faces(t)], {}, {}, {}};
      raster.template run<shape()>(rect, square, out, counts);
    }
  };
  run(std::integral_constant<Shape, Shape::two>());
  run(std::integral_constant<Shape, Shape::one_in>());
  run(std::integral_constant<Shape, Shape::one_behind>());
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
