// SPDX-License-Identifier: BSD-3-Clause
// Finds the pixels that a batch's cells cover, from the edges of the outline alone, one cell or one pixel per lane.
// Included once per instruction set (Highway's include guard idiom).
//
// What      Hits are pixels whose centre is inside the cell's outline, where the smallest of its four edge functions is
//           positive. They are packed into the queue; those close to an edge are marked as uncertain.
// How       Edge functions are linear, so from one block of pixels to the next each changes by a constant: four
//           additions per block. Cells of a few pixels are processed together instead, one cell per lane.
// Accuracy  Float. The rounding error of the sums is below outline_uncertainty; for values below this,
//           lattice_cross-inl.h determines the exact sign.
// Ends      Blocks extend beyond the rectangle only if the rectangle is narrower than a block; the lanes outside are
//           masked.

#if defined(TESSERA_PROJECTION_LATTICE_COVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_LATTICE_COVER_INL_H_
#undef TESSERA_PROJECTION_LATTICE_COVER_INL_H_
#else
#define TESSERA_PROJECTION_LATTICE_COVER_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "projection/lattice/lattice_parts-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {

/// A block of pixels is a vector of lanes. It is approximately square, or half as high and twice as wide, or the
/// reverse. The shape is used with which the fewest blocks cover a cell's box.
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

/// Above this value, an outline's sign is certain. The start value contributes 1 (2^-22 of the largest value). Each
/// addition from block to block contributes a quarter for the rounding of the sum, and a quarter for the rounding of
/// the step. Next to a narrow rectangle, whose blocks extend beyond it, values are up to 1.4 times as large.
constexpr int most_blocks = SegmentWindows::most_pixels / lanes;
constexpr float outline_uncertainty = 2.0f + 0.75f * static_cast<float>(most_blocks);

/// Returns first, first + 1... (Iota() of a variable would go through memory, lane by lane.)
HWY_INLINE VI numbers_from(int first) { return Iota(DI(), 0) + Set(DI(), first); }

/// Appends the lanes that are hit, or may be hit, after `size` hits in the queue; returns the new size.
HWY_INLINE std::size_t push_hits(VF least, MF among, VI hits, HitQueue& queue, std::size_t size) {
  const DF df;
  const DI d;
  const VF bound = Set(df, outline_uncertainty), minus_bound = Set(df, -outline_uncertainty);
  const VI mark = Set(d, Hit::uncertain);
  const MF near = greater_where(among, least, minus_bound);
  hits = or_where(RebindMask(d, least <= bound), hits, mark);
  const LanePacker pack(RebindMask(d, near));
  StoreU(pack(hits), d, queue.hit + size);
  return size + pack.count();
}

/// Cells of a few pixels. As many cells of a batch as there are lanes, from cell `from` on, process their candidate
/// pixels together, row by row; each cell begins at its own corner.
struct SmallCells {
  // Costs in cycles, roughly as measured with AVX-512: of a block, and of the steps of all lanes here.
  static constexpr int block_cost = 8, cell_cost = 45, step_cost = 9, start_cost = 60;

  /// Returns the subset of `cells` (one bit each) that is faster this way: the cells up to some size, if their largest
  /// number of candidate pixels costs less than the blocks of all these cells.
  HWY_INLINE static unsigned worth_while(const CellBatch& batch, unsigned cells, int from) {
    const DI d;
    const auto takes = mask_of(cells, from);
    const VI width = IfThenElseZero(takes, Load(d, batch.x1 + from) - Load(d, batch.x0 + from));
    const VI height = IfThenElseZero(takes, Load(d, batch.y1 + from) - Load(d, batch.y0 + from));
    const VI side = Max(width, height);
    constexpr int across = usual_width, down = lanes / usual_width;
    const VI blocks = hn::ShiftRight<std::countr_zero(unsigned{across})>(width + Set(d, across - 1)) *
                      hn::ShiftRight<std::countr_zero(unsigned{down})>(height + Set(d, down - 1));
    const VI cost = IfThenElseZero(takes, blocks * Set(d, block_cost) + Set(d, cell_cost));
    for (const int most_side : {16, 10, 6}) {
      const auto small = side < Set(d, most_side + 1);
      const int candidates =
          GetLane(MaxOfLanes(d, IfThenElseZero(small, width))) * GetLane(MaxOfLanes(d, IfThenElseZero(small, height)));
      if (candidates * step_cost + start_cost < GetLane(SumOfLanes(d, IfThenElseZero(small, cost))))
        return cells & lane_bits(RebindMask(DF(), small)) << from;
    }
    return 0;
  }

  /// Finds the hits of `cells` (one bit each). drain() is called to make room in the queue.
  template <class Drain>
  HWY_INLINE static void cover(const CellBatch& batch, const CellParts& parts, unsigned cells, int from,
                               HitQueue& queue, const Drain& drain) {
    const DI d;
    const DF df;
    const auto takes = mask_of(cells, from);
    const VI x0 = Load(d, batch.x0 + from), y0 = Load(d, batch.y0 + from);
    const VI width = IfThenElseZero(takes, Load(d, batch.x1 + from) - x0);
    const VI height = IfThenElseZero(takes, Load(d, batch.y1 + from) - y0);
    const int rows = GetLane(MaxOfLanes(d, height));
    VI row_hits = Or(numbers_from(from), Or(ShiftLeft<Hit::column_bit>(x0), ShiftLeft<Hit::row_bit>(y0)));
    const VF one = Set(df, 1.0f), center = Set(df, static_cast<float>(CellBatch::center));
    const VF first_x = ConvertTo(df, x0) - center;
    VF y = ConvertTo(df, y0) - center;
    for (int r = 0; r < rows; ++r) {
      const VI row_width = IfThenElseZero(height > Set(d, r), width);
      const int columns = GetLane(MaxOfLanes(d, row_width));
      VF row_edge[4];
      for (int k = 0; k < 4; ++k)
        row_edge[k] = MulAdd(Load(df, parts.outline[k].y + from), y, Load(df, parts.outline[k].start + from));
      VF x = first_x;
      VI hits = row_hits, column = Zero(d);
      std::size_t size = queue.size;
      for (int c = 0; c < columns; ++c) {
        VF edge[4];
        for (int k = 0; k < 4; ++k) edge[k] = MulAdd(Load(df, parts.outline[k].x + from), x, row_edge[k]);
        const VF least = Min(Min(edge[0], edge[1]), Min(edge[2], edge[3]));
        size = push_hits(least, RebindMask(df, row_width > column), hits, queue, size);
        x = x + one;
        column = column + Set(d, 1);
        hits = hits + Set(d, 1 << Hit::column_bit);
      }
      queue.size = size;
      if (size >= HitQueue::worth_draining) drain();
      y = y + one;
      row_hits = row_hits + Set(d, 1 << Hit::row_bit);
    }
  }

 private:
  HWY_INLINE static MI mask_of(unsigned cells, int from) {
    cells >>= from;
    const std::uint8_t bits[8] = {static_cast<std::uint8_t>(cells), static_cast<std::uint8_t>(cells >> 8)};
    return LoadMaskBits(DI(), bits);
  }
};

/// Covers each of a batch's cells with blocks of pixels.
class CellBlocks {
 public:
  /// Places blocks over all cells at once. `rect` contains the pixels, relative to the square's corner. Blocks that
  /// would extend beyond `rect` are moved inwards; this is correct because the edge functions exclude pixels outside
  /// the cell. In rectangles narrower than a block this is not enough; those blocks are `clipped`.
  HWY_INLINE void lay(const CellBatch& batch, const CellParts& parts, const scene::PixelRect& rect) {
    right_ = rect.x1, bottom_ = rect.y1;
    const DI d;
    const DF df;
    const auto number = [](int n) HWY_ATTR { return Set(DI(), n); };
    const VI right = number(right_), bottom = number(bottom_);
    const VI first_x = number(rect.x0), first_y = number(rect.y0);
    const VI center = number(CellBatch::center), one = number(1);
    for (int t = 0; t < CellBatch::most; t += lanes) {
      const VI x0 = Load(d, batch.x0 + t), y0 = Load(d, batch.y0 + t);
      const VI box_width = Load(d, batch.x1 + t) - x0, box_height = Load(d, batch.y1 + t) - y0;
      VI shape = Zero(d), columns = shape, rows = shape, blocks = number(0x7fffffff);
      VI block_width = shape, block_height = shape;
      for (int i = 0; i < 3; ++i) {
        const BlockShape& of = block_shapes[i];
        const auto blocks_over = [&](VI box, int side) HWY_ATTR {
          return ShiftRightSame(box + number(side - 1), __builtin_ctz(static_cast<unsigned>(side)));
        };
        const VI across = blocks_over(box_width, of.width), down = blocks_over(box_height, of.height);
        const VI count = across * down;
        const auto fewer = count < blocks;
        blocks = IfThenElse(fewer, count, blocks), shape = IfThenElse(fewer, number(i), shape);
        columns = IfThenElse(fewer, across, columns), rows = IfThenElse(fewer, down, rows);
        block_width = IfThenElse(fewer, number(of.width), block_width);
        block_height = IfThenElse(fewer, number(of.height), block_height);
      }
      const VI across = columns * block_width, down = rows * block_height;
      const VI left = Max(first_x, Min(x0, right - across));
      const VI top = Max(first_y, Min(y0, bottom - down));
      const auto clipped = Or(left + across > right, top + down > bottom);
      const VI last_pixel = (columns - one) * block_width;
      Store(shape, d, shape_ + t);
      Store(left, d, left_ + t), Store(top, d, top_ + t);
      Store(columns, d, columns_ + t), Store(blocks, d, blocks_ + t);
      Store(VecFromMask(d, clipped), d, clipped_ + t);
      Store(Or(numbers_from(t), Or(ShiftLeft<Hit::column_bit>(left), ShiftLeft<Hit::row_bit>(top))), d, first_hit_ + t);
      Store(ShiftLeft<Hit::column_bit>(block_width), d, hit_step_ + t);
      Store(ShiftLeft<Hit::row_bit>(block_height) - ShiftLeft<Hit::column_bit>(last_pixel), d,
            hit_step_ + CellBatch::most + t);
      const VF x = ConvertTo(df, left - center), y = ConvertTo(df, top - center);
      const VF back = ConvertTo(df, last_pixel);
      const VF across_f = ConvertTo(df, block_width), down_f = ConvertTo(df, block_height);
      for (int k = 0; k < 4; ++k) {
        const CellParts::Edge& edge = parts.outline[k];
        const VF along_x = Load(df, edge.x + t), along_y = Load(df, edge.y + t);
        Store(MulAdd(along_x, x, MulAdd(along_y, y, Load(df, edge.start + t))), df, edge_[k] + t);
        Store(along_x * across_f, df, edge_step_[k] + t);
        Store(NegMulAdd(along_x, back, along_y * down_f), df, edge_step_[k] + CellBatch::most + t);
      }
    }
  }

  /// Processes all blocks, row by row, in one loop, because the number of blocks in a row is hard for the processor to
  /// predict.
  HWY_INLINE void cover(const CellParts& parts, int t, HitQueue& queue) const {
    const DI d;
    const DF df;
    const BlockShape& shape = block_shapes[shape_[t]];
    const VI column = Load(d, shape.column), row = Load(d, shape.row);
    const VF x = ConvertTo(df, column), y = ConvertTo(df, row);
    VF edge[4];
    for (int k = 0; k < 4; ++k)
      edge[k] =
          MulAdd(Set(df, parts.outline[k].x[t]), x, MulAdd(Set(df, parts.outline[k].y[t]), y, Set(df, edge_[k][t])));
    VI hits = Set(d, first_hit_[t]) + Or(ShiftLeft<Hit::column_bit>(column), ShiftLeft<Hit::row_bit>(row));
    const bool clipped = clipped_[t] != 0;
    const int columns = columns_[t];
    int left = columns;
    std::size_t size = queue.size;
    for (int block = 0, count = blocks_[t]; block < count; ++block) {
      const VF least = Min(Min(edge[0], edge[1]), Min(edge[2], edge[3]));
      MF among = Eq(x, x);
      if (HWY_UNLIKELY(clipped)) among = in_rectangle(shape, t, block);
      size = push_hits(least, among, hits, queue, size);
      // All bits of `wraps` are set after the last block of a row. (The result of a comparison would be in a part of a
      // register, and combining it with the rest would wait for the count of hits.)
      const int wraps = (--left - 1) >> 31;
      left += columns & wraps;
      const int step = (wraps & CellBatch::most) + t;
      for (int k = 0; k < 4; ++k) edge[k] = edge[k] + Set(df, edge_step_[k][step]);
      hits = hits + Set(d, hit_step_[step]);
    }
    queue.size = size;
  }

 private:
  /// Returns the lanes of a block that are in the rectangle.
  HWY_NOINLINE MF in_rectangle(const BlockShape& shape, int t, int block) const {
    const DI d;
    const VI x = Load(d, shape.column) + Set(d, left_[t] + block % columns_[t] * shape.width);
    const VI y = Load(d, shape.row) + Set(d, top_[t] + block / columns_[t] * shape.height);
    return RebindMask(DF(), And(x < Set(d, right_), y < Set(d, bottom_)));
  }

  int right_, bottom_;
  // One value per cell: the first block's corner, the number of blocks in a row and in all, and the increments from
  // each block to the next; the second half is for the last block of a row.
  alignas(64) std::int32_t left_[CellBatch::most], top_[CellBatch::most], columns_[CellBatch::most];
  alignas(64) std::int32_t blocks_[CellBatch::most], shape_[CellBatch::most], clipped_[CellBatch::most];
  alignas(64) std::int32_t first_hit_[CellBatch::most], hit_step_[2 * CellBatch::most];
  alignas(64) float edge_[4][CellBatch::most], edge_step_[4][2 * CellBatch::most];
};

/// Working memory for rasterizing a batch.
struct CoverScratch {
  HitQueue hits;
  CellBlocks blocks;
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
