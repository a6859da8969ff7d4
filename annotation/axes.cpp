// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "annotation/sketch.hpp"
#include "annotation/ticks.hpp"

namespace tessera::annotation {
namespace {

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};
constexpr std::array<Pen, 3> axis_pens{Pen::x_axis, Pen::y_axis, Pen::z_axis};

/// A label of this text, centred at `middle`.
Label centred(const Typeface& face, const glm::dvec2& middle, std::string text, Pen pen) {
  const double width = face.width(text);
  return {{middle.x - width / 2, middle.y + 0.36 * face.size()}, std::move(text), pen};
}

void add_arrow(Sketch& sketch, const glm::dvec2& from, const glm::dvec2& along, Pen pen) {
  auto& marks = sketch.sheet.on_top.marks;
  const double size = sketch.typeface.size(), width = 1.5 * sketch.line_width();
  const double length = glm::length(along);
  const double head = std::min(0.55 * size, length);
  if (length < 1) return;  // the line is seen along its direction
  const glm::dvec2 unit = along / length, across(-unit.y, unit.x), tip = from + along;
  marks.emplace_back(Stroke{{from, tip - unit * (0.9 * head)}, width, pen});
  marks.emplace_back(
      Shape{{tip, tip - unit * head + across * (0.45 * head), tip - unit * head - across * (0.45 * head)}, pen});
}

/// Corners of the box of a label.
struct Box2 {
  glm::dvec2 low, high;
  [[nodiscard]] bool meets(const Box2& other) const {
    return low.x < other.high.x && other.low.x < high.x && low.y < other.high.y && other.low.y < high.y;
  }
};

/// The scale along one axis of the data's box. It is drawn at one of the four edges of the box in the direction of the
/// axis.
class EdgeAxis {
 public:
  EdgeAxis(Sketch& sketch, const Box& box, int axis, std::vector<Box2>& taken)
      : sketch_(sketch), box_(box), axis_(axis), taken_(taken) {}

  void add(bool outlined) {
    if (!choose()) return;
    const Pen pen = axis_pens[static_cast<std::size_t>(axis_)];
    const bool behind = faces_towards_eye(sketch_.screen, box_, edge_) == 0;
    Drawing& drawing = behind ? sketch_.sheet.behind : sketch_.sheet.before;
    if (!outlined) drawing.marks.emplace_back(Stroke{{line_[0], line_[1]}, sketch_.line_width(), Pen::ink});
    const double size = sketch_.typeface.size();
    const double tick = 0.4 * size;
    // Labels that do not fit next to each other are left out.
    const int most = std::clamp(static_cast<int>(glm::length(line_[1] - line_[0]) / (4 * size)), 3, 10);
    std::vector<Tick> ticks = linear_ticks(box_.low[axis_], box_.high[axis_], most);
    double widest = 0;
    for (const Tick& t : ticks) widest = std::max(widest, sketch_.typeface.width(t.label));
    for (const Tick& t : ticks) {
      const auto at = place_of(t.value);
      if (!at) continue;
      if (put({*at + outward_ * (tick + 0.3 * size)}, t.label, Pen::ink))
        drawing.marks.emplace_back(Stroke{{*at, *at + outward_ * tick}, sketch_.line_width(), Pen::ink});
    }
    const glm::dvec2 middle = (line_[0] + line_[1]) * 0.5;
    const double beyond = tick + 0.9 * size + std::abs(outward_.x) * widest + std::abs(outward_.y) * size;
    const auto axis = static_cast<std::size_t>(axis_);
    // If a title would overlap labels, it is moved further outwards.
    for (int further = 0; further < 4; ++further)
      if (put(middle + outward_ * (beyond + further * size), sketch_.with_unit(axis_names[axis]), pen)) break;
  }

 private:
  /// Chooses the edge at the silhouette of the box. If there are several, the one that is lowest and then furthest left
  /// is chosen; if the eye is in the box, it is the longest edge on the image. Returns false if no edge is visible.
  bool choose() {
    const double margin = 0;
    double best = -std::numeric_limits<double>::infinity();
    const auto center = sketch_.screen.pixel(box_.low + (box_.high - box_.low) * 0.5);
    for (const BoxEdge& edge : box_edges()) {
      if (edge.axis != axis_) continue;
      const auto line =
          sketch_.screen.segment(corner(box_, edge.corner), corner(box_, edge.corner | 1 << axis_), margin);
      if (!line) continue;
      const double length = glm::length((*line)[1] - (*line)[0]);
      if (length < 2 * sketch_.typeface.size()) continue;
      const glm::dvec2 middle = ((*line)[0] + (*line)[1]) * 0.5;
      const glm::dvec2 inside = center.value_or(glm::dvec2(sketch_.layout.width(), sketch_.layout.height()) * 0.5);
      const glm::dvec2 unit = ((*line)[1] - (*line)[0]) / length;
      glm::dvec2 outward(-unit.y, unit.x);
      if (glm::dot(outward, middle - inside) < 0) outward = -outward;
      const double side = sketch_.layout.width() + sketch_.layout.height();
      const bool at_border = faces_towards_eye(sketch_.screen, box_, edge) == 1;
      // Lower edges are preferred, then edges further left. Edges at the silhouette are preferred to all others.
      const double score =
          (at_border ? 10 : 0) + length / side + (outward.y - 0.7 * outward.x) + 0.1 * (middle.y - middle.x) / side;
      if (score <= best) continue;
      best = score, edge_ = edge, line_ = *line, outward_ = outward;
    }
    return std::isfinite(best);
  }

  /// Returns the position of a value on the line of the edge; none if it is outside the image.
  [[nodiscard]] std::optional<glm::dvec2> place_of(double value) const {
    glm::dvec3 world = corner(box_, edge_.corner);
    world[axis_] = value;
    const auto at = sketch_.screen.pixel(world);
    if (!at || at->x < 0 || at->y < 0 || at->x > sketch_.layout.width() || at->y > sketch_.layout.height())
      return std::nullopt;
    return at;
  }

  /// Adds a label that begins at `from` and extends outwards, shifted into the image. Returns false if it would overlap
  /// another label.
  bool put(const glm::dvec2& from, const std::string& text, Pen pen) {
    const Typeface& face = sketch_.typeface;
    const glm::dvec2 half(face.width(text) / 2, 0.5 * face.size());
    const double reach = std::abs(outward_.x) * half.x + std::abs(outward_.y) * half.y;
    const glm::dvec2 room(sketch_.layout.width(), sketch_.layout.height()), edge = half + glm::dvec2(2);
    if (room.x < 2 * edge.x || room.y < 2 * edge.y) return false;
    const glm::dvec2 middle = glm::clamp(from + outward_ * reach, edge, room - edge);
    const double gap = 0.25 * face.size();
    const Box2 box{middle - half - glm::dvec2(gap), middle + half + glm::dvec2(gap)};
    if (std::ranges::any_of(taken_, [&](const Box2& other) { return box.meets(other); })) return false;
    taken_.push_back({middle - half, middle + half});
    sketch_.sheet.before.marks.emplace_back(centred(face, middle, text, pen));
    return true;
  }

  Sketch& sketch_;
  const Box& box_;
  int axis_;
  std::vector<Box2>& taken_;
  BoxEdge edge_{};
  Segment line_{};
  glm::dvec2 outward_{};
};

}  // namespace

void add_triad(Sketch& sketch, Place place) {
  const Typeface& face = sketch.typeface;
  const double arm = std::min(2.4 * face.size(), 0.12 * std::min(sketch.layout.width(), sketch.layout.height()));
  const double around = arm + 1.1 * face.size();
  const auto corner_at = sketch.layout.take(place, 2 * around, 2 * around);
  if (!corner_at) return;
  const glm::dvec2 middle = *corner_at + glm::dvec2(around);
  const ViewBasis& basis = sketch.screen.basis();
  std::array<int, 3> order{0, 1, 2};
  std::ranges::stable_sort(order, [&](int a, int b) { return basis.forward[a] > basis.forward[b]; });
  for (const int axis : order) {  // the farthest axis is drawn first
    const Pen pen = axis_pens[static_cast<std::size_t>(axis)];
    const glm::dvec2 along(basis.right[axis], -basis.up[axis]);
    add_arrow(sketch, middle, along * arm, pen);
    const double length = glm::length(along);
    // If an axis is seen along its direction, its letter is next to the middle of the triad.
    const glm::dvec2 at =
        length > 0.15 ? along * arm + along / length * (0.7 * face.size()) : glm::dvec2(-0.6, 0.6) * face.size();
    sketch.sheet.on_top.marks.emplace_back(centred(face, middle + at, axis_names[static_cast<std::size_t>(axis)], pen));
  }
}

void add_box_axes(Sketch& sketch, const Box& box, bool outlined) {
  if (box.empty()) return;
  std::vector<Box2> taken;
  for (const auto& [low, high] : sketch.layout.taken()) taken.push_back({low, high});
  for (int axis = 0; axis < 3; ++axis) EdgeAxis(sketch, box, axis, taken).add(outlined);
}

void add_outline(Sketch& sketch, const Box& box) {
  if (box.empty()) return;
  const double width = sketch.line_width();
  for (const BoxEdge& edge : box_edges()) {
    const auto line =
        sketch.screen.segment(corner(box, edge.corner), corner(box, edge.corner | 1 << edge.axis), 4 * width);
    if (!line) continue;
    const bool behind = faces_towards_eye(sketch.screen, box, edge) == 0;
    (behind ? sketch.sheet.behind : sketch.sheet.before).marks.emplace_back(Stroke{{(*line)[0], (*line)[1]}, width});
  }
}

}  // namespace tessera::annotation
