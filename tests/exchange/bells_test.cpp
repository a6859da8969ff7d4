#include "exchange/bells.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "exchange/collectives.hpp"
#include "exchange/loopback_transport.hpp"

namespace tessera::exchange {
namespace {

using std::chrono::seconds;

TEST(Bells, WakeTheRankThatTheyAreRungFor) {
  run_ranks(3, [](Transport& transport) {
    const auto bells = Bells::hung(transport);
    ASSERT_NE(bells, nullptr);
    EXPECT_TRUE(bells->of_all());
    const std::uint32_t heard = bells->heard();
    barrier(transport);
    if (transport.rank() == 0) {
      for (const int rank : {1, 2}) bells->ring(rank);
      EXPECT_EQ(bells->heard(), heard);  // nobody has rung here
      return;
    }
    const auto start = std::chrono::steady_clock::now();
    while (bells->heard() == heard && std::chrono::steady_clock::now() - start < seconds(20))
      bells->wait(heard, seconds(5));
    EXPECT_EQ(bells->heard(), heard + 1);
    bells->wait(heard, seconds(30));  // it has rung since: at once
    EXPECT_LT(std::chrono::steady_clock::now() - start, seconds(20));
  });
}

TEST(Bells, ARankThatNobodyRingsForSleepsAsLongAsItWants) {
  run_ranks(2, [](Transport& transport) {
    const auto bells = Bells::hung(transport);
    const auto start = std::chrono::steady_clock::now();
    const std::uint32_t heard = bells->heard();
    // A signal may wake it early.
    while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(50))
      bells->wait(heard, std::chrono::milliseconds(60));
    EXPECT_EQ(bells->heard(), heard);
  });
}

TEST(Bells, OfOneRankThereAreNone) {
  run_ranks(1, [](Transport& transport) { EXPECT_EQ(Bells::hung(transport), nullptr); });
}

}  // namespace
}  // namespace tessera::exchange
