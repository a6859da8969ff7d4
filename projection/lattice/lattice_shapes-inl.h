// SPDX-License-Identifier: BSD-3-Clause
// What the lattice rasterizer's steps share: types, the parts that a cell's edges and faces play, the exact sign of an
// edge function. Included once per instruction set (Highway's include guard idiom).

#if defined(TESSERA_PROJECTION_LATTICE_SHAPES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_LATTICE_SHAPES_INL_H_
#undef TESSERA_PROJECTION_LATTICE_SHAPES_INL_H_
#else
#define TESSERA_PROJECTION_LATTICE_SHAPES_INL_H_
#endif

#include <algorithm>
#include <cmath>

#include "projection/edge_sign.hpp"
#include "projection/lattice/lattice_setup-inl.h"
#include "scene/lanes/lanes-inl.h"
#include "scene/lanes/pack_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {

using scene::HWY_NAMESPACE::DF;
using scene::HWY_NAMESPACE::DI;
using scene::HWY_NAMESPACE::dot_of_halves;
using scene::HWY_NAMESPACE::greater_where;
using scene::HWY_NAMESPACE::LanePacker;
using scene::HWY_NAMESPACE::least_magnitude;
using scene::HWY_NAMESPACE::lookup_two;
using scene::HWY_NAMESPACE::MF;
using scene::HWY_NAMESPACE::MI;
using scene::HWY_NAMESPACE::or_where;
using scene::HWY_NAMESPACE::VF;
using scene::HWY_NAMESPACE::VI;
constexpr int lanes = static_cast<int>(MaxLanes(DF()));

/// Depth (steps) and scalar where the lanes' rays pass one side of the cell.
struct Crossing {
  VI depth;
  VF scalar;
};

/// Appends the lanes of `hit`. Packed in registers and stored as whole vectors: a compressing store is slower on
/// several processors.
HWY_INLINE void append(MF hit, VI pixel, VI front, VI back, VF scalar_front, VF scalar_back, SegmentStream& out) {
  const DI d;
  const DF df;
  const LanePacker pack(RebindMask(d, hit));
  StoreU(pack(pixel), d, out.pixel.data() + out.size);
  StoreU(pack(front), d, out.front.data() + out.size);
  StoreU(pack(back), d, out.back.data() + out.size);
  StoreU(pack(scalar_front), df, out.scalar_front.data() + out.size);
  StoreU(pack(scalar_back), df, out.scalar_back.data() + out.size);
  out.size += pack.count();
}

/// The same of what SegmentStream::hit keeps, before append() of the lanes' segments.
HWY_NOINLINE inline void append_hits(MF hit, VI hits, SegmentStream& out) {
  const DI d;
  const LanePacker pack(RebindMask(d, hit));
  StoreU(pack(hits), d, out.hit.data() + out.size);
}

/// Which edges and faces play which part, by the set of front faces (bit f of the index).
struct Roles {
  std::uint8_t valid;          ///< some pixel can be hit
  std::uint8_t three;          ///< one face against three
  std::uint8_t single_behind;  ///< the one is the back face
  std::uint8_t outline[4];     ///< edges between front and back (three: the fourth repeats the third)
  std::uint8_t inner[3];       ///< two and two: the front faces', the back faces' edge. Three: 01, 02, 12 of the three
  std::uint8_t face[4];        ///< two and two: front 0, 1, back 0, 1; three: the one, then 0, 1, 2
};

constexpr Roles roles_of(unsigned front) {
  Roles r{};
  unsigned count = 0;
  for (unsigned f = 0; f < 4; ++f) count += front >> f & 1;
  r.valid = count >= 1 && count <= 3;
  if (!r.valid) return r;
  r.three = count != 2;
  r.single_behind = count == 3;
  int outlines = 0;
  for (int e = 0; e < 6; ++e)
    if ((front >> edge_faces[e][0] & 1) != (front >> edge_faces[e][1] & 1))
      r.outline[outlines++] = static_cast<std::uint8_t>(e);
  for (; outlines < 4; ++outlines) r.outline[outlines] = r.outline[outlines - 1];
  int next = 0;
  const auto add = [&](bool is_front) {
    for (unsigned f = 0; f < 4; ++f)
      if ((front >> f & 1) == (is_front ? 1u : 0u)) r.face[next++] = static_cast<std::uint8_t>(f);
  };
  add(count < 3), add(count == 3);
  const auto between = [&](int f, int g) {
    for (int e = 0; e < 6; ++e)
      if (edge_faces[e][0] == f && edge_faces[e][1] == g) return static_cast<std::uint8_t>(e);
    return std::uint8_t{0};
  };
  if (r.three) {
    r.inner[0] = between(r.face[1], r.face[2]);
    r.inner[1] = between(r.face[1], r.face[3]);
    r.inner[2] = between(r.face[2], r.face[3]);
  } else {
    r.inner[0] = between(r.face[0], r.face[1]);
    r.inner[1] = r.inner[2] = between(r.face[2], r.face[3]);
  }
  return r;
}

struct RoleTable {
  Roles roles[16];
};
constexpr RoleTable make_role_table() {
  RoleTable t{};
  for (unsigned front = 0; front < 16; ++front) t.roles[front] = roles_of(front);
  return t;
}
constexpr RoleTable role_table = make_role_table();

/// Replaces edge functions of the batch's cell t at (px, py) that are not certain by +-2, with the sign of exact
/// arithmetic and the tie rule; edges are `stride` apart. Returns whether the ray meets an edge of the outline between
/// two faces that it passes: it is in the cell for no way at all, which rounded planes would not say.
inline bool settle_pixel(const LatticeView& view, const CellBatch& batch, int t, double px, double py, float* edges,
                         int stride, RasterCounts& counts) {
  const scene::Tet& corners = view.projected.mesh->tets()[batch.tet[t]];
  const Roles& roles = role_table.roles[batch.front_faces(t)];
  bool touching = false;
  for (int e = 0; e < 6; ++e) {
    float& edge = edges[e * stride];
    if (std::abs(edge) > 1) continue;
    bool on_edge = false;
    const int sign =
        edge_sign(view.projected.vertices[corners[edge_from[e]]], view.projected.vertices[corners[edge_to[e]]], px, py,
                  view.projected.pixels_per_tangent, &on_edge);
    const unsigned edge_on = batch.edge_on(t) >> edge_faces[e][0] | batch.edge_on(t) >> edge_faces[e][1];
    if (on_edge && (edge_on & 1) == 0 && std::find(roles.outline, roles.outline + 4, e) != roles.outline + 4)
      touching = true;
    ++counts.exact_sign_tests;
    edge = static_cast<float>(2 * ((batch.flipped(t) >> e & 1) != 0 ? -sign : sign));
  }
  return touching;
}

/// The lanes of a mask, a bit each.
HWY_INLINE unsigned lane_bits(MF mask) {
  std::uint8_t bits[8] = {0};
  StoreMaskBits(DF(), mask, bits);
  return bits[0] | static_cast<unsigned>(bits[1]) << 8;
}

/// The faces' planes as a ray meets one of them: 1 / weight, and with it depth and scalar behind a corner.
HWY_INLINE VF inverse_weight(VI weight) {
  const DF d;
  const VF w = ConvertTo(d, weight);
  // One Newton step makes the estimate (11 to 14 bits) right to float rounding.
  const VF estimate = ApproximateReciprocal(w);
  return estimate * NegMulAdd(w, estimate, Set(d, 2.0f)) * Set(d, CellBatch::weight_one);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
