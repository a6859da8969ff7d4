// SPDX-License-Identifier: BSD-3-Clause
// Casts packets of rays through one chunk of 32 slabs by exact integrals. Included once per instruction set (Highway's
// include guard idiom).
//
// What      The light that each ray accumulates in the chunk, composited behind its previous light (TileRays), and a
//           bound of its error.
// How       Slabs are processed in groups of eight. First the field in the slabs that every live ray crosses from plane
//           to plane is found as lines (slab_lines-inl.h), each slab independently. Then their light is added front to
//           back. This order lets the processor overlap slabs. Where the field is smooth, one line represents two
//           slabs. Slabs in which rays begin or end, shaded slabs and cell data are cast voxel by voxel
//           (voxel_pieces-inl.h), and so are lanes whose field may meet the value of a surface (surface_pieces-inl.h).
// Accuracy  A line represents a slab if the bound of ray_piece-inl.h for the field's distance from the line is below
//           the tolerance of a piece; a Bend adds the effect of that distance to first order.
// Bits      Results depend on a packet's rays and the chunk alone: lanes of a vector are integrated together, and the
//           vectors of a packet share the current interval. Therefore they differ between instruction sets.
// Ends      Opaque lanes are removed every four slabs.

#if defined(TESSERA_VOLUME_CAST_SLABS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_CAST_SLABS_INL_H_
#undef TESSERA_VOLUME_CAST_SLABS_INL_H_
#else
#define TESSERA_VOLUME_CAST_SLABS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "volume/lanes/packet_slabs-inl.h"
#include "volume/lanes/slab_lines-inl.h"
#include "volume/lanes/surface_pieces-inl.h"
#include "volume/lanes/voxel_pieces-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// The inputs and outputs of casting the packets of a tile.
template <class Lookup>
struct TileCast {
  const ChunkView& chunk;
  const Lookup& lookup;
  CurrentInterval& current;
  TileRays& rays;
  TileCounts& counts;
};

/// Casts one packet, or some of its lanes, through a chunk.
template <bool cell_data, class Surfaces, class Window, class Lookup>
class PacketCast {
 public:
  /// `before` is the transmittance in front of the chunk; `seen` marks lanes whose light has begun.
  HWY_INLINE PacketCast(const TileCast<Lookup>& tile, const PacketSlabs& slabs, const Lanes& lanes, VF before, MF seen)
      : chunk_(tile.chunk),
        frame_(tile.chunk.frame),
        slabs_(slabs),
        lanes_(lanes),
        mirrored_(lanes, std::is_same_v<Window, GatherWindow> ? static_cast<int>(chunk_.block.pitch) : Window::columns),
        current_(tile.current),
        packet_{frame_, chunk_.axes, tile.lookup, lanes_, current_},
        rays_{start(), {Set(DF(), -1.0f), seen, Zero(DF()), Zero(DF())}, tile.counts},
        surfaces_(frame_),
        before_(before),
        has_steps_(frame_.error_bound != nullptr && !frame_.error_bound->step.empty()),
        crossings_(Zero(DF())) {
    find_ends();
  }
  PacketCast(const PacketCast&) = delete;  // packet_ refers to lanes_
  PacketCast& operator=(const PacketCast&) = delete;

  [[nodiscard]] HWY_INLINE const RayState& rays() const { return rays_; }

  HWY_INLINE void run(const Reach& reach) {
    const DF d;
    const bool tallies = frame_.tally != nullptr;
    GroupWork work{};
    for (int n = 0; n < chunk_.box.slabs; n += SlabLines::most) {
      if (HWY_UNLIKELY(tallies)) {
        if (n > 0) work.add_to(chunk_, lanes_, reach, n, rays_.light, rays_.counts);
        work = {n, lanes_.k_out, rays_.light.optical_depth, rays_.counts.samples};
      }
      if (!go_on(n)) break;
      if (frame_.some_hidden && !any_visible_ahead(n)) continue;
      group(n, std::min(n + SlabLines::most, chunk_.box.slabs));
    }
    if (HWY_UNLIKELY(tallies)) work.add_to(chunk_, lanes_, reach, chunk_.box.slabs, rays_.light, rays_.counts);
    rays_.counts.voxels_visited += static_cast<std::uint64_t>(GetLane(SumOfLanes(d, crossings_)));
  }

 private:
  static HWY_INLINE Progress start() {
    const VF zero = Zero(DF());
    return {zero, Set(DF(), 1.0f), zero, zero, zero, zero};
  }

  /// Finds the slabs that all live lanes cross from plane to plane: [plain_from_, plain_to_).
  HWY_INLINE void find_ends() {
    const DF d;
    mirrored_.live = lanes_.k_in < lanes_.k_out;
    all_live_ = AllTrue(d, mirrored_.live);
    live_count_ = CountTrue(d, mirrored_.live);
    plain_from_ = GetLane(MaxOfLanes(d, IfThenElse(mirrored_.live, lanes_.k_in, Set(d, -1.0f))));
    plain_to_ = GetLane(MinOfLanes(d, IfThenElse(mirrored_.live, lanes_.k_out, Set(d, 64.0f))));
  }

  /// Ends opaque rays. Returns false if all rays are opaque or have left the volume.
  HWY_INLINE bool go_on(int n) {
    const DF d;
    const MF dark = And(mirrored_.live, before_ * rays_.light.transmittance < Set(d, frame_.least_transmittance));
    if (!AllFalse(d, dark)) {
      lanes_.k_out = IfThenElse(dark, Set(d, -1.0f), lanes_.k_out);
      find_ends();
    }
    return !AllFalse(d, And(mirrored_.live, lanes_.k_out > Set(d, static_cast<float>(n))));
  }

  /// Whether the eight slabs from n on may meet a visible cell.
  HWY_INLINE bool any_visible_ahead(int n) const {
    const int m = n + SlabLines::most - 1;
    const std::int64_t end_k = frame_.voxels[static_cast<std::size_t>(chunk_.axes.k)];
    const std::int64_t k_first = chunk_.box.first_k + n, k_last = std::min(chunk_.box.first_k + m, end_k - 1);
    std::int64_t low[3], high[3];
    low[chunk_.axes.i] = std::min(slabs_.i_first[n], slabs_.i_first[m]);
    high[chunk_.axes.i] = std::max(slabs_.i_last[n], slabs_.i_last[m]);
    low[chunk_.axes.j] = std::min(slabs_.j_first[n], slabs_.j_first[m]);
    high[chunk_.axes.j] = std::max(slabs_.j_last[n], slabs_.j_last[m]);
    low[chunk_.axes.k] = chunk_.axes.mirrored ? end_k - 1 - k_last : k_first;
    high[chunk_.axes.k] = chunk_.axes.mirrored ? end_k - 1 - k_first : k_last;
    return any_visible(frame_, low, high);
  }

  HWY_INLINE WindowPlace place_of(int n) const {
    const float* const samples = chunk_.block.slice(0);
    const float* const front = samples + slabs_.front[n];
    return {front, cell_data ? front : samples + slabs_.back[n], slabs_.origin[n], chunk_.block.pitch,
            slabs_.border[n] == 0};
  }

  /// Returns the lanes that are in slab n.
  HWY_INLINE MF here(int n) const {
    const DF d;
    return And(mirrored_.live,
               And(lanes_.k_out > Set(d, static_cast<float>(n)), lanes_.k_in < Set(d, static_cast<float>(n + 1))));
  }

  enum class Kind { empty, lines, parts };

  HWY_INLINE Kind kind_of(int n) const {
    const DF d;
    const auto from = static_cast<float>(n), to = static_cast<float>(n + 1);
    const bool by_lines = !cell_data && frame_.shading == nullptr;
    if (HWY_LIKELY(plain_from_ <= from && to <= plain_to_)) return by_lines ? Kind::lines : Kind::parts;
    const MF some = here(n);
    if (AllFalse(d, some)) return Kind::empty;
    const MF whole = And(lanes_.k_in <= Set(d, from), lanes_.k_out >= Set(d, to));
    return by_lines && AllFalse(d, AndNot(whole, some)) ? Kind::lines : Kind::parts;
  }

  HWY_INLINE void group(int begin, int end) {
    SlabLines lines;
    lines.first = begin;
    Kind kinds[SlabLines::most + 1];
    for (int n = begin; n < end; ++n) {
      Kind& kind = kinds[n - begin];
      kind = kind_of(n);
      if (kind != Kind::lines) continue;
      if constexpr (!cell_data) {
        const WindowPlace place = place_of(n);
        const Window window(place.front, place.back, chunk_.block.pitch);
        if (frame_.some_clear && current_.holds(window, *place.front) && current_.clear() &&
            surfaces_.none_in(window, *place.front)) {
          kind = Kind::empty;
          continue;
        }
        // A gather reads at every lane's position; only lanes that cross this slab are certainly in the block.
        MirroredLanes gathered = mirrored_;
        if (std::is_same_v<Window, GatherWindow>) gathered.live = here(n);
        const MirroredLanes& found = std::is_same_v<Window, GatherWindow> ? gathered : mirrored_;
        find_line(found, window, place, n, lines, crossings_);
        if (n + 1 == end || kind_of(n + 1) != Kind::lines || frame_.some_clear)
          find_back(found, window, place, n, lines);
      }
    }
    kinds[end - begin] = Kind::empty;
    for (int n = begin; n < end;) {
      const int m = n - begin;
      if (n == begin + SlabLines::most / 2 && !go_on(n)) return;
      if (kinds[m] == Kind::lines) {
        if constexpr (!cell_data) n += add_lines(lines, n, kinds[m + 1] == Kind::lines && m % 2 == 0);
      } else {
        if (kinds[m] == Kind::parts) add_parts(n);
        ++n;
      }
    }
  }

  /// Adds two slabs as one line from front to back. The field deviates from the line by a tent, whose height is the
  /// difference between the field at the back of `a` and the middle of the line, and in addition by at most r:
  ///
  ///          . a.s_1                    tent = a.s_1 - (a.s_0 + b.s_1) / 2
  ///        .   .                        r    = deviations of a and b from their own lines
  ///      .       . b.s_1
  ///    .   . - '
  ///   a.s_0
  ///
  /// The tent is even about the middle, so its product with the slope of the line vanishes, and only the product of r
  /// with the slope remains. Returns false, and adds nothing, if the remaining error may be too large.
  HWY_INLINE bool add_pair(const Line& a, const Line& b, int n) {
    const DF d;
    const VF half = Set(d, 0.5f);
    const UniformLookup& table = current_.uniform();
    // NaN where either slab's field is NaN, because Max alone may drop NaN.
    const VF r = MulAdd(Zero(d), a.rho + b.rho, Max(a.rho, b.rho));
    const VF low = Min(Min(a.s_0, a.s_1), b.s_1) - r, high = Max(Max(a.s_0, a.s_1), b.s_1) + r;
    if (HWY_UNLIKELY(!current_.around(low, high, mirrored_.live)) || !surfaces_.none_between(low, high, mirrored_.live))
      return false;
    if (current_.clear()) return true;
    const VF length = lanes_.length + lanes_.length, span = b.s_1 - a.s_0;
    const VF tent = a.s_1 - half * (a.s_0 + b.s_1);
    const VF rho = Abs(tent) + r, tilt = Abs(span) * Set(d, 0.25f);
    const VF product = MulAdd(rho, rho, r * tilt), shadow = rho * (rho + tilt);
    const VF dimmed = length * Set(d, table.dimming_bound) *
                      MulAdd(Abs(tent) * (length * Set(d, table.extinction)), Set(d, 1 / 60.0f), r * Set(d, 0.25f));
    const VF error = MulAdd(
        length, dimmed,
        length * MulAdd(Set(d, 10 * table.product_bound), product, length * Set(d, table.shadow_bound) * shadow));
    if (!AllTrue(d, error <= Set(d, 1.0f))) return false;
    add_uniform_line(a.s_0, b.s_1, span, half * (tent + (a.shift + b.shift)), length, n);
    return true;
  }

  /// Adds slab n, or slabs n and n + 1 if `two` is set and one line can represent both. Returns their number.
  HWY_INLINE int add_lines(const SlabLines& lines, int n, bool two) {
    const DF d;
    const int m = n - lines.first;
    const bool plain = all_live_ && plain_from_ <= static_cast<float>(n) && static_cast<float>(n + 2) <= plain_to_;
    Line a = line_of(lines, m);
    if (two && plain && add_pair(a, line_of(lines, m + 1), n)) return 2;
    const UniformLookup& table = current_.uniform();
    VF length = lanes_.length;
    MF live = mirrored_.live;
    if (!plain) {
      live = here(n);
      a = a.kept(live);
      length = IfThenElseZero(live, length);
    }
    const VF low = Min(a.s_0, a.s_1) - a.rho, high = Max(a.s_0, a.s_1) + a.rho;
    if constexpr (has_surfaces) {
      if (HWY_UNLIKELY(!surfaces_.none_between(low, high, live))) {
        live = add_met(n, low, high, live);
        if (AllFalse(d, live)) return 1;
        a = a.kept(live);
        length = IfThenElseZero(live, length);
      }
    }
    const bool uniform = current_.around(low, high, live) || (has_steps_ && on_one_side(n));
    if (HWY_LIKELY(uniform)) {
      if (current_.clear()) return 1;
      const VF scale = MulAdd(length, Set(d, table.shadow_bound), Set(d, 10 * table.product_bound));
      if (HWY_LIKELY(AllFalse(d, MulAdd(spread_of(a, length), scale, dimming_of(a, length)) > Set(d, 1.0f)))) {
        add_uniform_line(a.s_0, a.s_1, a.span, a.shift, length, n);
        return 1;
      }
      if (!table.independent && add_bent_line(lines, a, n, live, length)) return 1;
    }
    add_slowly(lines, a, n, live, length);
    return 1;
  }

  /// Whether all samples that lanes may meet in slab n are certainly in one interval, which then becomes the current
  /// interval. The field is then in this interval, too, even if rounding may place it beyond a step.
  HWY_NOINLINE bool on_one_side(int n) {
    const auto all_held = [&] {
      const int corner = cell_data ? 0 : 1;
      for (int slice = n; slice <= n + corner; ++slice)
        for (int j = slabs_.j_first[n]; j <= slabs_.j_last[n] + corner; ++j) {
          const float* const row = chunk_.block.at(slice, slabs_.i_first[n], j);
          for (int i = 0; i <= slabs_.i_last[n] + corner - slabs_.i_first[n]; ++i)
            if (!current_.holds(row[i])) return false;
        }
      return true;
    };
    if (all_held()) return true;
    const float some = *chunk_.block.at(n, slabs_.i_first[n], slabs_.j_first[n]);
    if (!(some == some)) return false;
    current_.move_to(current_.interval_of(some));
    return all_held();
  }

  /// Bound of the field's deviation from the line in products of its changes over a slab.
  static HWY_INLINE VF spread_of(const Line& line, VF length) {
    return length * line.rho * MulAdd(Abs(line.span), Set(DF(), 0.25f), line.rho);
  }
  /// The front of a slab attenuates its back. Returns a bound of the deviation's effect on this, in tolerances.
  HWY_INLINE VF dimming_of(const Line& line, VF length) const {
    return length * Set(DF(), current_.uniform().dimming_bound / 9) * (length * line.rho);
  }

  /// Adds a slab that is too rough for a line. Its light is that of a line plus the effect of the field's bend, to
  /// first order in the slab's optical depth. Where extinction k and colour c are linear in the field, light increases
  /// by k' c' times the product of the deviations, and decreases by c' k^2 times their covariance with the position,
  /// since the front attenuates the back. Returns false and adds nothing if the remaining error may be too large.
  HWY_INLINE bool add_bent_line(const SlabLines& lines, const Line& line, int n, MF live, VF length) {
    const DF d;
    const UniformLookup& table = current_.uniform();
    const VF spread = spread_of(line, length), dimmed = dimming_of(line, length);
    const Bend found = bend_of(lines, n - lines.first, line);
    const auto kept = [&](VF v) HWY_ATTR { return IfThenElseZero(live, v); };
    const VF product = kept(found.product), covariance = kept(found.covariance), odd = kept(found.odd);
    const VF depth = length * Set(d, table.extinction), span = Abs(line.span);
    const VF beside_odd = MulAdd(Set(d, 0.5f), span, MulAdd(Set(d, 2.0f), line.rho, odd));
    const VF next_order = MulAdd(line.rho * Set(d, 1 / 9.0f), span + line.rho, Abs(product));
    const VF products = length * Set(d, 10 * table.product_bound) * MulAdd(odd, beside_odd, depth * next_order);
    const VF shadows = length * Set(d, table.shadow_bound) * spread;
    if (!AllFalse(d, MulAdd(dimmed, depth, products + shadows) > Set(d, 1.0f))) return false;
    const float slope = 2 * table.row[LaneTable::half_extinction_slope];
    const VF middle = MulAdd(Set(d, 0.5f), line.span, line.s_0 - Set(d, table.row[LaneTable::base]));
    const VF here = length * MulAdd(Set(d, slope), middle, Set(d, 2 * table.row[LaneTable::half_extinction]));
    const VF more = NegMulAdd(here * here, covariance, length * Set(d, slope) * product);
    const VF seen = rays_.light.transmittance * more;
    rays_.light.red = MulAdd(seen, Set(d, table.row[LaneTable::red_slope]), rays_.light.red);
    rays_.light.green = MulAdd(seen, Set(d, table.row[LaneTable::green_slope]), rays_.light.green);
    rays_.light.blue = MulAdd(seen, Set(d, table.row[LaneTable::blue_slope]), rays_.light.blue);
    add_uniform_line(line.s_0, line.s_1, line.span, line.shift, length, n);
    return true;
  }

  HWY_INLINE void add_uniform_line(VF s_0, VF s_1, VF span, VF shift, VF length, int n) {
    const DF d;
    const VF before = rays_.light.transmittance;
    CL::lanes::add_piece<false>(current_.uniform(), 0, {s_0 + shift, s_1 + shift, span, length}, rays_.light);
    rays_.counts.samples += live_count_;
    if (HWY_UNLIKELY(!AllTrue(d, rays_.notes.seen)))
      note_first_light(rays_.light, Set(d, static_cast<float>(n)), rays_.notes);
    if (HWY_UNLIKELY(current_.uniform().ramp > 0))
      note_ramps(current_.uniform(), length, before, rays_.light.transmittance, rays_.notes);
  }

  /// Adds a slab that crosses knots or is too rough for a line.
  HWY_NOINLINE void add_slowly(const SlabLines& lines, const Line& line, int n, MF live, VF length) {
    const MF apart = cast_mixed(packet_, line, live, Set(DF(), static_cast<float>(n)), length, rays_);
    if (!AllFalse(DF(), apart)) cast_stretches(packet_, lines, n, apart, rays_);
  }

  /// Adds the lanes that may meet surfaces in slab n, with their field in [low, high]. Returns the other lanes.
  HWY_NOINLINE MF add_met(int n, VF low, VF high, MF live) {
    const MF met = surfaces_.met(low, high, live);
    const WindowPlace place = place_of(n);
    const Window window(place.front, place.back, chunk_.block.pitch);
    add_surfaces(path_of(lanes_, n, slabs_.i_window[n], slabs_.j_window[n]), window, rest_at(place), met);
    return AndNot(met, live);
  }
  HWY_INLINE RestOfSamples rest_at(const WindowPlace& place) const { return {chunk_.block, place.front, place.back}; }
  HWY_INLINE void add_surfaces(const SlabPath& path, const Window& window, const RestOfSamples& rest, MF lanes) {
    SurfaceCast<Lookup>(packet_, surfaces_, rays_).cast(path, window, rest, lanes);
  }

  /// Adds a slab in which lanes begin or end, a slab of cell data, or a shaded slab.
  HWY_NOINLINE void add_parts(int n) {
    const DF d;
    const WindowPlace place = place_of(n);
    const Window window(place.front, place.back, chunk_.block.pitch);
    const bool uniform =
        current_.holds(window, *place.front) || (has_steps_ && std::is_same_v<Window, GatherWindow> && on_one_side(n));
    const bool meets_none = surfaces_.none_in(window, *place.front);
    if (uniform && current_.clear() && meets_none) return;
    const SlabPath path = path_of(lanes_, n, slabs_.i_window[n], slabs_.j_window[n]);
    for (const Stretch& stretch : path.stretches)
      rays_.counts.voxels_visited += CountTrue(d, stretch.end > stretch.begin);
    const Progress front_light = rays_.light;
    if constexpr (has_surfaces) {
      if (!meets_none) {
        const MF there = path.to > path.from;
        add_surfaces(path, window, rest_at(place), there);
        if (HWY_UNLIKELY(frame_.shading == nullptr && frame_.error_bound != nullptr && frame_.error_bound->ends))
          note_ends(packet_, part_line(lanes_, path, window), path, there, front_light, rays_);
        return;
      }
    }
    if (cell_data || frame_.shading != nullptr) {
      cast_voxels<cell_data>(packet_, path, SlabSamples<Window>{window, rest_at(place)},
                             uniform ? &current_.uniform() : nullptr, path.to > path.from, rays_);
      return;
    }
    if constexpr (!cell_data) {
      const MF there = path.to > path.from;
      const VF length = IfThenElseZero(there, lanes_.length * (path.to - path.from));
      const Line line = part_line(lanes_, path, window);
      MF apart = there;
      if (!(uniform && has_steps_)) apart = cast_mixed(packet_, line, there, path.from + path.k, length, rays_);
      if (!AllFalse(d, apart))
        cast_voxels<false>(packet_, path, SlabSamples<Window>{window, rest_at(place)},
                           uniform && has_steps_ ? &current_.uniform() : nullptr, apart, rays_);
      if (HWY_UNLIKELY(frame_.error_bound != nullptr && frame_.error_bound->ends))
        note_ends(packet_, line, path, there, front_light, rays_);
    }
  }

  static constexpr bool has_surfaces = std::is_same_v<Surfaces, LaneSurfaces>;

  const ChunkView& chunk_;
  const FrameView& frame_;
  const PacketSlabs& slabs_;
  Lanes lanes_;
  MirroredLanes mirrored_;
  CurrentInterval& current_;
  PacketView<Lookup> packet_;
  RayState rays_;
  [[no_unique_address]] Surfaces surfaces_;
  VF before_;       ///< transmittance in front of the chunk
  bool has_steps_;  ///< whether the transfer function has steps that matter
  VF crossings_;
  float plain_from_, plain_to_;
  bool all_live_;
  std::size_t live_count_;
};

/// Casts lanes [ray, ray + Lanes()) of a packet through the chunk.
template <bool cell_data, class Surfaces, class Window, class Lookup>
HWY_NOINLINE void cast_lanes(const TileCast<Lookup>& tile, int ray, const Reach& reach, const PacketSlabs& slabs) {
  const DF d;
  constexpr std::size_t most = MaxLanes(DF());
  const std::size_t lane_count = hn::Lanes(d);
  const ChunkView& chunk = tile.chunk;
  TileRays& rays = tile.rays;
  Lanes lanes = lanes_of(chunk, ray, slabs.i_first[0], slabs.j_first[0], rays);
  const VF before = LoadU(d, rays.transmittance + ray);
  lanes.k_out = IfThenElse(before < Set(d, chunk.frame.least_transmittance), Set(d, -1.0f), lanes.k_out);
  const MF seen_before = LoadU(d, rays.alpha + ray) > Zero(d);
  PacketCast<cell_data, Surfaces, Window, Lookup> cast(tile, slabs, lanes, before, seen_before);
  cast.run(reach);

  const Progress& progress = cast.rays().light;
  const RayNotes& notes = cast.rays().notes;
  const auto add = [&](float* sum, VF part)
                       HWY_ATTR { StoreU(MulAdd(before, part, LoadU(d, sum + ray)), d, sum + ray); };
  add(rays.alpha, progress.alpha);
  add(rays.red, progress.red);
  add(rays.green, progress.green);
  add(rays.blue, progress.blue);
  StoreU(before * progress.transmittance, d, rays.transmittance + ray);
  add(rays.error_bound, notes.error_bound);
  const VF rough = before * before * notes.rough;
  StoreU(rough + LoadU(d, rays.rough + ray), d, rays.rough + ray);
  if (!AllFalse(d, AndNot(seen_before, notes.seen))) {
    const auto first_k = static_cast<double>(chunk.box.first_k);
    HWY_ALIGN float place[most];
    Store(IfThenElse(seen_before, Set(d, -1.0f), notes.first), d, place);
    for (std::size_t l = 0; l < lane_count; ++l)
      if (place[l] >= 0) rays.first_k[static_cast<std::size_t>(ray) + l] = first_k + static_cast<double>(place[l]);
  }
}

template <bool cell_data, class Surfaces, CL::TableForm form>
HWY_NOINLINE void cast_chunk_as(const ChunkView& chunk, TileRays& rays, TileCounts& counts) {
  const CL::Lookup<form> lookup(*chunk.frame.table);
  CurrentInterval current(*chunk.frame.table, chunk.frame);
  const TileCast<CL::Lookup<form>> tile{chunk, lookup, current, rays, counts};
  for (int packet = 0; packet < TileRays::packets; ++packet) {
    const Reach& reach = chunk.reach[packet];
    if (!reach.any) continue;
    PacketSlabs slabs(reach, chunk.box);
    // The search starts at this packet's interval, so that its bits do not depend on other packets.
    const int first = chunk.box.first_slab;
    current.begin_at(*chunk.block.at(first, slabs.i_first[first], slabs.j_first[first]));
    const auto cast = [&]<class Window>() HWY_ATTR {
      slabs.template place_windows<Window>(chunk.block, chunk.box.slabs);
      for (int lane = 0; lane < TileRays::packet_rays; lane += static_cast<int>(hn::Lanes(DF())))
        cast_lanes<cell_data, Surfaces, Window>(tile, packet * TileRays::packet_rays + lane, reach, slabs);
    };
#if HWY_TARGET <= HWY_AVX3
    if (slabs.widest_i <= SmallWindow::columns - 2 && slabs.widest_j <= SmallWindow::rows - 2)
      cast.template operator()<SmallWindow>();
    else if (slabs.widest_i <= LargeWindow::columns - 2 && slabs.widest_j <= LargeWindow::rows - 2)
      cast.template operator()<LargeWindow>();
    else
#endif
      cast.template operator()<GatherWindow>();
  }
}

template <CL::TableForm form>
HWY_INLINE void cast_chunk(const ChunkView& chunk, TileRays& rays, TileCounts& counts) {
  if (chunk.frame.cell_data)
    cast_chunk_as<true, NoSurfaces, form>(chunk, rays, counts);
  else
    cast_chunk_as<false, NoSurfaces, form>(chunk, rays, counts);
}

/// Point data with surfaces (FrameView::surfaces).
template <CL::TableForm form>
HWY_INLINE void cast_chunk_with_surfaces(const ChunkView& chunk, TileRays& rays, TileCounts& counts) {
  cast_chunk_as<false, LaneSurfaces, form>(chunk, rays, counts);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
