#include "projection/edge_sign.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace tessera::projection {
namespace {

PixelVertex at(double x, double y, double w = 1) { return {x, y, w, w}; }

__extension__ using Wide = __int128;

TEST(EdgeSign, AgreesWithIntegersOnAndBesideTheEdge) {
  std::mt19937_64 random(11);
  int zeros = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    // Homogeneous coordinates of up to 40 bits; half of the trials have the pixel on the edge by construction.
    const auto draw = [&](int bits) {
      return static_cast<std::int64_t>(random() >> (64 - bits)) - (1ll << (bits - 1));
    };
    const std::int64_t px = 2 * (draw(12) & 0xfff) + 1, py = 2 * (draw(12) & 0xfff) + 1;  // in half pixels
    std::int64_t a[3] = {draw(40), draw(40), draw(20)}, b[3];
    if (trial % 2 == 0) {
      for (auto& v : b) v = draw(20);
    } else {
      // b = 3 a + k (px, py, 2): the ray through p, a and b lie in one plane.
      const std::int64_t k = draw(20);
      b[0] = 3 * a[0] + k * px, b[1] = 3 * a[1] + k * py, b[2] = 3 * a[2] + 2 * k;
    }
    const Wide x = static_cast<Wide>(a[1]) * b[2] - static_cast<Wide>(a[2]) * b[1];
    const Wide y = static_cast<Wide>(a[2]) * b[0] - static_cast<Wide>(a[0]) * b[2];
    const Wide w = static_cast<Wide>(a[0]) * b[1] - static_cast<Wide>(a[1]) * b[0];
    Wide e = x * px + y * py + 2 * w;
    zeros += e == 0;
    if (e == 0) e = x != 0 ? x : y;
    const int expected = e > 0 ? 1 : e < 0 ? -1 : 0;
    const PixelVertex va = at(static_cast<double>(a[0]), static_cast<double>(a[1]), static_cast<double>(a[2]));
    const PixelVertex vb = at(static_cast<double>(b[0]), static_cast<double>(b[1]), static_cast<double>(b[2]));
    EXPECT_EQ(edge_sign(va, vb, px * 0.5, py * 0.5), expected) << "trial " << trial;
    EXPECT_EQ(edge_sign(vb, va, px * 0.5, py * 0.5), -expected) << "trial " << trial;
  }
  EXPECT_GE(zeros, 10000);
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
