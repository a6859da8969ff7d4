// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "annotation/sketch.hpp"
#include "annotation/ticks.hpp"

namespace tessera::annotation {
namespace {

/// Maps between values and places along a colour bar, from its low end at 0 to its high end at 1.
struct Scale {
  double low, high;
  bool logarithmic;

  [[nodiscard]] double value(double t) const {
    if (!logarithmic) return std::lerp(low, high, t);
    return std::clamp(low * std::pow(high / low, t), low, high);
  }
  /// Returns the place of a value. It is the middle if the range consists of one value.
  [[nodiscard]] double place(double value) const {
    if (low == high) return 0.5;
    const double t = logarithmic ? std::log(value / low) / std::log(high / low)
                                 : (value / 2 - low / 2) / (high / 2 - low / 2);  // numbers are halved so that
                                                                                  // differences do not overflow
    return std::clamp(t, 0.0, 1.0);
  }
  [[nodiscard]] std::vector<Tick> ticks(int most) const {
    return logarithmic ? logarithmic_ticks(low, high, most) : linear_ticks(low, high, most);
  }
};

/// The rectangle of the bar, in whole pixels. The bar has `steps` pixels along its length, counted from the low end.
struct Bar {
  int x, y, width, height;
  bool upright;
  [[nodiscard]] int steps() const { return upright ? height : width; }
  /// Returns the pixel coordinate along the bar at the fraction t of its length.
  [[nodiscard]] double at(double t) const { return upright ? y + height * (1 - t) : x + width * t; }
};

void add_colors(Sketch& sketch, const Bar& bar, const Scale& scale, const TransferFunction& function) {
  Swatch swatch{bar.x, bar.y, bar.width, bar.height, {}};
  std::vector<glm::dvec3> along;
  along.reserve(static_cast<std::size_t>(bar.steps()));
  for (int i = 0; i < bar.steps(); ++i) along.push_back(function.evaluate(scale.value((i + 0.5) / bar.steps())).color);
  swatch.colors.reserve(static_cast<std::size_t>(bar.width) * static_cast<std::size_t>(bar.height));
  for (int y = 0; y < bar.height; ++y)
    for (int x = 0; x < bar.width; ++x)
      swatch.colors.push_back(along[static_cast<std::size_t>(bar.upright ? bar.height - 1 - y : x)]);
  sketch.sheet.on_top.swatches.push_back(std::move(swatch));
}

/// Adds the graph of the extinction over the range, scaled so that the largest value has the height `depth`. The graph
/// is to the left of an upright bar and above a horizontal bar.
void add_graph(Sketch& sketch, const Bar& bar, const Scale& scale, const TransferFunction& function, double depth) {
  std::vector<double> extinction;
  extinction.reserve(static_cast<std::size_t>(bar.steps()));
  for (int i = 0; i < bar.steps(); ++i)
    extinction.push_back(function.evaluate(scale.value((i + 0.5) / bar.steps())).extinction);
  const double largest = *std::ranges::max_element(extinction);
  if (!(largest > 0)) return;
  const double base = (bar.upright ? bar.x : bar.y) - 2 * sketch.line_width();
  const auto corner = [&](double along, double height) {
    return bar.upright ? glm::dvec2(base - height, along) : glm::dvec2(along, base - height);
  };
  Shape graph;
  graph.corners.push_back(corner(bar.at(0), 0));
  const double steps = bar.steps();
  double before = extinction.front() / largest * depth;
  graph.corners.push_back(corner(bar.at(0), before));
  for (int i = 0; i < bar.steps(); ++i) {
    const double height = extinction[static_cast<std::size_t>(i)] / largest * depth;
    // A change of more than a pixel between adjacent pixels is a step, which is drawn vertically.
    if (std::abs(height - before) > 1) {
      graph.corners.push_back(corner(bar.at(i / steps), before));
      graph.corners.push_back(corner(bar.at(i / steps), height));
    }
    graph.corners.push_back(corner(bar.at((i + 0.5) / steps), height));
    before = height;
  }
  graph.corners.push_back(corner(bar.at(1), before));
  graph.corners.push_back(corner(bar.at(1), 0));
  auto& marks = sketch.sheet.on_top.marks;
  Stroke line{{graph.corners.begin() + 1, graph.corners.end() - 1}, sketch.line_width()};
  graph.opacity = 0.4;
  marks.emplace_back(std::move(graph));
  marks.emplace_back(std::move(line));
}

/// Adds a frame around the bar, just outside its colours.
void add_frame(Sketch& sketch, const Bar& bar) {
  const double w = sketch.line_width(), half = w / 2;
  const double left = bar.x - half, right = bar.x + bar.width + half;
  const double top = bar.y - half, bottom = bar.y + bar.height + half;
  auto& marks = sketch.sheet.on_top.marks;
  marks.emplace_back(Stroke{{{left - half, top}, {right + half, top}}, w});
  marks.emplace_back(Stroke{{{left - half, bottom}, {right + half, bottom}}, w});
  marks.emplace_back(Stroke{{{left, top}, {left, bottom}}, w});
  marks.emplace_back(Stroke{{{right, top}, {right, bottom}}, w});
}

double widest(const Typeface& face, const std::vector<Tick>& ticks) {
  double width = 0;
  for (const Tick& tick : ticks) width = std::max(width, face.width(tick.label));
  return width;
}

/// Adds an upright bar, with its labels on the right.
void add_upright(Sketch& sketch, const ColorBar& bar, const TransferFunction& function, const Scale& scale) {
  const Typeface& face = sketch.typeface;
  const double size = face.size(), margin = sketch.layout.margin(), w = sketch.line_width();
  // The length leaves space for a line of text in the corners, and for the title.
  const double length = std::floor(
      std::min(0.6 * sketch.layout.height(), sketch.layout.height() - 2 * (margin + 1.5 * face.line()) - face.line()));
  if (length < 2 * size) return;
  const std::vector<Tick> ticks = scale.ticks(static_cast<int>(std::min(length / (2.2 * size), 12.0)));
  const double labels = widest(face, ticks), tick = std::round(0.35 * size), gap = 0.25 * size;
  const double graph = std::round(1.2 * size), thick = std::max(4.0, std::round(size));
  const std::string title = face.fitted(clean_text(bar.title), 0.4 * sketch.layout.width());
  const double bar_part = graph + 3 * w + thick + tick + gap + labels, width = std::max(bar_part, face.width(title));
  const double head = title.empty() ? 0 : face.line() + 0.4 * size;
  const auto corner = sketch.layout.take(bar.place, width, length + head);
  if (!corner) return;
  const bool right = column_of(bar.place) > 0;
  const double left = corner->x + (right ? width - bar_part : 0);
  const Bar place{static_cast<int>(std::round(left + graph + 2 * w)), static_cast<int>(std::round(corner->y + head)),
                  static_cast<int>(thick), static_cast<int>(length), true};
  add_colors(sketch, place, scale, function);
  add_graph(sketch, place, scale, function, graph);
  add_frame(sketch, place);
  auto& marks = sketch.sheet.on_top.marks;
  const double from = place.x + place.width + w;
  for (const Tick& t : ticks) {
    const double y = place.at(scale.place(t.value));
    marks.emplace_back(Stroke{{{from, sketch.crisp(y)}, {from + tick, sketch.crisp(y)}}, w});
    marks.emplace_back(Label{{from + tick + gap, y + 0.36 * size}, t.label});
  }
  if (title.empty()) return;
  marks.emplace_back(Label{{corner->x + (right ? width - face.width(title) : 0), corner->y + face.ascent()}, title});
}

/// Returns as many ticks as there is space for labels next to each other.
std::vector<Tick> level_ticks(const Sketch& sketch, const Scale& scale, double length) {
  std::vector<Tick> ticks;
  for (int most = 10; most >= 2; --most) {
    ticks = scale.ticks(most);
    double least = length;
    for (std::size_t i = 1; i < ticks.size(); ++i)
      least = std::min(least, length * (scale.place(ticks[i].value) - scale.place(ticks[i - 1].value)));
    if (widest(sketch.typeface, ticks) + sketch.typeface.size() <= least) break;
  }
  return ticks;
}

/// Adds a horizontal bar, with its labels below and its title above.
void add_level(Sketch& sketch, const ColorBar& bar, const TransferFunction& function, const Scale& scale) {
  const Typeface& face = sketch.typeface;
  const double size = face.size(), w = sketch.line_width();
  const double length = std::floor(0.5 * sketch.layout.width());
  if (length < 3 * size) return;
  const std::vector<Tick> ticks = level_ticks(sketch, scale, length);
  const double tick = std::round(0.35 * size), graph = std::round(1.2 * size), thick = std::max(4.0, std::round(size));
  const std::string title = face.fitted(clean_text(bar.title), sketch.layout.width() - 2 * sketch.layout.margin());
  const double labels = widest(face, ticks);  // half of each outer label extends beyond the bar
  const double head = title.empty() ? 0 : face.line();
  const double height = head + graph + 3 * w + thick + tick + face.line();
  const double width = std::max(length + labels, face.width(title));
  const auto corner = sketch.layout.take(bar.place, width, height);
  if (!corner) return;
  const int column = column_of(bar.place);
  const double left = corner->x + (column < 0   ? labels / 2
                                   : column > 0 ? width - length - labels / 2
                                                : (width - length) / 2);
  const Bar place{static_cast<int>(std::round(left)), static_cast<int>(std::round(corner->y + head + graph + 2 * w)),
                  static_cast<int>(length), static_cast<int>(thick), false};
  add_colors(sketch, place, scale, function);
  add_graph(sketch, place, scale, function, graph);
  add_frame(sketch, place);
  auto& marks = sketch.sheet.on_top.marks;
  const double from = place.y + place.height + w;
  for (const Tick& t : ticks) {
    const double x = place.at(scale.place(t.value));
    marks.emplace_back(Stroke{{{sketch.crisp(x), from}, {sketch.crisp(x), from + tick}}, w});
    marks.emplace_back(Label{{x - face.width(t.label) / 2, from + tick + face.ascent()}, t.label});
  }
  if (title.empty()) return;
  const double middle = place.x + place.width / 2.0;
  const double title_left =
      std::clamp(middle - face.width(title) / 2, corner->x, corner->x + width - face.width(title));
  marks.emplace_back(Label{{title_left, corner->y + face.ascent()}, title});
}

}  // namespace

std::array<double, 2> range_of(const ColorBar& bar, const TransferFunction& function) {
  if (bar.range) return *bar.range;
  if (function.knots().empty()) return {0, 0};
  return {function.knots().front().value, function.knots().back().value};
}

void add_color_bar(Sketch& sketch, const ColorBar& bar, const TransferFunction& function) {
  const auto [low, high] = range_of(bar, function);
  const Scale scale{low, high, bar.logarithmic};
  if (row_of(bar.place) == 0)
    add_upright(sketch, bar, function, scale);
  else
    add_level(sketch, bar, function, scale);
}

}  // namespace tessera::annotation
