// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>

#include "annotation/sketch.hpp"
#include "annotation/ticks.hpp"

namespace tessera::annotation {

void add_scale_bar(Sketch& sketch, const ScaleBar& bar) {
  const double pixels = sketch.screen.pixels_per_unit();
  if (!(pixels > 0) || !std::isfinite(pixels)) return;
  const double limit = 0.25 * sketch.layout.width() / pixels;
  if (!(limit > 0) || !std::isfinite(limit)) return;
  const Typeface& face = sketch.typeface;
  const double length = round_length(limit), drawn = length * pixels;
  std::string words = number_words(length);
  if (!sketch.style.length_unit.empty()) words = fmt::format("{} {}", words, clean_text(sketch.style.length_unit));
  if (sketch.screen.view().camera.projection == ProjectionKind::perspective) words += " at the focal point";
  words = face.fitted(words, sketch.layout.width() - 2 * sketch.layout.margin());
  const double text_width = face.width(words), serif = 0.3 * face.size();
  const double width = std::max(text_width, drawn + sketch.line_width());
  const auto corner = sketch.layout.take(bar.place, width, face.line() + 2 * serif);
  if (!corner) return;
  const int column = column_of(bar.place);
  const auto placed = [&](double part) {
    return corner->x + (column < 0 ? 0 : 1) * (width - part) / (column > 0 ? 1 : 2);
  };
  const double left = sketch.crisp(placed(drawn)), y = sketch.crisp(corner->y + face.line() + serif);
  const double right = left + drawn, w = sketch.line_width();
  auto& marks = sketch.sheet.on_top.marks;
  marks.emplace_back(Label{{placed(text_width), corner->y + face.ascent()}, words});
  // The length is the distance between the middles of the two end lines.
  marks.emplace_back(Stroke{{{left, y}, {right, y}}, w});
  marks.emplace_back(Stroke{{{left, y - serif}, {left, y + serif}}, w});
  marks.emplace_back(Stroke{{{right, y - serif}, {right, y + serif}}, w});
}

}  // namespace tessera::annotation
