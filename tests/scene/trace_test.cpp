// SPDX-License-Identifier: BSD-3-Clause
#include "scene/trace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <thread>

namespace tessera::scene {
namespace {

TEST(Trace, NoSpanOfAnyThreadIsLost) {
  Trace trace;
  constexpr int threads = 8, each = 2000;
  {
    std::vector<std::jthread> workers;
    for (int t = 0; t < threads; ++t)
      workers.emplace_back([&] {
        for (int i = 0; i < each; ++i) const TraceScope scope(&trace, "project", i);
      });
    // A read during writes returns complete spans.
    for (const TraceSpan& span : trace.spans()) EXPECT_EQ(std::string(span.stage), "project");
  }
  std::vector<int> seen(each);
  std::set<std::uint32_t> numbers;
  for (const TraceSpan& span : trace.spans()) {
    ++seen.at(static_cast<std::size_t>(span.frame));
    numbers.insert(span.thread);
    EXPECT_GE(span.wall_us, 0);
    EXPECT_GE(span.cpu_us, 0);
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), threads), each);
  EXPECT_EQ(numbers.size(), static_cast<std::size_t>(threads));
  EXPECT_EQ(*numbers.rbegin(), static_cast<std::uint32_t>(threads - 1));  // dense
}

TEST(Trace, RolesShareARecordingAndNameTheirSpans) {
  std::optional<Trace> projecting(TraceRole::projector);
  Trace compositing(*projecting, TraceRole::compositor);
  { const TraceScope scope(&*projecting, "composite"); }
  { const TraceScope scope(&compositing, "composite"); }
  projecting.reset();
  const auto spans = compositing.spans();
  ASSERT_EQ(spans.size(), 2u);
  EXPECT_EQ(spans[0].role, TraceRole::projector);
  EXPECT_EQ(spans[1].role, TraceRole::compositor);
  EXPECT_EQ(spans[0].thread, spans[1].thread);
  EXPECT_LE(spans[0].start_us + spans[0].wall_us, spans[1].start_us);  // one clock
}

TEST(Trace, ASpanTakesItsRolesFrameUnlessItNamesOne) {
  Trace trace;
  Trace other(trace, TraceRole::compositor);
  trace.set_frame(4);
  { const TraceScope scope(&trace, "cull"); }
  { const TraceScope scope(&trace, "cull", 9); }
  { const TraceScope scope(&other, "cull"); }
  other.add_frame(2, 0);
  const auto spans = trace.spans();
  ASSERT_EQ(spans.size(), 4u);
  EXPECT_EQ(spans[0].frame, 4);
  EXPECT_EQ(spans[1].frame, 9);
  EXPECT_EQ(spans[2].frame, -1);
  EXPECT_EQ(spans[3].frame, 2);
  EXPECT_EQ(std::string(spans[3].stage), "frame");
  EXPECT_EQ(spans[3].role, TraceRole::compositor);
}

TEST(Trace, SpansOfATileCarryItsNumberInEveryRole) {
  Trace trace;
  Trace other(trace, TraceRole::compositor);
  {
    const TraceTile of_tile(&trace, 7);
    { const TraceScope scope(&other, "composite"); }
    StageTimer timer(&trace);
    timer.record("project");
  }
  { const TraceScope scope(&trace, "send", 0, 10, 1, 3); }
  const TraceTile off(nullptr, 7);  // nothing happens
  const auto spans = trace.spans();
  ASSERT_EQ(spans.size(), 3u);
  EXPECT_EQ(spans[0].tile, 7);
  EXPECT_EQ(spans[1].tile, 7);
  EXPECT_EQ(std::string(spans[1].stage), "project");
  EXPECT_EQ(spans[2].tile, -1);
  EXPECT_EQ(spans[2].peer, 3);
}

TEST(Trace, RecordingsThatFollowOrAlternateDoNotMix) {
  // The allocator often reuses the first recording's address for the second.
  for (int i = 0; i < 100; ++i) {
    Trace trace;
    EXPECT_TRUE(trace.spans().empty());
    { const TraceScope scope(&trace, "sort"); }
    EXPECT_EQ(trace.spans().size(), 1u);
  }
  Trace a, b;
  for (int i = 0; i < 10; ++i) const TraceScope first(&a, "sort"), second(&b, "cull");
  ASSERT_EQ(a.spans().size(), 10u);
  ASSERT_EQ(b.spans().size(), 10u);
  for (const TraceSpan& span : a.spans()) EXPECT_EQ(std::string(span.stage), "sort");
}

TEST(Trace, AScopeCountsWhatItMoved) {
  Trace trace;
  {
    TraceScope scope(&trace, "send", 1);
    scope.moved(100, 2);
    scope.moved(5'000'000'000, 1);
  }
  TraceScope(nullptr, "send").moved(1);  // off: nothing happens
  ASSERT_EQ(trace.spans().size(), 1u);
  EXPECT_EQ(trace.spans()[0].bytes, 5'000'000'100u);
  EXPECT_EQ(trace.spans()[0].messages, 3u);
}

}  // namespace
}  // namespace tessera::scene
