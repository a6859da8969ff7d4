// SPDX-License-Identifier: BSD-3-Clause
// Integrates the segments of windows' rows. Included once per instruction set (Highway's include guard idiom).
//
// What      The input is the sorted segments of sixteen pixels, one pixel per lane, row by row: row i contains the
//           i-th segment of every pixel. LightRows integrates rows to light C and opacity alpha; window_light-inl.h
//           composites them.
// How       Segments that need only one piece are integrated in place; segments that are cut into several pieces wait
//           until they fill the lanes. The light of a surface is composited in front of that of the segment behind it.
// Bits      The light of a segment does not depend on the other lanes.

#if defined(TESSERA_COMPOSITOR_WINDOW_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_COMPOSITOR_WINDOW_ROWS_INL_H_
#undef TESSERA_COMPOSITOR_WINDOW_ROWS_INL_H_
#else
#define TESSERA_COMPOSITOR_WINDOW_ROWS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "compositor/surface_lights-inl.h"
#include "compositor/window_kernel.hpp"
#include "projection/lattice/segment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::compositor {
namespace HWY_NAMESPACE {

using projection::HWY_NAMESPACE::SegmentLanes;
constexpr std::int32_t no_key = WindowState::not_yet;  // greater than all keys

/// The light that leaves the segments of a block of rows. A row has one segment per pixel, at [row * lanes + lane].
struct LightRows {
  static constexpr std::size_t most = 32, numbers = most * most_lanes;
  alignas(64) float alpha[numbers], optical_depth[numbers], red[numbers], green[numbers], blue[numbers];
  /// Depths of the segment, in lattice steps; `front` is no_key where the lane has no valid segment in the row.
  alignas(64) std::int32_t front[numbers], back[numbers];
  alignas(64) std::int32_t interval[numbers];
  alignas(64) float length[numbers], scalar_front[numbers], scalar_back[numbers];
  alignas(64) float own[numbers], white[numbers];  ///< SegmentLight of each segment; only for lit matter
  // The positions of segments that need more than one piece, until these segments fill the lanes.
  alignas(64) std::int32_t waiting_at[numbers + most_lanes];
  std::size_t waiting = 0;
  bool lit[most];  ///< whether some lane of the row has light or optical depth
  // For runs: where the run of each lane ends after the rows (no_key: the lane is not in a run), and whether no run
  // ends between the rows.
  alignas(64) std::int32_t run_back[most_lanes];
  bool touching;
  // Segments that begin at a surface: their positions, their marks during integration, and the rows that have such
  // segments, one bit per row.
  alignas(64) std::int32_t marked_at[numbers + most_lanes];
  alignas(64) float mark[numbers + most_lanes];
  std::size_t marked = 0;
  std::uint32_t marked_rows = 0;

  /// Stores the marks of a row, for those lanes whose segment is final and whose pixel is open. Returns the row's front
  /// scalars, with marks replaced by the surfaces' values.
  HWY_INLINE VF set_aside_surfaces(std::span<const float> by_number, MI is_final, MI open, VF scalar_from,
                                   std::size_t row) {
    using Mark = projection::LatticeMark;
    const DF d;
    const DI di;
    const MF is_mark = And(RebindMask(d, is_final), scalar_from >= Set(d, Mark::first));
    if (AllFalse(d, is_mark)) return scalar_from;
    const auto takes = And(RebindMask(di, is_mark), open);
    const LanePacker pack(takes);
    if (pack.count() > 0) {
      StoreU(pack(Iota(di, 0) + Set(di, static_cast<std::int32_t>(row * hn::Lanes(d)))), di, marked_at + marked);
      StoreU(pack(scalar_from), d, mark + marked);
      marked += pack.count();
      marked_rows |= 1u << row;
    }
    const VI last = Set(di, static_cast<std::int32_t>(by_number.size()) - 1);
    const VI number = IfThenElseZero(RebindMask(di, is_mark), Min(number_of(scalar_from), last));
    return IfThenElse(is_mark, GatherIndex(d, by_number.data(), number), scalar_from);
  }
  /// Must be called after integrate(). Composites the light of surfaces in front of the light behind them.
  /// `show_first`: whether the first visible segment of some lane may still be needed.
  template <TableForm form>
  HWY_NOINLINE void put_surfaces(const scene::SurfaceSet& surfaces, const Lookup<form>& table, double color_unit,
                                 bool show_first) {
    const DF d;
    const DI di;
    for (std::size_t i = 0; i < marked; i += hn::Lanes(d)) {
      // Lanes beyond the last repeat the first.
      const auto here = FirstN(d, marked - i);
      const VI at = IfThenElse(RebindMask(di, here), Load(di, marked_at + i), Set(di, marked_at[i]));
      const VF marks = IfThenElse(here, Load(d, mark + i), Set(d, mark[i]));
      const bool shows_field = surfaces.shows_field();
      FieldColors field{doubles(0), doubles(0), doubles(0)};
      if (shows_field) field = field_colors(table, color_unit, GatherIndex(d, scalar_back, at));
      const SurfaceLights light(surfaces, marks, shows_field ? &field : nullptr);
      const auto put = [&](const Doubles& of_surface, float* to) HWY_ATTR {
        const VF sum = demote(light.before(of_surface, promote(GatherIndex(d, to, at))));
        ScatterIndex(sum, d, to, at);
        return sum;
      };
      put(light.red, red), put(light.green, green), put(light.blue, blue);
      const VF hidden = put(light.opacity, alpha);
      if (!show_first) continue;
      // The optical depth is only tested for being positive.
      ScatterIndex(hidden, d, optical_depth, at);
      ScatterIndex(marks, d, scalar_front, at);
    }
    for (; marked_rows != 0; marked_rows &= marked_rows - 1) lit[__builtin_ctz(marked_rows)] = true;
    marked = 0;
  }

  HWY_INLINE void put_segment(const SegmentLanes& s, VF segment_length, VI scalar_interval, std::size_t at) {
    const DF d;
    const DI di;
    Store(segment_length, d, length + at);
    Store(s.scalar_front, d, scalar_front + at), Store(s.scalar_back, d, scalar_back + at);
    Store(s.front, di, front + at), Store(s.back, di, back + at), Store(scalar_interval, di, interval + at);
  }
  HWY_INLINE void put(const Light& light, std::size_t at) {
    const DF d;
    Store(light.alpha, d, alpha + at), Store(light.optical_depth, d, optical_depth + at);
    Store(light.red, d, red + at), Store(light.green, d, green + at), Store(light.blue, d, blue + at);
  }
  HWY_INLINE void defer(MF more, VI places) {
    const DI d;
    const LanePacker pack(RebindMask(d, more));
    StoreU(pack(places), d, waiting_at + waiting);
    waiting += pack.count();
  }
  template <TableForm form>
  HWY_INLINE void integrate_waiting(const Lookup<form>& table) {
    const DF d;
    const DI di;
    alignas(64) float now[5][most_lanes];
    StoreU(Zero(di), di, waiting_at + waiting);  // lanes beyond the last also read some position
    for (std::size_t i = 0; i < waiting; i += hn::Lanes(d)) {
      const std::size_t here = std::min(hn::Lanes(d), waiting - i);
      const VI at = Load(di, waiting_at + i);
      const Light light = integrate_lanes(table, GatherIndex(d, length, at), GatherIndex(d, scalar_front, at),
                                          GatherIndex(d, scalar_back, at), FirstN(d, here));
      Store(light.alpha, d, now[0]), Store(light.optical_depth, d, now[1]);
      Store(light.red, d, now[2]), Store(light.green, d, now[3]), Store(light.blue, d, now[4]);
      for (std::size_t k = 0; k < here; ++k) {
        const auto to = static_cast<std::size_t>(waiting_at[i + k]);
        alpha[to] = now[0][k], optical_depth[to] = now[1][k];
        red[to] = now[2][k], green[to] = now[3][k], blue[to] = now[4][k];
      }
    }
    waiting = 0;
  }

  /// Applies lighting to the matter of the first `count` rows, after integration.
  HWY_NOINLINE void light_matter(std::size_t count) {
    const DF d;
    for (std::size_t row = 0; row < count; ++row) {
      if (!lit[row]) continue;
      const std::size_t at = row * hn::Lanes(d);
      const VF of_color = Load(d, own + at), shine = Load(d, white + at) * Load(d, alpha + at);
      for (float* color : {red + at, green + at, blue + at}) Store(MulAdd(of_color, Load(d, color), shine), d, color);
    }
  }

  /// Computes the light of the segments in the first `count` rows by another method than that of the lanes.
  HWY_NOINLINE void integrate_in_double(const integrals::SegmentIntegrator& integrator, const scene::Lattice& lattice,
                                        std::size_t count, integrals::SegmentBatch& batch) {
    const std::size_t lanes = hn::Lanes(DF()), n = count * lanes;
    std::array<std::uint16_t, numbers> places;
    batch.reserve(n);
    batch.size = 0;
    for (std::size_t i = 0; i < n; ++i) {
      alpha[i] = optical_depth[i] = red[i] = green[i] = blue[i] = 0;
      if (!(length[i] > 0)) continue;
      places[batch.size] = static_cast<std::uint16_t>(i);
      batch.length[batch.size] = length[i] * lattice.depth_unit;
      batch.scalar_front[batch.size] = lattice.scalar(scalar_front[i]);
      batch.scalar_back[batch.size] = lattice.scalar(scalar_back[i]);
      ++batch.size;
    }
    integrator.integrate(batch);
    std::fill_n(lit, count, false);
    for (std::size_t k = 0; k < batch.size; ++k) {
      const std::size_t i = places[k];
      alpha[i] = static_cast<float>(-std::expm1(-batch.optical_depth[k]));
      optical_depth[i] = static_cast<float>(batch.optical_depth[k]);
      red[i] = static_cast<float>(batch.red[k]), green[i] = static_cast<float>(batch.green[k]);
      blue[i] = static_cast<float>(batch.blue[k]);
      lit[i / lanes] = lit[i / lanes] || optical_depth[i] > 0 || red[i] + green[i] + blue[i] > 0;
    }
  }

  /// Computes the light of the segments in the first `count` rows.
  template <TableForm form>
  HWY_INLINE void integrate(const Lookup<form>& table, std::size_t count) {
    table.independent ? integrate_rows<true>(table, count) : integrate_rows<false>(table, count);
    integrate_waiting(table);
  }

 private:
  template <bool independent, TableForm form>
  HWY_INLINE void integrate_rows(const Lookup<form>& table, std::size_t count) {
    const DI d;
    const DF df;
    const std::size_t lanes = hn::Lanes(d);
    VI places = Iota(d, 0);
    for (std::size_t row = 0; row < count; ++row) {
      const std::size_t at = row * lanes;
      const VF l = Load(df, length + at), from = Load(df, scalar_front + at), to = Load(df, scalar_back + at);
      MF more;
      const Light light = integrate_simple<independent>(table, Load(d, interval + at), l, from, to, more);
      put(light, at);
      MF shows = Or(more, light.optical_depth > Zero(df));
      if constexpr (independent) shows = Or(shows, light.red + (light.green + light.blue) > Zero(df));
      lit[row] = !AllFalse(df, shows);
      if (!AllFalse(df, more)) defer(more, places);
      places = places + Set(d, static_cast<std::int32_t>(lanes));
    }
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::compositor
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
