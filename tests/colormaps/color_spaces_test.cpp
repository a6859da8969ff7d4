// SPDX-License-Identifier: BSD-3-Clause
#include "colormaps/color_spaces.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tessera::colormaps {
namespace {

TEST(ColorSpaces, SrgbDecodesByItsStandard) {
  EXPECT_DOUBLE_EQ(decode_srgb(0.0), 0);
  EXPECT_DOUBLE_EQ(decode_srgb(1.0), 1);
  EXPECT_DOUBLE_EQ(decode_srgb(0.04), 0.04 / 12.92);
  EXPECT_NEAR(decode_srgb(0.5), 0.21404114048223255, 1e-15);  // ((0.5 + 0.055) / 1.055)^2.4
  for (int i = -300; i <= 300; ++i) {
    const double v = i / 200.0;
    EXPECT_NEAR(encode_srgb(decode_srgb(v)), v, 2e-7) << v;  // the standard's thresholds are rounded
  }
}

TEST(ColorSpaces, AMixBeginsAndEndsExactlyAtItsColours) {
  const glm::dvec3 a{0.1, 0.7, 0.3}, b{0.9, 0.05, 0.6};
  for (const ColorSpace space : {ColorSpace::rgb, ColorSpace::hsv, ColorSpace::lab, ColorSpace::diverging}) {
    EXPECT_EQ(mix_colors(a, b, 0, space), a);
    EXPECT_EQ(mix_colors(a, b, 1, space), b);
    // The result approaches the ends continuously.
    const glm::dvec3 near_a = mix_colors(a, b, 1e-9, space), near_b = mix_colors(a, b, 1 - 1e-9, space);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(near_a[k], a[k], 1e-6);
      EXPECT_NEAR(near_b[k], b[k], 1e-6);
    }
  }
}

TEST(ColorSpaces, MixesAreVtksToTheRoundingOfItsMatrices) {
  // Reference values from VTK 9.1's vtkColorTransferFunction::GetColor in the spaces Lab, Diverging and HSV with
  // SetHSVWrap(1), between the colours below. VTK's XYZ matrices are rounded to four digits in both directions, which
  // gives an error of 1.3e-4 in the green of VTK's own end colour.
  const glm::dvec3 a{0.231373, 0.298039, 0.752941}, b{0.705882, 0.0156863, 0.14902}, c{0.9, 0.9, 0.2};
  const struct {
    ColorSpace space;
    glm::dvec3 from, to;
    double t;
    glm::dvec3 truth;
  } cases[] = {
      {ColorSpace::lab, a, b, 0.1, {0.355754988, 0.280486032, 0.689155756}},
      {ColorSpace::lab, a, b, 0.5, {0.580662530, 0.202498456, 0.443042772}},
      {ColorSpace::lab, a, b, 0.9, {0.686924808, 0.082290577, 0.208762267}},
      {ColorSpace::lab, b, c, 0.3, {0.784719293, 0.380435274, 0.172776605}},
      {ColorSpace::diverging, a, b, 0.1, {0.351735418, 0.468505687, 0.890375511}},
      {ColorSpace::diverging, a, b, 0.25, {0.553318141, 0.688634521, 0.995187915}},
      {ColorSpace::diverging, a, b, 0.5, {0.865395197, 0.865410210, 0.865395561}},
      {ColorSpace::diverging, a, b, 0.9, {0.842251404, 0.326619276, 0.266613231}},
      {ColorSpace::diverging, b, c, 0.3, {1, 0.805209337, 0.552883485}},
      {ColorSpace::diverging, {0, 0, 0}, {0.1, 0.2, 0.9}, 0.5, {0.441004130, 0.388233425, 0.601447378}},
      {ColorSpace::diverging, {0.1, 0.2, 0.9}, {1, 1, 1}, 0.2, {0.492896803, 0.411545089, 1}},
      {ColorSpace::hsv, b, c, 0.3, {0.764117400, 0.178380600, 0.062827456}},
  };
  for (const auto& one : cases) {
    const glm::dvec3 mixed = mix_colors(one.from, one.to, one.t, one.space, true);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(mixed[k], one.truth[k], one.space == ColorSpace::hsv ? 1e-8 : 2e-4) << one.t << " channel " << k;
  }
}

TEST(ColorSpaces, GreysStayGrey) {
  for (const ColorSpace space : {ColorSpace::rgb, ColorSpace::hsv, ColorSpace::lab, ColorSpace::diverging})
    for (const double t : {0.1, 0.5, 0.9}) {
      const glm::dvec3 c = mix_colors({0.1, 0.1, 0.1}, {0.9, 0.9, 0.9}, t, space);
      EXPECT_NEAR(c.x, c.y, 1e-12);
      EXPECT_NEAR(c.y, c.z, 1e-12);
    }
}

TEST(ColorSpaces, HueTakesTheShorterPathOnlyIfItMayWrap) {
  const glm::dvec3 red{1, 0, 0.2}, orange{1, 0.2, 0};  // either side of hue 0
  EXPECT_LT(mix_colors(red, orange, 0.5, ColorSpace::hsv, true).y, 0.01);
  EXPECT_GT(mix_colors(red, orange, 0.5, ColorSpace::hsv, false).y, 0.9);  // through cyan
}

TEST(ColorSpaces, AnyTwoColoursMixToFiniteOnesInGamut) {
  std::uint32_t noise = 7;
  const auto next = [&] { return static_cast<double>((noise = noise * 1664525 + 1013904223) >> 30) / 3; };
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec3 a{next(), next(), next()}, b{next(), next(), next()};
    for (const ColorSpace space : {ColorSpace::rgb, ColorSpace::hsv, ColorSpace::lab, ColorSpace::diverging})
      for (const double t : {0.01, 0.5, 0.77}) {
        const glm::dvec3 c = mix_colors(a, b, t, space, i % 2 == 0);
        for (int k = 0; k < 3; ++k) EXPECT_TRUE(c[k] >= 0 && c[k] <= 1) << c[k];
      }
  }
}

}  // namespace
}  // namespace tessera::colormaps
