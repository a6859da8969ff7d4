#include "projection/edge_sign.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace tessera::projection {
namespace {

PixelVertex at(double x, double y, double w = 1) { return {x, y, w, w}; }

__extension__ using Wide = __int128;

/// A vertex in whole numbers: homogeneous coordinates with w = 2, -2 or 0, so that positions are in half pixels.
struct WholeVertex {
  std::int64_t x, y, w;
  /// The same vertex, at another distance from the eye.
  [[nodiscard]] PixelVertex seen(double scale) const {
    const double part = w == 0 ? scale : 1 / static_cast<double>(w);
    return at(static_cast<double>(x) * part, static_cast<double>(y) * part, static_cast<double>(w) * scale);
  }
};

TEST(EdgeSign, AgreesWithIntegersOnAndBesideTheEdgeBeforeBesideAndBehindTheEye) {
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
      // Beside the eye: where the line from the pixel to the point leads.
      return w == 0 ? WholeVertex{x - px, y - py, 0} : WholeVertex{side * x, side * y, w};
    };
    // Positions of up to 40 bits; half of the trials have the pixel on the edge by construction.
    const std::int64_t dx = draw(30), dy = draw(30), m = draw(10), n = draw(10);
    const WholeVertex a = vertex(px + m * dx, py + m * dy);
    const WholeVertex b = trial % 2 == 0 ? vertex(draw(40), draw(40)) : vertex(px + n * dx, py + n * dy);
    const Wide x = static_cast<Wide>(a.y) * b.w - static_cast<Wide>(a.w) * b.y;
    const Wide y = static_cast<Wide>(a.w) * b.x - static_cast<Wide>(a.x) * b.w;
    const Wide w = static_cast<Wide>(a.x) * b.y - static_cast<Wide>(a.y) * b.x;
    Wide e = x * px + y * py + 2 * w;
    zeros += e == 0;
    beside += a.w == 0 && b.w != 0;
    if (e == 0) e = x != 0 ? x : y;
    const int expected = e > 0 ? 1 : e < 0 ? -1 : 0;
    const PixelVertex va = a.seen(0.7), vb = b.seen(1.0 / 3);  // no depth that divides without rest
    EXPECT_EQ(edge_sign(va, vb, px * 0.5, py * 0.5), expected) << "trial " << trial;
    EXPECT_EQ(edge_sign(vb, va, px * 0.5, py * 0.5), -expected) << "trial " << trial;
  }
  EXPECT_GE(zeros, 20000);
  EXPECT_GE(beside, 5000);
}

TEST(EdgeSign, OnTheEdgeTheRayIsShiftedRightThenDown) {
  // An upright edge: the shift to the right decides. A level one: the shift down.
  EXPECT_EQ(edge_sign(at(3.5, 0), at(3.5, 9), 3.5, 4.5), edge_sign(at(3.5, 0), at(3.5, 9), 3.75, 4.5));
  EXPECT_EQ(edge_sign(at(0, 4.5), at(9, 4.5), 3.5, 4.5), edge_sign(at(0, 4.5), at(9, 4.5), 3.5, 4.75));
  EXPECT_EQ(edge_sign(at(2, 2), at(2, 2), 3.5, 4.5), 0);
}

TEST(EdgeSign, SeesOneUnitInTheLastPlace) {
  const double below = std::nextafter(3.5, 0);
  EXPECT_EQ(edge_sign(at(below, 0), at(3.5, 9), 3.5, 8.5), edge_sign(at(0, 0), at(0, 9), 3.5, 8.5));
}

}  // namespace
}  // namespace tessera::projection
