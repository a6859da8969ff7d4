#include "projection/depth_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <tuple>

#include "support/instruction_sets.hpp"

namespace tessera::projection {
namespace {

bool before(const TileEntry& a, const TileEntry& b) {
  return std::tie(a.near_depth, a.tet) < std::tie(b.near_depth, b.tet);
}

/// The same entries as std::sort has them, equal depths by tet.
void expect_ordered(std::vector<TileEntry> entries, DepthOrderScratch& scratch, const std::string& what) {
  std::vector<TileEntry> expected = entries;
  std::sort(expected.begin(), expected.end(), before);
  order_by_depth(entries, scratch);
  for (std::size_t i = 0; i < entries.size(); ++i)
    ASSERT_TRUE(entries[i].near_depth == expected[i].near_depth && entries[i].tet == expected[i].tet)
        << what << ", " << entries.size() << " entries, entry " << i;
}

constexpr std::uint32_t seed = 3;

std::map<std::string, std::function<float(std::size_t)>> depths(std::mt19937& random) {
  const auto unit = [&random] { return std::uniform_real_distribution<float>(0, 1)(random); };
  return {{"even", [=](std::size_t) { return unit(); }},
          {"few values", [=](std::size_t) { return std::floor(unit() * 7); }},
          {"one value", [](std::size_t) { return 3.0f; }},
          {"signs and zeros", [=](std::size_t i) { return i % 3 == 0   ? -0.0f
                                                          : i % 3 == 1 ? 0.0f
                                                                       : unit() - 0.5f; }},
          {"one far outlier", [=](std::size_t i) { return i == 7 ? 1e30f : unit(); }},
          {"two far apart crowds", [=](std::size_t i) { return (i % 2 == 0 ? -1e20f : 1e20f) * (1 + 1e-6f * unit()); }},
          {"every size", [=](std::size_t) { return std::ldexp(1 + unit(), -static_cast<int>(unit() * 120)); }},
          {"all of float", [=](std::size_t) { return (unit() - 0.5f) * 2 * 3.3e38f; }},
          {"smallest steps", [=](std::size_t) { return std::floor(unit() * 100) * 1.4e-45f; }},
          {"falling", [](std::size_t i) { return -static_cast<float>(i); }},
          {"rising", [](std::size_t i) { return static_cast<float>(i); }},
          {"infinite", [=](std::size_t i) { return i % 5 == 0   ? HUGE_VALF
                                                   : i % 5 == 1 ? -HUGE_VALF
                                                                : unit(); }}};
}

TEST(DepthOrder, OrdersByDepthThenTetWhateverTheDepths) {
  tests::for_each_instruction_set([](const char* name) {
    std::mt19937 random(seed);
    DepthOrderScratch scratch;
    for (const auto& [what, depth] : depths(random))
      for (const std::size_t n : {0, 1, 2, 3, 24, 25, 100, 1000, 5003}) {
        std::vector<TileEntry> entries;
        for (std::size_t i = 0; i < n; ++i) entries.push_back({depth(i), static_cast<std::uint32_t>(i)});
        const std::string where = std::string(name) + ", " + what;
        expect_ordered(entries, scratch, where);
        std::shuffle(entries.begin(), entries.end(), random);
        expect_ordered(entries, scratch, where + ", tets in any order");
      }
  });
}

TEST(DepthOrder, OfRepeatedTetsAnyOrderWillDo) {
  std::vector<TileEntry> entries(100, TileEntry{1, 5});
  entries[50] = {0, 9};
  DepthOrderScratch scratch;
  order_by_depth(entries, scratch);
  EXPECT_TRUE(std::is_sorted(entries.begin(), entries.end(), before));
}

}  // namespace
}  // namespace tessera::projection
