// SPDX-License-Identifier: BSD-3-Clause
#include "projection/edge_sign.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

namespace tessera::projection::edge_sign_test {
namespace {

PixelVertex at(double x, double y, double w = 1) { return {x * w, y * w, w, w}; }

constexpr double orthographic = 0, perspective = 1000;  // pixels per tangent

__extension__ using Wide = __int128;

/// A vertex with integer coordinates: homogeneous with w = 2, -2 or 0, so that positions are in half pixels.
struct WholeVertex {
  std::int64_t x, y, w;
  /// The same vertex at a depth of `distance` on either side of the eye, with the rounding of that depth.
  [[nodiscard]] PixelVertex seen(double distance) const {
    if (w == 0) return {static_cast<double>(x), static_cast<double>(y), 0, 0};
    const double side = w > 0 ? 1 : -1;
    return at(side * static_cast<double>(x) / 2, side * static_cast<double>(y) / 2, side * distance);
  }
};

TEST(EdgeSign, AgreesWithIntegersOnAndNearTheEdgeAllAroundTheEye) {
  std::mt19937_64 random(11);
  int zeros = 0, beside = 0;
  for (int trial = 0; trial < 40000; ++trial) {
    const auto draw = [&](int bits) {
      return static_cast<std::int64_t>(random() >> (64 - bits)) - (1ll << (bits - 1));
    };
    const std::int64_t px = 2 * (draw(12) & 0xfff) + 1, py = 2 * (draw(12) & 0xfff) + 1;  // in half pixels
    const std::int64_t signs[] = {2, -2, 0};
    const auto vertex = [&](std::int64_t x, std::int64_t y) {
      const std::int64_t w = signs[random() % 3], side = w < 0 ? -1 : 1;
      // A point in the plane of the eye is given by the direction from the pixel to the point.
      return w == 0 ? WholeVertex{x - px, y - py, 0} : WholeVertex{side * x, side * y, w};
    };
    // In half of the trials the pixel is on the edge by construction.
    const std::int64_t dx = draw(20), dy = draw(20), m = draw(10), n = draw(10);
    const WholeVertex a = vertex(px + m * dx, py + m * dy);
    const WholeVertex b = trial % 2 == 0 ? vertex(draw(30), draw(30)) : vertex(px + n * dx, py + n * dy);
    const Wide x = static_cast<Wide>(a.y) * b.w - static_cast<Wide>(a.w) * b.y;
    const Wide y = static_cast<Wide>(a.w) * b.x - static_cast<Wide>(a.x) * b.w;
    const Wide w = static_cast<Wide>(a.x) * b.y - static_cast<Wide>(a.y) * b.x;
    Wide e = x * px + y * py + 2 * w;
    zeros += e == 0;
    beside += a.w == 0 && b.w != 0;
    if (e == 0) e = x != 0 ? x : y;
    const int expected = e > 0 ? 1 : e < 0 ? -1 : 0;
    const PixelVertex va = a.seen(0.7), vb = b.seen(1.0 / 3);  // so that products are rounded
    ASSERT_EQ(edge_sign(va, vb, px * 0.5, py * 0.5, perspective), expected) << "trial " << trial;
    ASSERT_EQ(edge_sign(vb, va, px * 0.5, py * 0.5, perspective), -expected) << "trial " << trial;
    if (a.w <= 0 || b.w <= 0) continue;
    ASSERT_EQ(edge_sign(a.seen(1), b.seen(1), px * 0.5, py * 0.5, orthographic), expected) << "trial " << trial;
  }
  EXPECT_GE(zeros, 15000);
  EXPECT_GE(beside, 5000);
}

TEST(EdgeSign, OnTheEdgeTheRayIsShiftedRightThenDown) {
  for (const double view : {orthographic, perspective}) {
    // For a vertical edge the shift to the right decides, for a horizontal one the shift down.
    const auto sign = [view](const PixelVertex& a, const PixelVertex& b, double px, double py) {
      return edge_sign(a, b, px, py, view);
    };
    EXPECT_EQ(sign(at(3.5, 0), at(3.5, 9), 3.5, 4.5), sign(at(3.5, 0), at(3.5, 9), 3.75, 4.5));
    EXPECT_EQ(sign(at(0, 4.5), at(9, 4.5), 3.5, 4.5), sign(at(0, 4.5), at(9, 4.5), 3.5, 4.75));
    EXPECT_EQ(sign(at(2, 2), at(2, 2), 3.5, 4.5), 0);
  }
}

TEST(EdgeSign, SeesOneUnitInTheLastPlace) {
  const double below = std::nextafter(3.5, 0);
  EXPECT_EQ(edge_sign(at(below, 0), at(3.5, 9), 3.5, 8.5, orthographic),
            edge_sign(at(0, 0), at(0, 9), 3.5, 8.5, orthographic));
}

TEST(EdgeSign, PerspectiveNoiseDoesNotDecideASide) {
  for (const double noise : {0x1p-52, 1e-13, 1e-10}) {
    EXPECT_EQ(edge_sign(at(3.5 * (1 - noise), 0, 0.3), at(3.5, 9, 7), 3.5, 8.5, perspective),
              edge_sign(at(3.5, 0), at(3.5, 9), 3.5, 8.5, orthographic));
  }
  const double more = 1e-9;
  EXPECT_EQ(edge_sign(at(3.5 * (1 - more), 0, 0.3), at(3.5, 9, 7), 3.5, 4.5, perspective),
            edge_sign(at(3.4, 0), at(3.5, 9), 3.5, 4.5, orthographic));
}

TEST(EdgeSign, SightErrorBoundsWhatRoundingMoves) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> spread;
  for (int trial = 0; trial < 20000; ++trial) {
    const double per_tangent = std::exp2(std::uniform_real_distribution<double>(0, 30)(random));
    const double w = spread(random) * std::exp2(std::uniform_real_distribution<double>(-60, 3)(random));
    const PixelVertex v{spread(random) * per_tangent, spread(random) * per_tangent, w, w};
    const LineOfSight sight = line_of_sight(v, per_tangent);
    const double scale = sight.w == 0 ? 1 : std::abs(w), bound = sight_error(v, per_tangent, 100);
    for (const double p : {0.5, 99.5}) {
      ASSERT_LE(std::abs((v.x - p * w) - (sight.x - p * sight.w) * scale), bound + 1e-13 * std::abs(p * w));
      ASSERT_LE(std::abs((v.y - p * w) - (sight.y - p * sight.w) * scale), bound + 1e-13 * std::abs(p * w));
    }
  }
}

}  // namespace
}  // namespace tessera::projection::edge_sign_test
