// SPDX-License-Identifier: BSD-3-Clause
#include "sorting/pixel_lists.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>
#include <vector>

namespace tessera::sorting::pixel_lists_test {
namespace {

using Key = std::tuple<double, double, std::uint32_t>;

projection::RaySegments segments_of(const std::vector<std::pair<std::uint32_t, Key>>& given) {
  projection::RaySegments s;
  s.reserve(given.size());
  for (const auto& [pixel, key] : given) {
    s.front[s.size] = std::get<0>(key);
    s.back[s.size] = std::get<1>(key);
    s.pixel_and_tet[s.size] = static_cast<std::uint64_t>(std::get<2>(key)) << 32 | pixel;
    ++s.size;
  }
  return s;
}

TEST(PixelLists, OrdersByFrontThenBackThenTetInListsOfAnyLength) {
  std::mt19937 random(3);
  // Pixel 0 is empty, the others get lists from one element to 20,000; depths have few distinct values, so that ties
  // are frequent.
  const std::vector<std::size_t> lengths{0, 1, 2, 47, 48, 49, 1000, 20000};
  std::vector<std::pair<std::uint32_t, Key>> given;
  std::vector<std::vector<Key>> expected(lengths.size());
  for (std::uint32_t p = 0; p < lengths.size(); ++p)
    for (std::uint32_t i = 0; i < lengths[p]; ++i) {
      const double front = random() % 50;
      const Key key{front, front + random() % 3, i};
      given.push_back({p, key});
      expected[p].push_back(key);
    }
  for (int shuffle = 0; shuffle < 3; ++shuffle) {
    std::shuffle(given.begin(), given.end(), random);
    const projection::RaySegments s = segments_of(given);
    PixelLists lists;
    lists.sort(s, lengths.size());
    for (std::uint32_t p = 0; p < lengths.size(); ++p) {
      std::sort(expected[p].begin(), expected[p].end());
      std::vector<Key> sorted;
      for (const auto& [front, i] : lists.pixel(p)) {
        EXPECT_EQ(front, s.front[i]);
        EXPECT_EQ(s.pixel(i), p);
        sorted.push_back({s.front[i], s.back[i], s.tet(i)});
      }
      EXPECT_EQ(sorted, expected[p]);
    }
  }
}

TEST(PixelLists, AZeroLengthSegmentComesBeforeTheOneThatBeginsThere) {
  const projection::RaySegments s = segments_of({{0, {2, 3, 1}}, {0, {2, 2, 9}}, {0, {1, 2, 5}}});
  PixelLists lists;
  lists.sort(s, 1);
  std::vector<std::uint32_t> order;
  for (const auto& entry : lists.pixel(0)) order.push_back(entry.segment);
  EXPECT_EQ(order, (std::vector<std::uint32_t>{2, 1, 0}));
}

TEST(PixelLists, SortedByBackEqualSegmentsStayInTetOrder) {
  std::mt19937 random(4);
  std::vector<std::pair<std::uint32_t, Key>> given;
  // Fronts are noise that must be ignored. Tets arrive in order, as passed to the rasterizer.
  for (std::uint32_t i = 0; i < 3000; ++i)
    given.push_back({static_cast<std::uint32_t>(random() % 20),
                     {static_cast<double>(random() % 100), static_cast<double>(random() % 9), i}});
  const projection::RaySegments s = segments_of(given);
  PixelLists lists;
  lists.sort(s, 20, PixelLists::Key::back);
  std::size_t listed = 0;
  for (std::uint32_t p = 0; p < 20; ++p) {
    const auto list = lists.pixel(p);
    listed += list.size();
    for (std::size_t i = 0; i < list.size(); ++i) {
      EXPECT_EQ(list[i].depth, s.back[list[i].segment]);
      if (i > 0) {
        EXPECT_LT(std::tuple(list[i - 1].depth, list[i - 1].segment), std::tuple(list[i].depth, list[i].segment));
      }
    }
  }
  EXPECT_EQ(listed, 3000u);
}

}  // namespace
}  // namespace tessera::sorting::pixel_lists_test
