// SPDX-License-Identifier: BSD-3-Clause
#include "reference/mesh/exact_determinant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tessera::reference::exact_determinant_test {
namespace {

TEST(ExactDeterminant, AgreesWithIntegerArithmetic) {
  // 38-bit integers: the exact value needs 116 bits, so double arithmetic would be wrong.
  std::mt19937_64 random(7);
  const auto number = [&] { return static_cast<std::int64_t>(random() >> 26) - (std::int64_t{1} << 37); };
  for (int n = 0; n < 2000; ++n) {
    std::int64_t m[3][3];
    for (auto& row : m)
      for (auto& entry : row) entry = number();
    // A row that is almost a combination of the others makes the determinant small.
    for (int i = 0; i < 3; ++i) m[2][i] = m[0][i] / 2 - m[1][i] / 4 + (n % 3 == 0 ? i : 0);
    const auto term = [&](int i, int j, int k) { return static_cast<__int128>(m[0][i]) * m[1][j] * m[2][k]; };
    const __int128 truth =
        term(0, 1, 2) - term(0, 2, 1) + term(1, 2, 0) - term(1, 0, 2) + term(2, 0, 1) - term(2, 1, 0);
    const auto row = [&](int i) { return glm::dvec3(m[i][0], m[i][1], m[i][2]); };
    const Determinant found = exact_determinant(row(0), row(1), row(2));
    EXPECT_EQ(found.sign, truth > 0 ? 1 : truth < 0 ? -1 : 0);
    EXPECT_NEAR(found.value, static_cast<double>(truth), std::abs(static_cast<double>(truth)) * 1e-15);
  }
}

TEST(ExactDeterminant, SeesOneBitOfDifference) {
  const glm::dvec3 a(1.0 / 3, 1e5 / 7, 1), b(2.0 / 3, 2e5 / 7, 2);
  EXPECT_EQ(exact_determinant(a, b, {0.1, 0.2, 0.3}).sign, 0);  // b is exactly 2 a
  glm::dvec3 nudged = b;
  nudged.x = std::nextafter(b.x, 1.0);
  const int sign = exact_determinant(a, nudged, {0.1, 0.2, 0.3}).sign;
  EXPECT_NE(sign, 0);
  EXPECT_EQ(exact_determinant(nudged, a, {0.1, 0.2, 0.3}).sign, -sign);
}

}  // namespace
}  // namespace tessera::reference::exact_determinant_test
