#include "scene/frame_counters.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace tessera::scene {
namespace {

TEST(FrameCounters, EachIsInTheListOnceAndIsPutTogetherAsItSays) {
  std::set<std::string_view> names;
  FrameCounters a, b;
  std::uint64_t n = 1;
  for (const FrameCounter& counter : frame_counters) {
    names.insert(counter.name);
    EXPECT_EQ(a.*counter.member, 0u) << counter.name << " is another one, too";
    a.*counter.member = n, b.*counter.member = 100 * n;
    ++n;
  }
  EXPECT_EQ(names.size(), frame_counters.size());
  FrameCounters both = a;
  both += b;
  n = 1;
  for (const FrameCounter& counter : frame_counters) {
    EXPECT_EQ(both.*counter.member, counter.together == FrameCounter::Together::sum ? 101 * n : 100 * n);
    ++n;
  }
}

TEST(FrameCounters, TheGuideSaysWhatEachCounts) {
  std::ifstream file(TESSERA_SOURCE_DIR "/docs/GUIDE.md");
  const std::string guide{std::istreambuf_iterator<char>(file), {}};
  for (const FrameCounter& counter : frame_counters)
    EXPECT_NE(guide.find("| `" + std::string(counter.name) + "` | " + std::string(counter.meaning) + " |"),
              std::string::npos)
        << counter.name;
}

}  // namespace
}  // namespace tessera::scene
