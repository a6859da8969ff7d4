// SPDX-License-Identifier: BSD-3-Clause
#include "reference/mesh/ray_tet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/mesh/exact_determinant.hpp"

namespace tessera::reference {
namespace {

/// Whether all corners are clearly on one side of the plane through the eye that projects to the column (axis 0) or row
/// (axis 1) `at`. In that case no line in that plane meets the cell. This saves most of the work for cells that cross
/// the eye's plane, which have no box. The margin is far wider than rounding.
bool on_one_side(const std::array<Corner, 4>& corners, int axis, double at) {
  int left = 0, right = 0;
  for (const Corner& c : corners) {
    const glm::dvec3& h = c.vertex.sight;
    const double moved = at * h.z, margin = 1e-9 * (std::abs(h[axis]) + std::abs(moved));
    left += h[axis] - moved < -margin;
    right += h[axis] - moved > margin;
  }
  return left == 4 || right == 4;
}

/// The value E of an edge: its sign on rounded lines of sight, after the tie rule, and its magnitude for the unrounded
/// vertices, which is used as a weight.
struct EdgeValue {
  int sign;
  long double value;
};

/// Values are computed exactly if rounding may have changed them by more than one part in this number.
constexpr long double wanted_precision = 1e12L;

/// E, and whether rounding changed it by less than one part in `precision`.
struct RoundedValue {
  long double value;
  bool good;
};
RoundedValue rounded_value(double x, double y, const glm::dvec3& a, const glm::dvec3& b, long double precision) {
  // E = (Xa - x wa)(Yb - y wb) - (Ya - y wa)(Xb - x wb), which equals det[(x,y,1), a, b].
  const long double xa_part = static_cast<long double>(x) * a.z, ya_part = static_cast<long double>(y) * a.z;
  const long double xb_part = static_cast<long double>(x) * b.z, yb_part = static_cast<long double>(y) * b.z;
  const long double xa = a.x - xa_part, ya = a.y - ya_part, xb = b.x - xb_part, yb = b.y - yb_part;
  const long double value = xa * yb - ya * xb;

  // The error of each difference is at most epsilon times the magnitudes of its operands; the same applies to the
  // products and the last difference.
  const long double xa_size = std::abs(a.x) + std::abs(xa_part), ya_size = std::abs(a.y) + std::abs(ya_part);
  const long double xb_size = std::abs(b.x) + std::abs(xb_part), yb_size = std::abs(b.y) + std::abs(yb_part);
  const long double error =
      4 * std::numeric_limits<long double>::epsilon() *
      (xa_size * std::abs(yb) + std::abs(xa) * yb_size + ya_size * std::abs(xb) + std::abs(ya) * xb_size);
  return {value, std::abs(value) > error * precision};
}

int sign_by_sight(double x, double y, const glm::dvec3& a, const glm::dvec3& b) {
  const RoundedValue rounded = rounded_value(x, y, a, b, 1);
  if (rounded.good) return rounded.value > 0 ? 1 : -1;
  const Determinant exact = exact_determinant({x, y, 1}, a, b);
  if (exact.sign != 0) return exact.sign;
  // The line meets the edge. The sign is that of the derivative of E with respect to x or, if that is zero, with
  // respect to y.
  const int by_x = exact_determinant({1, 0, 0}, a, b).sign;
  return by_x != 0 ? by_x : exact_determinant({0, 1, 0}, a, b).sign;
}

EdgeValue edge_value(double x, double y, const ProjectedVertex& a, const ProjectedVertex& b) {
  const RoundedValue rounded = rounded_value(x, y, a.homogeneous, b.homogeneous, wanted_precision);
  const long double value =
      rounded.good ? rounded.value : exact_determinant({x, y, 1}, a.homogeneous, b.homogeneous).value;
  return {sign_by_sight(x, y, a.sight, b.sight), value};
}

/// Whether three vertices and the eye are in one plane.
bool edge_on(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  long double value = 0, size = 0;
  const auto add = [&](double p, double q, double r) {
    const long double term = static_cast<long double>(p) * q * r;
    value += term;
    size += std::abs(term);
  };
  add(a.x, b.y, c.z), add(-a.x, b.z, c.y);
  add(a.y, b.z, c.x), add(-a.y, b.x, c.z);
  add(a.z, b.x, c.y), add(-a.z, b.y, c.x);
  if (std::abs(value) > 16 * std::numeric_limits<long double>::epsilon() * size) return false;
  return exact_determinant(a, b, c).sign == 0;
}

struct Hit {
  double depth, scalar;
  double change;  ///< scalar minus `from`
  int face = -1;  ///< index of the opposite corner
};

/// Weights need not be normalised, only non-negative. The results are between the values of the corners by
/// construction.
Hit weighted(const std::array<const Corner*, 3>& corners, const std::array<long double, 3>& weights, double from) {
  const long double sum = weights[0] + weights[1] + weights[2];
  long double depth = 0, scalar = 0, change = 0;
  for (int i = 0; i < 3; ++i) {
    const long double share = sum > 0 ? weights[i] / sum : 1.0L / 3;
    depth += share * corners[i]->vertex.depth;
    scalar += share * corners[i]->scalar;
    change += share * (static_cast<long double>(corners[i]->scalar) - from);
  }
  const auto [d0, d1] = std::minmax({corners[0]->vertex.depth, corners[1]->vertex.depth, corners[2]->vertex.depth});
  const auto [s0, s1] = std::minmax({corners[0]->scalar, corners[1]->scalar, corners[2]->scalar});
  return {std::clamp(static_cast<double>(depth), d0, d1), std::clamp(static_cast<double>(scalar), s0, s1),
          std::clamp(static_cast<double>(change), s0 - from, s1 - from)};
}

/// Computes the hit from the values of the three edges, if the line is on the same side of all of them.
std::optional<Hit> hit_of(const std::array<const Corner*, 3>& c, const EdgeValue& ab, const EdgeValue& bc,
                          const EdgeValue& ac, double from) {
  // E_ca is -E_ac.
  if (ab.sign == 0 || bc.sign != ab.sign || -ac.sign != ab.sign) return std::nullopt;
  if (edge_on(c[0]->vertex.sight, c[1]->vertex.sight, c[2]->vertex.sight)) return std::nullopt;
  return weighted(c, {std::abs(bc.value), std::abs(ac.value), std::abs(ab.value)}, from);
}

/// Returns the scalar at an eye on the cell's surface. The volumes spanned by the eye and the four faces are its
/// barycentric coordinates.
double scalar_at_eye(const std::array<Corner, 4>& c) {
  const auto volume = [&](int i, int j, int k) {
    return exact_determinant(c[i].vertex.homogeneous, c[j].vertex.homogeneous, c[k].vertex.homogeneous).value;
  };
  const std::array<double, 4> volumes{volume(1, 2, 3), -volume(0, 2, 3), volume(0, 1, 3), -volume(0, 1, 2)};
  const double sum = volumes[0] + volumes[1] + volumes[2] + volumes[3];
  double scalar = 0;
  for (int i = 0; i < 4; ++i) scalar += volumes[i] / sum * c[i].scalar;
  const auto [low, high] = std::minmax({c[0].scalar, c[1].scalar, c[2].scalar, c[3].scalar});
  return std::clamp(scalar, low, high);
}

}  // namespace

std::optional<Stretch> intersect(const std::array<Corner, 4>& corners, double x, double y) {
  if (on_one_side(corners, 0, x) || on_one_side(corners, 1, y)) return std::nullopt;
  EdgeValue e[4][4];
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) e[i][j] = edge_value(x, y, corners[i].vertex, corners[j].vertex);

  constexpr int faces[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
  std::array<Hit, 2> hits{};
  int count = 0;
  for (const auto& [a, b, c] : faces) {
    const std::optional<Hit> hit =
        hit_of({&corners[a], &corners[b], &corners[c]}, e[a][b], e[b][c], e[a][c], corners[0].scalar);
    if (!hit) continue;
    if (count == 2) return std::nullopt;  // impossible: a line enters and leaves a tetrahedron once
    hits[count] = *hit;
    hits[count++].face = 6 - a - b - c;
  }
  if (count == 0) return std::nullopt;
  if (count == 1) {
    const double scalar = scalar_at_eye(corners);
    hits[1] = {0, scalar, scalar - corners[0].scalar};
  }
  if (hits[0].depth > hits[1].depth) std::swap(hits[0], hits[1]);
  return Stretch{hits[0].depth,  hits[1].depth,  hits[0].scalar, hits[1].scalar, corners[0].scalar,
                 hits[0].change, hits[1].change, hits[0].face,   hits[1].face};
}

std::optional<TriangleHit> intersect(const std::array<Corner, 3>& corners, double x, double y) {
  const auto& [a, b, c] = corners;
  const std::optional<Hit> hit =
      hit_of({&a, &b, &c}, edge_value(x, y, a.vertex, b.vertex), edge_value(x, y, b.vertex, c.vertex),
             edge_value(x, y, a.vertex, c.vertex), a.scalar);
  if (!hit) return std::nullopt;
  return TriangleHit{hit->depth, hit->scalar};
}

std::optional<Stretch> clipped(const Stretch& stretch, double nearest, double farthest) {
  if (!(nearest < farthest) || !(stretch.back > nearest) || !(stretch.front < farthest)) return std::nullopt;
  const auto change_at = [&](double depth) {
    const double share = (depth - stretch.front) / (stretch.back - stretch.front);
    return stretch.change_front + share * (stretch.change_back - stretch.change_front);
  };
  Stretch kept = stretch;
  if (stretch.front < nearest) kept.front = nearest, kept.change_front = change_at(nearest), kept.face_front = -1;
  if (stretch.back > farthest) kept.back = farthest, kept.change_back = change_at(farthest), kept.face_back = -1;
  if (stretch.front < nearest) kept.scalar_front = stretch.corner_scalar + kept.change_front;
  if (stretch.back > farthest) kept.scalar_back = stretch.corner_scalar + kept.change_back;
  return kept;
}

}  // namespace tessera::reference
