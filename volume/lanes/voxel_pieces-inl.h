// SPDX-License-Identifier: BSD-3-Clause
// Casts rays through a slab voxel by voxel, and through slabs that cross knots. Included once per instruction set
// (Highway's include guard idiom).
//
// What      The light of lanes that cannot be integrated as a line of slab_lines-inl.h: where rays begin or end in a
//           slab, with shading, with cell data, and where the field crosses knots of the transfer function or is rough.
// How       In a voxel the field along the ray is a cubic, and its values at the ends and in the middle of a stretch
//           with its leading coefficient determine the light (ray_piece-inl.h). In a slab that crosses knots,
//           cast_mixed() integrates the lanes that do not cross any as lines; the stretches of the other lanes are
//           packed into full vectors (cast_stretches()).
// Accuracy  That of ray_piece-inl.h. For dense matter, note_ends() and note_planes() record the effect of rounding
//           errors of the positions where rays begin and end.
// Ends      NaN samples are blank: their stretches add nothing.

#if defined(TESSERA_VOLUME_VOXEL_PIECES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_VOXEL_PIECES_INL_H_
#undef TESSERA_VOLUME_VOXEL_PIECES_INL_H_
#else
#define TESSERA_VOLUME_VOXEL_PIECES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "volume/lanes/current_interval-inl.h"
#include "volume/lanes/packet_lanes-inl.h"
#include "volume/lanes/shading-inl.h"
#include "volume/lanes/slab_lines-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// The trilinear field of a lane's voxel along its ray: a + u c, where a and c are bilinear in (x, y).
struct VoxelField {
  VF a00, ai, aj, aij, c00, ci, cj, cij;
  VF x, y;  ///< position at u = 0, relative to the voxel's corner

  HWY_INLINE VoxelField(const Corners& s, VF x_in, VF y_in) : x(x_in), y(y_in) {
    a00 = s.a00;
    ai = s.a10 - s.a00, aj = s.a01 - s.a00, aij = s.a11 - s.a01 - ai;
    const VF c10 = s.b10 - s.a10, c01 = s.b01 - s.a01, c11 = s.b11 - s.a11;
    c00 = s.b00 - s.a00;
    ci = c10 - c00, cj = c01 - c00, cij = c11 - c01 - ci;
  }
  HWY_INLINE VF at(VF u, const Lanes& lanes) const {
    const VF fx = MulAdd(u, lanes.bx, x), fy = MulAdd(u, lanes.by, y);
    const VF a = MulAdd(fy, MulAdd(fx, aij, aj), MulAdd(fx, ai, a00));
    const VF c = MulAdd(fy, MulAdd(fx, cij, cj), MulAdd(fx, ci, c00));
    return MulAdd(u, c, a);
  }
  HWY_INLINE Gradient gradient(VF u, const Lanes& lanes) const {
    const VF fx = MulAdd(u, lanes.bx, x), fy = MulAdd(u, lanes.by, y);
    return {MulAdd(fy, MulAdd(u, cij, aij), MulAdd(u, ci, ai)), MulAdd(fx, MulAdd(u, cij, aij), MulAdd(u, cj, aj)),
            MulAdd(fy, MulAdd(fx, cij, cj), MulAdd(fx, ci, c00))};
  }
  /// The field at u = 0.
  HWY_INLINE VF at_front() const { return MulAdd(y, MulAdd(x, aij, aj), MulAdd(x, ai, a00)); }
  /// Returns the field at u = 1, where the ray is at (x_1, y_1), in the coordinates of the voxel's corner (i, j).
  HWY_INLINE VF at_back(VF x_1, VF y_1, VF i, VF j) const {
    const VF fx = x_1 - i, fy = y_1 - j;
    const VF a = MulAdd(fy, MulAdd(fx, aij, aj), MulAdd(fx, ai, a00));
    return a + MulAdd(fy, MulAdd(fx, cij, cj), MulAdd(fx, ci, c00));
  }
  struct MiddleAndMean {
    VF middle, mean;
  };
  /// Returns the value at the middle u of a stretch of extent e, and the mean over the stretch: every product of two of
  /// x, y and u adds a twelfth of the product of their changes. `ee` is e^2 / 12.
  HWY_INLINE MiddleAndMean middle_and_mean(VF u, VF ee, const Lanes& lanes) const {
    const VF fx = MulAdd(u, lanes.bx, x), fy = MulAdd(u, lanes.by, y);
    const VF a_y = MulAdd(fx, aij, aj), c_y = MulAdd(fx, cij, cj), c_x = MulAdd(fy, cij, ci);
    const VF a = MulAdd(fy, a_y, MulAdd(fx, ai, a00)), c = MulAdd(fy, c_y, MulAdd(fx, ci, c00));
    const VF middle = MulAdd(u, c, a);
    const VF twist = MulAdd(lanes.bends, MulAdd(u, cij, aij), MulAdd(lanes.bx, c_x, lanes.by * c_y));
    return {middle, MulAdd(ee, twist, middle)};
  }
};

/// The data with which a packet's rays are cast.
template <class Lookup>
struct PacketView {
  const FrameView& frame;
  const RayAxes& axes;
  const Lookup& lookup;
  const Lanes& lanes;
  CurrentInterval& current;
};

/// Returns the rounding error of a position in slab n of the chunk, in slabs: the rounding error of numbers of this
/// size.
HWY_INLINE VF place_noise(VF k) { return (k + Set(DF(), 2.0f)) * Set(DF(), 0x1p-24f); }

/// Records the errors of a slab of point data due to rounding of the positions where rays begin and end in the slab.
/// Matter is in excess or missing at the slab's front (scalar line.s_0), with the slab's own light behind it, and at
/// the slab's back. `front_light` is the light accumulated in front of the slab.
template <class Lookup>
HWY_NOINLINE void note_ends(const PacketView<Lookup>& packet, const Line& line, const SlabPath& path, MF there,
                            const Progress& front_light, RayState& rays) {
  const DF d;
  const Lookup& lookup = packet.lookup;
  const LaneErrorBound& bound = *packet.frame.error_bound;
  const Progress& progress = rays.light;
  const VF zero = Zero(d), one = Set(d, 1.0f), before = front_light.transmittance, behind = progress.transmittance;
  const VF light[3] = {front_light.red, front_light.green, front_light.blue};
  const VF off = place_noise(path.k) * packet.lanes.length, brightest = Set(d, bound.brightest);
  const MF good = And(there, line.rho == line.rho);
  const auto at = [&](VF s, MF ends, bool front) HWY_ATTR {
    const VF scalar = IfThenElseZero(good, s);
    const VI interval = lookup.locate(scalar, zero == zero);
    const auto index = lookup.index(interval, good);
    const VF from = scalar - lookup.at(LaneTable::base, index), dimmed = before - behind;
    const VF sums[3] = {progress.red, progress.green, progress.blue};
    VF differs = zero, sent = zero;
    for (int c = 0; c < 3; ++c) {
      const VF color =
          MulAdd(lookup.at(LaneTable::red_slope + 2 * c, index), from, lookup.at(LaneTable::red + 2 * c, index));
      const VF own = sums[c] - light[c];
      differs = Max(differs, lookup.independent ? own : Abs(NegMulAdd(color, dimmed, own)));
      if (lookup.independent) sent = Max(sent, color);
    }
    if (!front) differs = zero;
    const VF seen = front ? before : behind;
    const VF error = MulAdd(extinction_at(lookup, index, scalar), MulAdd(behind, brightest, differs), sent * seen);
    const VF noted = Min(error * off, seen * Set(d, bound.most));
    rays.notes.error_bound = rays.notes.error_bound + IfThenElseZero(And(good, ends), noted);
  };
  at(line.s_0, path.from > zero, true);
  at(line.s_1, path.to < one, false);
}

/// Records the same errors for stretch n of cell data, which begins and ends at planes of its voxel. `piece` is the
/// stretch; `before` is the transmittance at its front.
template <class Lookup>
HWY_NOINLINE void note_planes(const PacketView<Lookup>& packet, const SlabPath& path, int n, const Piece& piece,
                              VF before, RayState& rays) {
  const DF d;
  const Lookup& lookup = packet.lookup;
  const Lanes& lanes = packet.lanes;
  const LaneErrorBound& bound = *packet.frame.error_bound;
  const VF zero = Zero(d), one = Set(d, 1.0f), behind = rays.light.transmittance;
  const Stretch& stretch = path.stretches[n];
  const MF good = And(piece.length > zero, piece.s_0 == piece.s_0);
  const VF scalar = IfThenElseZero(good, piece.s_0);
  const VI interval = lookup.locate(scalar, zero == zero);
  const auto index = lookup.index(interval, good);
  // The slower the ray moves across a plane of another axis, the less accurate the crossing is.
  const auto off = [&](VF i, VF j) HWY_ATTR {
    const auto of = [&](VF place, VF per_slope, MF crossed) HWY_ATTR {
      const VF noise = (Abs(place) + one) * Set(d, 0x1p-24f);
      return IfThenElseZero(crossed, noise * Abs(per_slope));
    };
    const VF crossing = of(path.x, lanes.per_bx, i != stretch.i) + of(path.y, lanes.per_by, j != stretch.j);
    return Min(place_noise(path.k) + crossing, one);
  };
  const VF front = n == 0 ? place_noise(path.k) : off(path.stretches[n - 1].i, path.stretches[n - 1].j),
           back = n == 2 ? place_noise(path.k) : off(path.stretches[n + 1].i, path.stretches[n + 1].j);
  const VF both =
      (IfThenElseZero(stretch.begin > zero, front) + IfThenElseZero(stretch.end < one, back)) * lanes.length;
  const VF extinction = extinction_at(lookup, index, scalar), brightest = Set(d, bound.brightest);
  VF error = extinction * behind * brightest;
  if (lookup.independent) {
    const VF from = scalar - lookup.at(LaneTable::base, index);
    VF sent = zero;
    for (int c = 0; c < 3; ++c)
      sent = Max(
          sent, MulAdd(lookup.at(LaneTable::red_slope + 2 * c, index), from, lookup.at(LaneTable::red + 2 * c, index)));
    error = MulAdd(extinction, brightest, sent) * before;
  }
  const VF noted = Min(error * both, before * Set(d, bound.most));
  rays.notes.error_bound = rays.notes.error_bound + IfThenElseZero(good, noted);
}

/// The rounding errors of a slab's samples (SlabBlock::rest), for gradients.
class RestOfSamples {
 public:
  /// `front` and `back` are the beginning of the window in both slices.
  HWY_INLINE RestOfSamples(const SlabBlock& block, const float* front, const float* back)
      : there_(block.has_rest), window_(block.rest_of(front), block.rest_of(back), block.pitch) {}

  /// Adds the contribution of the rounding errors to the gradient at u.
  HWY_INLINE void add(const SlabPath& path, const Stretch& stretch, const Lanes& lanes, VF u, Gradient& g) const {
    if (HWY_LIKELY(!there_)) return;
    const VoxelField rest(window_.corners(window_index(window_, path, stretch)), path.x - stretch.i,
                          path.y - stretch.j);
    const Gradient more = rest.gradient(u, lanes);
    g = {g.i + more.i, g.j + more.j, g.k + more.k};
  }

 private:
  bool there_;
  GatherWindow window_;
};

/// A slab's samples around the rays, and their rounding errors.
template <class Window>
struct SlabSamples {
  const Window& window;
  const RestOfSamples& rest;
};

/// Casts the `wanted` lanes voxel by voxel. `uniform` is the table's row if all lanes are in one interval, else null.
template <bool cell_data, class Window, class Lookup>
HWY_NOINLINE void cast_voxels(const PacketView<Lookup>& packet, const SlabPath& path,
                              const SlabSamples<Window>& samples, const UniformLookup* uniform, MF wanted,
                              RayState& rays) {
  const FrameView& frame = packet.frame;
  const Lanes& lanes = packet.lanes;
  const Window& window = samples.window;
  Progress& progress = rays.light;
  RayNotes& notes = rays.notes;
  const DF d;
  const VF half = Set(d, 0.5f), zero = Zero(d), one = Set(d, 1.0f);
  const bool lit_part = frame.shading != nullptr && !cell_data;
  for (const Stretch& stretch : path.stretches) {
    const VF extent = stretch.end - stretch.begin;
    const MF there = And(wanted, extent > Zero(d));
    const std::size_t voxels = CountTrue(d, there);
    if (voxels == 0) continue;
    const VI index = window_index(window, path, stretch);
    Piece piece;
    Lit lit{one, zero, zero};
    piece.begin = stretch.begin + path.k;
    piece.extent = extent;
    piece.length = IfThenElseZero(there, extent * lanes.length);
    if constexpr (cell_data) {
      piece.s_0 = piece.s_mid = piece.s_1 = window.front(index);
      piece.p_3 = Zero(d);
    } else {
      const VoxelField field(window.corners(index), path.x - stretch.i, path.y - stretch.j);
      const VF middle = half * (stretch.begin + stretch.end);
      piece.s_0 = field.at(stretch.begin, lanes);
      piece.s_mid = field.at(middle, lanes);
      piece.s_1 = field.at(stretch.end, lanes);
      piece.p_3 = field.cij * lanes.bends * (extent * (extent * extent));
      if (lit_part) {
        Gradient gradient = field.gradient(middle, lanes);
        samples.rest.add(path, stretch, lanes, middle, gradient);
        gradient = gradient.kept(there);
        const VF per_length = Set(d, static_cast<float>(frame.shading->unit / frame.length_unit)) / lanes.length;
        lit = shade(frame, packet.axes, gradient, gradient.along(lanes) * per_length, lanes.light_view);
      }
    }
    Progress part{zero, one, zero, zero, zero, zero};
    Progress& target = lit_part ? part : progress;
    const VF before = progress.transmittance;
    if (uniform != nullptr && HWY_LIKELY(add_uniform<cell_data>(*uniform, piece, target))) {
      rays.counts.samples += voxels;
      if (HWY_UNLIKELY(!AllTrue(d, notes.seen))) note_first_light(target, piece.begin, notes);
      if (HWY_UNLIKELY(uniform->ramp > 0))
        note_ramps(*uniform, piece.length, before, (lit_part ? before : one) * target.transmittance, notes);
    } else {
      const VF through = lit_part ? before : one, error_bound = notes.error_bound, rough = notes.rough;
      notes.error_bound = notes.rough = zero;
      add_any(packet.lookup, frame, piece, target, notes, rays.counts.samples);
      notes.error_bound = MulAdd(through, notes.error_bound, error_bound);
      notes.rough = MulAdd(through * through, notes.rough, rough);
    }
    if (cell_data && HWY_UNLIKELY(frame.error_bound != nullptr && frame.error_bound->ends))
      note_planes(packet, path, static_cast<int>(&stretch - path.stretches), piece, before, rays);
    if (lit_part) {
      if (HWY_UNLIKELY(frame.has_rest)) notes.error_bound = MulAdd(before * part.alpha, lit.error, notes.error_bound);
      put_behind(part, lit, progress);
      // Inside the stretch, light was measured from the stretch's own front.
      note_first_light(progress, piece.begin, notes);
    }
  }
}

/// Returns an upper bound of the difference between a stretch's cubic and the chord between the ends of the stretch:
/// the height of the even part, and a quarter of the odd part's coefficient (ray_piece-inl.h).
HWY_INLINE VF bump_of(VF s_0, VF middle, VF s_1, VF p_3) {
  const DF d;
  const VF even = NegMulAdd(Set(d, 0.5f), s_0 + s_1, middle);
  return MulAdd(Set(d, 0.25f), Abs(p_3), Abs(even));
}

/// Returns the cubic at a stretch's other end, by Simpson's rule, which is exact: mean = (s_0 + 4 middle + s_1) / 6.
HWY_INLINE VF other_end(VF s, VF middle, VF mean) {
  const DF d;
  return MulAdd(Set(d, 6.0f), mean, Set(d, -4.0f) * middle) - s;
}

/// Returns an upper bound of the field's distance from the slab's line: that at the borders of voxels, and that of the
/// bumps in between. NaN where the field is NaN.
HWY_INLINE VF distance_bound(VF border_1, VF line_1, VF border_2, VF line_2, const VF (&bump)[3]) {
  const VF borders = Max(Abs(border_1 - line_1), Abs(border_2 - line_2));
  const VF bumps = Max(Max(bump[0], bump[1]), bump[2]);
  const VF any = bump[0] + bump[1] + (bump[2] + (border_1 + border_2));
  return MulAdd(Zero(DF()), any, borders + bumps);
}

/// Returns the line of a slab that lanes may enter or leave anywhere. The result is arbitrary for lanes outside the
/// slab.
template <class Window>
HWY_INLINE Line part_line(const Lanes& lanes, const SlabPath& path, const Window& window) {
  const DF d;
  const VF half = Set(d, 0.5f);
  const VF extent = path.to - path.from;
  const VF per_extent = Set(d, 1.0f) / extent;
  Line line;
  VF total = Zero(d);
  VoxelField::MiddleAndMean of[3];
  VF p_3[3];
  line.s_0 = line.s_1 = total;
  for (int p = 0; p < 3; ++p) {
    const Stretch& stretch = path.stretches[p];
    const VoxelField field(window.corners(window_index(window, path, stretch)), path.x - stretch.i, path.y - stretch.j);
    const VF e = stretch.end - stretch.begin, ee = e * e;
    of[p] = field.middle_and_mean(half * (stretch.begin + stretch.end), ee * Set(d, 1 / 12.0f), lanes);
    p_3[p] = field.cij * lanes.bends * (ee * e);
    total = MulAdd(e * per_extent, of[p].mean, total);
    if (p == 0) line.s_0 = field.at(stretch.begin, lanes);
    if (p == 2) line.s_1 = field.at(stretch.end, lanes);
  }
  line.span = line.s_1 - line.s_0;
  line.shift = NegMulAdd(half, line.s_0 + line.s_1, total);
  const VF slope = line.span * per_extent;
  const VF border_1 = other_end(line.s_0, of[0].middle, of[0].mean),
           border_2 = other_end(line.s_1, of[2].middle, of[2].mean);
  const VF bump[3] = {bump_of(line.s_0, of[0].middle, border_1, p_3[0]),
                      bump_of(border_1, of[1].middle, border_2, p_3[1]),
                      bump_of(border_2, of[2].middle, line.s_1, p_3[2])};
  const auto on_line = [&](VF at) HWY_ATTR { return MulAdd(at - path.from, slope, line.s_0); };
  line.rho =
      distance_bound(border_1, on_line(path.stretches[1].begin), border_2, on_line(path.stretches[2].begin), bump);
  return line;
}

/// The stretches of a slab from front to back, and the lanes that have them.
struct SlabPieces {
  Piece pieces[3];
  MF there[3];
};

#if HWY_TARGET <= HWY_AVX3
/// Adds pieces of lanes for which light has begun already. They are packed into full vectors, each integrated
/// separately from its own front, and then composited by lane.
template <class Lookup>
HWY_INLINE void add_side_by_side(const PacketView<Lookup>& packet, const SlabPieces& slab, RayState& rays) {
  const DF d;
  const VF zero = Zero(d), one = Set(d, 1.0f);
  constexpr std::size_t lanes_each = MaxLanes(DF()), most = 4 * lanes_each;
  HWY_ALIGN float s_0[most], s_mid[most], s_1[most], p_3[most], length[most];
  std::size_t begin[4] = {0, 0, 0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const Piece& piece = slab.pieces[k];
    const MF there = slab.there[k];
    begin[k + 1] = begin[k] + CountTrue(d, there);
    const auto keep = [&](VF v, float* to) HWY_ATTR { StoreU(Compress(v, there), d, to + begin[k]); };
    keep(piece.s_0, s_0), keep(piece.s_mid, s_mid), keep(piece.s_1, s_1);
    keep(piece.p_3, p_3), keep(piece.length, length);
  }
  HWY_ALIGN float light[8][most];
  for (std::size_t n = 0; n < begin[3]; n += lanes_each) {
    const VF used = IfThenElseZero(FirstN(d, begin[3] - n), Load(d, length + n));
    const Piece piece{Load(d, s_0 + n), Load(d, s_mid + n), Load(d, s_1 + n), Load(d, p_3 + n), used, zero, zero};
    Progress part{zero, one, zero, zero, zero, zero};
    RayNotes here{zero, zero == zero, zero, zero};
    add_any(packet.lookup, packet.frame, piece, part, here, rays.counts.samples);
    const VF parts[8] = {part.alpha, part.transmittance, part.optical_depth, part.red,
                         part.green, part.blue,          here.error_bound,   here.rough};
    for (int c = 0; c < 8; ++c) Store(parts[c], d, light[c] + n);
  }
  Progress& progress = rays.light;
  RayNotes& notes = rays.notes;
  for (std::size_t k = 0; k < 3; ++k) {
    const MF there = slab.there[k];
    const auto part = [&](int c) HWY_ATTR { return expand_load(there, light[c] + begin[k], zero); };
    const VF through = progress.transmittance;
    progress.alpha = MulAdd(through, part(0), progress.alpha);
    progress.transmittance = through * expand_load(there, light[1] + begin[k], one);
    progress.optical_depth = progress.optical_depth + part(2);
    progress.red = MulAdd(through, part(3), progress.red);
    progress.green = MulAdd(through, part(4), progress.green);
    progress.blue = MulAdd(through, part(5), progress.blue);
    notes.error_bound = MulAdd(through, part(6), notes.error_bound);
    notes.rough = MulAdd(through * through, part(7), notes.rough);
  }
}
#endif

/// Casts the stretches of a slab (slab_lines-inl.h) one by one, for the `wanted` lanes.
template <class Lookup>
HWY_NOINLINE void cast_stretches(const PacketView<Lookup>& packet, const SlabLines& lines, int n, MF wanted,
                                 RayState& rays) {
  const FrameView& frame = packet.frame;
  const int m = n - lines.first;
  const DF d;
  const VF half = Set(d, 0.5f), zero = Zero(d), one = Set(d, 1.0f);
  const VF u_1 = lines.u_1[m], u_2 = lines.u_2[m], s_end = lines.s[m + 1];
  const VF place[4] = {zero, u_1, u_2, one};
  // A stretch behind a plane that is not crossed does not exist.
  const VF value[4] = {lines.s[m], IfThenElse(u_1 < one, lines.f_1[m], s_end),
                       IfThenElse(u_2 < one, lines.f_2[m], s_end), s_end};
  SlabPieces slab;
  MF torn = zero != zero;
  const bool has_blanks = frame.ranges->range.blanks > 0;
  for (int k = 0; k < 3; ++k) {
    Piece& p = slab.pieces[k];
    p.extent = place[k + 1] - place[k];
    slab.there[k] = And(wanted, p.extent > zero);
    p.s_0 = value[k], p.s_1 = value[k + 1];
    p.s_mid = NegMulAdd(Set(d, 0.25f), lines.even[k][m], half * (p.s_0 + p.s_1));
    p.p_3 = lines.odd[k][m];
    p.length = IfThenElseZero(slab.there[k], p.extent * packet.lanes.length);
    p.begin = place[k] + Set(d, static_cast<float>(n));
    // A voxel that is not blank, but whose end value is from a voxel that is: because of rounding, the ray passes an
    // edge of both on different sides.
    const VF shape = lines.even[k][m] + lines.odd[k][m];
    if (HWY_UNLIKELY(has_blanks)) torn = Or(torn, AndNot(p.s_mid == p.s_mid, And(slab.there[k], shape == shape)));
  }
  if (HWY_UNLIKELY(has_blanks && !AllFalse(d, torn)))
    rays.notes.error_bound = rays.notes.error_bound + IfThenElseZero(torn, Set(d, 1e9f));
#if HWY_TARGET <= HWY_AVX3
  if (AllTrue(d, Or(rays.notes.seen, Not(wanted)))) return add_side_by_side(packet, slab, rays);
#endif
  for (const Piece& piece : slab.pieces)
    add_any(packet.lookup, frame, piece, rays.light, rays.notes, rays.counts.samples);
}

/// Processes a slab, or a part of a slab, whose lanes are in several intervals or cross knots. Adds the lanes that can
/// be integrated as a line, and returns the others. `length` is that of the lanes in the slab; `begin` is in slabs from
/// the chunk's first slab.
template <class Lookup>
HWY_NOINLINE MF cast_mixed(const PacketView<Lookup>& packet, const Line& line, MF there, VF begin, VF length,
                           RayState& rays) {
  const FrameView& frame = packet.frame;
  const Lookup& lookup = packet.lookup;
  Progress& progress = rays.light;
  RayNotes& notes = rays.notes;
  const DF d;
  const VF zero = Zero(d);
  const VF spread = length * line.rho * MulAdd(Abs(line.span), Set(d, 0.25f), line.rho);
  const VF low = Min(line.s_0, line.s_1) - line.rho, high = Max(line.s_0, line.s_1) + line.rho;
  const VI interval = lookup.locate(low, zero == zero);
  const auto index = lookup.index(interval, there);
  packet.current.move_to(
      static_cast<std::size_t>(GetLane(MaxOfLanes(DI(), IfThenElseZero(RebindMask(DI(), there), interval)))));
  const VF edge = lookup.edge(interval, index, Set(DI(), 1));
  const FunctionSlopes slope = slopes_in(lookup, index);
  const VF scale = slope.extinction * Set(d, 1 / frame.piece_tolerance) *
                   MulAdd(length * slope.extinction, Set(d, 0.03f * frame.largest_color), slope.color);
  const VF extinction = Max(extinction_at(lookup, index, low), extinction_at(lookup, index, high));
  const VF dimming = length * extinction * (lookup.independent ? length : length * extinction);
  const VF dimmed = dimming * slope.color * (line.rho * Set(d, 1 / (9 * frame.piece_tolerance)));
  MF together = And(And(there, high < edge), MulAdd(spread, scale, dimmed) <= Set(d, 1.0f));
  if (frame.error_bound != nullptr && !frame.error_bound->step.empty()) {
    // Lanes that may touch a step are examined as cubics.
    const VF noise = Set(d, frame.error_bound->noise), low_edge = lookup.edge(interval, index, Zero(DI()));
    const MF above = low - low_edge >= noise;
    together = And(together, And(above, edge - high >= noise));
  }
  if (!AllFalse(d, together)) {
    const auto kept = [&](VF v) HWY_ATTR { return IfThenElseZero(together, v); };
    const VF before = progress.transmittance;
    const CL::lanes::LinearPiece piece{kept(line.s_0 + line.shift), kept(line.s_1 + line.shift), kept(line.span),
                                       kept(length)};
    CL::lanes::add_piece<false>(lookup, index, piece, progress);
    rays.counts.samples += CountTrue(d, together);
    note_first_light(progress, begin, notes);
    if (frame.error_bound != nullptr)
      note_ramps(IntervalLanes<Lookup>{lookup, index, interval, together, frame.error_bound}, kept(length), before,
                 progress.transmittance, notes);
  }
  return AndNot(together, there);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
