// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "reference/curved/curved_integral.hpp"
#include "reference/grid/grid_integral.hpp"
#include "reference/integral.hpp"
#include "reference/mesh/face_piece.hpp"
#include "reference/smooth_scalar.hpp"

namespace tessera::reference::curved_pieces_test {
namespace {

using scene::Emission;
using scene::Knot;

FacePiece any_piece(bool triangle, int a_degree, int b_degree) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  FacePiece piece{triangle, a_degree, b_degree, {0, 0}, {1, 0}, {0, 1}, {}};
  for (int j = 0; j <= b_degree; ++j)
    for (int i = 0; i <= (triangle ? a_degree - j : a_degree); ++i)
      piece.control.emplace_back(unit(random), unit(random), unit(random));
  return piece;
}

TEST(FacePieces, HalvesOfHalvesAreTheSamePatch) {
  constexpr double rounding = 1e-13;
  for (const auto& [triangle, a, b] :
       {std::tuple{true, 1, 1}, {true, 2, 2}, {true, 4, 4}, {false, 1, 1}, {false, 2, 3}, {false, 4, 1}}) {
    const FacePiece whole = any_piece(triangle, a, b);
    std::vector<FacePiece> pieces{whole};
    double area = 0;
    for (int n = 0; n < 5; ++n) {
      std::vector<FacePiece> finer;
      for (const FacePiece& piece : pieces) {
        const auto [one, other] = halves(piece);
        finer.push_back(one);
        finer.push_back(other);
      }
      pieces = finer;
    }
    for (const FacePiece& piece : pieces) {
      area += std::abs(piece.along_a.x * piece.along_b.y - piece.along_a.y * piece.along_b.x);
      for (const glm::dvec2 place : {glm::dvec2(0.2, 0.3), glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0.1, 0.9)}) {
        const glm::dvec2 in_whole = piece.origin + place.x * piece.along_a + place.y * piece.along_b;
        EXPECT_NEAR(glm::length(point_of(piece, place).at - point_of(whole, in_whole).at), 0, rounding);
      }
    }
    EXPECT_NEAR(area, 1, rounding);
  }
}

TEST(FacePieces, SlopesAreThoseOfFiniteDifferences) {
  constexpr double step = 1e-5, error = 1e-8;  // step^2 times the third derivatives
  for (const auto& [triangle, a, b] : {std::tuple{true, 3, 3}, {false, 2, 3}}) {
    const FacePiece piece = any_piece(triangle, a, b);
    const glm::dvec2 place(0.3, 0.45);
    const PiecePoint point = point_of(piece, place);
    const auto difference = [&](glm::dvec2 d) {
      return (point_of(piece, place + d).at - point_of(piece, place - d).at) / (2 * step);
    };
    EXPECT_NEAR(glm::length(difference({step, 0}) - point.along_a), 0, error);
    EXPECT_NEAR(glm::length(difference({0, step}) - point.along_b), 0, error);
    // Control vectors bound the derivatives: the first is the derivative at the corner.
    EXPECT_NEAR(glm::length(slopes(piece).along_a.front() - point_of(piece, {0, 0}).along_a), 0, 1e-13);
    EXPECT_NEAR(glm::length(slopes(piece).along_b.front() - point_of(piece, {0, 0}).along_b), 0, 1e-13);
  }
}

TEST(SmoothScalar, FollowsAnySmoothFunction) {
  const auto function = [](double z) { return std::sin(3 * z) + 1 / (z + 0.3); };
  double end = 0.5;
  for (const SmoothScalar& piece : smooth_pieces(0.5, 4, 1, function)) {
    EXPECT_EQ(piece.front, end);
    end = piece.back;
    for (const double u : {-1.0, -0.7, 0.0, 0.33, 1.0}) {
      const double z = piece.front + (piece.back - piece.front) * (1 + u) / 2;
      EXPECT_NEAR(piece.at(u), function(z), 2e-14);
    }
  }
  EXPECT_EQ(end, 4);
}

TEST(SmoothScalar, EndsAtASingularity) {
  const std::vector<SmoothScalar> pieces = smooth_pieces(0, 1, 1, [](double z) { return std::sqrt(z); });
  EXPECT_LT(pieces.size(), 100u);
  double integral = 0;
  for (const SmoothScalar& piece : pieces)
    for (int i = 0; i < 100; ++i) integral += piece.at((i + 0.5) / 50 - 1) * (piece.back - piece.front) / 100;
  EXPECT_NEAR(integral, 2.0 / 3, 1e-5);  // of the midpoint rule
}

TEST(SmoothScalar, FindsItsExtrema) {
  const auto pieces = smooth_pieces(-1, 1, 1, [](double z) { return 4 * z * z * z - 3 * z; });
  ASSERT_EQ(pieces.size(), 1u);
  const std::vector<double> turns = pieces[0].turning_points();
  ASSERT_EQ(turns.size(), 2u);
  EXPECT_NEAR(turns[0], -0.5, 1e-7);
  EXPECT_NEAR(turns[1], 0.5, 1e-7);
  EXPECT_TRUE(smooth_pieces(-1, 1, 1, [](double z) { return 3 * z; })[0].turning_points().empty());
  // Where the slope vanishes without changing sign, rounding may give two turning points with a negligible distance.
  const SmoothScalar flat = smooth_pieces(-1, 1, 1, [](double z) { return z * z * z; })[0];
  const std::vector<double> none = flat.turning_points();
  ASSERT_LE(none.size(), 2u);
  for (const double u : none) EXPECT_NEAR(flat.at(u), 0, 1e-15);
}

/// Transfer functions with a step, steep ramps and transparent parts.
const std::vector<std::vector<Knot>>& transfer_functions() {
  static const std::vector<std::vector<Knot>> functions{
      {{0, {1, 0.5, 0.25}, 2}},
      {{-1, {1, 0, 0}, 0}, {1, {0, 1, 0.5}, 3}},
      {{-0.5, {1, 0, 0}, 0},
       {0, {0, 1, 0}, 0},
       {0, {0, 1, 1}, 5},
       {0.2, {1, 1, 0}, 1},
       {0.2001, {0, 0, 1}, 60},
       {0.7, {0, 0, 1}, 0}},
      {{0.1, {1, 0, 0}, 1000}, {0.5, {0, 0, 1}, 1e5}},
  };
  return functions;
}

TEST(CurvedIntegral, OfCubicsMatchesThatOfGrids) {
  constexpr double error = 2e-12;  // the accuracy of both
  for (const auto& knots : transfer_functions())
    for (const Emission emission : {Emission::absorption, Emission::independent}) {
      CurvedIntegral curved(knots, emission);
      GridIntegral of_grid(knots, emission);
      const std::array<Cubic, 3> cubics{{{{-0.6, 1, 0.4, -0.3}}, {{0.5, -3, 4, -1}}, {{0.5, -1.5, 0.2, 0.3}}}};
      double depth = 1;
      for (const Cubic& cubic : cubics) {
        const double next = depth + 0.8;
        of_grid.add((next - depth) * 1.25, cubic, depth, next);
        for (const SmoothScalar& piece :
             smooth_pieces(depth, next, 1, [&](double z) { return cubic.at((z - depth) / 0.8); }))
          curved.add(piece, 1.25, 0);
        depth = next;
      }
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(curved.color()[i], of_grid.color()[i], error);
      EXPECT_NEAR(curved.opacity(), of_grid.opacity(), error);
      EXPECT_NEAR(curved.first_visible_depth(), of_grid.first_visible_depth(), 1e-7);
    }
}

TEST(CurvedIntegral, OfAConstantOnAStepTakesTheUpperKnot) {
  const std::vector<Knot> knots{{0, {1, 0, 0}, 1}, {0.5, {1, 0, 0}, 1}, {0.5, {0, 1, 0}, 3}, {1, {0, 1, 0}, 3}};
  CurvedIntegral integral(knots, Emission::absorption);
  integral.add(SmoothScalar(1, 2, 0), 1, 0.5);
  EXPECT_NEAR(integral.optical_depth(), 3, 1e-14);
  EXPECT_EQ(integral.color()[0], 0);
}

TEST(CurvedIntegral, OfARationalScalarMatchesItsClosedForm) {
  // kappa = 1 / (1 + z): T = 1 / (1 + z), and light with the colour kappa: (1 - 1 / (1 + z)^2) / 2.
  const std::vector<Knot> knots{{0, {0, 0, 0}, 0}, {1, {1, 1, 1}, 1}};
  CurvedIntegral integral(knots, Emission::absorption);
  for (const SmoothScalar& piece : smooth_pieces(0, 5, 1, [](double z) { return 1 / (1 + z); }))
    integral.add(piece, 1, 0);
  EXPECT_NEAR(integral.opacity(), 1 - 1.0 / 6, 1e-13);
  EXPECT_NEAR(integral.color()[1], (1 - 1.0 / 36) / 2, 1e-13);
}

}  // namespace
}  // namespace tessera::reference::curved_pieces_test
