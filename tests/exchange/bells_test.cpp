// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/bells.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "exchange/collectives.hpp"
#include "exchange/loopback_transport.hpp"

namespace tessera::exchange {
namespace {

TEST(Bells, WakeTheRankTheyAreRungFor) {
  run_ranks(3, [](Transport& transport) {
    const auto bells = Bells::hung(transport);
    ASSERT_NE(bells, nullptr);
    EXPECT_TRUE(bells->of_all());
    const std::uint32_t before = bells->heard();
    barrier(transport);
    if (transport.rank() == 0) {
      for (const int rank : {1, 2}) bells->ring(rank);
      EXPECT_EQ(bells->heard(), before);  // this rank was sent no wake-up
      return;
    }
    // If the wake-up were lost, the test would hang.
    while (bells->heard() == before) bells->wait(before, std::chrono::hours(1));
    EXPECT_EQ(bells->heard(), before + 1);
    bells->wait(before, std::chrono::hours(1));  // returns at once, because a wake-up was sent after `before`
  });
}

TEST(Bells, ARankWithoutAWakeUpSleepsForItsWholeTimeout) {
  run_ranks(2, [](Transport& transport) {
    const auto bells = Bells::hung(transport);
    const auto start = std::chrono::steady_clock::now();
    const std::uint32_t before = bells->heard();
    // A signal may wake the thread early.
    while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(50))
      bells->wait(before, std::chrono::milliseconds(60));
    EXPECT_EQ(bells->heard(), before);
  });
}

TEST(Bells, OneRankNeedsNone) {
  run_ranks(1, [](Transport& transport) { EXPECT_EQ(Bells::hung(transport), nullptr); });
}

}  // namespace
}  // namespace tessera::exchange
