// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <variant>
#include <vector>

/// A drawing as values, before it is rendered to pixels. Later parts are drawn over earlier parts, and all halos below
/// all ink. Lengths are in pixels from the image's top left corner, with y downwards.
namespace tessera::annotation {

/// Colours of lines and text; ink.hpp defines them.
enum class Pen { ink, x_axis, y_axis, z_axis };

/// A line through points.
struct Stroke {
  std::vector<glm::dvec2> points;
  double width;
  Pen pen = Pen::ink;
};

/// `at` is the left end of the baseline.
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

/// A rectangle of opaque pixels in given colours, row by row.
struct Swatch {
  int x, y, width, height;
  std::vector<glm::dvec3> colors;
};

using Mark = std::variant<Stroke, Label, Shape>;

/// One layer of an annotation: swatches, and marks over them.
struct Drawing {
  std::vector<Swatch> swatches;
  std::vector<Mark> marks;
};

/// A whole annotation: the parts behind the data of the image, the parts in front of them, and the parts without a
/// position in the world.
struct Sheet {
  Drawing behind, before, on_top;
};

}  // namespace tessera::annotation
