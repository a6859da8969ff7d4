// SPDX-License-Identifier: BSD-3-Clause
#include "scene/frame_counters.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "tessera/mesh_counts.hpp"

namespace tessera::scene {
namespace {

/// Each counter is in its list once, and combined according to its declaration.
template <class Counters, class Table>
void expect_listed_once(const Table& list) {
  std::set<std::string_view> names;
  std::size_t named = 0;
  Counters a, b;
  std::uint64_t n = 1;
  for (const auto& counter : list) {
    if (!counter.name.empty()) ++named, names.insert(counter.name);
    EXPECT_EQ(a.*counter.member, 0) << counter.name << " is another one, too";
    a.*counter.member = n, b.*counter.member = 100 * n;
    ++n;
  }
  EXPECT_EQ(names.size(), named);
  Counters both = a;
  both += b;
  n = 1;
  for (const auto& counter : list) {
    EXPECT_EQ(both.*counter.member, counter.together == Table::value_type::Together::sum ? 101 * n : 100 * n);
    ++n;
  }
}

TEST(FrameCounters, EachIsListedOnceAndCombinedAsDeclared) {
  expect_listed_once<FrameCounters>(frame_counters);
  expect_listed_once<GridCounters>(grid_counters);
  expect_listed_once<MeshCounts>(mesh_counters);
  expect_listed_once<HigherOrderCells>(higher_order_counters);
  expect_listed_once<HigherOrderCells>(higher_order_bounds);
}

TEST(FrameCounters, TheReferenceDescribesEachCounter) {
  std::ifstream file(TESSERA_SOURCE_DIR "/docs/REFERENCE.md");
  const std::string guide{std::istreambuf_iterator<char>(file), {}};
  const auto expect_described = [&](std::string_view name, std::string_view meaning) {
    EXPECT_NE(guide.find("| `" + std::string(name) + "` | " + std::string(meaning) + " |"), std::string::npos) << name;
  };
  for (const FrameCounter& counter : frame_counters) expect_described(counter.name, counter.meaning);
  for (const GridCounter& counter : grid_counters) expect_described(counter.name, counter.meaning);
}

}  // namespace
}  // namespace tessera::scene
