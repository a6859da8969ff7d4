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

/// Assigns each element a rectangle at its position.
class Layout {
 public:
  Layout(ImageSize size, double margin) : size_(size), margin_(margin) {}

  [[nodiscard]] double margin() const { return margin_; }
  [[nodiscard]] double width() const { return size_.width; }
  [[nodiscard]] double height() const { return size_.height; }
  /// Assigns the next rectangle of this size at a position. Returns its top left corner; none if the rectangle would
  /// not be on the image.
  std::optional<glm::dvec2> take(Place place, double width, double height);
  /// Low and high corners of all assigned rectangles.
  [[nodiscard]] const std::vector<std::array<glm::dvec2, 2>>& taken() const { return taken_; }

 private:
  ImageSize size_;
  double margin_;
  std::array<double, 8> used_{};  ///< for each position: extent of the assigned rectangles from the margin inwards
  std::vector<std::array<glm::dvec2, 2>> taken_;
};

/// Column and row of a position: -1 is left or top, 0 is the middle, 1 is right or bottom.
int column_of(Place place);
int row_of(Place place);

/// The tools and the sheet shared by the parts of an annotation.
struct Sketch {
  const Screen& screen;
  const Typeface& typeface;
  const AnnotationStyle& style;
  Layout layout;
  Sheet sheet{};

  /// Width of lines in pixels. It is a whole number, so that horizontal and vertical lines are sharp.
  [[nodiscard]] double line_width() const;
  /// Returns the position nearest to `at` for the middle of a horizontal or vertical line at which the line covers
  /// whole pixels.
  [[nodiscard]] double crisp(double at) const;
  /// Returns `name`, followed by the unit of the world in brackets if it is known.
  [[nodiscard]] std::string with_unit(const std::string& name) const;
};

/// The values at the ends of a colour bar.
std::array<double, 2> range_of(const ColorBar& bar, const TransferFunction& function);

void add_color_bar(Sketch& sketch, const ColorBar& bar, const TransferFunction& function);
void add_triad(Sketch& sketch, Place place);
/// Must be called last, because its labels avoid the elements already placed. `outlined` states whether the edges of
/// the box are already drawn.
void add_box_axes(Sketch& sketch, const Box& box, bool outlined);
void add_outline(Sketch& sketch, const Box& box);
void add_scale_bar(Sketch& sketch, const ScaleBar& bar);
void add_text(Sketch& sketch, const Text& text);

}  // namespace tessera::annotation
