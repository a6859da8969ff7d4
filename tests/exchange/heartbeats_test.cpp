// SPDX-License-Identifier: BSD-3-Clause
// Ranks that stop and continue, in a simulated job: which ranks report it, how often, and which do not.
#include "exchange/heartbeats.hpp"

#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <random>
#include <string>

#include "support/some_cases.hpp"

namespace tessera::exchange {
namespace {

using std::chrono::milliseconds;
using Clock = Heartbeats::Clock;

constexpr milliseconds timeout(8000), step(10);

/// Ranks whose engines check their messages every 10 ms of a simulated clock, unless they are stopped. Messages take up
/// to `delay`.
class SimulatedJob {
 public:
  SimulatedJob(int ranks, bool ends_run, std::uint64_t seed, milliseconds delay = milliseconds(20))
      : random_(seed), delay_(delay), stopped_(static_cast<std::size_t>(ranks)), inboxes_(stopped_.size()) {
    reports.resize(stopped_.size());
    for (int rank = 0; rank < ranks; ++rank)
      ranks_.emplace_back(rank, ranks,
                          StallSettings{timeout, ends_run,
                                        [this, rank](const std::string& words) {
                                          reports[static_cast<std::size_t>(rank)].push_back(words);
                                        }},
                          "process " + std::to_string(1000 + rank), now_);
  }

  void stop(int rank, bool stopped = true) { stopped_[static_cast<std::size_t>(rank)] = stopped; }

  void run(milliseconds time) {
    for (const auto end = now_ + time; now_ < end; now_ += step)
      for (std::size_t rank = 0; rank < ranks_.size(); ++rank)
        if (!stopped_[rank]) turn(rank);
  }

  [[nodiscard]] std::vector<std::string> all_reports() const {
    std::vector<std::string> all;
    for (const auto& of_rank : reports) all.insert(all.end(), of_rank.begin(), of_rank.end());
    return all;
  }
  /// Ranks that would end the run, and the rank that each has lost.
  [[nodiscard]] std::vector<std::array<int, 2>> losses() const {
    std::vector<std::array<int, 2>> losses;
    for (std::size_t rank = 0; rank < ranks_.size(); ++rank)
      if (ranks_[rank].lost()) losses.push_back({static_cast<int>(rank), ranks_[rank].lost()->rank});
    return losses;
  }
  [[nodiscard]] const Heartbeats& rank(int rank) const { return ranks_[static_cast<std::size_t>(rank)]; }

  std::vector<std::vector<std::string>> reports;  ///< by rank

 private:
  struct Mail {
    Clock::time_point arrives;
    int from;
    Bytes bytes;
  };

  void turn(std::size_t rank) {
    auto& inbox = inboxes_[rank];
    for (; !inbox.empty() && inbox.front().arrives <= now_; inbox.pop_front())
      ranks_[rank].take(inbox.front().from, inbox.front().bytes);
    for (auto& message : ranks_[rank].turn(now_)) {
      const milliseconds delay(std::uniform_int_distribution<int>(0, static_cast<int>(delay_.count()))(random_));
      inboxes_[static_cast<std::size_t>(message.to)].push_back(
          {now_ + delay, static_cast<int>(rank), std::move(message.bytes)});
    }
  }

  std::mt19937_64 random_;
  milliseconds delay_;
  Clock::time_point now_{};
  std::vector<bool> stopped_;
  std::vector<std::deque<Mail>> inboxes_;
  std::vector<Heartbeats> ranks_;
};

TEST(Heartbeats, ReportsNothingWhileAllRanksRunWithSlowMessages) {
  for (const int delay : {0, 500, 3000, 6000}) {
    SimulatedJob job(4, true, 1, milliseconds(delay));
    job.run(100 * timeout);
    EXPECT_TRUE(job.all_reports().empty()) << delay;
    EXPECT_TRUE(job.losses().empty()) << delay;
  }
}

TEST(Heartbeats, ReportsAStoppedRankOnceAndItsReturn) {
  SimulatedJob job(4, false, 1);
  job.run(timeout);
  job.stop(2);
  job.run(timeout - milliseconds(1500));
  EXPECT_TRUE(job.all_reports().empty());
  job.run(milliseconds(2000));
  ASSERT_EQ(job.all_reports().size(), 1u);
  ASSERT_EQ(job.reports[0].size(), 1u);
  EXPECT_EQ(job.reports[0][0].find("rank 2 of 4 (process 1002) has been silent for 8"), 0u) << job.reports[0][0];
  job.stop(2, false);
  job.run(timeout);
  ASSERT_EQ(job.all_reports().size(), 2u);
  EXPECT_EQ(job.reports[0][1].find("rank 2 of 4 (process 1002) is back after 9"), 0u) << job.reports[0][1];
}

TEST(Heartbeats, ALongStallIsReportedAgainAtDoublingIntervals) {
  SimulatedJob job(2, false, 1);
  job.stop(1);
  job.run(35 * timeout);
  EXPECT_EQ(job.all_reports().size(), 6u);  // after 1, 2, 4, 8, 16 and 32 times
}

TEST(Heartbeats, TheLowestRunningRankReportsAStoppedFirstRank) {
  for (const int also_stopped : {0, 1}) {
    SimulatedJob job(5, false, 1);
    job.run(timeout);
    for (int rank = 0; rank <= also_stopped; ++rank) job.stop(rank);
    job.run(timeout + milliseconds(2000));
    ASSERT_EQ(job.all_reports().size(), 1u);
    const auto& words = job.reports[static_cast<std::size_t>(also_stopped) + 1];
    ASSERT_EQ(words.size(), 1u);
    EXPECT_EQ(words[0].find("rank 0 of 5 (process 1000) has been silent"), 0u) << words[0];
  }
}

TEST(Heartbeats, OneRankEndsTheRunOnRequest) {
  for (const int stopped : {0, 1, 3}) {
    SimulatedJob job(4, true, 1);
    job.run(timeout);
    job.stop(stopped);
    job.run(timeout + timeout / 2);
    const int judge = stopped == 0 ? 1 : 0;
    EXPECT_EQ(job.losses(), (std::vector<std::array<int, 2>>{{judge, stopped}})) << stopped;
    EXPECT_TRUE(job.all_reports().empty());
    const scene::Error& error = job.rank(judge).lost()->error;
    EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
    EXPECT_NE(std::string(error.what()).find("rank " + std::to_string(stopped) + " of 4"), std::string::npos);
  }
}

TEST(Heartbeats, AJobThatWasStoppedAsAWholeReportsNoRank) {
  for (int ranks = 2; ranks < 6; ++ranks) {
    SimulatedJob job(ranks, true, 1);
    job.run(timeout);
    for (int rank = 0; rank < ranks; ++rank) job.stop(rank);
    job.run(50 * timeout);
    for (int rank = 0; rank < ranks; ++rank) job.stop(rank, false);
    job.run(3 * timeout);
    EXPECT_TRUE(job.losses().empty());
  }
}

TEST(Heartbeats, RandomStopsAreNoticedIfTheyAreLongAndOnlyThen) {
  constexpr int cases = 3000;
  test::SomeCases some(5);
  for (int number = 0; number < cases; ++number) {
    if (!some.next()) continue;
    const std::uint64_t seed = 20261123u + static_cast<std::uint64_t>(number);
    std::mt19937_64 random(seed);
    const int ranks = std::uniform_int_distribution<int>(2, 9)(random);
    SimulatedJob job(ranks, false, seed, milliseconds(std::uniform_int_distribution<int>(0, 80)(random)));
    job.run(milliseconds(std::uniform_int_distribution<int>(0, 9000)(random)));
    const int stopped = std::uniform_int_distribution<int>(0, ranks - 1)(random);
    // The length of the stop in timeouts. An eighth of a timeout and a message's delay may pass between the last
    // heartbeat and the stop, and rank r waits r quarters of a second longer than a timeout.
    const double length = std::uniform_real_distribution<double>(0, 1.9)(random);
    job.stop(stopped);
    job.run(milliseconds(static_cast<int>(length * 8000)));
    job.stop(stopped, false);
    job.run(2 * timeout);
    const auto words = job.all_reports();
    const std::string name = "rank " + std::to_string(stopped) + " of " + std::to_string(ranks);
    for (const auto& line : words) EXPECT_EQ(line.find(name), 0u) << line << ", seed " << seed;
    if (length < 0.7) {
      EXPECT_EQ(words.size(), 0u) << "seed " << seed;
    }
    if (length > 1.3 && length < 1.7) {
      EXPECT_EQ(words.size(), 2u) << "seed " << seed;
    }
    if (HasFailure()) return;
  }
}

TEST(StallWatch, ChargesNoRankWithTheTimeThatTheWatcherDidNotRun) {
  const StallWatch::Clock::time_point begin{};
  StallWatch watch({1}, timeout, begin);
  EXPECT_TRUE(watch.look(begin + 1000 * timeout).empty());
  EXPECT_TRUE(watch.look(begin + 2000 * timeout).empty());  // an eighth each
  for (int i = 2; i < 7; ++i) EXPECT_TRUE(watch.look(begin + (1000 + i) * 1000 * timeout).empty()) << i;
  EXPECT_EQ(watch.look(begin + 3000000 * timeout).size(), 1u);
}

}  // namespace
}  // namespace tessera::exchange
