// SPDX-License-Identifier: BSD-3-Clause
// Too few threads or too little memory: the image is rendered, or one line states a remedy.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "apps/film_runs.hpp"

namespace tessera::apps {
namespace {

/// Sanitizers reserve unlimited address space, so limits of it cannot be tested.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

class RankLimits : public FilmRuns {
 protected:
  static Words limited(int mebibytes, const Words& command, const std::string& first = "") {
    Words words{"sh", "-c", first + "ulimit -v " + std::to_string(mebibytes << 10) + " && exec \"$@\"", "sh"};
    words.insert(words.end(), command.begin(), command.end());
    return words;
  }

  /// The lowest limit with which the loader reaches our code, MiB.
  static int least_limit() {
    int too_little = 62, enough = 4096;
    while (enough - too_little > 2) {
      const int between = (too_little + enough) / 4 * 2;
      const bool starts = Running(limited(between, {TESSERA_PROGRAM, "--version"})).wait().status == 0;
      (starts ? enough : too_little) = between;
    }
    return enough;
  }

  static void expect_no_noise(const Outcome& outcome, const std::string& what) {
    EXPECT_EQ(outcome.err.find("please report"), std::string::npos) << what << "\n" << outcome.err;
    EXPECT_EQ(outcome.err.find("terminate called"), std::string::npos) << what << "\n" << outcome.err;
  }
};

TEST_F(RankLimits, MoreThreadsThanCoresAreNoWarning) {
  for (const std::string& input : inputs_)
    for (const char* threads : {"1", "3", "64", "1024"}) {
      const Outcome outcome = tessera({"render", input, "-o", folder_ / "a.pfm", "--size", "40x40", "--threads",
                                       threads, "--verify", "50", "--quiet"});
      EXPECT_EQ(outcome.status, 0) << input << " " << threads;
      EXPECT_EQ(outcome.err, "") << input << " " << threads;
    }
}

TEST_F(RankLimits, UnderAMemoryLimitOneLineGivesTheRemedy) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers take all address space";
  const int least = least_limit();
  for (const std::string& input : inputs_)
    for (const int more : {0, 2, 4, 6, 8, 12, 16, 24, 40, 80, 160}) {
      const Outcome outcome = Running(limited(least + more, {TESSERA_PROGRAM, "render", input, "-o", folder_ / "a.pfm",
                                                             "--size", "40x40", "--threads", "64", "--quiet"}))
                                  .wait();
      const std::string what = input + " " + std::to_string(least + more);
      EXPECT_TRUE(outcome.status == 0 || outcome.status == 3) << outcome.status;
      EXPECT_EQ(outcome.own_lines().size(), outcome.status == 0 ? 0u : 1u) << what << "\n" << outcome.err;
      expect_no_noise(outcome, what);
    }
}

// If MPI does not start, only its report and the launcher's report are printed, and the launcher of Open MPI 4.1.4 may
// hang at its own end. Each rank prints at most one line, and all ranks end.
TEST_F(RankLimits, UnderAMemoryLimitRanksEndWhereverTheyDie) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers take all address space";
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  const int least = least_limit();
  for (const std::string& input : inputs_)
    for (const int more : {0, 4, 30, 60, 110, 150, 200, 250}) {
      const std::string picture = folder_ / (std::to_string(more) + ".pfm");
      Words words = mpirun_command(2, {"render", input, "-o", picture, "--size", "40x40", "--threads", "4", "--quiet"});
      const std::string begun = folder_ / ("begun" + std::to_string(more) + input.substr(input.size() - 4) + "-");
      const Words shell = limited(least + more, {}, ": > " + begun + "$OMPI_COMM_WORLD_RANK; ");
      words.insert(std::find(words.begin(), words.end(), TESSERA_PROGRAM), shell.begin(), shell.end());
      const std::string what = input + " " + std::to_string(least + more);
      Running running(words);
      const auto have_begun = [&] {
        return std::filesystem::exists(begun + "0") && std::filesystem::exists(begun + "1");
      };
      ASSERT_TRUE(test::await([&] { return !running.runs() || have_begun(); })) << what << ": hangs";
      ASSERT_TRUE(test::await([&] { return ranks_with(picture).empty(); })) << what << ": hangs";
      const Outcome outcome = running.wait_or_kill();
      EXPECT_LE(outcome.own_lines().size(), outcome.status == 0 ? 0u : 2u) << what << "\n" << outcome.err;
      EXPECT_TRUE(outcome.status != 0 || std::filesystem::exists(picture)) << what << "\n" << outcome.err;
      expect_no_noise(outcome, what);
      std::filesystem::remove(picture);
    }
}

}  // namespace
}  // namespace tessera::apps
