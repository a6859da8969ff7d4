// SPDX-License-Identifier: BSD-3-Clause
#include "projection/lattice/lattice_rasterizer.hpp"

#include <algorithm>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/lattice/lattice_rasterizer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "projection/lattice/lattice_cover-inl.h"
#include "projection/lattice/lattice_cross-inl.h"
#include "projection/lattice/lattice_cut-inl.h"
#include "projection/lattice/lattice_faces-inl.h"
#include "projection/lattice/lattice_lights-inl.h"
#include "projection/lattice/lattice_normals-inl.h"
#include "projection/lattice/lattice_surfaces.hpp"

HWY_BEFORE_NAMESPACE();
namespace tessera::projection {
namespace HWY_NAMESPACE {

/// Highway's emulated lanes are not used, because double precision takes less time.
bool available() { return HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128; }

#if HWY_TARGET == HWY_SCALAR
void rasterize(const LatticeView&, const ListedCells&, const MaskedRect&, LatticeScratch&, SegmentStream&,
               RasterCounts&) {}
#else
/// Returns the subset of `cells` (one bit each) whose candidate pixels are not all closed.
HWY_INLINE unsigned open_cells(const CellBatch& batch, const MaskedRect& pixels, unsigned cells) {
  const scene::PixelRect rect = pixels.in_square();
  const std::uint32_t all = static_cast<std::uint32_t>((std::uint64_t{1} << rect.width()) - 1) << rect.x0;
  bool all_open = true;
  for (int y = rect.y0; y < rect.y1; ++y) all_open = all_open && pixels.open[y] == all;
  if (all_open) return cells;
  const auto shut = [&](int t) {
    std::uint32_t takes = 0;
    for (int y = batch.y0[t]; y < batch.y1[t]; ++y) takes |= pixels.open[y];
    const std::uint64_t columns = (std::uint64_t{1} << batch.x1[t]) - (std::uint64_t{1} << batch.x0[t]);
    return (takes & columns) == 0;
  };
  for (unsigned left = cells; left != 0; left &= left - 1)
    if (shut(__builtin_ctz(left))) cells &= ~(left & -left);
  return cells;
}

/// Must be called after set-up of a batch. Covers the pixels of the batch's regular cells and appends their segments.
template <bool perspective, bool per_cell>
void rasterize_cells(const LatticeView& view, const CellBatch& batch, const MaskedRect& pixels, CoverScratch& scratch,
                     SegmentStream& out, RasterCounts& counts) {
  HitQueue& hits = scratch.hits;
  unsigned cells = 0;
  CellParts parts;
  parts.three = parts.behind = 0;
  for (int from = 0; from < batch.size; from += lanes) cells |= PartOrder(batch, from, parts).shapes();
  cells = open_cells(batch, pixels, cells & ~batch.irregular & ((1u << batch.size) - 1));
  if (cells == 0) return;

  for (int from = 0; from < batch.size; from += lanes)
    PartOrder(batch, from, parts).template order<perspective, per_cell>();
  using Crossing = HitCrossing<perspective, per_cell>;
  Crossing crossing(view, batch, parts, pixels, out, counts);
  if constexpr (Crossing::together) {
    for (int from = 0; from < batch.size; from += lanes) {
      const unsigned small = SmallCells::worth_while(batch, cells, from);
      if (small == 0) continue;
      SmallCells::cover(batch, parts, small, from, hits,
                        [&]() HWY_ATTR { crossing.template drain<true, true>(hits, from); });
      crossing.template finish<true, true>(hits, from);
      cells &= ~small;
    }
  }
  if (cells == 0) return;
  scratch.blocks.lay(batch, parts, pixels.in_square());
  // Cells of one shape are processed after those of the other, so that branches are predictable.
  const auto cover = [&](unsigned of_shape) HWY_ATTR {
    for (; of_shape != 0; of_shape &= of_shape - 1) {
      const int t = __builtin_ctz(of_shape);
      scratch.blocks.cover(parts, t, hits);
      crossing.drain_cell(hits, t);
    }
  };
  cover(cells & ~parts.three);
  crossing.template finish_cells<true, false>(hits);
  cover(cells & parts.three);
  crossing.template finish_cells<false, true>(hits);
}

/// Rasterizes an irregular cell in double precision and converts its segments to the lattice.
HWY_NOINLINE void rasterize_irregular(const LatticeView& view, const TileEntry& entry, const scene::PixelRect& rect,
                                      LatticeScratch& scratch, SegmentStream& out, RasterCounts& counts) {
  const RaySegments& s = scratch.splitter.rasterize(view.projected, view.steps, entry, rect, counts);
  out.reserve(out.size + s.size);
  counts.irregular_segments += s.size;
  const std::size_t first = out.size;
  for (std::size_t i = 0; i < s.size; ++i) {
    out.pixel[out.size] = static_cast<std::int32_t>(s.pixel(i));
    if (view.projected.iso != nullptr && is_crossing(s.scalar_front[i])) {
      out.front[out.size] = out.back[out.size] = view.lattice.depth_step(s.front[i]);
      out.scalar_front[out.size] = LatticeMark::of(crossing_of(s.scalar_front[i]));
      out.scalar_back[out.size] = 0;
      ++out.size;
      continue;
    }
    out.front[out.size] = view.lattice.depth_step(s.front[i]);
    out.back[out.size] = view.lattice.depth_step(s.back[i]);
    const LatticeScalars scalars =
        lattice_scalars(s.scalar_front[i], s.scalar_back[i], view.steps, view.lattice, view.magnified);
    out.scalar_front[out.size] = scalars.front;
    out.scalar_back[out.size] = scalars.back;
    ++out.size;
  }
  if (!out.lit) return;
  const glm::vec3 normal = MeshNormals(view.projected.mesh->mesh()).of(entry.tet);
  for (std::size_t i = first; i < out.size; ++i) {
    const int x = rect.x0 + out.pixel[i] % rect.width(), y = rect.y0 + out.pixel[i] / rect.width();
    const MatterLight::Light light = view.light->on(normal, view.space->direction(x + 0.5, y + 0.5));
    out.own[i] = static_cast<float>(light.own), out.white[i] = static_cast<float>(light.white);
  }
}

void rasterize(const LatticeView& view, const ListedCells& list, const MaskedRect& pixels, LatticeScratch& scratch,
               SegmentStream& out, RasterCounts& counts) {
  const bool per_cell = view.projected.mesh->mesh().association == scene::Association::cell;
  CellBatch batch;
  CoverScratch cover_scratch;
  LatticeSurfaces surfaces;
  std::optional<SegmentLights> lights;
  if (view.light != nullptr) lights.emplace(view, pixels);
  out.lit = lights.has_value();
  for (std::size_t from = 0; from < list.cells.size(); from += CellBatch::most) {
    const auto cells = list.cells.subspan(from, std::min<std::size_t>(CellBatch::most, list.cells.size() - from));
    const std::size_t begin = out.size;
    if (from == 0) prefetch_cells(view, list.next);
    if (view.perspective)
      set_up_cells<true>(view, cells, pixels, batch);
    else
      set_up_cells<false>(view, cells, pixels, batch);
    for (unsigned irregular = batch.irregular; irregular != 0; irregular &= irregular - 1)
      rasterize_irregular(view, cells[static_cast<std::size_t>(__builtin_ctz(irregular))], pixels.rect, scratch, out,
                          counts);
    const unsigned crossed = view.projected.iso != nullptr ? find_surfaces(view, batch, surfaces) : 0;
    const std::size_t first = out.size;
    if (lights) prefetch_corners(view, batch);
    out.keeps_hits = crossed != 0 || lights;
    out.reserve(out.size + cells.size() * static_cast<std::size_t>(pixels.rect.area()));
    if (view.perspective)
      per_cell ? rasterize_cells<true, true>(view, batch, pixels, cover_scratch, out, counts)
               : rasterize_cells<true, false>(view, batch, pixels, cover_scratch, out, counts);
    else
      per_cell ? rasterize_cells<false, true>(view, batch, pixels, cover_scratch, out, counts)
               : rasterize_cells<false, false>(view, batch, pixels, cover_scratch, out, counts);
    if (lights) lights->set(batch, first, out);
    if (pixels.faces != nullptr) FaceCuts(*pixels.faces, out).cut(begin);
    if (crossed == 0) continue;
    const CrossedSegments segments = crossed_segments(out, first, surfaces);
    if (segments.count == 0) continue;
    find_normals(view, batch, segments.cells, surfaces);
    SurfaceCuts(view, surfaces, pixels, out).cut(segments);
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
                           const scene::Lattice& lattice, bool perspective, std::span<LatticeVertex> out) {
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

void rasterize_lattice(const LatticeView& view, const ListedCells& list, const MaskedRect& pixels,
                       LatticeScratch& scratch, SegmentStream& out, RasterCounts& counts) {
  HWY_DYNAMIC_DISPATCH(rasterize)(view, list, pixels, scratch, out, counts);
}

}  // namespace tessera::projection
#endif  // HWY_ONCE
