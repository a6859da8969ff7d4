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

/// The scalar at part `part` of a segment: not the higher end's, so that a part that lies below a step of the transfer
/// function keeps an end below it.
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
  // By all that a mark holds: equal ones are interchangeable, so the order in which triangles come shows nowhere.
  const auto key = [](const FaceMark& m) { return std::tie(m.pixel, m.depth, m.number, m.cosine, m.value); };
  const auto before = [&](const FaceMark& a, const FaceMark& b) { return key(a) < key(b); };
  std::sort(marks_.begin(), marks_.end(), before);
  // Triangles that coincide are at one depth, whatever was rounded how.
  for (auto first = marks_.begin(); first != marks_.end();) {
    auto last = first + 1;
    while (last != marks_.end() && last->pixel == first->pixel &&
           last->depth - first->depth <= first->tolerance + last->tolerance)
      (last++)->depth = first->depth;
    if (last - first > 1) std::sort(first, last, before);
    first = last;
  }
  for (const FaceMark& mark : marks_) {
    ++begin_[mark.pixel + 1];
    own_ += mark.own ? 1 : 0;
  }
  for (std::size_t p = 1; p < begin_.size(); ++p) begin_[p] += begin_[p - 1];
}

void FaceMarks::append_own(RaySegments& segments) const {
  for (const FaceMark& mark : marks_) {
    if (!mark.own) continue;
    const std::size_t at = segments.size++;
    segments.pixel_and_tet[at] = mark.pixel;
    segments.front[at] = segments.back[at] = mark.depth;
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
    for (const FaceMark& mark : marks)
      if (is_at(mark, front)) {
        segments.front[at] = segments.back[at] = mark.depth;
        return;
      }
    return;
  }
  const double from = segments.scalar_front[at], to = segments.scalar_back[at];
  std::size_t rest = at;  // what is not cut yet
  for (const FaceMark& mark : marks) {
    if (is_at(mark, front)) {
      // Nothing of what is left is before it.
      segments.front[rest] = next_behind(mark.depth);
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
      segments.front[behind] = next_behind(mark.depth), segments.back[behind] = segments.back[rest];
      segments.scalar_front[behind] = scalar, segments.scalar_back[behind] = segments.scalar_back[rest];
      segments.back[rest] = mark.depth, segments.scalar_back[rest] = scalar;
      rest = behind;
    }
  }
}

}  // namespace tessera::projection
