// SPDX-License-Identifier: BSD-3-Clause
// The roles of a cell's edges and faces in its image, and the exact sign of an edge function. Included once per
// instruction set (Highway's include guard idiom).
//
// What   Seen from the eye, a cell has two front and two back faces, or one face on one side and three on the other:
//
//          two and two        one and three
//               .                   .
//              /|\                 /|\            outline  edges between a front and a back face
//             / | \               / | \           inner    two and two: the edge between the front faces and that
//            .--|--.             /  |  \                   between the back faces, which cross in the image;
//             \ | /             /  .'.  \                  one and three: the three edges between the three, which
//              \|/             / .'   '. \                 meet in the corner that the one face does not have
//               '             '-----------'
//
//        A ray meets the cell where the edge functions of the outline are positive; those of the inner edges
//        select the faces that it passes (lattice_cross-inl.h).
// Bits   Signs are those of exact arithmetic with the tie rule (edge_sign.hpp) wherever float does not decide.

#if defined(TESSERA_PROJECTION_LATTICE_SHAPES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_LATTICE_SHAPES_INL_H_
#undef TESSERA_PROJECTION_LATTICE_SHAPES_INL_H_
#else
#define TESSERA_PROJECTION_LATTICE_SHAPES_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

#include "projection/edge_sign.hpp"
#include "projection/lattice/lattice_setup-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {

constexpr int lanes = static_cast<int>(MaxLanes(DF()));

/// The roles of edges and faces. A table of these is indexed by the set of front faces (bit f: face f).
struct Roles {
  std::uint8_t valid;          ///< whether some pixel can be hit
  std::uint8_t three;          ///< whether the cell has one face against three
  std::uint8_t single_behind;  ///< whether the single face is the back face
  std::uint8_t outline[4];     ///< edges between front and back (three: the fourth repeats the third)
  std::uint8_t inner[3];       ///< two and two: edge of the front, of the back faces. Three: 01, 02, 12 of the three
  std::uint8_t face[4];        ///< two and two: front 0, 1, back 0, 1; three: the single face, then 0, 1, 2
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

/// Replaces the uncertain edge functions of the batch's cell t at a pixel by +-2, with the sign of exact arithmetic and
/// the tie rule. Returns whether the ray meets an edge of the outline between the two faces that it passes: its length
/// inside the cell is then zero, which rounded planes might not show.
inline bool settle_pixel(const LatticeView& view, const CellBatch& batch, int t, const glm::dvec2& pixel,
                         float (&edges)[6], RasterCounts& counts) {
  const scene::Tet& corners = view.projected.mesh->tets()[batch.tet[t]];
  const Roles& roles = role_table.roles[batch.front_faces(t)];
  bool touching = false;
  for (int e = 0; e < 6; ++e) {
    if (std::abs(edges[e]) > 1) continue;
    bool on_edge = false;
    const int sign =
        edge_sign(view.projected.vertices[corners[edge_from[e]]], view.projected.vertices[corners[edge_to[e]]], pixel.x,
                  pixel.y, view.projected.pixels_per_tangent, &on_edge);
    const unsigned edge_on = batch.edge_on(t) >> edge_faces[e][0] | batch.edge_on(t) >> edge_faces[e][1];
    if (on_edge && (edge_on & 1) == 0 && std::find(roles.outline, roles.outline + 4, e) != roles.outline + 4)
      touching = true;
    ++counts.exact_sign_tests;
    edges[e] = static_cast<float>(2 * ((batch.flipped(t) >> e & 1) != 0 ? -sign : sign));
  }
  return touching;
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
