// SPDX-License-Identifier: BSD-3-Clause
#include "scene/frame_counters.hpp"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace tessera::scene {
namespace {

/// Each is in its list once, and is put together as it says.
template <class Counters, std::size_t count>
void expect_listed_once(const std::array<Counter<Counters>, count>& list) {
  std::set<std::string_view> names;
  Counters a, b;
  std::uint64_t n = 1;
  for (const auto& counter : list) {
    names.insert(counter.name);
    EXPECT_EQ(a.*counter.member, 0u) << counter.name << " is another one, too";
    a.*counter.member = n, b.*counter.member = 100 * n;
    ++n;
  }
  EXPECT_EQ(names.size(), list.size());
  Counters both = a;
  both += b;
  n = 1;
  for (const auto& counter : list) {
    EXPECT_EQ(both.*counter.member, counter.together == Counter<Counters>::Together::sum ? 101 * n : 100 * n);
    ++n;
  }
}

TEST(FrameCounters, EachIsInTheListOnceAndIsPutTogetherAsItSays) {
  expect_listed_once(frame_counters);
  expect_listed_once(grid_counters);
}

TEST(FrameCounters, TheReferenceSaysWhatEachCounts) {
  std::ifstream file(TESSERA_SOURCE_DIR "/docs/REFERENCE.md");
  const std::string guide{std::istreambuf_iterator<char>(file), {}};
  const auto expect_said = [&](std::string_view name, std::string_view meaning) {
    EXPECT_NE(guide.find("| `" + std::string(name) + "` | " + std::string(meaning) + " |"), std::string::npos) << name;
  };
  for (const FrameCounter& counter : frame_counters) expect_said(counter.name, counter.meaning);
  for (const GridCounter& counter : grid_counters) expect_said(counter.name, counter.meaning);
}

}  // namespace
}  // namespace tessera::scene
