// SPDX-License-Identifier: BSD-3-Clause
#include "projection/cull_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/cull_cells.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "scene/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::projection {
namespace HWY_NAMESPACE {
using namespace scene::HWY_NAMESPACE;  // vectors and operations on their lanes

double smallest(const PixelVertex* vertices, std::size_t count) {
  double least = std::numeric_limits<double>::max();
  std::size_t v = 0;
#if HWY_TARGET != HWY_SCALAR
  const DD d;
  VD least_lanes = Set(d, least);
  for (; v + hn::Lanes(d) <= count; v += hn::Lanes(d)) {
    VD x, y, w, depth;
    LoadInterleaved4(d, &vertices[v].x, x, y, w, depth);
    least_lanes = Min(depth, least_lanes);
  }
  least = GetLane(MinOfLanes(d, least_lanes));
#endif
  for (; v < count; ++v) least = vertices[v].depth < least ? vertices[v].depth : least;
  return least;
}

HWY_INLINE CullVertex cull_vertex(const PixelVertex& v, double scalar, double depth_origin) {
  CullVertex out;
  out.x = static_cast<float>(v.x / v.w);
  out.y = static_cast<float>(v.y / v.w);
  const double size = (v.depth < 0 ? -v.depth : v.depth) + (depth_origin < 0 ? -depth_origin : depth_origin);
  const double depth = (v.depth - depth_origin) - 4e-16 * size;
  // Subtracts in advance what rounding to float may add.
  const double lower = depth - (depth < 0 ? -depth : depth) * 0x1p-23 - 0x1p-149;
  out.depth = static_cast<float>(lower < 3e38 ? lower : 3e38);
  out.scalar = static_cast<float>(scalar);
  return out;
}

#if HWY_TARGET == HWY_SCALAR

void make_vertices(const PixelVertex* vertices, const double* scalars, std::size_t count, double depth_origin,
                   CullVertex* out) {
  for (std::size_t v = 0; v < count; ++v)
    out[v] = cull_vertex(vertices[v], scalars != nullptr ? scalars[v] : 0, depth_origin);
}

CulledBlock cull(const CullView&, const CellBlock& cells, std::uint32_t*, float*) {
  CulledBlock block;
  block.unsure = ~std::uint64_t{0} >> (cull_block_cells - cells.tets.size());
  return block;
}

#else

void make_vertices(const PixelVertex* vertices, const double* scalars, std::size_t count, double depth_origin,
                   CullVertex* out) {
  const DD dd;
  const hn::Rebind<float, DD> df;
  const std::size_t lanes = hn::Lanes(dd);
  const auto origin = Set(dd, depth_origin), origin_size = Abs(origin);
  std::size_t v = 0;
  for (; v + lanes <= count; v += lanes) {
    VD x, y, w, depth;
    LoadInterleaved4(dd, &vertices[v].x, x, y, w, depth);
    const auto offset = depth - origin - (Abs(depth) + origin_size) * Set(dd, 4e-16);
    const auto lower = offset - Abs(offset) * Set(dd, 0x1p-23) - Set(dd, 0x1p-149);
    const auto scalar = scalars != nullptr ? LoadU(dd, scalars + v) : Zero(dd);
    StoreInterleaved4(DemoteTo(df, x / w), DemoteTo(df, y / w), DemoteTo(df, Min(lower, Set(dd, 3e38))),
                      DemoteTo(df, scalar), df, &out[v].x);
  }
  for (; v < count; ++v) out[v] = cull_vertex(vertices[v], scalars != nullptr ? scalars[v] : 0, depth_origin);
}

HWY_INLINE std::uint64_t bits_of(MF mask) { return lane_bits(mask); }

/// Range [low, high) of pixels whose centres are in [least, most], and whether floats determine it with certainty.
struct Covered {
  VF low, high;
  MF empty, sure;  ///< `empty` is set only with certainty
};

/// Exceeds the rounding errors of a float pixel position and of the sums formed with it here, and is at least ten times
/// footprint()'s slack.
HWY_INLINE VF slack_of(VF pixel) { return MulAdd(Abs(pixel), Set(DF(), 0x1p-22f), Set(DF(), 1e-6f)); }

HWY_INLINE Covered covered(VF least, VF most, VF side) {
  const DF d;
  const VF half = Set(d, 0.5f), zero = Zero(d);
  const auto in_window = [&](VF v) HWY_ATTR { return Min(Max(v, zero), side); };
  const VF from = least - half, from_slack = slack_of(least);
  const VF to = most + half, to_slack = slack_of(most);  // floor(most - 1/2) + 1
  const VF first = in_window(Ceil(from - from_slack)), last = in_window(Floor(to + to_slack));
  const MF first_sure = first == in_window(Ceil(from + from_slack));
  const MF last_sure = last == in_window(Floor(to - to_slack));
  return {first, last, first >= last, And(first_sure, last_sure)};
}

/// Returns the boxes of `count` cells, computed one cell at a time: smallest and largest x, y, depth and scalar.
HWY_INLINE void boxes_of(const CullVertex* vertices, const scene::Tet* tets, std::size_t count, float* low,
                         float* high) {
  const hn::FixedTag<float, 4> d;
  for (std::size_t t = 0; t < count; ++t) {
    const auto a = Load(d, &vertices[tets[t][0]].x), b = Load(d, &vertices[tets[t][1]].x);
    const auto c = Load(d, &vertices[tets[t][2]].x), e = Load(d, &vertices[tets[t][3]].x);
    Store(Min(Min(a, b), Min(c, e)), d, low + 4 * t);
    Store(Max(Max(a, b), Max(c, e)), d, high + 4 * t);
  }
}

/// The boxes of a vector of cells.
struct Boxes {
  VF x_low, y_low, depth_low, scalar_low, x_high, y_high, depth_high, scalar_high;

  HWY_INLINE Boxes(const float* low, const float* high) {
    const DF d;
    LoadInterleaved4(d, low, x_low, y_low, depth_low, scalar_low);
    LoadInterleaved4(d, high, x_high, y_high, depth_high, scalar_high);
  }
};

/// Whether the transfer function certainly makes cells invisible, and whether it possibly does.
struct Hidden {
  MF surely, maybe;

  HWY_INLINE Hidden(const Boxes& boxes, std::span<const ClearFloats> clear) {
    const DF d;
    surely = maybe = Zero(d) < Zero(d);
    for (const ClearFloats& c : clear) {
      surely = Or(surely, And(boxes.scalar_low >= Set(d, c.sure_low), boxes.scalar_high <= Set(d, c.sure_high)));
      maybe = Or(maybe, And(boxes.scalar_low >= Set(d, c.maybe_low), boxes.scalar_high <= Set(d, c.maybe_high)));
    }
  }
};

/// The position of cells relative to the clipping range and the window.
struct Placed {
  Covered columns, rows;
  MF too_near, too_far, in_depth, empty, covers, tame, inside, outside;

  HWY_INLINE Placed(const CullView& view, const Boxes& b) {
    const DF d;
    // The largest depth that a vertex with this CullVertex::depth may have.
    const auto at_most = [&](VF v) HWY_ATTR { return MulAdd(Abs(v), Set(d, 4e-7f), v) + Set(d, view.depth_slack); };
    too_near = at_most(b.depth_high) < Set(d, view.near_low);
    too_far = b.depth_low > Set(d, view.far_high);
    in_depth = And(b.depth_low > Set(d, view.near_high), at_most(b.depth_low) < Set(d, view.far_low));

    const VF width = Set(d, view.width), height = Set(d, view.height);
    columns = covered(b.x_low, b.x_high, width), rows = covered(b.y_low, b.y_high, height);
    // The sum is NaN if one of its terms is NaN.
    const VF widest = Abs(b.x_low) + Abs(b.x_high) + (Abs(b.y_low) + Abs(b.y_high));
    tame = widest < Set(d, 1e30f);
    empty = Or(columns.empty, rows.empty);
    covers = AndNot(empty, And(columns.sure, rows.sure));
    const auto within = [&](VF least, VF most, VF side)
                            HWY_ATTR { return And(least > slack_of(least), most + slack_of(most) < side); };
    const auto beyond = [&](VF least, VF most, VF side)
                            HWY_ATTR { return Or(most + slack_of(most) < Zero(d), least - slack_of(least) > side); };
    inside = And(within(b.x_low, b.x_high, width), within(b.y_low, b.y_high, height));
    outside = Or(beyond(b.x_low, b.x_high, width), beyond(b.y_low, b.y_high, height));
  }
};

/// Writes the places of cells with these boxes of pixels. Returns the cells whose box is in one tile.
HWY_INLINE std::uint64_t store_places(const CullView& view, const Placed& placed, std::uint32_t* places) {
  const DF d;
  const DI di;
  // Integers up to 65536 plus a half, divided by the tile size: the error of floats is less than half a pixel.
  const VF inverse = Set(d, view.inverse_tile_size), half = Set(d, 0.5f);
  const auto tile = [&](VF pixel) HWY_ATTR { return Floor(pixel * inverse); };
  const VF column0 = tile(placed.columns.low + half), column1 = tile(placed.columns.high - half);
  const VF row0 = tile(placed.rows.low + half), row1 = tile(placed.rows.high - half);
  const auto first = ConvertTo(di, MulAdd(row0, Set(d, view.columns), column0));
  const auto more_columns = ConvertTo(di, column1 - column0);
  const auto more_rows = ConvertTo(di, row1 - row0);
  const auto place = Or(first, Or(ShiftLeft<24>(more_columns), ShiftLeft<28>(more_rows)));
  const auto wide = Max(more_columns, more_rows) > Set(di, largest_place_span);
  StoreU(IfThenElse(wide, Set(di, static_cast<std::int32_t>(wide_place)), place), di,
         reinterpret_cast<std::int32_t*>(places));
  return bits_of(RebindMask(d, Or(more_columns, more_rows) == Zero(di)));
}

CulledBlock cull(const CullView& view, const CellBlock& block, std::uint32_t* places, float* near_depths) {
  CulledBlock culled;
  const std::size_t count = block.tets.size();
  const std::uint64_t cells = ~std::uint64_t{0} >> (cull_block_cells - count);
  if (view.nothing_sure) {
    culled.unsure = cells;
    return culled;
  }
  alignas(64) float low[4 * cull_block_cells], high[4 * cull_block_cells], scalars[cull_block_cells];
  boxes_of(block.vertices, block.tets.data(), count, low, high);
  if (block.cell_scalars != nullptr)
    for (std::size_t t = 0; t < count; ++t) scalars[t] = static_cast<float>(block.cell_scalars[t]);

  const DF d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t t = count; t < (count + lanes - 1) / lanes * lanes; ++t) {  // padding
    for (std::size_t i = 0; i < 4; ++i) low[4 * t + i] = high[4 * t + i] = 0;
    scalars[t] = 0;
  }
  for (std::size_t t = 0; t < count; t += lanes) {
    Boxes boxes(low + 4 * t, high + 4 * t);
    if (block.cell_scalars != nullptr) boxes.scalar_low = boxes.scalar_high = Load(d, scalars + t);
    const Hidden hidden(boxes, block.clear);
    const Placed placed(view, boxes);

    const std::uint64_t here = cells >> t & (~std::uint64_t{0} >> (64 - lanes)), visible = ~bits_of(hidden.maybe);
    const std::uint64_t drawn = visible & bits_of(And(placed.in_depth, placed.tame));
    const std::uint64_t empty = drawn & bits_of(placed.empty), projected = drawn & bits_of(placed.covers) & here;
    const std::uint64_t outside =
        ((visible & bits_of(Or(placed.too_near, placed.too_far))) | (empty & bits_of(placed.outside))) & here;
    culled.projected |= projected << t;
    culled.invisible |= (bits_of(hidden.surely) & here) << t;
    culled.outside_view |= outside << t;
    culled.between_pixels |= (empty & bits_of(placed.inside) & ~outside & here) << t;
    culled.in_one_tile |= (projected & store_places(view, placed, places + t)) << t;
    StoreU(Max(boxes.depth_low, Set(d, view.near_low)), d, near_depths + t);
  }
  culled.unsure = cells & ~(culled.projected | culled.invisible | culled.outside_view | culled.between_pixels);
  return culled;
}

#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::projection {
namespace {

float not_above(double v) {
  const auto f = static_cast<float>(v);
  return static_cast<double>(f) <= v ? f : std::nextafter(f, -std::numeric_limits<float>::infinity());
}
float not_below(double v) { return -not_above(-v); }

}  // namespace

HWY_EXPORT(smallest);
HWY_EXPORT(make_vertices);
HWY_EXPORT(cull);

double smallest_depth(std::span<const PixelVertex> vertices) {
  return HWY_DYNAMIC_DISPATCH(smallest)(vertices.data(), vertices.size());
}

void make_cull_vertices(std::span<const PixelVertex> vertices, std::span<const double> scalars, double depth_origin,
                        CullVertex* out) {
  HWY_DYNAMIC_DISPATCH(make_vertices)
  (vertices.data(), scalars.empty() ? nullptr : scalars.data(), vertices.size(), depth_origin, out);
}

ClearFloats clear_floats(const ClearIntervals::Interval& interval, bool exact) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  if (exact) {
    const float low = not_below(interval.low), high = not_above(interval.high);
    return {low, high, low, high};
  }
  // Rounding is monotonic: s >= low implies float(s) >= float(low), and float(s) > float(low) implies s > low.
  const auto low = static_cast<float>(interval.low), high = static_cast<float>(interval.high);
  return {std::isinf(interval.low) ? low : std::nextafter(low, infinity),
          std::isinf(interval.high) ? high : std::nextafter(high, -infinity), low, high};
}

namespace {
int tiles(int pixels, int tile_size) { return (pixels + tile_size - 1) / tile_size; }
}  // namespace

CullView::CullView(double near_depth, double far_depth, double depth_origin, scene::ImageSize image, int tile_size)
    : width(static_cast<float>(image.width)),
      height(static_cast<float>(image.height)),
      inverse_tile_size(1.0f / static_cast<float>(tile_size)),
      columns(static_cast<float>(tiles(image.width, tile_size))) {
  constexpr double most = 1e37;
  const double to_near = near_depth - depth_origin, to_far = far_depth - depth_origin;
  const double rows = tiles(image.height, tile_size);
  nothing_sure = !(std::abs(depth_origin) < most && std::abs(near_depth) < most &&
                   (std::abs(far_depth) < most || std::isinf(far_depth))) ||
                 static_cast<double>(columns) * rows > static_cast<double>(most_places);
  const double near_slack = 1e-15 * (std::abs(near_depth) + std::abs(depth_origin));
  near_low = not_above(to_near - near_slack);
  near_high = not_below(to_near + near_slack);
  const double far_slack = std::isinf(far_depth) ? 0 : 1e-15 * (std::abs(far_depth) + std::abs(depth_origin));
  far_low = not_above(to_far - far_slack);
  far_high = not_below(to_far + far_slack);
  depth_slack = not_below(2e-15 * std::abs(depth_origin) + 0x1p-146);
}

CulledBlock cull_cells(const CullView& view, const CellBlock& block, std::uint32_t* places, float* near_depths) {
  return HWY_DYNAMIC_DISPATCH(cull)(view, block, places, near_depths);
}

}  // namespace tessera::projection
#endif  // HWY_ONCE
