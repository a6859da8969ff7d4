// SPDX-License-Identifier: BSD-3-Clause
#include "projection/face_marks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "projection/surface_crossings.hpp"

namespace tessera::projection {
namespace {

bool is_at(const FaceMark& mark, double depth) { return std::abs(mark.depth - depth) <= mark.tolerance; }

double next_behind(double depth) { return std::nextafter(depth, std::numeric_limits<double>::infinity()); }
double next_before(double depth) { return std::nextafter(depth, -std::numeric_limits<double>::infinity()); }

/// Sorts marks at one depth by slope in x, marks with equal slopes in x by slope in y, and marks in one plane by
/// number.
void order_by_slope(std::span<FaceMark> marks, std::size_t axis = 0) {
  if (marks.size() < 2) return;
  if (axis == 2) {
    std::sort(marks.begin(), marks.end(), [](const FaceMark& a, const FaceMark& b) {
      return std::tie(a.number, a.cosine, a.value) < std::tie(b.number, b.cosine, b.value);
    });
    return;
  }
  std::sort(marks.begin(), marks.end(), [&](const FaceMark& a, const FaceMark& b) {
    const auto key = [&](const FaceMark& m) {
      return std::tie(m.slope[axis], m.slope_error[axis], m.number, m.cosine, m.value);
    };
    return key(a) < key(b);
  });
  for (std::size_t first = 0, last; first < marks.size(); first = last) {
    const auto is_one = [&](const FaceMark& mark) {
      return mark.slope[axis] - marks[first].slope[axis] <= mark.slope_error[axis] + marks[first].slope_error[axis];
    };
    for (last = first + 1; last < marks.size() && is_one(marks[last]);) ++last;
    order_by_slope(marks.subspan(first, last - first), axis + 1);
  }
}

/// Sets the encoded depths of marks of one ray at one depth.
void put_in_place(std::span<FaceMark> marks) {
  order_by_slope(marks);
  double place = marks.front().depth;
  for (FaceMark& mark : marks) {
    mark.place = next_behind(place);
    place = next_behind(mark.place);
  }
  for (FaceMark& mark : marks) mark.behind = next_behind(place);
}

/// Sorts the marks of one ray, and sets their encoded depths.
void sort_ray(std::span<FaceMark> marks) {
  // Marks are compared by all fields: equal marks are interchangeable, so the order of the triangles has no effect.
  std::sort(marks.begin(), marks.end(), [](const FaceMark& a, const FaceMark& b) {
    const auto key = [](const FaceMark& m) {
      return std::tie(m.depth, m.number, m.cosine, m.value, m.slope, m.slope_error);
    };
    return key(a) < key(b);
  });
  for (std::size_t first = 0, last; first < marks.size(); first = last) {
    for (last = first + 1; last < marks.size() &&
                           marks[last].depth - marks[first].depth <= marks[first].tolerance + marks[last].tolerance;
         ++last)
      marks[last].depth = marks[first].depth;
    put_in_place(marks.subspan(first, last - first));
  }
}

/// Returns the scalar at the fraction `part` of a segment. It is less than the scalar of the higher end, so that each
/// part of a segment below a step of the transfer function has at least one end below the step.
double scalar_between(double from, double to, double part) {
  if (from == to) return from;
  const auto [low, high] = std::minmax(from, to);
  const double between = std::clamp(from + (to - from) * part, low, high);
  return between == high ? std::nextafter(high, low) : between;
}

}  // namespace

void FaceMarks::reset(std::size_t pixels) {
  marks_.clear();
  begin_.assign(pixels + 1, 0);
  own_ = 0;
}

void FaceMarks::sort() {
  for (const FaceMark& mark : marks_) {
    ++begin_[mark.pixel + 1];
    own_ += mark.own ? 1 : 0;
  }
  for (std::size_t p = 1; p < begin_.size(); ++p) begin_[p] += begin_[p - 1];
  next_ = begin_;
  by_pixel_.resize(marks_.size());
  for (const FaceMark& mark : marks_) by_pixel_[next_[mark.pixel]++] = mark;
  marks_.swap(by_pixel_);
  for (std::size_t p = 0; p + 1 < begin_.size(); ++p)
    if (begin_[p] < begin_[p + 1]) sort_ray(std::span(marks_).subspan(begin_[p], begin_[p + 1] - begin_[p]));
}

void FaceMarks::append_own(RaySegments& segments) const {
  for (const FaceMark& mark : marks_) {
    if (!mark.own) continue;
    const std::size_t at = segments.size++;
    segments.pixel_and_tet[at] = mark.pixel;
    segments.front[at] = segments.back[at] = mark.place;
    segments.scalar_front[at] = marked(Crossing{mark.number, mark.cosine});
    segments.scalar_back[at] = mark.value;
  }
}

void FaceMarks::cut(RaySegments& segments, std::size_t first) const {
  if (marks_.empty()) return;
  const std::size_t end = segments.size;
  for (std::size_t i = first; i < end; ++i) {
    const std::uint32_t p = segments.pixel(i);
    if (begin_[p] == begin_[p + 1]) continue;
    cut_one(segments, i, std::span(marks_).subspan(begin_[p], begin_[p + 1] - begin_[p]));
  }
}

void FaceMarks::cut_one(RaySegments& segments, std::size_t at, std::span<const FaceMark> marks) const {
  const double front = segments.front[at], back = segments.back[at];
  if (is_crossing(segments.scalar_front[at])) {
    const auto mark = std::ranges::find_if(marks, [&](const FaceMark& m) { return is_at(m, front); });
    if (mark == marks.end()) return;
    const std::uint32_t number = crossing_of(segments.scalar_front[at]).number;
    const auto next =
        std::find_if(mark, marks.end(), [&](const FaceMark& m) { return m.depth != mark->depth || m.number > number; });
    const bool is_last = next == marks.end() || next->depth != mark->depth;
    segments.front[at] = segments.back[at] = next_before(is_last ? mark->behind : next->place);
    return;
  }
  const double from = segments.scalar_front[at], to = segments.scalar_back[at];
  std::size_t rest = at;  // the part that is not cut yet
  for (const FaceMark& mark : marks) {
    if (is_at(mark, front)) {
      // The mark is in front of the remaining part.
      segments.front[rest] = mark.behind;
      if (!(segments.front[rest] < segments.back[rest])) {
        segments.front[rest] = segments.back[rest] = mark.depth;
        return;
      }
    } else if (is_at(mark, back)) {
      segments.back[rest] = std::max(segments.front[rest], mark.depth);
      return;
    } else if (mark.depth >= back) {
      return;
    } else if (mark.depth > segments.front[rest]) {
      const double scalar = scalar_between(from, to, (mark.depth - front) / (back - front));
      const std::size_t behind = segments.size++;
      segments.pixel_and_tet[behind] = segments.pixel_and_tet[at];
      segments.front[behind] = mark.behind, segments.back[behind] = segments.back[rest];
      segments.scalar_front[behind] = scalar, segments.scalar_back[behind] = segments.scalar_back[rest];
      segments.back[rest] = mark.depth, segments.scalar_back[rest] = scalar;
      rest = behind;
    }
  }
}

}  // namespace tessera::projection
