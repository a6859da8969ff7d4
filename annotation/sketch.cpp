// SPDX-License-Identifier: BSD-3-Clause
#include "annotation/sketch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tessera::annotation {

int column_of(Place place) {
  switch (place) {
    case Place::top_left:
    case Place::left:
    case Place::bottom_left:
      return -1;
    case Place::top:
    case Place::bottom:
      return 0;
    default:
      return 1;
  }
}

int row_of(Place place) {
  switch (place) {
    case Place::top_left:
    case Place::top:
    case Place::top_right:
      return -1;
    case Place::left:
    case Place::right:
      return 0;
    default:
      return 1;
  }
}

std::optional<glm::dvec2> Layout::take(Place place, double width, double height) {
  const int column = column_of(place), row = row_of(place);
  double& used = used_[static_cast<std::size_t>(place)];
  const bool sideways = row == 0;
  if (width + (sideways ? used : 0) > size_.width - 2 * margin_) return std::nullopt;
  if (height + (sideways ? 0 : used) > size_.height - 2 * margin_) return std::nullopt;
  const auto along = [&](int side, double full, double part, double offset) {
    return side < 0 ? margin_ + offset : side > 0 ? full - margin_ - offset - part : (full - part) / 2;
  };
  const glm::dvec2 corner(along(column, size_.width, width, sideways ? used : 0),
                          along(row, size_.height, height, sideways ? 0 : used));
  used += (sideways ? width : height) + margin_ / 2;
  taken_.push_back({corner, corner + glm::dvec2(width, height)});
  return corner;
}

double Sketch::line_width() const { return std::max(1.0, std::round(typeface.size() / 13)); }

double Sketch::crisp(double at) const {
  const double half = line_width() / 2;
  return std::round(at - half) + half;
}

std::string Sketch::with_unit(const std::string& name) const {
  if (style.length_unit.empty()) return name;
  return fmt::format("{} [{}]", name, clean_text(style.length_unit));
}

void add_text(Sketch& sketch, const Text& text) {
  const Typeface& face = sketch.typeface;
  // Lines at the bottom are stacked upwards, so that the last line is the lowest.
  std::vector<std::string> lines;
  for (std::size_t at = 0; at <= text.text.size();) {
    const std::size_t end = std::min(text.text.find('\n', at), text.text.size());
    lines.push_back(
        face.fitted(clean_text(text.text.substr(at, end - at)), sketch.layout.width() - 2 * sketch.layout.margin()));
    at = end + 1;
  }
  double width = 0;
  for (const std::string& line : lines) width = std::max(width, face.width(line));
  const auto corner = sketch.layout.take(text.place, width, face.line() * static_cast<double>(lines.size()));
  if (!corner) return;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double free = width - face.width(lines[i]);
    const int column = column_of(text.place);
    const double x = corner->x + (column < 0 ? 0 : column > 0 ? free : free / 2);
    sketch.sheet.on_top.marks.emplace_back(
        Label{{x, corner->y + face.ascent() + static_cast<double>(i) * face.line()}, lines[i]});
  }
}

}  // namespace tessera::annotation
