// SPDX-License-Identifier: BSD-3-Clause
#include "server/precedence.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace tessera::server {
namespace {

using std::chrono::milliseconds;

TEST(Precedence, HoldsLongWorkWhileShortWorkRuns) {
  Precedence precedence;
  const Precedence::Clock::time_point start{};
  precedence.pass({});
  precedence.begin_short(start);
  EXPECT_TRUE(precedence.is_held());
  std::atomic<bool> has_passed = false;
  std::thread long_work([&] {
    precedence.pass({});
    has_passed = true;
  });
  EXPECT_FALSE(has_passed);
  precedence.end_short(start + milliseconds(10));
  long_work.join();
  EXPECT_TRUE(has_passed);
}

TEST(Precedence, LetsStoppedWorkPass) {
  Precedence precedence;
  precedence.begin_short({});
  std::stop_source stop;
  std::thread long_work([&] { precedence.pass(stop.get_token()); });
  stop.request_stop();
  long_work.join();
  EXPECT_TRUE(precedence.is_held());
}

TEST(Precedence, LeavesAQuarterOfTheTimeToLongWork) {
  Precedence precedence;
  Precedence::Clock::time_point now{};
  Precedence::Clock::duration held{}, free{};
  for (int i = 0; i < 2000; ++i) {  // without a pause between two short tasks
    precedence.begin_short(now);
    (precedence.is_held() ? held : free) += milliseconds(50);
    now += milliseconds(50);
    precedence.end_short(now);
  }
  EXPECT_GT(free, (held + free) / 5);
  EXPECT_LT(free, (held + free) / 3);
}

TEST(Precedence, IsAlwaysThatOfShortWorkWithPauses) {
  Precedence precedence;
  Precedence::Clock::time_point now{};
  for (int i = 0; i < 2000; ++i) {
    precedence.begin_short(now);
    EXPECT_TRUE(precedence.is_held());
    now += milliseconds(50);
    precedence.end_short(now);
    now += milliseconds(20);
  }
}

}  // namespace
}  // namespace tessera::server
