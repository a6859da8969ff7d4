// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/host_team.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <numeric>
#include <set>
#include <string>
#include <thread>

#include "exchange/loopback_transport.hpp"
#include "scene/error.hpp"
#include "scene/frame_watch.hpp"

namespace tessera::exchange {
namespace {

using Room = scene::Team::Room;

TEST(HostTeam, IsOfTheRanksThatJoin) {
  run_ranks(5, [](Transport& transport) {
    const bool joins = transport.rank() != 2;
    const auto team = HostTeam::form(transport, joins);
    ASSERT_EQ(team != nullptr, joins);
    if (!joins) return;
    EXPECT_EQ(team->ranks(), (std::vector<int>{0, 1, 3, 4}));
    EXPECT_EQ(team->size(), 4);
    EXPECT_EQ(team->ranks()[static_cast<std::size_t>(team->rank())], transport.rank());
  });
}

TEST(HostTeam, DoesNotFormForOneRank) {
  run_ranks(3, [](Transport& transport) { EXPECT_EQ(HostTeam::form(transport, transport.rank() == 1), nullptr); });
  run_ranks(1, [](Transport& transport) { EXPECT_EQ(HostTeam::form(transport, true), nullptr); });
}

TEST(HostTeam, GathersAWordFromEachRankRepeatedly) {
  run_ranks(4, [](Transport& transport) {
    const auto team = HostTeam::form(transport, true);
    team->begin();
    for (std::uint64_t turn = 0; turn < 300; ++turn) {
      const auto words = team->gather(1000 * turn + static_cast<std::uint64_t>(team->rank()));
      ASSERT_EQ(words.size(), 4u);
      for (std::uint64_t m = 0; m < 4; ++m) ASSERT_EQ(words[m], 1000 * turn + m);
    }
  });
}

TEST(HostTeam, SharesDataThroughGrowthAndShrinking) {
  run_ranks(3, [](Transport& transport) {
    const auto team = HostTeam::form(transport, true);
    team->begin();
    const std::uint32_t* before = nullptr;
    for (const std::size_t count : {10u, 1000u, 3'000'000u, 2'900'000u, 100u, 5'000'000u}) {
      auto* const shared = team->memory_of<std::uint32_t>(Room::entries, count);
      // The memory is reused if it is large enough and at most twice too large.
      if (count == 2'900'000u) {
        EXPECT_EQ(shared, before);
      }
      before = shared;
      const scene::Share own = scene::share_of(count, team.get());
      for (std::size_t i = own.first; i < own.last; ++i) shared[i] = static_cast<std::uint32_t>(7 * i + count);
      team->barrier();
      for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(shared[i], static_cast<std::uint32_t>(7 * i + count));
      team->barrier();
    }
  });
}

TEST(HostTeam, DrawsEachNumberOnceAnEpoch) {
  for (const std::uint32_t stops_at : {1000u, 700u}) {
    std::mutex mutex;
    std::vector<std::multiset<std::uint32_t>> drawn(3);
    run_ranks(3, [&](Transport& transport) {
      const auto team = HostTeam::form(transport, true);
      for (std::size_t epoch = 0; epoch < 3; ++epoch) {
        team->begin();
        for (const std::uint32_t count : {stops_at, 1000u})
          for (std::uint32_t number = team->draw(count); number < count; number = team->draw(count)) {
            const std::lock_guard lock(mutex);
            drawn[epoch].insert(number);
          }
      }
    });
    for (const auto& numbers : drawn) {
      EXPECT_EQ(numbers.size(), 1000u);
      EXPECT_EQ(std::set<std::uint32_t>(numbers.begin(), numbers.end()).size(), 1000u);
    }
  }
}

TEST(HostTeam, ARankThatLeavesAnEpochBlocksNoOtherAndJoinsTheNext) {
  std::atomic<int> stopped = 0;
  run_ranks(3, [&](Transport& transport) {
    const auto team = HostTeam::form(transport, true);
    for (int epoch = 0; epoch < 50; ++epoch) {
      team->begin();
      try {
        team->barrier();
        if (epoch % 3 == team->rank()) throw scene::FrameStopped{};
        team->barrier();
        ADD_FAILURE() << "one is missing";
      } catch (const scene::FrameStopped&) {
        team->leave();
        ++stopped;
      }
    }
    team->begin();
    EXPECT_EQ(team->gather(5), (std::vector<std::uint64_t>{5, 5, 5}));
  });
  EXPECT_EQ(stopped, 150);
}

TEST(HostTeam, AnErrorOfOneEndsTheOthersWait) {
  std::atomic<int> failed = 0;
  EXPECT_THROW(run_ranks(3,
                         [&](Transport& transport) {
                           const auto team = HostTeam::form(transport, true);
                           try {
                             team->begin();
                             if (transport.rank() == 1) throw scene::bad_input("piece_1.vtu: is cut short");
                             team->barrier();
                           } catch (const scene::Error& error) {
                             EXPECT_STREQ(error.what(), "piece_1.vtu: is cut short");
                             ++failed;
                             throw;
                           }
                         }),
               scene::Error);
  EXPECT_EQ(failed, 3);
}

TEST(HostTeam, MemoryThatTheMachineDoesNotHaveIsAnErrorOfAll) {
  std::atomic<int> failed = 0;
  EXPECT_THROW(run_ranks(2,
                         [&](Transport& transport) {
                           const auto team = HostTeam::form(transport, true);
                           team->begin();
                           try {
                             team->memory(Room::entries, std::size_t{1} << 62);
                           } catch (const scene::Error& error) {
                             EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
                             EXPECT_NE(std::string(error.what()).find("memory ran out"), std::string::npos);
                             ++failed;
                             throw;
                           }
                         }),
               scene::Error);
  EXPECT_EQ(failed, 2);
}

TEST(SharedPages, OfAnotherSizeOrMissingAreRefused) {
  const SharedPages pages = SharedPages::made(5000);
  const auto process = static_cast<std::uint64_t>(getpid());
  EXPECT_TRUE(SharedPages::opened(process, pages.descriptor(), 5000));
  EXPECT_FALSE(SharedPages::opened(process, pages.descriptor(), 50000));
  EXPECT_FALSE(SharedPages::opened(process, 100'000, 5000));
  EXPECT_FALSE(SharedPages::opened(process, 0, 4096));  // standard input
}

}  // namespace
}  // namespace tessera::exchange
