#include "sorting/pixel_lists.hpp"

#include <algorithm>

namespace tessera::sorting {
namespace {

/// Up to this many elements insertion beats std::sort; lists from depth-ordered cells are nearly sorted.
constexpr std::ptrdiff_t insertion_limit = 48;

}  // namespace

void PixelLists::sort(const projection::RaySegments& s, std::size_t pixel_count) {
  begin_.assign(pixel_count + 1, 0);
  order_.resize(s.size);
  for (std::size_t i = 0; i < s.size; ++i) ++begin_[s.pixel(i) + 1];
  for (std::size_t p = 0; p < pixel_count; ++p) begin_[p + 1] += begin_[p];
  for (std::size_t i = 0; i < s.size; ++i) order_[begin_[s.pixel(i)]++] = static_cast<std::uint32_t>(i);
  // begin_[p] now stands where p's list ends: shift back by one.
  for (std::size_t p = pixel_count; p > 0; --p) begin_[p] = begin_[p - 1];
  begin_[0] = 0;

  const auto before = [&](std::uint32_t i, std::uint32_t j) {
    if (s.front[i] != s.front[j]) return s.front[i] < s.front[j];
    if (s.back[i] != s.back[j]) return s.back[i] < s.back[j];
    return s.tet(i) < s.tet(j);
  };
  for (std::size_t p = 0; p < pixel_count; ++p) {
    const auto first = order_.begin() + begin_[p], last = order_.begin() + begin_[p + 1];
    if (last - first > insertion_limit) {
      std::sort(first, last, before);
      continue;
    }
    if (first == last) continue;
    for (auto next = first + 1; next != last; ++next) {
      const std::uint32_t element = *next;
      auto hole = next;
      for (; hole != first && before(element, *(hole - 1)); --hole) *hole = *(hole - 1);
      *hole = element;
    }
  }
}

}  // namespace tessera::sorting
