// SPDX-License-Identifier: BSD-3-Clause
#include "reference/mesh/face_piece.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::reference {
namespace {

std::size_t square_index(const FacePiece& piece, int i, int j) {
  const auto row = static_cast<std::size_t>(piece.a_degree) + 1;
  return static_cast<std::size_t>(i) + row * static_cast<std::size_t>(j);
}

/// Returns the index of a point in rows of n + 1, n, n - 1 ... points.
std::size_t triangle_index(int n, int i, int j) {
  const int before = j * (n + 1) - j * (j - 1) / 2;
  return static_cast<std::size_t>(before) + static_cast<std::size_t>(i);
}

glm::dvec3 middle(const glm::dvec3& a, const glm::dvec3& b) { return (a + b) * 0.5; }

double longest(const std::vector<glm::dvec3>& vectors) {
  double most = 0;
  for (const glm::dvec3& v : vectors) most = std::max(most, glm::length(v));
  return most;
}

std::pair<FacePiece, FacePiece> square_halves(const FacePiece& piece, bool across_a) {
  std::pair<FacePiece, FacePiece> result{piece, piece};
  auto& [low, high] = result;
  const int n = across_a ? piece.a_degree : piece.b_degree, lines = across_a ? piece.b_degree : piece.a_degree;
  (across_a ? low.along_a : low.along_b) *= 0.5;
  (across_a ? high.along_a : high.along_b) *= 0.5;
  high.origin += across_a ? high.along_a : high.along_b;
  const auto at = [&](int i, int line) {
    return across_a ? square_index(piece, i, line) : square_index(piece, line, i);
  };
  for (int line = 0; line <= lines; ++line)
    for (int round = 1; round <= n; ++round) {  // de Casteljau; the first point of each round belongs to the lower half
      for (int i = 0; i <= n - round; ++i)
        high.control[at(i, line)] = middle(high.control[at(i, line)], high.control[at(i + 1, line)]);
      low.control[at(round, line)] = high.control[at(0, line)];
    }
  return result;
}

std::pair<FacePiece, FacePiece> triangle_halves(const FacePiece& piece) {
  const int n = piece.a_degree;
  // Corners: p at the origin, q at a = 1, r at b = 1. The halves are (p, r, m) and (q, r, m) with m between p and q.
  std::pair<FacePiece, FacePiece> result{piece, piece};
  auto& [first, second] = result;
  const glm::dvec2 q = piece.origin + piece.along_a, r = piece.origin + piece.along_b,
                   m = piece.origin + piece.along_a * 0.5;
  first.along_a = r - piece.origin, first.along_b = m - piece.origin;
  second.origin = q, second.along_a = r - q, second.along_b = m - q;
  // After `round` rounds, point (i, j) depends on n - round - i - j times p, i times q, j times r, and `round` times m.
  std::vector<glm::dvec3> point = piece.control;
  for (int round = 0; round <= n; ++round) {
    for (int j = 0; round > 0 && j <= n - round; ++j)
      for (int i = 0; i + j <= n - round; ++i)
        point[triangle_index(n, i, j)] = middle(point[triangle_index(n, i, j)], point[triangle_index(n, i + 1, j)]);
    for (int of_r = 0; of_r <= n - round; ++of_r) {
      first.control[triangle_index(n, of_r, round)] = point[triangle_index(n, 0, of_r)];
      second.control[triangle_index(n, of_r, round)] = point[triangle_index(n, n - round - of_r, of_r)];
    }
  }
  return result;
}

}  // namespace

PieceSlopes slopes(const FacePiece& piece) {
  PieceSlopes result;
  const std::vector<glm::dvec3>& p = piece.control;
  const double n = piece.a_degree, m = piece.b_degree;
  if (piece.triangle) {
    const int degree = piece.a_degree;
    for (int j = 0; j < degree; ++j)
      for (int i = 0; i + j < degree; ++i) {
        const glm::dvec3& corner = p[triangle_index(degree, i, j)];
        result.along_a.push_back(n * (p[triangle_index(degree, i + 1, j)] - corner));
        result.along_b.push_back(n * (p[triangle_index(degree, i, j + 1)] - corner));
      }
    return result;
  }
  for (int j = 0; j <= piece.b_degree; ++j)
    for (int i = 0; i < piece.a_degree; ++i)
      result.along_a.push_back(n * (p[square_index(piece, i + 1, j)] - p[square_index(piece, i, j)]));
  for (int j = 0; j < piece.b_degree; ++j)
    for (int i = 0; i <= piece.a_degree; ++i)
      result.along_b.push_back(m * (p[square_index(piece, i, j + 1)] - p[square_index(piece, i, j)]));
  return result;
}

std::pair<FacePiece, FacePiece> halves(const FacePiece& piece) {
  if (piece.triangle) return triangle_halves(piece);
  const PieceSlopes s = slopes(piece);
  const double a = longest(s.along_a), b = longest(s.along_b);
  // If one side of the piece is more than 16 times as long as the other in (u, v), it is halved. Otherwise pieces could
  // become slivers, whose short side would be mistaken for the size of the piece.
  const double a_side = glm::length(piece.along_a), b_side = glm::length(piece.along_b);
  const bool across_a = a_side > 16 * b_side ? true : b_side > 16 * a_side ? false : a >= b;
  return square_halves(piece, across_a);
}

PiecePoint point_of(const FacePiece& piece, glm::dvec2 place) {
  // Applies de Casteljau's algorithm without its last round. The points before the last round also give the
  // derivatives.
  std::vector<glm::dvec3> p = piece.control;
  if (piece.triangle) {
    const int n = piece.a_degree;
    for (int round = 1; round < n; ++round)
      for (int j = 0; j <= n - round; ++j)
        for (int i = 0; i + j <= n - round; ++i)
          p[triangle_index(n, i, j)] = (1 - place.x - place.y) * p[triangle_index(n, i, j)] +
                                       place.x * p[triangle_index(n, i + 1, j)] +
                                       place.y * p[triangle_index(n, i, j + 1)];
    const glm::dvec3 corner = p[triangle_index(n, 0, 0)], a = p[triangle_index(n, 1, 0)] - corner,
                     b = p[triangle_index(n, 0, 1)] - corner;
    return {corner + place.x * a + place.y * b, static_cast<double>(n) * a, static_cast<double>(n) * b};
  }
  const auto mixed = [](const glm::dvec3& a, const glm::dvec3& b, double u) { return (1 - u) * a + u * b; };
  const int n = piece.a_degree, m = piece.b_degree;
  for (int j = 0; j <= m; ++j)
    for (int round = 1; round < n; ++round)
      for (int i = 0; i <= n - round; ++i)
        p[square_index(piece, i, j)] = mixed(p[square_index(piece, i, j)], p[square_index(piece, i + 1, j)], place.x);
  for (int i = 0; i <= 1; ++i)
    for (int round = 1; round < m; ++round)
      for (int j = 0; j <= m - round; ++j)
        p[square_index(piece, i, j)] = mixed(p[square_index(piece, i, j)], p[square_index(piece, i, j + 1)], place.y);
  const glm::dvec3 &p00 = p[square_index(piece, 0, 0)], &p10 = p[square_index(piece, 1, 0)],
                   &p01 = p[square_index(piece, 0, 1)], &p11 = p[square_index(piece, 1, 1)];
  return {mixed(mixed(p00, p10, place.x), mixed(p01, p11, place.x), place.y),
          static_cast<double>(n) * mixed(p10 - p00, p11 - p01, place.y),
          static_cast<double>(m) * mixed(p01 - p00, p11 - p10, place.x)};
}

}  // namespace tessera::reference
