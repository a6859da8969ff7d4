// SPDX-License-Identifier: BSD-3-Clause
// Casts packets of rays through one chunk of slabs in steps, for `sampled` and `preintegrated`. Included once per
// instruction set (Highway's include guard idiom).
//
// What      The light that each ray accumulates in the chunk, composited behind its previous light (TileRays).
// How       Steps begin where a ray enters the volume. All have the same length except the last, which ends where the
//           ray leaves. A step belongs to the chunk that contains its position: its middle (sampled) or its end
//           (preintegrated). The position is the same double in every chunk, so no step is done twice or omitted.
//
//             enters    step 0    step 1    step 2   leaves
//             |---------|---------|---------|-----|       + middle: sampled
//                  +         +         +       +
//             >         >         >         >     >       > ends: preintegrated; the first is where the ray enters
//
//           Sampled: one sample in the middle; extinction and colour are assumed constant over the step. Pre-integrated
//           (Engel, Kraus, Ertl, "High-Quality Pre-Integrated Volume Rendering Using Hardware-Accelerated Pixel
//           Shading", 2001, section 3): optical depth and light of a step between two scalars are looked up in a table
//           with bilinear interpolation. The table is made for the full step length, so a shorter last step is
//           integrated exactly.
// Accuracy  That of the method: it depends on the step length and, for preintegrated, on the table's resolution
//           (preintegrated_table.hpp). No error bounds are recorded.
// Bits      A ray's bits depend on the ray and the chunks alone, not on the other lanes.
// Ends      A step with a blank (NaN) sample is empty. Rays end below the least transmittance. Hidden chunks are not
//           sampled: skip_chunk() carries NaN as the scalar at the end of their last step.

#if defined(TESSERA_VOLUME_SAMPLE_SLABS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_SAMPLE_SLABS_INL_H_
#undef TESSERA_VOLUME_SAMPLE_SLABS_INL_H_
#else
#define TESSERA_VOLUME_SAMPLE_SLABS_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "volume/lanes/cast_slabs-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

struct RaySteps {
  /// Where the ray enters, the length of a step, and the length of the last step, in units of k.
  double k_in, each, last;
  std::int64_t count;

  HWY_INLINE RaySteps(double k_in_, double k_out, double each_)
      : k_in(k_in_),
        each(each_),
        count(std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil((k_out - k_in_) / each_ - 1e-6)))) {
    last = k_out - (k_in + static_cast<double>(count - 1) * each);
  }
  [[nodiscard]] HWY_INLINE double place(std::int64_t n, bool at_end) const {
    const double begin = k_in + static_cast<double>(n) * each, length = n == count - 1 ? last : each;
    return at_end ? begin + length : begin + 0.5 * length;
  }
  /// Number of steps whose position is before k.
  [[nodiscard]] HWY_INLINE std::int64_t before(double k, bool at_end) const {
    auto n = static_cast<std::int64_t>(std::min(std::max((k - k_in) / each - 1, 0.0), static_cast<double>(count)));
    while (n < count && place(n, at_end) < k) ++n;
    return n;
  }
};

/// Returns the trilinear field at (x, y, k) of the chunk, for lanes anywhere in the block; NaN near blanks.
template <bool cell_data>
HWY_INLINE VF field_in_block(const ChunkView& chunk, const std::int32_t* slice_offsets, const Lanes& lanes, VF k,
                             MF active) {
  const DF d;
  const VF first = Set(d, static_cast<float>(chunk.box.first_slab)),
           last = Set(d, static_cast<float>(chunk.box.slabs - 1));
  const VF plane = Min(Max(Floor(k), first), last);
  const VF x = MulAdd(k, lanes.bx, lanes.x), y = MulAdd(k, lanes.by, lanes.y);
  const VF i = Min(Max(Floor(x), lanes.i_least), lanes.i_most), j = Min(Max(Floor(y), lanes.j_least), lanes.j_most);
  const VI n = ConvertTo(DI(), IfThenElseZero(active, plane));
  const VI column = ConvertTo(DI(), IfThenElseZero(active, i + lanes.i)),
           row = ConvertTo(DI(), IfThenElseZero(active, j + lanes.j));
  const VI in_slice = row * Set(DI(), static_cast<std::int32_t>(chunk.block.pitch)) + column;
  const float* const samples = chunk.block.samples.data();
  const auto pitch = chunk.block.pitch;
  // Lanes that are not active read the first sample.
  const auto offset = [&](int slice) HWY_ATTR {
    const VI at = in_slice + GatherIndex(DI(), slice_offsets + slice, n);
    return IfThenElseZero(RebindMask(DI(), active), at);
  };
  const VI a = offset(0);
  if constexpr (cell_data) return GatherIndex(d, samples, a);
  const VI b = offset(1);
  const auto at = [&](std::ptrdiff_t corner, VI index) HWY_ATTR { return GatherIndex(d, samples + corner, index); };
  const Corners s{at(0, a), at(1, a), at(pitch, a), at(pitch + 1, a),
                  at(0, b), at(1, b), at(pitch, b), at(pitch + 1, b)};
  const VoxelField field(s, x - i, y - j);
  const VF fx = field.x, fy = field.y;
  const VF front = MulAdd(fy, MulAdd(fx, field.aij, field.aj), MulAdd(fx, field.ai, field.a00));
  const VF change = MulAdd(fy, MulAdd(fx, field.cij, field.cj), MulAdd(fx, field.ci, field.c00));
  return MulAdd(k - plane, change, front);
}

/// Looks up optical depth and light in the pre-integrated table, with bilinear interpolation.
HWY_INLINE void look_up(const PreintegratedTable& table, VF front, VF back, VF (&out)[4]) {
  const DF d;
  const VF last = Set(d, static_cast<float>(table.size - 1)), zero = Zero(d);
  const auto place = [&](VF s) HWY_ATTR { return Min(Max((s - Set(d, table.low)) * Set(d, table.scale), zero), last); };
  const VF f = place(front), b = place(back);
  const VF f0 = Min(Floor(f), last - Set(d, 1.0f)), b0 = Min(Floor(b), last - Set(d, 1.0f));
  const VF wf = f - f0, wb = b - b0;
  const VI index = ConvertTo(DI(), MulAdd(f0, Set(d, static_cast<float>(table.size)), b0));
  for (int c = 0; c < 4; ++c) {
    const float* const t = table.channel(c);
    const VF s00 = GatherIndex(d, t, index), s01 = GatherIndex(d, t + 1, index),
             s10 = GatherIndex(d, t + table.size, index), s11 = GatherIndex(d, t + table.size + 1, index);
    const VF low = MulAdd(wb, s01 - s00, s00), high = MulAdd(wb, s11 - s10, s10);
    out[c] = MulAdd(wf, high - low, low);
  }
}

/// The steps of a packet's lanes [ray, ray + Lanes()) whose positions are in a chunk, relative to the chunk's first
/// plane.
struct ChunkSteps {
  static constexpr std::size_t most = MaxLanes(DF());
  HWY_ALIGN float begin[most], each[most], last[most], count[most];
  HWY_ALIGN float final_step[most];  ///< number of the ray's last step; -1 if this step is not in the chunk
  HWY_ALIGN float entry[most];       ///< where the ray enters the volume; -1 if this is not in the chunk
  std::int64_t longest = 0;          ///< largest count
  bool some_enter = false;

  HWY_INLINE ChunkSteps(const ChunkView& chunk, int ray, const TileRays& rays) {
    const FrameView& frame = chunk.frame;
    const double from = static_cast<double>(chunk.box.first_k), to = from + chunk.box.slabs;
    const bool final_chunk =
        chunk.box.first_k + chunk.box.slabs >= frame.voxels[static_cast<std::size_t>(chunk.axes.k)];
    for (std::size_t l = 0; l < hn::Lanes(DF()); ++l) {
      const std::size_t r = static_cast<std::size_t>(ray) + l;
      begin[l] = each[l] = last[l] = 0, count[l] = 0, final_step[l] = entry[l] = -1;
      if (!(rays.from[r] < rays.to[r]) || rays.transmittance[r] < frame.least_transmittance) continue;
      const RaySteps s(rays.k_in[r], rays.k_out[r], frame.step / static_cast<double>(rays.length_k[r]));
      const bool at_end = frame.preintegrated != nullptr;
      // Slices divide the steps of a ray at their planes; boxes divide them where the ray goes from one to the next.
      const std::int64_t first_step =
          s.before(rays.from[r] > rays.k_in[r] ? std::max(from, rays.from[r]) : from, at_end);
      const std::int64_t end_step = rays.to[r] < rays.k_out[r] ? s.before(std::min(to, rays.to[r]), at_end)
                                    : final_chunk              ? s.count
                                                               : s.before(to, at_end);
      count[l] = static_cast<float>(end_step - first_step);
      longest = std::max(longest, end_step - first_step);
      begin[l] = static_cast<float>(s.k_in + static_cast<double>(first_step) * s.each - from);
      each[l] = static_cast<float>(s.each), last[l] = static_cast<float>(s.last);
      if (end_step == s.count) final_step[l] = static_cast<float>(s.count - 1 - first_step);
      if (rays.k_in[r] >= from && rays.k_in[r] < to && rays.from[r] <= rays.k_in[r])
        entry[l] = static_cast<float>(rays.k_in[r] - from), some_enter = true;
    }
  }
};

/// Optical depth of a step, and the light of the step before attenuation by what is in front of it.
struct StepLight {
  VF depth, color[3];
};

/// Returns a step with the constant scalar s and the length `extent` in k; empty where s is blank or lanes are not
/// active.
template <class Lookup>
HWY_INLINE StepLight sampled_step(const Lookup& lookup, VF s, VF extent, VF length_k, MF active) {
  const DF d;
  const VF zero = Zero(d), one = Set(d, 1.0f);
  const MF good = And(active, s == s);
  const VF scalar = IfThenElseZero(good, s);
  const auto index = lookup.index(lookup.locate(scalar, zero == zero), good);
  const VF off = scalar - lookup.at(LaneTable::base, index);
  const VF kappa = Max(zero, MulAdd(lookup.at(LaneTable::half_extinction_slope, index), off,
                                    lookup.at(LaneTable::half_extinction, index)));
  const VF length = IfThenElseZero(good, extent * length_k);
  StepLight light;
  light.depth = (kappa + kappa) * length;
  const VF opacity = one - Exp(d, Neg(light.depth));
  // For independent emission: the mean transmittance of the step, which is 1 where the step is thin.
  const VF mean =
      IfThenElse(light.depth < Set(d, 1e-3f), NegMulAdd(Set(d, 0.5f), light.depth, one), opacity / light.depth);
  const VF weight = lookup.independent ? length * mean : opacity;
  for (int c = 0; c < 3; ++c)
    light.color[c] =
        weight * MulAdd(lookup.at(LaneTable::red_slope + 2 * c, index), off, lookup.at(LaneTable::red + 2 * c, index));
  return light;
}

struct ScalarStep {
  VF front, back, length;
};

/// Returns a step from the table; the shorter last step of a ray is integrated exactly.
template <class Lookup>
HWY_INLINE StepLight preintegrated_step(const PreintegratedTable& table, const Lookup& lookup, const ScalarStep& step,
                                        MF active, MF last) {
  const DF d;
  const VF front = step.front, back = step.back;
  // At blank samples, the scalar is NaN at either end.
  const MF good = And(active, And(back == back, front == front));
  VF found[4];
  look_up(table, IfThenElseZero(good, front), IfThenElseZero(good, back), found);
  StepLight light;
  light.depth = IfThenElseZero(good, found[0]);
  for (int c = 0; c < 3; ++c) light.color[c] = IfThenElseZero(good, found[c + 1]);
  // The table is made for the full length of a step, and light is not proportional to the length.
  const MF final_one = And(good, last);
  if (!AllFalse(d, final_one)) {
    const CL::Light exact = CL::integrate_lanes(lookup, step.length, front, back, final_one);
    light.depth = IfThenElse(final_one, exact.optical_depth, light.depth);
    const VF own[] = {exact.red, exact.green, exact.blue};
    for (int c = 0; c < 3; ++c) light.color[c] = IfThenElse(final_one, own[c], light.color[c]);
  }
  return light;
}

template <bool cell_data, class Lookup>
HWY_INLINE void sample_lanes(const ChunkView& chunk, const Lookup& lookup, const std::int32_t* slice_offsets, int ray,
                             TileRays& rays, TileCounts& counts) {
  const DF d;
  const PreintegratedTable* const table = chunk.frame.preintegrated;
  const VF zero = Zero(d), one = Set(d, 1.0f);
  const Lanes lanes = lanes_of(chunk, ray, 0, 0, rays);
  const ChunkSteps steps(chunk, ray, rays);
  if (table != nullptr && steps.some_enter) {
    const VF place = Load(d, steps.entry);
    const MF enters = place >= zero;
    const VF front = field_in_block<cell_data>(chunk, slice_offsets, lanes, place, enters);
    StoreU(IfThenElse(enters, front, LoadU(d, rays.carried + ray)), d, rays.carried + ray);
  }
  if (steps.longest == 0) return;
  const VF step_begin = Load(d, steps.begin), step_each = Load(d, steps.each), step_last = Load(d, steps.last),
           step_count = Load(d, steps.count), step_final = Load(d, steps.final_step);
  VF through = LoadU(d, rays.transmittance + ray), alpha = LoadU(d, rays.alpha + ray);
  VF light[3] = {LoadU(d, rays.red + ray), LoadU(d, rays.green + ray), LoadU(d, rays.blue + ray)};
  VF carried = LoadU(d, rays.carried + ray);
  const VF least = Set(d, chunk.frame.least_transmittance);
  RayNotes notes{Set(d, -1.0f), alpha > zero, zero, zero};
  for (std::int64_t m = 0; m < steps.longest; ++m) {
    const VF number = Set(d, static_cast<float>(m));
    const MF active = And(number < step_count, through >= least);
    if (AllFalse(d, active)) break;
    counts.samples += CountTrue(d, active);
    const MF last = number == step_final;
    const VF extent = IfThenElse(last, step_last, step_each);
    const VF k = MulAdd(number, step_each, step_begin);
    StepLight step;
    if (table == nullptr) {
      const VF s = field_in_block<cell_data>(chunk, slice_offsets, lanes, MulAdd(extent, Set(d, 0.5f), k), active);
      step = sampled_step(lookup, s, extent, lanes.length, active);
    } else {
      const VF back = field_in_block<cell_data>(chunk, slice_offsets, lanes, k + extent, active);
      step = preintegrated_step(*table, lookup, {carried, back, extent * lanes.length}, active, last);
      carried = IfThenElse(active, back, carried);
    }
    for (int c = 0; c < 3; ++c) light[c] = MulAdd(through, step.color[c], light[c]);
    const VF hidden = through * (one - Exp(d, Neg(step.depth)));
    alpha = alpha + hidden;
    through = through - hidden;
    const MF now = AndNot(notes.seen, alpha > zero);
    notes.first = IfThenElse(now, k, notes.first);
    notes.seen = Or(notes.seen, now);
  }
  StoreU(through, d, rays.transmittance + ray);
  StoreU(alpha, d, rays.alpha + ray);
  StoreU(light[0], d, rays.red + ray);
  StoreU(light[1], d, rays.green + ray);
  StoreU(light[2], d, rays.blue + ray);
  StoreU(carried, d, rays.carried + ray);
  HWY_ALIGN float place[MaxLanes(DF())];
  Store(notes.first, d, place);
  for (std::size_t l = 0; l < hn::Lanes(d); ++l) {
    double& first_k = rays.first_k[static_cast<std::size_t>(ray) + l];
    if (std::isnan(first_k) && rays.alpha[static_cast<std::size_t>(ray) + l] > 0)
      first_k = std::max(0.0, static_cast<double>(chunk.box.first_k) + static_cast<double>(place[l]));
  }
}

template <bool cell_data, CL::TableForm form>
HWY_NOINLINE void sample_chunk_as(const ChunkView& chunk, TileRays& rays, TileCounts& counts) {
  const CL::Lookup<form> lookup(*chunk.frame.table);
  // Offsets in the block of lattice point (0, 0) of each slice.
  HWY_ALIGN std::int32_t slice_offsets[SlabBlock::slices + 1];
  const int slices = chunk.box.slabs + (cell_data ? 0 : 1);
  for (int n = 0; n < slices; ++n)
    slice_offsets[n] = static_cast<std::int32_t>(chunk.block.at(n, 0, 0) - chunk.block.samples.data());
  for (int packet = 0; packet < TileRays::packets; ++packet) {
    if (!chunk.reach[packet].any) continue;
    for (int lane = 0; lane < TileRays::packet_rays; lane += static_cast<int>(hn::Lanes(DF())))
      sample_lanes<cell_data>(chunk, lookup, slice_offsets, packet * TileRays::packet_rays + lane, rays, counts);
  }
}

/// In a hidden chunk the field is not known. The ray stores a blank instead, so that its next step is invisible, as it
/// would be with the field (visible_to_steps() in cell_ranges.hpp).
HWY_INLINE void skip_chunk(const ChunkView& chunk, TileRays& rays) {
  const auto lanes = static_cast<int>(hn::Lanes(DF()));
  for (int ray = 0; ray < TileRays::count; ray += lanes) {
    if (!chunk.reach[ray / TileRays::packet_rays].any) continue;
    const ChunkSteps steps(chunk, ray, rays);
    for (int l = 0; l < lanes; ++l)
      if (steps.count[l] > 0 || steps.entry[l] >= 0) rays.carried[ray + l] = std::numeric_limits<float>::quiet_NaN();
  }
}

HWY_INLINE void sample_chunk(const ChunkView& chunk, TileRays& rays, TileCounts& counts) {
  const auto as = [&]<CL::TableForm form>() HWY_ATTR {
    if (chunk.frame.cell_data)
      sample_chunk_as<true, form>(chunk, rays, counts);
    else
      sample_chunk_as<false, form>(chunk, rays, counts);
  };
  // The form for many knots suffices, because samples are gathered anyway.
  as.template operator()<CL::TableForm::many>();
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
