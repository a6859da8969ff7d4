// SPDX-License-Identifier: BSD-3-Clause
// Text is readable on any background and over any data, by the contrast of WCAG 2: (lighter + 0.05) / (darker + 0.05).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "annotation/ink.hpp"
#include "annotation/small_pictures.hpp"

namespace tessera::annotation {
namespace {

double luminance(const glm::dvec3& light) { return 0.2126 * light.x + 0.7152 * light.y + 0.0722 * light.z; }
double contrast(double a, double b) { return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05); }

TEST(Readable, InkStandsOutFromItsBackgroundAndItsHalo) {
  for (int r = 0; r <= 10; ++r)
    for (int g = 0; g <= 10; ++g)
      for (int b = 0; b <= 10; ++b) {
        AnnotationStyle style;
        style.background = glm::dvec3(r, g, b) / 10.0;
        const Ink ink(style);
        const double text = luminance(ink.color(Pen::ink));
        // WCAG requires 4.5 for text.
        EXPECT_GE(contrast(text, luminance(*style.background)), 4.5);
        EXPECT_GE(contrast(text, luminance(ink.halo())), 4.5);
        // WCAG requires 3 for graphics.
        for (const Pen pen : {Pen::x_axis, Pen::y_axis, Pen::z_axis})
          EXPECT_GE(contrast(luminance(ink.color(pen)), luminance(*style.background)), 3);
      }
}

TEST(Readable, ARequestedColourIsUsedWithAContrastingHalo) {
  for (int grey = 0; grey <= 100; ++grey) {
    AnnotationStyle style;
    style.ink = glm::dvec3(grey / 100.0);
    for (int behind = -1; behind <= 10; ++behind) {
      style.background = behind < 0 ? std::nullopt : std::optional(glm::dvec3(behind / 10.0));
      const Ink ink(style);
      EXPECT_EQ(ink.color(Pen::ink), *style.ink);
      if (behind < 0) {
        EXPECT_GE(contrast(grey / 100.0, luminance(ink.halo())), 4.5) << grey;
      }
      EXPECT_GT(contrast(grey / 100.0, luminance(ink.halo())), 1) << grey << " on " << behind;
    }
  }
}

/// The darkest and the lightest of the pixels, as composited over a page.
std::array<double, 2> extremes(const Image& picture, double page) {
  double low = 1e9, high = -1e9;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    const double alpha = picture.rgba[i + 3];
    const double seen = luminance({picture.rgba[i], picture.rgba[i + 1], picture.rgba[i + 2]}) + (1 - alpha) * page;
    low = std::min(low, seen);
    high = std::max(high, seen);
  }
  return {low, high};
}

TEST(Readable, TransparentImagesAreReadableOnAnyPageAndData) {
  Annotation text;
  text.texts = {{"Tessera"}};
  text.style.text_size = 20;
  const View view{{}, {200, 60}};
  for (const float light : {0.0F, 0.2F, 1.0F})
    for (const float alpha : {0.0F, 0.5F, 1.0F})
      for (const double page : {0.0, 0.2, 1.0}) {
        Image picture = plain_picture(view.size, light * alpha, alpha);
        annotate(picture, text, view, {}, {});
        const auto [low, high] = extremes(picture, page);
        // Ink contrasts with its halo, whatever is behind them.
        EXPECT_GE(contrast(low, high), 4.5) << light << " " << alpha << " " << page;
      }
}

TEST(Readable, DisplayValuesAreJudgedByTheLightTheyAre) {
  AnnotationStyle style;
  style.background = glm::dvec3(0.3);  // bright enough for black text in linear light, but dark as a display value
  EXPECT_EQ(Ink(style).color(Pen::ink), glm::dvec3(0));
  style.display_colors = true;
  EXPECT_EQ(Ink(style).color(Pen::ink), glm::dvec3(1));
}

}  // namespace
}  // namespace tessera::annotation
