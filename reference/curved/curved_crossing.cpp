// SPDX-License-Identifier: BSD-3-Clause
#include "reference/curved/curved_crossing.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "reference/mesh/face_piece.hpp"

namespace tessera::reference {
namespace {

constexpr int most_pieces = 4000;
constexpr double smallest_piece = 0x1p-26;  // fraction of the face
constexpr double edge_tolerance = 1e-9;     // fraction of a piece

/// Whether a piece has no crossing, or only a negligible one: all control points are on one side of the ray by more
/// than `rounding`, or the piece is, up to `rounding`, a point or a line along the ray.
bool misses(const std::vector<glm::dvec3>& control, double rounding) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, 4> low, high;
  low.fill(infinity), high.fill(-infinity);
  for (const glm::dvec3& p : control) {
    const std::array<double, 4> along{p.x, p.y, p.x + p.y, p.x - p.y};
    for (std::size_t i = 0; i < 4; ++i) low[i] = std::min(low[i], along[i]), high[i] = std::max(high[i], along[i]);
  }
  for (std::size_t i = 0; i < 4; ++i)
    if (low[i] > rounding || high[i] < -rounding) return true;
  return high[0] - low[0] < rounding && high[1] - low[1] < rounding;
}

/// The inverse of the derivatives of the map from a piece to the plane across the ray.
struct Preconditioner {
  double xx, xy, yx, yy;

  Preconditioner(const glm::dvec3& along_a, const glm::dvec3& along_b) {
    const double determinant = along_a.x * along_b.y - along_b.x * along_a.y;
    xx = along_b.y / determinant, xy = -along_b.x / determinant;
    yx = -along_a.y / determinant, yy = along_a.x / determinant;
  }
  [[nodiscard]] glm::dvec2 operator()(const glm::dvec3& v) const { return {xx * v.x + xy * v.y, yx * v.x + yy * v.y}; }
};

glm::dvec3 mean(const std::vector<glm::dvec3>& vectors) {
  glm::dvec3 sum(0);
  for (const glm::dvec3& v : vectors) sum += v;
  return sum / static_cast<double>(vectors.size());
}

/// Whether the map of a piece to the plane across the ray is one-to-one: |I - A J| <= 1/4 in the maximum norm for all
/// of its derivatives J. This also ensures that Newton's method converges from the middle of the piece.
bool one_to_one(const FacePiece& piece) {
  const PieceSlopes slope = slopes(piece);
  const Preconditioner across(mean(slope.along_a), mean(slope.along_b));
  glm::dvec2 off_a(0), off_b(0);
  for (const glm::dvec3& v : slope.along_a) off_a = glm::max(off_a, glm::abs(across(v) - glm::dvec2(1, 0)));
  for (const glm::dvec3& v : slope.along_b) off_b = glm::max(off_b, glm::abs(across(v) - glm::dvec2(0, 1)));
  return off_a.x + off_b.x <= 0.25 && off_a.y + off_b.y <= 0.25;  // also false for NaN
}

bool is_inside(bool triangle, glm::dvec2 place) {
  if (!(std::min(place.x, place.y) >= -edge_tolerance)) return false;
  return (triangle ? place.x + place.y : std::max(place.x, place.y)) <= 1 + edge_tolerance;
}

/// Applies Newton's method, starting at the coordinates `place` of the face.
std::optional<glm::dvec2> crossing_near(const FacePiece& face, glm::dvec2 place) {
  constexpr int most_steps = 40, few_steps = 8;
  constexpr double last_step = 1e-10, short_step = 1e-6;
  for (int n = 0; n < most_steps; ++n) {
    const PiecePoint point = point_of(face, place);
    const glm::dvec2 step = -Preconditioner(point.along_a, point.along_b)(point.at);
    const double length = glm::length(step);
    if (!(length < 10)) return std::nullopt;
    place += step;
    // If the eye is very far away, rounding prevents steps from becoming shorter than `last_step`.
    if (length < last_step || (n > few_steps && length < short_step)) return place;
  }
  return std::nullopt;
}

/// Converts a place of the face to a piece's own coordinates.
glm::dvec2 within(const FacePiece& piece, glm::dvec2 place) {
  const Preconditioner into(glm::dvec3(piece.along_a, 0), glm::dvec3(piece.along_b, 0));
  return into(glm::dvec3(place - piece.origin, 0));
}

}  // namespace

void find_crossings(const CellOnRay& cell, const FacePatch& face, std::vector<Crossing>& crossings) {
  constexpr double rounding = 1e-14;  // relative to the cell's size
  FacePiece whole{face.triangle, face.u_degree, face.v_degree, {0, 0}, {1, 0}, {0, 1}, {}};
  for (const std::size_t i : face.control) whole.control.push_back(cell.control[i]);

  std::vector<FacePiece> pieces{whole};
  for (int n = 0; !pieces.empty() && n < most_pieces; ++n) {
    const FacePiece piece = std::move(pieces.back());
    pieces.pop_back();
    if (misses(piece.control, rounding * cell.size)) continue;
    const bool smallest = std::max(glm::length(piece.along_a), glm::length(piece.along_b)) < smallest_piece;
    if (!smallest && !one_to_one(piece)) {
      auto [one, other] = halves(piece);
      pieces.push_back(std::move(other));
      pieces.push_back(std::move(one));
      continue;
    }
    const double middle = piece.triangle ? 1.0 / 3 : 0.5;
    const std::optional<glm::dvec2> place =
        crossing_near(whole, piece.origin + (piece.along_a + piece.along_b) * middle);
    if (!place || !is_inside(piece.triangle, within(piece, *place))) continue;
    crossings.push_back(
        {point_of(whole, *place).at.z, face.origin + place->x * face.along_u + place->y * face.along_v});
  }
}

}  // namespace tessera::reference
