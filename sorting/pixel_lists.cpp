// SPDX-License-Identifier: BSD-3-Clause
#include "sorting/pixel_lists.hpp"

#include <algorithm>

#include "projection/surface_crossings.hpp"

namespace tessera::sorting {
namespace {

/// Up to this number of elements, insertion sort is faster than std::sort, because lists from cells in depth order are
/// nearly sorted.
constexpr std::ptrdiff_t insertion_limit = 48;

}  // namespace

void PixelLists::sort(const projection::RaySegments& s, std::size_t pixel_count, Key key) {
  const std::vector<double>& depth = key == Key::front ? s.front : s.back;
  begin_.assign(pixel_count + 1, 0);
  entries_.resize(s.size);
  for (std::size_t i = 0; i < s.size; ++i) ++begin_[s.pixel(i) + 1];
  for (std::size_t p = 0; p < pixel_count; ++p) begin_[p + 1] += begin_[p];
  for (std::size_t i = 0; i < s.size; ++i) entries_[begin_[s.pixel(i)]++] = {depth[i], static_cast<std::uint32_t>(i)};
  // begin_[p] is now the end of p's list; shifting all values by one makes it the beginning.
  for (std::size_t p = pixel_count; p > 0; --p) begin_[p] = begin_[p - 1];
  begin_[0] = 0;

  const auto before = [&](const Entry& a, const Entry& b) {
    if (a.depth != b.depth) return a.depth < b.depth;
    if (key == Key::front && s.back[a.segment] != s.back[b.segment]) return s.back[a.segment] < s.back[b.segment];
    if (projection::is_crossing(s.scalar_front[a.segment]) && projection::is_crossing(s.scalar_front[b.segment])) {
      const projection::Crossing at_a = projection::crossing_of(s.scalar_front[a.segment]);
      const projection::Crossing at_b = projection::crossing_of(s.scalar_front[b.segment]);
      if (at_a.number != at_b.number) return at_a.number < at_b.number;
      // Triangles have no tet, so crossings are compared by all that they contain.
      if (at_a.cosine != at_b.cosine) return at_a.cosine < at_b.cosine;
      if (s.scalar_back[a.segment] != s.scalar_back[b.segment])
        return s.scalar_back[a.segment] < s.scalar_back[b.segment];
    }
    return s.tet(a.segment) < s.tet(b.segment);
  };
  for (std::size_t p = 0; p < pixel_count; ++p) {
    const auto first = entries_.begin() + begin_[p], last = entries_.begin() + begin_[p + 1];
    if (last - first > insertion_limit) {
      std::sort(first, last, before);
      continue;
    }
    if (first == last) continue;
    for (auto next = first + 1; next != last; ++next) {
      const Entry element = *next;
      auto hole = next;
      for (; hole != first && before(element, *(hole - 1)); --hole) *hole = *(hole - 1);
      *hole = element;
    }
  }
}

}  // namespace tessera::sorting
