// SPDX-License-Identifier: BSD-3-Clause
// Ranks that are stopped: they are reported and waited for, or end the run.

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/film_runs.hpp"

namespace tessera::apps {
namespace {

class RankStalls : public FilmRuns {
 protected:
  void SetUp() override {
    if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
    FilmRuns::SetUp();
  }

  /// Stops a rank during a film of `frames` images until the stall has been reported. Returns the rank's process, or 0
  /// if the film ended too soon.
  pid_t stop_and_go_on(const Running& running, int ranks, int stopped, int frames) {
    // After 20 images, each rank has received the other ranks' first heartbeats, which contain their process ids.
    if (!wait_for_pictures(running, 20)) return 0;
    const auto all = ranks_with(pictures_);
    if (!all.contains(stopped)) return 0;
    const pid_t process = all.at(stopped);
    kill(process, SIGSTOP);
    // Two frames are in flight at a time: with more than 8 left, every rank takes part in the remaining work.
    const bool in_time = pictures() + 8 < static_cast<std::size_t>(frames);
    const std::string name = "rank " + std::to_string(stopped) + " of " + std::to_string(ranks) + " (process " +
                             std::to_string(process) + " on ";
    if (in_time) {
      EXPECT_TRUE(test::await([&] { return running.errors().find(name) != std::string::npos; })) << running.errors();
      EXPECT_TRUE(running.runs());
    }
    kill(process, SIGCONT);
    return in_time ? process : 0;
  }
};

TEST_F(RankStalls, AStoppedRankIsNamedAndWaitedFor) {
  for (const std::string& input : inputs_)
    for (const auto& [ranks, stopped] : input == inputs_[0] ? std::vector<std::pair<int, int>>{{2, 1}, {3, 0}}
                                                            : std::vector<std::pair<int, int>>{{2, 0}, {3, 2}}) {
      int frames = 60;
      for (pid_t process = 0; process == 0; frames *= 2) {
        clear_pictures();
        Words words = film(input, {"--stall-timeout", "1"}, frames);
        if (input == inputs_[0]) words.insert(words.end(), {"--exchange", "segments"});  // the bytes of one process
        std::erase(words, "--quiet");
        Running running(command(ranks, words));
        process = stop_and_go_on(running, ranks, stopped, frames);
        const Outcome outcome = running.wait();
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_TRUE(outcome.own_lines().empty()) << outcome.err;
        if (process == 0) continue;
        EXPECT_NE(outcome.err.find(" has been silent for "), std::string::npos) << outcome.err;
        EXPECT_NE(outcome.err.find(" is back after "), std::string::npos) << outcome.err;
      }
      const Folder alone;
      ASSERT_EQ(tessera({"render", input, "-o", alone / "f_%04d.pfm", "--size", "60x60", "--orbit",
                         std::to_string(frames / 2), "--quiet"})
                    .status,
                0);
      for (const auto& picture : alone.names())
        EXPECT_EQ(contents(pictures_ + "/" + picture), contents(alone / picture)) << picture;
    }
}

TEST_F(RankStalls, AStoppedRankEndsTheRunOnRequest) {
  for (const auto& [input, ranks, stopped] : {std::tuple(inputs_[0], 2, 0), std::tuple(inputs_[1], 4, 3)}) {
    // The timeout is ten seconds: no running rank is silent for that long, however busy the machine is.
    Running running(command(ranks, film(input, {"--stall-timeout", "10", "--on-stall", "abort"})));
    ASSERT_TRUE(wait_for_pictures(running, 3)) << running.wait().err;
    kill(ranks_with(pictures_).at(stopped), SIGSTOP);
    const Outcome outcome = running.wait();
    clear_pictures();
    EXPECT_EQ(outcome.status, 3) << outcome.err;
    const Words lines = outcome.own_lines();
    ASSERT_EQ(lines.size(), 1u) << outcome.err;
    EXPECT_NE(lines[0].find("rank " + std::to_string(stopped) + " of " + std::to_string(ranks)), std::string::npos);
    EXPECT_EQ(outcome.err.find("waiting for it"), std::string::npos) << outcome.err;
  }
}

TEST_F(RankStalls, ARankThatComputesForLongIsNotStopped) {
  constexpr double timeout = 4;
  // Only the first rank verifies. The number of pixels grows until verification takes longer than the stall timeout.
  double verified = 0;
  for (int pixels = 60000; verified < 1.5 * timeout; pixels *= 2) {
    const Outcome outcome =
        mpirun(2, {"render", inputs_[1], "-o", folder_ / "a.pfm", "--size", "1024x1024", "--threads", "1", "--verify",
                   std::to_string(pixels), "--stall-timeout", std::to_string(timeout), "--on-stall", "abort",
                   "--timing", folder_ / "trace.json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("silent"), std::string::npos) << outcome.err;
    const auto trace = nlohmann::json::parse(contents(folder_ / "trace.json"));
    for (const auto& event : trace.at("traceEvents"))
      if (event.at("name") == "verify") verified = event.at("dur").get<double>() / 1e6;
    ASSERT_GT(verified, 0);
  }
}

TEST_F(RankStalls, RefusesInvalidOptions) {
  for (const Words& words : std::vector<Words>{{"--stall-timeout", "-1"},
                                               {"--stall-timeout", "soon"},
                                               {"--stall-timeout", "0.001"},
                                               {"--on-stall", "panic"},
                                               {"--on-stall", "abort", "--stall-timeout", "0"}}) {
    const Outcome outcome = tessera(film(inputs_[0], words));
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.own_lines().size(), 1u) << outcome.err;
  }
  for (const Words& words : std::vector<Words>{{"--stall-timeout", "0"}, {"--stall-timeout=5", "--on-stall=abort"}})
    EXPECT_EQ(tessera(film(inputs_[0], words, 2)).status, 0);
}

}  // namespace
}  // namespace tessera::apps
