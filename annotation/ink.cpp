// SPDX-License-Identifier: BSD-3-Clause
#include "annotation/ink.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::annotation {
namespace {

/// Converts a display value to linear light (IEC 61966-2-1).
double linear(double display) {
  return display <= 0.04045 ? display / 12.92 : std::pow((display + 0.055) / 1.055, 2.4);
}

glm::dvec3 linear(const glm::dvec3& display) { return {linear(display.x), linear(display.y), linear(display.z)}; }

/// Luminance of linear light (Rec. 709).
double luminance(const glm::dvec3& light) { return glm::dot(light, glm::dvec3(0.2126, 0.7152, 0.0722)); }

/// Contrast of two luminances as defined by WCAG 2, from 1 to 21.
double contrast(double a, double b) { return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05); }

/// Whether black has more contrast to this luminance than white. On either side of the limit the larger contrast is at
/// least 4.58.
bool is_bright(double luminance) { return luminance > 0.1791; }

}  // namespace

Ink::Ink(const AnnotationStyle& style) : display_(style.display_colors) {
  constexpr glm::dvec3 black(0), white(1);
  ink_ = style.ink ? *style.ink : !style.background || is_bright(light(*style.background)) ? black : white;
  dark_ = !is_bright(light(ink_));
  // A halo in the colour of the background is invisible on the background. The halo has this colour if it contrasts
  // with the ink.
  const bool differs = style.background && is_bright(light(*style.background)) == dark_;
  halo_ = differs ? *style.background : dark_ ? white : black;
}

double Ink::light(const glm::dvec3& color) const { return luminance(display_ ? linear(color) : color); }

glm::dvec3 Ink::color(Pen pen) const {
  if (pen == Pen::ink) return ink_;
  using Colors = std::array<glm::dvec3, 3>;  // display values
  static constexpr Colors dark{{{0.78, 0.08, 0.08}, {0.03, 0.45, 0.10}, {0.10, 0.20, 0.85}}};
  static constexpr Colors bright{{{1.0, 0.45, 0.40}, {0.45, 0.90, 0.45}, {0.55, 0.70, 1.0}}};
  const glm::dvec3 shown = (dark_ ? dark : bright)[static_cast<std::size_t>(pen) - 1];
  const glm::dvec3 color = display_ ? shown : linear(shown);
  // On a grey background, the axes are not coloured.
  constexpr double least = 3;  // WCAG's minimum for graphics
  return contrast(light(color), light(halo_)) < least ? ink_ : color;
}

}  // namespace tessera::annotation
