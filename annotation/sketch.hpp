// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "annotation/drawing.hpp"
#include "annotation/screen.hpp"
#include "annotation/typeface.hpp"
#include "tessera/annotation.hpp"

namespace tessera::annotation {

/// Gives each thing its room at its place.
class Layout {
 public:
  Layout(ImageSize size, double margin) : size_(size), margin_(margin) {}

  [[nodiscard]] double margin() const { return margin_; }
  [[nodiscard]] double width() const { return size_.width; }
  [[nodiscard]] double height() const { return size_.height; }
  /// Top left corner of the next so large a rectangle at a place; nothing if it would not be on the picture.
  std::optional<glm::dvec2> take(Place place, double width, double height);
  /// Low and high corners of all that were given.
  [[nodiscard]] const std::vector<std::array<glm::dvec2, 2>>& taken() const { return taken_; }

 private:
  ImageSize size_;
  double margin_;
  std::array<double, 8> used_{};  ///< by place: from the margin inwards
  std::vector<std::array<glm::dvec2, 2>> taken_;
};

/// -1, 0 or 1: left, middle, right; top, middle, bottom.
int column_of(Place place);
int row_of(Place place);

/// What the parts of an annotation draw with, and on.
struct Sketch {
  const Screen& screen;
  const Typeface& typeface;
  const AnnotationStyle& style;
  Layout layout;
  Sheet sheet{};

  /// Of lines, pixels: whole, so that level and upright lines are sharp.
  [[nodiscard]] double line_width() const;
  /// Where a level or upright line's middle is best: the nearest place at which it covers whole pixels.
  [[nodiscard]] double crisp(double at) const;
  /// `name`, with the world's unit in brackets if it is known.
  [[nodiscard]] std::string with_unit(const std::string& name) const;
};

/// The values at the ends of a colour bar.
std::array<double, 2> range_of(const ColorBar& bar, const TransferFunction& function);

void add_color_bar(Sketch& sketch, const ColorBar& bar, const TransferFunction& function);
void add_triad(Sketch& sketch, Place place);
/// Last: its labels stay clear of what has been placed. `outlined`: the box's edges are drawn already.
void add_box_axes(Sketch& sketch, const Box& box, bool outlined);
void add_outline(Sketch& sketch, const Box& box);
void add_scale_bar(Sketch& sketch, const ScaleBar& bar);
void add_text(Sketch& sketch, const Text& text);

}  // namespace tessera::annotation
