// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <variant>
#include <vector>

/// What is to be drawn, as values, before any pixel is: in order, later over earlier, all halos under all ink.
/// Lengths are pixels from the picture's top left corner, y downwards.
namespace tessera::annotation {

/// Colours of lines and text; ink.hpp says which.
enum class Pen { ink, x_axis, y_axis, z_axis };

/// A line through points.
struct Stroke {
  std::vector<glm::dvec2> points;
  double width;
  Pen pen = Pen::ink;
};

/// `at` is the left end of the base line.
struct Label {
  glm::dvec2 at;
  std::string text;  ///< clean UTF-8
  Pen pen = Pen::ink;
};

/// A filled polygon.
struct Shape {
  std::vector<glm::dvec2> corners;
  Pen pen = Pen::ink;
  double opacity = 1;
};

/// Whole pixels of given colours, opaque, row by row.
struct Swatch {
  int x, y, width, height;
  std::vector<glm::dvec3> colors;
};

using Mark = std::variant<Stroke, Label, Shape>;

/// One layer: swatches, and over them marks.
struct Drawing {
  std::vector<Swatch> swatches;
  std::vector<Mark> marks;
};

/// All of an annotation: what lies behind the picture's data, what lies before that, and what is nowhere in the world.
struct Sheet {
  Drawing behind, before, on_top;
};

}  // namespace tessera::annotation
