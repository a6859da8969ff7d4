// SPDX-License-Identifier: BSD-3-Clause
// Faults during a run: an output directory or an input that is removed, ranks that are killed. One line in total, and
// the documented status.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "apps/film_runs.hpp"

namespace tessera::apps {
namespace {

class RankFaults : public FilmRuns {};

TEST_F(RankFaults, AnOutputDirectoryRemovedDuringTheRunIsASystemFailure) {
  for (const std::string& input : inputs_)
    for (const int ranks : {0, 1, 2, 3}) {
      if (ranks > 0 && !has_mpirun()) continue;
      Outcome outcome;
      bool in_time = false;  // before the last image
      for (int frames = 500; !in_time; frames *= 2) {
        std::filesystem::create_directory(pictures_);
        Running running(command(ranks, film(input, {}, frames)));
        ASSERT_TRUE(wait_for_pictures(running, 3)) << running.wait().err;
        std::filesystem::rename(pictures_, folder_ / "elsewhere");
        outcome = running.wait();
        in_time = pictures(folder_ / "elsewhere") < static_cast<std::size_t>(frames);
        std::filesystem::remove_all(folder_ / "elsewhere");
      }
      EXPECT_EQ(outcome.status, 3) << input << " " << ranks << "\n" << outcome.err;
      const Words lines = outcome.own_lines();
      ASSERT_EQ(lines.size(), 1u) << outcome.err;
      EXPECT_NE(lines[0].find("pictures/f_"), std::string::npos) << lines[0];
    }
}

TEST_F(RankFaults, AnInitiallyMissingDirectoryIsTheUsersError) {
  std::filesystem::remove(pictures_);
  for (const std::string& input : inputs_) EXPECT_EQ(tessera(film(input)).status, 2);
}

TEST_F(RankFaults, AStepRemovedDuringTheRunIsASystemFailure) {
  for (const std::string& input : inputs_) {
    const std::string later = folder_ / ("later" + std::filesystem::path(input).extension().string());
    Outcome outcome;
    bool in_time = false;
    for (int frames = 60; !in_time; frames *= 2) {
      clear_pictures();
      std::filesystem::copy_file(input, later);
      Running running(command(0, film(input, {later}, frames)));
      ASSERT_TRUE(wait_for_pictures(running, 3)) << running.wait().err;
      kill(running.process(), SIGSTOP);  // the process is stopped while the file is removed
      in_time = pictures() + 8 < static_cast<std::size_t>(frames);
      std::filesystem::remove(later);
      kill(running.process(), SIGCONT);
      outcome = running.wait();
    }
    EXPECT_EQ(outcome.status, 3) << outcome.err;
    EXPECT_EQ(outcome.own_lines().size(), 1u) << outcome.err;
    EXPECT_NE(outcome.err.find("later"), std::string::npos) << outcome.err;
  }
}

TEST_F(RankFaults, AKilledRankEndsTheRunInOneLine) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  for (const std::string& input : inputs_)
    for (const int ranks : {2, 4})
      for (const int ended : {0, ranks - 1}) {
        Running running(command(ranks, film(input)));
        ASSERT_TRUE(wait_for_pictures(running, 3)) << running.wait().err;
        kill(ranks_with(pictures_).at(ended), SIGTERM);
        const Outcome outcome = running.wait();
        clear_pictures();
        EXPECT_EQ(outcome.status, 3) << outcome.err;
        const Words lines = outcome.own_lines();
        ASSERT_EQ(lines.size(), 1u) << ended << " of " << ranks << "\n" << outcome.err;
        EXPECT_NE(lines[0].find("rank " + std::to_string(ended) + " of " + std::to_string(ranks)), std::string::npos)
            << lines[0];
      }
}

TEST_F(RankFaults, AllRanksKilledAtOnceGiveOneLine) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  for (const std::string& input : inputs_) {
    Running running(command(3, film(input)));
    ASSERT_TRUE(wait_for_pictures(running, 3)) << running.wait().err;
    for (const auto& [rank, process] : ranks_with(pictures_)) kill(process, SIGTERM);
    const Outcome outcome = running.wait();
    clear_pictures();
    EXPECT_NE(outcome.status, 0);
    EXPECT_EQ(outcome.own_lines().size(), 1u) << outcome.err;
  }
}

// Tests ranks that are killed by their launcher, because a rank has died or because the launcher itself is killed.
TEST_F(RankFaults, RanksThatTheLauncherEndsGiveOneLine) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  for (const int signal : {SIGTERM, SIGKILL}) {
    // Without this variable, Open MPI kills ranks one second after it has asked them to end, however busy the machine
    // is.
    Words words = command(3, film(inputs_[1]));
    words.insert(words.begin() + 1, "OMPI_MCA_odls_base_sigkill_timeout=10");
    Running running(words);
    ASSERT_TRUE(wait_for_pictures(running, 3)) << running.wait().err;
    kill(signal == SIGTERM ? running.process() : ranks_with(pictures_).at(1), signal);
    const Outcome outcome = running.wait();
    clear_pictures();
    EXPECT_NE(outcome.status, 0);
    const Words lines = outcome.own_lines();
    ASSERT_EQ(lines.size(), 1u) << outcome.err;
    EXPECT_NE(lines[0].find("ended from outside or has lost a rank"), std::string::npos) << lines[0];
  }
}

/// Private memory of the process, KiB.
long own_memory(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string word; status >> word;)
    if (word == "RssAnon:") {
      long kibibytes = 0;
      status >> kibibytes;
      return kibibytes;
    }
  return -1;
}

TEST_F(RankFaults, LongFilmsTakeNoMoreMemoryThanShortOnes) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers keep freed memory";
#endif
  for (const std::string& input : inputs_)
    for (const int ranks : {0, 2}) {
      if (ranks > 0 && !has_mpirun()) continue;
      Words words = film(input);
      *(std::find(words.begin(), words.end(), "--size") + 1) = "16x16";
      Running running(command(ranks, words));
      ASSERT_TRUE(wait_for_pictures(running, 300)) << running.wait().err;
      const pid_t process = ranks > 0 ? ranks_with(pictures_).at(0) : running.process();
      const long early = own_memory(process);
      ASSERT_TRUE(wait_for_pictures(running, 1300)) << running.wait().err;
      const long late = own_memory(process);
      kill(running.process(), SIGTERM);
      running.wait();
      clear_pictures();
      EXPECT_GT(early, 0);
      EXPECT_GT(late, 0);
      // Records of 3 KB per frame would take 3,000 KiB.
      EXPECT_LT(late - early, 1000) << input << " on " << ranks;
    }
}

}  // namespace
}  // namespace tessera::apps
