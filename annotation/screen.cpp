// SPDX-License-Identifier: BSD-3-Clause
#include "annotation/screen.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tessera::annotation {

Screen::Screen(const View& view) : view_(view) {
  validate(view.camera);
  validate(view.size);
  basis_ = view_basis(view.camera);
  const double half_height = 0.5 * view.size.height;
  scale_ = view.camera.projection == ProjectionKind::perspective
               ? half_height / std::tan(view.camera.view_angle / 2 * std::numbers::pi / 180)
               : half_height / view.camera.parallel_scale;
}

Screen::Homogeneous Screen::homogeneous(const glm::dvec3& world) const {
  const glm::dvec3 from_eye = world - view_.camera.position;
  const double depth = glm::dot(from_eye, basis_.forward);
  const double w = view_.camera.projection == ProjectionKind::perspective ? depth : 1;
  return {scale_ * glm::dot(from_eye, basis_.right) + 0.5 * view_.size.width * w,
          -scale_ * glm::dot(from_eye, basis_.up) + 0.5 * view_.size.height * w, w, depth};
}

std::optional<glm::dvec2> Screen::pixel(const glm::dvec3& world) const {
  const Homogeneous h = homogeneous(world);
  if (!(h.depth > 0)) return std::nullopt;
  return glm::dvec2(h.x / h.w, h.y / h.w);
}

std::optional<Segment> Screen::segment(const glm::dvec3& a, const glm::dvec3& b, double margin) const {
  // The algorithm of Liang and Barsky, applied before the division by w, where each bound is linear along the line.
  const Homogeneous p = homogeneous(a), q = homogeneous(b);
  const double least = 1e-12 * std::max(std::abs(p.depth), std::abs(q.depth));
  double from = 0, to = 1;
  const auto keep = [&](double at_p, double at_q) {  // keeps the part of the line where the bound is positive
    if (at_p < 0 && at_q < 0) to = -1;
    if (at_p < 0 && at_q >= 0) from = std::max(from, at_p / (at_p - at_q));
    if (at_p >= 0 && at_q < 0) to = std::min(to, at_p / (at_p - at_q));
  };
  const double right = view_.size.width + margin, bottom = view_.size.height + margin;
  keep(p.depth - least, q.depth - least);
  keep(p.x + margin * p.w, q.x + margin * q.w);
  keep(p.y + margin * p.w, q.y + margin * q.w);
  keep(right * p.w - p.x, right * q.w - q.x);
  keep(bottom * p.w - p.y, bottom * q.w - q.y);
  if (!(from <= to)) return std::nullopt;
  const auto at = [&](double t) {
    const double w = std::lerp(p.w, q.w, t);
    // Because of rounding, a cut end may be slightly outside, and w may be 0 if both ends are in the plane of the eye.
    return glm::dvec2(std::clamp(std::lerp(p.x, q.x, t) / w, -margin, right),
                      std::clamp(std::lerp(p.y, q.y, t) / w, -margin, bottom));
  };
  const Segment cut{at(from), at(to)};
  for (const glm::dvec2& end : cut)
    if (!std::isfinite(end.x) || !std::isfinite(end.y)) return std::nullopt;
  return cut;
}

double Screen::pixels_per_unit() const {
  if (view_.camera.projection == ProjectionKind::orthographic) return scale_;
  return scale_ / glm::dot(view_.camera.focal_point - view_.camera.position, basis_.forward);
}

bool Screen::faces_eye(const Box& box, int axis, bool high) const {
  if (view_.camera.projection == ProjectionKind::orthographic)
    return high ? basis_.forward[axis] < 0 : basis_.forward[axis] > 0;
  const double eye = view_.camera.position[axis];
  return high ? eye > box.high[axis] : eye < box.low[axis];
}

glm::dvec3 corner(const Box& box, int bits) {
  return {(bits & 1) != 0 ? box.high.x : box.low.x, (bits & 2) != 0 ? box.high.y : box.low.y,
          (bits & 4) != 0 ? box.high.z : box.low.z};
}

std::array<BoxEdge, 12> box_edges() {
  std::array<BoxEdge, 12> edges{};
  std::size_t n = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int bits = 0; bits < 8; ++bits)
      if ((bits >> axis & 1) == 0) edges[n++] = {bits, axis};
  return edges;
}

int faces_towards_eye(const Screen& screen, const Box& box, const BoxEdge& edge) {
  int count = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (axis != edge.axis && screen.faces_eye(box, axis, (edge.corner >> axis & 1) != 0)) ++count;
  return count;
}

}  // namespace tessera::annotation
