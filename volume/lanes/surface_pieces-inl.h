// SPDX-License-Identifier: BSD-3-Clause
// Casts rays through a slab voxel by voxel where they may meet iso-surfaces. Included once per instruction set
// (Highway's include guard idiom).
//
// What      The light of lanes whose field may reach a surface's value in a slab: that of the volume between the
//           surfaces they meet, that of the surfaces, and bounds of the errors of both.
// How       In a voxel the field along the ray is a cubic, which is monotonic between its extrema. In between, a ray
//           meets surfaces in the order of their values: it leaves the gap between two values when the field reaches
//           the upper value or falls below the lower one. The light up to that position is integrated as in
//           ray_piece-inl.h, then the surface's light is added.
//
//             upper value  ------------*------     * the ray meets the surface and enters the next gap
//                                   . '
//             field         . - - '                  the volume's light up to * is added before the surface's
//
//             lower value  -------------------
//
//           A crossing is first found by Newton's method on the cubic (ray_cubic-inl.h), then refined in differences of
//           the field from the value.
// Accuracy  Because of these differences, the error of a position is relative to the field's variation in the voxel.
//           Errors of positions and normals are recorded as independent rounding errors, like those of ramps
//           (piece_errors-inl.h). It is uncertain whether, or in which of two voxels, a ray meets a surface if the
//           field is near its value at an extremum, in a face of a voxel or at a ray's end. These rays are cast again
//           in double precision (SurfaceWalk). Level faces, whose four corners have exactly the value (frequent with
//           integer samples), are not uncertain: where lanes and value are exact, the field equals the value there, and
//           hence is not below it.
// Bits      Results depend on a packet's rays and the chunk alone, as in cast_slabs-inl.h.
// Ends      Voxels with NaN (blank) samples have no surfaces and add no light.

#if defined(TESSERA_VOLUME_SURFACE_PIECES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_SURFACE_PIECES_INL_H_
#undef TESSERA_VOLUME_SURFACE_PIECES_INL_H_
#else
#define TESSERA_VOLUME_SURFACE_PIECES_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "volume/lanes/current_interval-inl.h"
#include "volume/lanes/lane_surfaces-inl.h"
#include "volume/lanes/packet_lanes-inl.h"
#include "volume/lanes/shading-inl.h"
#include "volume/lanes/voxel_pieces-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// Error of a ray's position in voxels: an upper bound, and a bound that holds for most rays.
constexpr float place_off = 2e-6f, place_mostly_off = 5e-7f;

/// The range of a voxel's corners, and their largest magnitude.
struct CornerRange {
  VF width, largest;

  explicit HWY_INLINE CornerRange(const Corners& s) {
    const auto low = [](VF a, VF b) HWY_ATTR { return Min(a, b); };
    const auto high = [](VF a, VF b) HWY_ATTR { return Max(a, b); };
    const VF least = low(low(low(s.a00, s.a10), low(s.a01, s.a11)), low(low(s.b00, s.b10), low(s.b01, s.b11))),
             most = high(high(high(s.a00, s.a10), high(s.a01, s.a11)), high(high(s.b00, s.b10), high(s.b01, s.b11)));
    width = most - least;
    largest = Max(Abs(least), Abs(most));
  }
};

/// A stretch of each lane in one voxel.
struct VoxelStretch {
  VoxelField field;
  Corners corners;
  VF begin, extent;  ///< position and extent in the slab
  Piece piece;
  Cubic cubic;
  // The slab's path, the stretch in it, and the rounding errors of the slab's samples.
  const SlabPath& path;
  const Stretch& place;
  const RestOfSamples& rest;
};

/// Casts the lanes of a packet that may meet surfaces.
template <class Lookup>
class SurfaceCast {
 public:
  HWY_INLINE SurfaceCast(const PacketView<Lookup>& packet, LaneSurfaces& surfaces, RayState& rays)
      : frame_(packet.frame),
        view_(*packet.frame.surfaces),
        axes_(packet.axes),
        lookup_(packet.lookup),
        lanes_(packet.lanes),
        current_(packet.current),
        surfaces_(surfaces),
        progress_(rays.light),
        notes_(rays.notes),
        counts_(rays.counts),
        per_length_(Set(DF(), static_cast<float>(view_.unit / frame_.length_unit)) / lanes_.length) {}

  /// Casts the `wanted` lanes through a slab.
  template <class Window>
  HWY_NOINLINE void cast(const SlabPath& path, const Window& window, const RestOfSamples& rest, MF wanted) {
    const DF d;
    const VF half = Set(d, 0.5f), zero = Zero(d), one = Set(d, 1.0f);
    for (const Stretch& s : path.stretches) {
      const VF extent = s.end - s.begin;
      const MF there = And(wanted, extent > zero);
      if (AllFalse(d, there)) continue;
      const Corners corners = window.corners(window_index(window, path, s));
      VoxelStretch stretch{
          VoxelField(corners, path.x - s.i, path.y - s.j), corners, s.begin, extent, {}, {}, path, s, rest};
      const VoxelField& field = stretch.field;
      Piece& piece = stretch.piece;
      piece.s_0 = field.at(s.begin, lanes_);
      piece.s_mid = field.at(half * (s.begin + s.end), lanes_);
      piece.s_1 = field.at(s.end, lanes_);
      piece.p_3 = field.cij * lanes_.bends * (extent * (extent * extent));
      piece.length = IfThenElseZero(there, extent * lanes_.length);
      piece.begin = s.begin + path.k;
      piece.extent = extent;
      const MF whole = And(there, piece.s_mid == piece.s_mid);
      stretch.cubic = cubic_of(piece, whole);
      const VF bump = bump_of(piece.s_0, piece.s_mid, piece.s_1, piece.p_3);
      const VF low = Min(piece.s_0, piece.s_1) - bump, high = Max(piece.s_0, piece.s_1) + bump;
      if (surfaces_.none_between(low, high, whole))
        add_light(stretch, zero, one, piece.s_0, piece.s_1, whole);
      else
        walk(stretch, whole);
    }
  }

 private:
  /// For each lane, the gap between two values that contains the lane's field.
  struct Gap {
    VI number;
    VF low, high;
  };
  HWY_INLINE Gap gap(VI number) const {
    return {number, surface_row(view_, view_.edge, number), surface_row(view_, view_.edge, number + Set(DI(), 1))};
  }

  /// Returns lanes whose field `s` is within the noise of a value that bounds the gap.
  static HWY_INLINE MF touches(const Gap& in, VF s, VF noise, MF lanes) {
    return And(lanes, Or(Abs(s - in.low) < noise, Abs(in.high - s) < noise));
  }

  /// Lanes for which a stretch begins or ends in a level face (see Accuracy above), and the axes across that face.
  struct LevelSide {
    MF any, across_i, across_j;
  };
  /// Finds the level faces at the end u of a stretch, for lanes that are near a value there, and sets the field `s` of
  /// these lanes to the exact value.
  HWY_NOINLINE LevelSide level_side(const VoxelStretch& stretch, const Gap& in, VF u, MF near, VF& s) const {
    const DF d;
    const DI di;
    const VF zero = Zero(d), one = Set(d, 1.0f);
    const MF upper = Abs(in.high - s) < Abs(s - in.low);
    const VF level = IfThenElse(upper, in.high, in.low);
    const VI edge = in.number + IfThenElseZero(RebindMask(di, upper), Set(di, 1));
    const MF exact = And(near, surface_row(view_, view_.exact, edge) > zero);
    const Corners& c = stretch.corners;
    const auto all = [&](VF a, VF b, VF e, VF f)
                         HWY_ATTR { return And(And(a == level, b == level), And(e == level, f == level)); };
    const VF off = Set(d, place_off);
    const auto across = [&](VF place, MF low, MF high) HWY_ATTR {
      return And(exact, Or(And(Abs(place) < off, low), And(Abs(place - one) < off, high)));
    };
    LevelSide side;
    side.across_i =
        across(MulAdd(u, lanes_.bx, stretch.field.x), all(c.a00, c.a01, c.b00, c.b01), all(c.a10, c.a11, c.b10, c.b11));
    side.across_j =
        across(MulAdd(u, lanes_.by, stretch.field.y), all(c.a00, c.a10, c.b00, c.b10), all(c.a01, c.a11, c.b01, c.b11));
    const MF across_k =
        And(exact, Or(And(u <= zero, all(c.a00, c.a10, c.a01, c.a11)), And(u >= one, all(c.b00, c.b10, c.b01, c.b11))));
    side.any = Or(across_k, Or(side.across_i, side.across_j));
    s = IfThenElse(side.any, level, s);
    return side;
  }

  HWY_NOINLINE void walk(const VoxelStretch& stretch, MF whole) {
    const DF d;
    const DI di;
    const VF zero = Zero(d), one = Set(d, 1.0f);
    const Cubic& c = stretch.cubic;
    const CornerRange range(stretch.corners);
    const VF noise = MulAdd(Set(d, place_off), range.width, Set(d, 0x1p-22f) * range.largest);
    const MF none = zero != zero;
    LevelSide front{none, none, none}, back = front;
    VF s_0 = c.p_0, s_1 = IfThenElseZero(whole, stretch.piece.s_1);
    const Turns turns(c, whole);
    Gap in = gap(surface_gap(view_, s_0));
    if (const MF near = touches(in, s_0, noise, whole); HWY_UNLIKELY(!AllFalse(d, near))) {
      if (view_.any_exact) front = level_side(stretch, in, stretch.begin, near, s_0);
      in = gap(surface_gap(view_, s_0));
      note(AndNot(front.any, near));
    }
    VF v = zero, s = s_0, lit = zero, s_lit = s_0;  // light has been added up to `lit`
    MF going = whole;
    // Each round ends at a surface, an extremum or the stretch's end.
    for (int round = 0; round < 4096; ++round) {
      const VF turn = turns.after(v);
      const MF last = turn == one;
      VF s_turn = IfThenElse(last, s_1, c.at(turn));
      if (const MF near = touches(in, s_turn, noise, going); HWY_UNLIKELY(!AllFalse(d, near))) {
        const MF at_back = And(near, last);
        if (view_.any_exact && !AllFalse(d, at_back)) {
          add_level(level_side(stretch, in, stretch.begin + stretch.extent, at_back, s_1), back);
          s_turn = IfThenElse(last, s_1, s_turn);
        }
        // This is recorded before the surface is added, because the surface may hide the part behind it.
        note(AndNot(And(last, back.any), near));
      }
      const MF up = s_turn >= s;
      const MF crosses = And(going, Or(And(up, s_turn >= in.high), AndNot(up, s_turn < in.low)));
      if (!AllFalse(d, crosses)) {
        const VF level = IfThenElse(up, in.high, in.low);
        const VI upward = IfThenElseZero(RebindMask(di, up), Set(di, 1)), edge = in.number + upward;
        const VF guess = IfThenElse(crosses, find_crossing(c, {v, s}, {turn, s_turn}, level, crosses), v);
        const Place place = place_of(stretch, v, turn, guess, level, surface_row(view_, view_.rest, edge));
        const VF at = IfThenElse(crosses, place.at, v);
        add_light(stretch, lit, at, s_lit, level, crosses);
        // A surface in a level face is met in this voxel, not in an adjacent one.
        const MF at_front = And(v == zero, level == s_0), at_back = And(last, level == s_1);
        const auto beside = [&](MF of_front, MF of_back) HWY_ATTR {
          return AndNot(Or(And(at_front, of_front), And(at_back, of_back)), crosses);
        };
        note_beside(stretch, place, beside(front.across_i, back.across_i), beside(front.across_j, back.across_j));
        add_surface(stretch, range, {place, edge, level, crosses});
        lit = IfThenElse(crosses, at, lit), s_lit = IfThenElse(crosses, level, s_lit);
        v = IfThenElse(crosses, at, v), s = IfThenElse(crosses, level, s);
        const VI number = edge + (upward - Set(di, 1));
        in = gap(IfThenElse(RebindMask(di, crosses), number, in.number));
      }
      const MF ends = AndNot(crosses, going);
      v = IfThenElse(ends, turn, v), s = IfThenElse(ends, s_turn, s);
      going = AndNot(And(ends, v >= one), going);
      if (AllFalse(d, going)) break;
    }
    note(going);
    add_light(stretch, lit, one, s_lit, s_1, whole);
  }

  static HWY_INLINE void add_level(const LevelSide& more, LevelSide& side) {
    side.any = Or(side.any, more.any);
    side.across_i = Or(side.across_i, more.across_i), side.across_j = Or(side.across_j, more.across_j);
  }

  /// Requests that these lanes are cast again, if they are visible, by adding their remaining light to the error bound.
  HWY_INLINE void note(MF unsure) {
    const VF seen = progress_.transmittance * Set(DF(), view_.brightest);
    notes_.error_bound = notes_.error_bound + IfThenElseZero(unsure, seen);
  }

  /// A position on the cubic and in the slab, and the field's gradient there.
  struct Place {
    VF at, u;
    Gradient gradient;
    VF slope;  ///< along the ray, per slab
  };

  /// Where lanes meet a surface.
  struct Hit {
    Place place;
    VI edge;   ///< index of the surface's value
    VF level;  ///< the value
    MF lanes;
  };

  /// Returns the position near `at`, between v and `turn`, where the field equals a surface's value, which is level +
  /// rest.
  HWY_INLINE Place place_of(const VoxelStretch& stretch, VF v, VF turn, VF at, VF level, VF rest) const {
    VoxelField from_level = stretch.field;
    from_level.a00 = from_level.a00 - level - rest;
    const VF low = MulAdd(v, stretch.extent, stretch.begin), high = MulAdd(turn, stretch.extent, stretch.begin);
    Place place;
    place.u = MulAdd(at, stretch.extent, stretch.begin);
    // find_crossing() uses values rounded to their level. Two Newton steps with differences from the exact value
    // correct this. The first position is accurate enough for the field's slopes; where the field is level the result
    // may be anywhere.
    for (int n = 0; n < 2; ++n) {
      const VF height = from_level.at(place.u, lanes_);
      place.gradient = from_level.gradient(place.u, lanes_);
      stretch.rest.add(stretch.path, stretch.place, lanes_, place.u, place.gradient);
      place.slope = place.gradient.along(lanes_);
      const VF next = place.u - height / place.slope;
      place.u = IfThenElse(And(next >= low, next <= high), next, place.u);
    }
    const VF in_stretch = (place.u - stretch.begin) / stretch.extent;
    place.at = Min(Max(in_stretch, v), turn);
    return place;
  }

  HWY_INLINE VF power_of(VF cosine) const {
    const DF d;
    if (HWY_UNLIKELY(view_.whole_shininess < 0)) {
      const VF c = Max(cosine, Set(d, 1e-30f));
      return Exp(d, Set(d, view_.shininess) * Log(d, c));
    }
    VF result = Set(d, 1.0f);
    for (int n = view_.whole_shininess; n > 0; n /= 2, cosine = cosine * cosine)
      if (n % 2 != 0) result = result * cosine;
    return result;
  }

  /// Returns squared lengths of world gradients, computed as products with the metric in the ray's axes.
  HWY_INLINE VF square_of(const Gradient& g) const {
    const float flip = axes_.mirrored ? -1.0f : 1.0f;
    const auto times = [&](VF v, int a, int b, float by)
                           HWY_ATTR { return v * Set(DF(), by * static_cast<float>(view_.metric[a][b])); };
    const VF m_i =
        times(g.i, axes_.i, axes_.i, 1) + (times(g.j, axes_.i, axes_.j, 2) + times(g.k, axes_.i, axes_.k, 2 * flip));
    const VF m_j = times(g.j, axes_.j, axes_.j, 1) + times(g.k, axes_.j, axes_.k, 2 * flip);
    return MulAdd(g.i, m_i, MulAdd(g.j, m_j, g.k * times(g.k, axes_.k, axes_.k, 1)));
  }

  HWY_INLINE void add_surface(const VoxelStretch& stretch, const CornerRange& range, const Hit& hit) {
    const DF d;
    const Place& place = hit.place;
    const VF zero = Zero(d), one = Set(d, 1.0f);
    const auto row = [&](const std::vector<float>& of) HWY_ATTR { return surface_row(view_, of, hit.edge); };
    const VF square = square_of(place.gradient);
    const MF flat = Not(square > zero);
    const VF steepness = Sqrt(IfThenElse(flat, one, square));
    const VF cosine = IfThenElse(flat, one, Min(one, Abs(place.slope) * per_length_ / steepness));
    const VF matte = MulAdd(Set(d, view_.diffuse), cosine, Set(d, view_.ambient)),
             shine = Set(d, view_.specular) * power_of(cosine);
    const VF before = progress_.transmittance;
    const VF hidden = IfThenElseZero(hit.lanes, before * row(view_.opacity));
    if (HWY_UNLIKELY(frame_.has_rest)) {
      const float turn = view_.diffuse + view_.specular * std::max(1.0f, view_.shininess);
      const float noise = frame_.rest_noise * turn *
                          static_cast<float>(std::sqrt(view_.metric[0][0] + view_.metric[1][1] + view_.metric[2][2]));
      const VF error = IfThenElseZero(Not(flat), Set(d, noise) / steepness);
      notes_.error_bound = MulAdd(hidden, error, notes_.error_bound);
    }
    const auto add = [&](const std::vector<float>& color, VF& sum)
                         HWY_ATTR { sum = MulAdd(hidden, MulAdd(row(color), matte, shine), sum); };
    add(view_.red, progress_.red);
    add(view_.green, progress_.green);
    add(view_.blue, progress_.blue);
    progress_.alpha = progress_.alpha + hidden;
    progress_.transmittance = before - hidden;
    if (HWY_UNLIKELY(!AllTrue(d, notes_.seen)))
      note_first_light(progress_, stretch.piece.begin - stretch.begin + place.u, notes_);
    note_surface(stretch, range, hit, steepness, hidden);
  }

  /// Requests that lanes are cast again if they meet a surface at the boundary to another voxel, where normals differ.
  /// Rays that keep_side() has moved off a plane are exempt.
  HWY_INLINE void note_beside(const VoxelStretch& stretch, const Place& place, MF beside_i, MF beside_j) {
    const DF d;
    const auto near = [&](VF at, VF slope) HWY_ATTR {
      const VF in = MulAdd(place.u, slope, at);
      const VF away = Min(Abs(in), Abs(Set(d, 1.0f) - in));
      return And(away < Set(d, place_off), slope != Zero(d));
    };
    note(Or(And(beside_i, near(stretch.field.x, lanes_.bx)), And(beside_j, near(stretch.field.y, lanes_.by))));
  }

  /// Records the errors of a surface: the error of its normal, and the error of matter in front of the surface that may
  /// actually be behind it. `steepness` is the gradient's length, `hidden` the light that the surface hides.
  HWY_INLINE void note_surface(const VoxelStretch& stretch, const CornerRange& range, const Hit& hit, VF steepness,
                               VF hidden) {
    const DF d;
    const Place& place = hit.place;
    const VoxelField& f = stretch.field;
    const VF fx = MulAdd(place.u, lanes_.bx, f.x), fy = MulAdd(place.u, lanes_.by, f.y);
    const VF bend = Abs(MulAdd(place.u, f.cij, f.aij)) + (Abs(MulAdd(fy, f.cij, f.ci)) + Abs(MulAdd(fx, f.cij, f.cj)));
    const VF aside = Set(d, place_mostly_off);
    const VF values = MulAdd(Set(d, 0x1p-24f), range.width, Set(d, view_.value_noise) * range.largest);
    const VF noise = MulAdd(aside, range.width, values);
    const VF per_slope = Set(d, 1.0f) / Max(Abs(place.slope), Set(d, 1e-30f));
    // The error of the initial position that remains after two steps of Newton's method.
    const VF guess = Set(d, 0x1p-22f) * range.largest * per_slope;
    const VF ratio = Min(guess * bend * per_slope, Set(d, 1.0f));
    const VF off = MulAdd(noise, per_slope, guess * (ratio * (ratio * ratio)));
    const VF tilt = MulAdd(bend, off + aside, values);
    const VF angle = Min(tilt * Set(d, view_.stretched) / steepness, Set(d, 4.0f));
    const VF error = IfThenElseZero(hit.lanes, hidden * angle * surface_row(view_, view_.angle_weight, hit.edge));
    notes_.rough = MulAdd(error, error, notes_.rough);
    if (HWY_UNLIKELY(frame_.error_bound != nullptr && frame_.error_bound->ends))
      note_matter(off, hit.level, hidden, hit.lanes);
  }

  HWY_NOINLINE void note_matter(VF off, VF level, VF hidden, MF crosses) {
    const DF d;
    const VF zero = Zero(d), scalar = IfThenElseZero(crosses, level);
    const VI interval = lookup_.locate(scalar, zero == zero);
    const auto index = lookup_.index(interval, crosses);
    const VF from = scalar - lookup_.at(LaneTable::base, index);
    VF sent = extinction_at(lookup_, index, scalar) * Set(d, view_.brightest);
    if (lookup_.independent)
      for (int c = 0; c < 3; ++c)
        sent = Max(sent, MulAdd(lookup_.at(LaneTable::red_slope + 2 * c, index), from,
                                lookup_.at(LaneTable::red + 2 * c, index)));
    const VF length = Min(off, Set(d, 1.0f)) * lanes_.length;
    const VF error = Min(length * sent, Set(d, view_.brightest));
    notes_.error_bound = MulAdd(error, hidden, notes_.error_bound);
  }

  /// Adds the light of the stretch between positions `a` and `b`, where the field is s_a and s_b.
  HWY_NOINLINE void add_light(const VoxelStretch& stretch, VF a, VF b, VF s_a, VF s_b, MF lanes) {
    const DF d;
    const VF half = Set(d, 0.5f), zero = Zero(d), one = Set(d, 1.0f);
    const VF extent = b - a, middle = half * (a + b);
    // Opaque lanes are finished, even if other lanes of the packet are not.
    const MF seen = progress_.transmittance >= Set(d, frame_.least_transmittance);
    const MF there = And(And(lanes, seen), extent > zero);
    if (AllFalse(d, there)) return;
    const auto kept = [&](VF v) HWY_ATTR { return IfThenElseZero(there, v); };
    const Piece piece{kept(s_a),
                      kept(stretch.cubic.at(middle)),
                      kept(s_b),
                      kept(stretch.cubic.p_3 * (extent * (extent * extent))),
                      kept(extent * stretch.piece.length),
                      MulAdd(a, stretch.piece.extent, stretch.piece.begin),
                      extent * stretch.piece.extent};
    const bool lit_part = frame_.shading != nullptr;
    Progress part{zero, one, zero, zero, zero, zero};
    Progress& target = lit_part ? part : progress_;
    const VF before = progress_.transmittance, through = lit_part ? before : one;
    const VF bump = bump_of(piece.s_0, piece.s_mid, piece.s_1, piece.p_3);
    const VF low = Min(piece.s_0, piece.s_1) - bump, high = Max(piece.s_0, piece.s_1) + bump;
    const UniformLookup& uniform = current_.uniform();
    const bool in_one = current_.around(low, high, there);
    if (in_one && current_.clear()) return;
    if (in_one && add_uniform<false>(uniform, piece, target)) {
      counts_.samples += CountTrue(d, there);
      if (HWY_UNLIKELY(!AllTrue(d, notes_.seen))) note_first_light(target, piece.begin, notes_);
      if (HWY_UNLIKELY(uniform.ramp > 0))
        note_ramps(uniform, piece.length, before, through * target.transmittance, notes_);
    } else {
      const VF error_bound = notes_.error_bound, rough = notes_.rough;
      notes_.error_bound = notes_.rough = zero;
      add_any(lookup_, frame_, piece, target, notes_, counts_.samples);
      notes_.error_bound = MulAdd(through, notes_.error_bound, error_bound);
      notes_.rough = MulAdd(through * through, notes_.rough, rough);
    }
    if (lit_part && !AllFalse(d, part.alpha > zero)) put_lit(stretch, middle, there, part, piece.begin);
  }

  HWY_NOINLINE void put_lit(const VoxelStretch& stretch, VF middle, MF there, const Progress& part, VF begin) {
    const VF u = MulAdd(middle, stretch.extent, stretch.begin);
    Gradient gradient = stretch.field.gradient(u, lanes_);
    stretch.rest.add(stretch.path, stretch.place, lanes_, u, gradient);
    gradient = gradient.kept(there);
    const Lit lit = shade(frame_, axes_, gradient, gradient.along(lanes_) * per_length_, lanes_.light_view);
    notes_.error_bound = MulAdd(progress_.transmittance * part.alpha, lit.error, notes_.error_bound);
    put_behind(part, lit, progress_);
    note_first_light(progress_, begin, notes_);
  }

  const FrameView& frame_;
  const SurfaceView& view_;
  const RayAxes& axes_;
  const Lookup& lookup_;
  const Lanes& lanes_;
  const CurrentInterval& current_;
  LaneSurfaces& surfaces_;
  Progress& progress_;
  RayNotes& notes_;
  TileCounts& counts_;
  VF per_length_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
