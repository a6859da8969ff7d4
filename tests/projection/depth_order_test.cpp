// SPDX-License-Identifier: BSD-3-Clause
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

namespace tessera::projection::depth_order_test {
namespace {

bool before(const TileEntry& a, const TileEntry& b) {
  return std::tie(a.near_depth, a.tet) < std::tie(b.near_depth, b.tet);
}

/// Expects the same entries, and no entry that is nearer than an earlier one by more than the slack. Returns the slack.
double expect_ordered(std::vector<TileEntry> entries, DepthOrderScratch& scratch, const std::string& what) {
  std::vector<TileEntry> expected = entries;
  const DepthOrder order = order_by_depth(entries, scratch);
  EXPECT_EQ(order.entries.size(), expected.size()) << what;
  double farthest = -HUGE_VAL;
  std::size_t too_near = 0;
  for (std::size_t i = 0; i < order.entries.size(); ++i) {
    farthest = std::max<double>(farthest, order.entries[i].near_depth);
    too_near += order.entries[i].near_depth < farthest - order.slack ? 1 : 0;
    EXPECT_EQ(order.nearest_from(i), order.entries[i].near_depth - order.slack);
  }
  EXPECT_EQ(too_near, 0) << what << ", " << expected.size() << " entries";

  std::vector<TileEntry> ordered(order.entries.begin(), order.entries.end());
  std::sort(expected.begin(), expected.end(), before);
  std::sort(ordered.begin(), ordered.end(), before);
  const auto same = [](const TileEntry& a, const TileEntry& b) {
    return a.near_depth == b.near_depth && a.tet == b.tet;
  };
  EXPECT_TRUE(std::equal(ordered.begin(), ordered.end(), expected.begin(), expected.end(), same))
      << what << ", " << expected.size() << " entries";
  return order.slack;
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

TEST(DepthOrder, NoEntryIsNearerThanOneBeforeItByMoreThanTheSlack) {
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

TEST(DepthOrder, SlackIsShort) {
  tests::for_each_instruction_set([](const char* name) {
    std::mt19937 random(seed);
    DepthOrderScratch scratch;
    auto of = depths(random);
    for (const std::size_t n : {25, 1000, 5003, 20000}) {
      const auto slack = [&](const std::string& what) {
        std::vector<TileEntry> entries;
        for (std::size_t i = 0; i < n; ++i) entries.push_back({of[what](i), static_cast<std::uint32_t>(i)});
        return expect_ordered(entries, scratch, std::string(name) + ", " + what);
      };
      // There is at least one step for every two entries, up to 4096 steps. The rest of the bound is the slack's margin
      // for rounding.
      EXPECT_LE(slack("even"), 1.02 / std::min(static_cast<double>(n) / 2 - 1, 4095.0)) << name;
      // Large numbers of entries are certainly reordered.
      if (n < 5003) continue;
      for (const char* what : {"one value", "one far outlier", "two far apart crowds", "every size"})
        EXPECT_EQ(slack(what), 0) << name << ", " << what << ", " << n;
    }
  });
}

}  // namespace
}  // namespace tessera::projection::depth_order_test
