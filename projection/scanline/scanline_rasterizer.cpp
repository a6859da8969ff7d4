// SPDX-License-Identifier: BSD-3-Clause
#include "projection/scanline/scanline_rasterizer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/scanline/scanline_rasterizer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tessera::projection {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Four lanes as in the paper, also on processors with longer vectors; fewer only on processors without four lanes.
using DF4 = hn::CappedTag<float, 4>;
using DI4 = hn::CappedTag<std::int32_t, 4>;
using VF4 = hn::Vec<DF4>;
using MF4 = hn::Mask<DF4>;
constexpr std::size_t most_lanes = MaxLanes(DF4());

HWY_INLINE int lane_count() { return static_cast<int>(hn::Lanes(DF4())); }

constexpr std::int32_t taken = 0;  ///< owner of a fragment that has been paired, or that was never written

/// A projected vertex: pixel position, eye depth, scalar, and the first row of the cell's box whose centre is not above
/// the vertex.
struct Vertex {
  float x, y, z, s;
  int row;  ///< counted from the top of the rectangle
};

/// Plain pointers to the arrays of ScanlineBuffers and RaySegments, for one rectangle of pixels. A SIMD store may alias
/// any memory, so with std::vector every store would make the next one reload its pointer.
struct EdgeArrays {
  float *x, *z, *s;
};
struct Arrays {
  int x0, y0, width;  ///< position and width of the rectangle
  EdgeArrays left, right;
  std::int32_t *first, *last;
  float* inverse_width;
  float *b_z, *b_s;
  std::int32_t* b_owner;
  std::uint64_t* pixel_and_tet;
  double *front, *back, *scalar_front, *scalar_back;
  std::size_t size;  ///< number of segments so far
  std::uint64_t unpaired;
};

/// The properties of a cell that its fragments use.
struct Cell {
  scene::PixelRect box;  ///< the pixels inside the rectangle that the cell may cover
  float nearest;         ///< depth of its nearest vertex
  float near_clip, far_clip;
  bool clipped;  ///< whether the cell extends beyond near_clip or far_clip
  float longest_edge;
  std::uint32_t tet;
  std::int32_t owner;  ///< the cell's number in ScanlineBuffers::owner
};

/// Returns the first row (or pixel) of [low, high] whose centre is not before `position`.
HWY_INLINE int first_centre(float position, int low, int high) {
  return static_cast<int>(std::clamp(std::ceil(position - 0.5f), static_cast<float>(low), static_cast<float>(high)));
}

/// Computes the intersections of the edge start -> end (start.y <= end.y) with the scanlines of the cell's box, four at
/// a time; row 0 is the image's row y0. The arrays have four elements more than the rectangle has rows, because the
/// last step may write past the edge's end, where the next edge overwrites the values or they are not read.
HWY_INLINE void walk_edge(const Vertex& start, const Vertex& end, int y0, const EdgeArrays& side) {
  if (start.row >= end.row) return;
  const DF4 f;
  const float per_row = 1 / (end.y - start.y);
  const VF4 inverse_dy = Set(f, per_row), inverse_slope = Set(f, (end.x - start.x) * per_row);
  const VF4 x_start = Set(f, start.x), z_start = Set(f, start.z), s_start = Set(f, start.s);
  const VF4 dz = Set(f, end.z - start.z), ds = Set(f, end.s - start.s);
  const VF4 y_start = Set(f, start.y), stride = Set(f, static_cast<float>(lane_count()));
  VF4 y = Iota(f, static_cast<float>(y0 + start.row) + 0.5f);  // exact: below 2^20
  for (int row = start.row; row < end.row; row += lane_count(), y = y + stride) {
    const VF4 step = y - y_start;  // for the first row, the sub-pixel pre-step
    const VF4 factor = step * inverse_dy;
    StoreU(MulAdd(step, inverse_slope, x_start), f, side.x + row);
    StoreU(MulAdd(factor, dz, z_start), f, side.z + row);
    StoreU(MulAdd(factor, ds, s_start), f, side.s + row);
  }
}

/// Computes the integer ends and inverse widths of the face's rows, four rows at a time, before the rows are filled.
HWY_INLINE void set_up_rows(int row0, int row1, const scene::PixelRect& box, const Arrays& to) {
  const DF4 f;
  const DI4 i;
  const VF4 half = Set(f, 0.5f), one = Set(f, 1.0f);
  const VF4 x0 = Set(f, static_cast<float>(box.x0)), x1 = Set(f, static_cast<float>(box.x1));
  const auto first_pixel = [&](VF4 x) { return ConvertTo(i, Min(Max(Ceil(x - half), x0), x1)); };
  for (int row = row0; row < row1; row += lane_count()) {
    const VF4 left = LoadU(f, to.left.x + row), right = LoadU(f, to.right.x + row);
    StoreU(first_pixel(left), i, to.first + row);
    StoreU(first_pixel(right), i, to.last + row);
    StoreU(one / (right - left), f, to.inverse_width + row);
  }
}

/// Up to four segments, on their way from lanes to RaySegments.
struct Lanes {
  alignas(16) float z_back[4], length[4], s_front[4], s_back[4];
};

/// Appends the first `count` lanes. Writes all lanes: the arrays have padding.
HWY_INLINE void store_segments(const Lanes& lanes, std::uint64_t pixel_and_tet, std::size_t count, double longest_edge,
                               Arrays& to) {
  const std::size_t at = to.size;
  for (std::size_t k = 0; k < most_lanes; ++k) to.pixel_and_tet[at + k] = pixel_and_tet + k;
  for (std::size_t k = 0; k < most_lanes; ++k) to.back[at + k] = lanes.z_back[k];
  // As in depths_of(): the product is exact (24 bits times 24), so a fused instruction makes no difference.
  for (std::size_t k = 0; k < most_lanes; ++k) to.front[at + k] = lanes.z_back[k] - lanes.length[k] * longest_edge;
  for (std::size_t k = 0; k < most_lanes; ++k) to.scalar_front[at + k] = lanes.s_front[k];
  for (std::size_t k = 0; k < most_lanes; ++k) to.scalar_back[at + k] = lanes.s_back[k];
  to.size += count;
}

/// Where the lanes' rays leave and enter a cell.
struct Crossings {
  VF4 z_back, z_front, s_front, s_back;
};

/// Stores lanes one by one; used when some rays do not both enter and leave the cell, or the clipping range cuts them.
HWY_NOINLINE void store_some(const Crossings& crossings, MF4 paired, std::uint64_t pixel_and_tet, const Cell& cell,
                             Arrays& to) {
  const DF4 f;
  alignas(16) float zb[4], zf[4], sf[4], sb[4], mine[4];
  Store(crossings.z_back, f, zb);
  Store(crossings.z_front, f, zf);
  Store(crossings.s_front, f, sf);
  Store(crossings.s_back, f, sb);
  Store(IfThenElseZero(paired, Set(f, 1.0f)), f, mine);
  for (std::size_t k = 0; k < hn::Lanes(f); ++k) {
    if (mine[k] == 0) continue;
    if (cell.clipped) {
      if (!(zb[k] > cell.near_clip && zf[k] < cell.far_clip)) continue;
      const float slope = (sb[k] - sf[k]) / (zb[k] - zf[k]), front = zf[k], scalar = sf[k];
      if (front < cell.near_clip) zf[k] = cell.near_clip, sf[k] = scalar + (zf[k] - front) * slope;
      if (zb[k] > cell.far_clip) zb[k] = cell.far_clip, sb[k] = scalar + (zb[k] - front) * slope;
    }
    const float length = std::max(0.0f, zb[k] - zf[k]) * (1 / cell.longest_edge);
    store_segments({{zb[k]}, {length}, {sf[k]}, {sb[k]}}, pixel_and_tet + k, 1, cell.longest_edge, to);
  }
}

enum class Side { back, front };

/// Fills the face's rows, four pixels at a time.
template <Side side>
HWY_INLINE void fill_rows(int row0, int row1, const Cell& cell, Arrays& to) {
  const DF4 f;
  const DI4 i;
  const int step = lane_count();
  const auto owner = Set(i, cell.owner);
  const VF4 stride = Set(f, static_cast<float>(step)), nearest = Set(f, cell.nearest),
            inverse_edge = Set(f, 1 / cell.longest_edge);
  for (int row = row0; row < row1; ++row) {
    const int first = to.first[row];
    int left = to.last[row] - first;
    if (left <= 0) continue;
    const VF4 x_left = Set(f, to.left.x[row]), inverse_width = Set(f, to.inverse_width[row]);
    const VF4 z_left = Set(f, to.left.z[row]), s_left = Set(f, to.left.s[row]);
    const VF4 dz = Set(f, to.right.z[row] - to.left.z[row]), ds = Set(f, to.right.s[row] - to.left.s[row]);
    int at = row * to.width + first - to.x0;
    VF4 x = Iota(f, static_cast<float>(first) + 0.5f);
    for (; left > 0; left -= step, at += step, x = x + stride) {
      const VF4 factor = (x - x_left) * inverse_width;
      const VF4 z = MulAdd(factor, dz, z_left), s = MulAdd(factor, ds, s_left);
      const auto lanes = FirstN(i, static_cast<std::size_t>(left));
      if constexpr (side == Side::back) {
        BlendedStore(Max(z, nearest), RebindMask(f, lanes), f, to.b_z + at);
        BlendedStore(s, RebindMask(f, lanes), f, to.b_s + at);
        BlendedStore(owner, lanes, i, to.b_owner + at);
      } else {
        const VF4 z_back = LoadU(f, to.b_z + at), s_back = LoadU(f, to.b_s + at);
        const auto paired = And(lanes, LoadU(i, to.b_owner + at) == owner);
        BlendedStore(Set(i, taken), paired, i, to.b_owner + at);
        const auto wanted = static_cast<std::size_t>(std::min(left, step)), found = CountTrue(i, paired);
        const std::uint64_t pixel_and_tet = static_cast<std::uint64_t>(cell.tet) << 32 | static_cast<unsigned>(at);
        if (HWY_LIKELY(found == wanted && !cell.clipped)) {
          Lanes segments;
          Store(z_back, f, segments.z_back);
          Store(Max(z_back - z, Zero(f)) * inverse_edge, f, segments.length);
          Store(s, f, segments.s_front);
          Store(s_back, f, segments.s_back);
          store_segments(segments, pixel_and_tet, wanted, cell.longest_edge, to);
        } else {
          to.unpaired += wanted - found;
          store_some({z_back, z, s, s_back}, RebindMask(f, paired), pixel_and_tet, cell, to);
        }
      }
    }
  }
}

/// A face in the image; `area` is twice its signed area.
struct Triangle {
  const Vertex &a, &b, &c;
  double area;
};

/// Scan-converts one face, whose area must not be zero.
HWY_INLINE void rasterize_face(const Triangle& face, Side side, const Cell& cell, Arrays& to) {
  const Vertex *min = &face.a, *mid = &face.b, *max = &face.c;
  bool turned = false;  // an odd permutation reverses the area's sign
  const auto sort = [&](const Vertex*& p, const Vertex*& q) {
    if (q->y < p->y) std::swap(p, q), turned = !turned;
  };
  sort(min, mid), sort(mid, max), sort(min, mid);
  if (min->row >= max->row) return;
  // y points down, so if the area of (min, mid, max) is positive, the long edge is the left one.
  const bool long_left = (face.area > 0) != turned;
  const EdgeArrays &long_side = long_left ? to.left : to.right, &short_side = long_left ? to.right : to.left;
  walk_edge(*min, *mid, to.y0, short_side);
  walk_edge(*mid, *max, to.y0, short_side);
  walk_edge(*min, *max, to.y0, long_side);
  set_up_rows(min->row, max->row, cell.box, to);
  if (side == Side::back)
    fill_rows<Side::back>(min->row, max->row, cell, to);
  else
    fill_rows<Side::front>(min->row, max->row, cell, to);
}

// Faces by their corners. `outward` as in `planes`: whether (a, b, c) has the orientation of (0, 1, 2), seen from
// outside.
struct Face {
  int a, b, c;
  bool outward;
};
constexpr Face faces[4] = {{0, 1, 2, true}, {0, 1, 3, false}, {0, 2, 3, true}, {1, 2, 3, false}};

void rasterize_cell(const std::array<PixelVertex, 4>& corners, const Vertex (&v)[4], const Cell& cell, Arrays& to) {
  // Six times the signed volume, which determines the orientation of the cell's faces. It is computed in double
  // precision, because in float the volume of a thin cell would be noise.
  const auto across = [&](int i) { return corners[i].x - corners[0].x; };
  const auto down = [&](int i) { return corners[i].y - corners[0].y; };
  const auto deep = [&](int i) { return corners[i].depth - corners[0].depth; };
  const double volume = across(1) * (down(2) * deep(3) - down(3) * deep(2)) -
                        down(1) * (across(2) * deep(3) - across(3) * deep(2)) +
                        deep(1) * (across(2) * down(3) - across(3) * down(2));
  if (volume == 0) return;
  double area[4];
  bool front[4];
  for (int k = 0; k < 4; ++k) {
    const Vertex &a = v[faces[k].a], &b = v[faces[k].b], &c = v[faces[k].c];
    // Areas are computed from the rounded vertices, that is, for the triangle that is drawn.
    area[k] = (static_cast<double>(b.x) - a.x) * (static_cast<double>(c.y) - a.y) -
              (static_cast<double>(b.y) - a.y) * (static_cast<double>(c.x) - a.x);
    // A face is a front face if depth increases from the face to the cell's fourth corner.
    front[k] = ((area[k] > 0) == (volume > 0)) == faces[k].outward;
  }
  for (const Side side : {Side::back, Side::front})
    for (int k = 0; k < 4; ++k)
      if (area[k] != 0 && front[k] == (side == Side::front))
        rasterize_face({v[faces[k].a], v[faces[k].b], v[faces[k].c], area[k]}, side, cell, to);
}

std::size_t rasterize(const ScanlineView& view, std::span<const TileEntry> entries, const scene::PixelRect& rect,
                      ScanlineBuffers& buffers, RaySegments& out, RasterCounts& counts) {
  const ProjectedMesh& projected = view.projected;
  const scene::TetMeshView& mesh = projected.mesh->mesh();
  const bool per_cell = mesh.association == scene::Association::cell;
  const auto room = static_cast<std::size_t>(rect.area());
  const auto side = [](ScanlineBuffers::EdgeArrays& e) { return EdgeArrays{e.x.data(), e.z.data(), e.s.data()}; };
  Arrays to{rect.x0,
            rect.y0,
            rect.width(),
            side(buffers.left),
            side(buffers.right),
            buffers.first.data(),
            buffers.last.data(),
            buffers.inverse_width.data(),
            buffers.z.data(),
            buffers.s.data(),
            buffers.owner.data(),
            out.pixel_and_tet.data(),
            out.front.data(),
            out.back.data(),
            out.scalar_front.data(),
            out.scalar_back.data(),
            out.size,
            0};
  std::size_t done = 0;
  for (; done < entries.size() && to.size + room <= out.capacity(); ++done) {
    const std::uint32_t tet = entries[done].tet;
    const scene::Tet& t = mesh.tets[tet];
    const std::array<PixelVertex, 4> corners{projected.vertices[t[0]], projected.vertices[t[1]],
                                             projected.vertices[t[2]], projected.vertices[t[3]]};
    Cell cell;
    // The box of the exact vertices is used, so that the pixels of a cell do not depend on the tiles for which it was
    // listed.
    cell.box = footprint(corners, rect);
    if (cell.box.empty()) continue;
    Vertex v[4];
    for (int k = 0; k < 4; ++k) {
      v[k] = {static_cast<float>(corners[k].x), static_cast<float>(corners[k].y), static_cast<float>(corners[k].depth),
              static_cast<float>(mesh.scalars[per_cell ? tet : t[k]]), 0};
      v[k].row = first_centre(v[k].y, cell.box.y0, cell.box.y1) - rect.y0;
    }
    const auto [nearest, farthest] = std::minmax({v[0].z, v[1].z, v[2].z, v[3].z});
    cell.nearest = nearest;
    cell.near_clip = static_cast<float>(projected.near_depth);
    cell.far_clip = static_cast<float>(projected.far_depth);
    cell.clipped = nearest < cell.near_clip || farthest > cell.far_clip;
    cell.longest_edge = view.longest_edge;
    cell.tet = tet;
    if (++buffers.cells == std::numeric_limits<std::int32_t>::max()) {
      std::fill(buffers.owner.begin(), buffers.owner.end(), taken);
      buffers.cells = 1;
    }
    cell.owner = buffers.cells;
    rasterize_cell(corners, v, cell, to);
  }
  out.size = to.size;
  counts.unpaired += to.unpaired;
  return done;
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace tessera::projection {
HWY_EXPORT(rasterize);

namespace {
constexpr std::size_t padding = 4;  // a step of four lanes may begin at the last element
}

std::size_t ScanlineBuffers::bytes_for(const scene::PixelRect& rect) {
  return (static_cast<std::size_t>(rect.area()) + padding) * (2 * sizeof(float) + sizeof(std::int32_t)) +
         (static_cast<std::size_t>(rect.height()) + padding) * (7 * sizeof(float) + 2 * sizeof(std::int32_t));
}

std::size_t rasterize_scanline(const ScanlineView& view, std::span<const TileEntry> entries,
                               const scene::PixelRect& rect, ScanlineBuffers& buffers, RaySegments& out,
                               RasterCounts& counts) {
  const std::size_t pixels = static_cast<std::size_t>(rect.area()) + padding,
                    rows = static_cast<std::size_t>(rect.height()) + padding;
  // The buffers only grow. The owner of a new element is 0, which is `taken`; the owners of old elements are stale.
  if (buffers.z.size() < pixels) {
    buffers.z.resize(pixels);
    buffers.s.resize(pixels);
    buffers.owner.resize(pixels);
  }
  if (buffers.first.size() < rows) {
    for (ScanlineBuffers::EdgeArrays* side : {&buffers.left, &buffers.right})
      for (std::vector<float>* array : {&side->x, &side->z, &side->s}) array->resize(rows);
    buffers.first.resize(rows);
    buffers.last.resize(rows);
    buffers.inverse_width.resize(rows);
  }
  return HWY_DYNAMIC_DISPATCH(rasterize)(view, entries, rect, buffers, out, counts);
}

bool fits_scanline(const ProjectedMesh& projected, float longest_edge) {
  const auto most = [](std::size_t count, const auto& size_of) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, count, 4096), 0.0,
        [&](const auto& range, double largest) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) largest = std::max(largest, size_of(i));
          return largest;
        },
        [](double a, double b) { return std::max(a, b); });
  };
  const auto& vertices = projected.vertices;
  const auto& scalars = projected.mesh->mesh().scalars;
  return longest_edge >= 1e-30f &&
         most(vertices.size(), [&](std::size_t v) { return std::abs(vertices[v].depth); }) < 1e37 &&
         most(vertices.size(),
              [&](std::size_t v) { return std::max(std::abs(vertices[v].x), std::abs(vertices[v].y)); }) <= 1e30 &&
         most(scalars.size(), [&](std::size_t i) { return std::abs(scalars[i]); }) < 1e37;
}

}  // namespace tessera::projection
#endif  // HWY_ONCE
