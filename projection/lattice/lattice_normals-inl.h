// SPDX-License-Identifier: BSD-3-Clause
// Finds the cells of a batch that have iso-surfaces, and their normals, one cell per lane. Included once per
// instruction set (Highway's include guard idiom).
//
// How       The field of a cell is s(p) = s_0 + g . (p - p_0). With the edges e_i = p_i - p_0 from corner 0, and the
//           changes c_i of the scalar along them, e_i . g = c_i; Cramer's rule gives the direction of the gradient,
//             g ~ c_1 (e_2 x e_3) + c_2 (e_3 x e_1) + c_3 (e_1 x e_2),
//           which is all that shading needs: a normal has unit length, and both of its sides are lit.
// Accuracy  Double precision; edges and changes are first scaled to 1, so that no product leaves the range of a double.
// Ends      A cell that is flat, without extent or with a single scalar has no normal (zero).

#if defined(TESSERA_PROJECTION_LATTICE_NORMALS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_LATTICE_NORMALS_INL_H_
#undef TESSERA_PROJECTION_LATTICE_NORMALS_INL_H_
#else
#define TESSERA_PROJECTION_LATTICE_NORMALS_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "projection/lattice/lattice_parts-inl.h"
#include "projection/lattice/lattice_surfaces.hpp"
#include "projection/surface_crossings.hpp"
#include "scene/lanes/doubles-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {

/// Perspective: the direction of the ray at a square's first pixel, and its change from pixel to pixel.
struct SquareRays {
  glm::dvec3 corner{}, right{}, down{};
  SquareRays(const PixelSpace& space, int x0, int y0) {
    if (!space.perspective()) return;
    corner = space.direction(x0 + 0.5, y0 + 0.5);
    right = space.direction(x0 + 1.5, y0 + 0.5) - corner;
    down = space.direction(x0 + 0.5, y0 + 1.5) - corner;
  }
};

/// The directions of the rays of hits.
struct RayLanes {
  Doubles x, y, z;

  HWY_INLINE RayLanes(const SquareRays& rays, VI hit) {
    const VI side = Set(DI(), SegmentWindows::side - 1);
    const Doubles column = promote(And(ShiftRight<Hit::column_bit>(hit), side));
    const Doubles row = promote(And(ShiftRight<Hit::row_bit>(hit), side));
    const auto along = [&](int axis) HWY_ATTR {
      return doubles(rays.corner[axis]) + doubles(rays.right[axis]) * column + doubles(rays.down[axis]) * row;
    };
    x = along(0), y = along(1), z = along(2);
  }
};

/// Vectors of three coordinates, one for each of as many cells as there are lanes.
struct Vectors {
  VD x, y, z;
};
HWY_INLINE Vectors operator+(const Vectors& a, const Vectors& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE Vectors operator-(const Vectors& a, const Vectors& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE Vectors operator*(const Vectors& a, VD b) { return {a.x * b, a.y * b, a.z * b}; }
HWY_INLINE VD dot(const Vectors& a, const Vectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
HWY_INLINE Vectors cross(const Vectors& a, const Vectors& b) {
  return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
HWY_INLINE VD largest(const Vectors& v) { return Max(Max(Abs(v.x), Abs(v.y)), Abs(v.z)); }

/// Returns the same as unit(gradient_direction()) of surface_crossings.hpp, except for rounding; one cell per lane.
HWY_INLINE Vectors unit_gradient(const Vectors (&corner)[4], const VD (&scalar)[4]) {
  const VD zero = Zero(DD());
  Vectors edge[3];
  VD change[3], size = zero, most = zero;
  for (std::size_t i = 0; i < 3; ++i) {
    edge[i] = corner[i + 1] - corner[0];
    change[i] = scalar[i + 1] - scalar[0];
    size = Max(size, largest(edge[i])), most = Max(most, Abs(change[i]));
  }
  // The edges are scaled to size 1, so that their squares and products are in the range of a double for any mesh.
  const VD one = Set(DD(), 1), per_size = one / size, per_change = one / most;
  const Vectors e1 = edge[0] * per_size, e2 = edge[1] * per_size, e3 = edge[2] * per_size;
  const VD c1 = change[0] * per_change, c2 = change[1] * per_change, c3 = change[2] * per_change;
  const Vectors direction = cross(e2, e3) * c1 + cross(e3, e1) * c2 + cross(e1, e2) * c3;
  const VD square = dot(direction, direction);
  const Vectors unit = direction * (one / Sqrt(square));
  // For a cell that is flat, without extent or with a single scalar, the divisions have produced NaN.
  const VD least = Set(DD(), 1e-300);
  const auto is = And(square > zero, And(size > least, most > least));
  return {IfThenElseZero(is, unit.x), IfThenElseZero(is, unit.y), IfThenElseZero(is, unit.z)};
}

/// Calls take(numbers, count, normal, scalar) for groups of the given cells of a batch (one bit each). A group has
/// `count` lanes, with the cells' numbers in the batch, their normals and their corners' scalars.
template <class Take>
HWY_INLINE void with_normals(const LatticeView& view, const CellBatch& batch, unsigned cells, const Take& take) {
  const DD d;
  const hn::RebindToSigned<DD> di;
  constexpr std::size_t most = MaxLanes(DD());
  const PreparedMesh& prepared = *view.projected.mesh;
  const scene::TetMeshView& mesh = prepared.mesh();
  const double* const positions = &mesh.positions.front().x;
  static_assert(sizeof(glm::dvec3) == 3 * sizeof(double));
  while (cells != 0) {
    // Lanes beyond the last read vertex 0.
    alignas(64) std::int64_t vertices[4][most] = {};
    std::size_t of_lane[most], count = 0;
    for (; cells != 0 && count < most; cells &= cells - 1, ++count) {
      of_lane[count] = static_cast<std::size_t>(__builtin_ctz(cells));
      const scene::Tet& corners = prepared.tets()[batch.tet[of_lane[count]]];
      for (std::size_t i = 0; i < 4; ++i) vertices[i][count] = corners[i];
    }
    Vectors corner[4];
    VD scalar[4];
    for (std::size_t i = 0; i < 4; ++i) {
      const auto vertex = Load(di, vertices[i]);
      const auto first = vertex + vertex + vertex;
      corner[i] = {GatherIndex(d, positions, first), GatherIndex(d, positions + 1, first),
                   GatherIndex(d, positions + 2, first)};
      scalar[i] = GatherIndex(d, mesh.scalars.data(), vertex);
    }
    take(of_lane, count, unit_gradient(corner, scalar), scalar);
  }
}

/// Computes the normals and cosines of the given cells of a batch (one bit each). Should be called some time after
/// find_surfaces(), whose prefetches have then completed.
HWY_NOINLINE inline void find_normals(const LatticeView& view, const CellBatch& batch, unsigned cells,
                                      LatticeSurfaces& surfaces) {
  const DD d;
  const glm::dvec3 towards = view.perspective ? glm::dvec3(0) : view.projected.iso->space->direction(0, 0);
  const Vectors ray{Set(d, towards.x), Set(d, towards.y), Set(d, towards.z)};
  with_normals(view, batch, cells,
               [&](const std::size_t* of_lane, std::size_t count, const Vectors& normal, const VD(&)[4]) HWY_ATTR {
                 const VD one = Set(d, 1), zero = Zero(d);
                 const VD least = IfThenElse(largest(normal) > zero, zero, one);
                 alignas(64) double found[5][MaxLanes(DD())];
                 Store(normal.x, d, found[0]), Store(normal.y, d, found[1]), Store(normal.z, d, found[2]);
                 Store(least, d, found[3]);
                 Store(Min(Max(Abs(dot(ray, normal)), least), one), d, found[4]);
                 for (std::size_t lane = 0; lane < count; ++lane) {
                   const std::size_t t = of_lane[lane];
                   for (std::size_t axis = 0; axis < 3; ++axis) surfaces.normal[axis][t] = found[axis][lane];
                   surfaces.least_cosine[t] = found[3][lane];
                   const auto cosine = static_cast<float>(found[4][lane]);
                   surfaces.cosine_code[t] = static_cast<std::int32_t>(LatticeMark::cosine_code(cosine));
                 }
               });
}

/// Prefetches the data of cell t that find_normals() reads.
HWY_INLINE void prefetch_corners(const LatticeView& view, const CellBatch& batch, int t) {
  const scene::TetMeshView& mesh = view.projected.mesh->mesh();
  for (const std::uint32_t v : view.projected.mesh->tets()[batch.tet[t]]) {
    __builtin_prefetch(&mesh.positions[v]);
    __builtin_prefetch(&mesh.scalars[v]);
  }
}

/// Prefetches the same data for all regular cells.
HWY_INLINE void prefetch_corners(const LatticeView& view, const CellBatch& batch) {
  for (unsigned left = ~batch.irregular & ((1u << batch.size) - 1); left != 0; left &= left - 1)
    prefetch_corners(view, batch, __builtin_ctz(left));
}

/// Returns the cells of a batch that have surfaces, one bit each. Irregular cells are treated as having no surfaces.
HWY_NOINLINE inline unsigned find_surfaces(const LatticeView& view, const CellBatch& batch, LatticeSurfaces& surfaces) {
  // By rounding, a scalar may cross a surface's value. The errors are the last place of a float (64 steps at most), the
  // rounding of the surface's value, and the rounding of a gradient over the square.
  constexpr float margin = 256;
  const DF df;
  const DI d;
  const std::span<const float> values = view.projected.iso->surfaces->on_lattice();
  unsigned with = 0;
  for (int from = 0; from < batch.size; from += lanes) {
    const VF below = Load(df, batch.scalar_low + from) - Set(df, margin);
    const VF above = Load(df, batch.scalar_high + from) + Set(df, margin);
    VI first = Zero(d), last = Zero(d);
    const auto count_if = [&](MF mask, VI& count) HWY_ATTR { count = count - VecFromMask(d, RebindMask(d, mask)); };
    for (const float value : values) {
      count_if(Set(df, value) < below, first);
      count_if(Set(df, value) <= above, last);
    }
    const unsigned at_all = (1u << batch.size) - 1, here = ((1u << lanes) - 1) << from;
    const unsigned regular = at_all & here & ~batch.irregular;
    const unsigned some = lane_bits(RebindMask(df, first < last)) << from & regular;
    with |= some;
    Store(first, d, surfaces.first + from);
    Store(last - first, d, surfaces.count + from);
    Store(Set(df, std::numeric_limits<float>::infinity()), df, surfaces.low + from);
    Store(Set(df, -std::numeric_limits<float>::infinity()), df, surfaces.high + from);
  }
  for (unsigned left = with; left != 0; left &= left - 1) {
    const int t = __builtin_ctz(left);
    surfaces.low[t] = values[static_cast<std::size_t>(surfaces.first[t])];
    prefetch_corners(view, batch, t);
    surfaces.high[t] = values[static_cast<std::size_t>(surfaces.first[t] + surfaces.count[t] - 1)];
  }
  return with;
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
