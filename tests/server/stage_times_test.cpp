// SPDX-License-Identifier: BSD-3-Clause
#include "server/stage_times.hpp"

#include <gtest/gtest.h>

namespace tessera::server {
namespace {

TraceSpan span(const char* stage, std::uint32_t thread, double start, double wall) {
  return {stage, thread, start, wall, 0};
}

TEST(StageTimes, ShareTheFrameByTimeInNoStageInside) {
  // Thread 0: 10 of composite, including 4 of integrate; thread 1: 6 of project.
  const auto times = stage_times(
      {span("integrate", 0, 3, 4), span("composite", 0, 0, 10), span("project", 1, 1, 6), span("frame", 0, 0, 20)}, 32);
  EXPECT_EQ(times, (std::map<std::string, double>{{"composite", 12}, {"integrate", 8}, {"project", 12}}));
}

TEST(StageTimes, AreEmptyWithoutSpans) { EXPECT_TRUE(stage_times({}, 5).empty()); }

}  // namespace
}  // namespace tessera::server
