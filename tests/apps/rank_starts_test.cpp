// Runs that are disturbed while MPI starts or ends, or whose ranks were not started alike.

#include <gtest/gtest.h>
#include <sys/types.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <thread>

#include "apps/program.hpp"

namespace tessera::apps {
namespace {

using std::chrono::milliseconds;
using Words = std::vector<std::string>;

class RankStarts : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
    ASSERT_EQ(tessera({"generate", "ripples", volume_, "n=16", "--quiet"}).status, 0);
  }

  [[nodiscard]] Words film(int frames, const Words& more = {}) const {
    Words words{"render",    volume_, "-o",      folder_ / "f_%02d.pfm",
                "--size",    "60x60", "--orbit", std::to_string(frames),
                "--threads", "1",     "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  /// A word of this run's command lines alone.
  [[nodiscard]] std::string own_word() const { return folder_ / "f_%02d.pfm"; }

  [[nodiscard]] std::size_t pictures() const {
    const auto names = folder_.names();
    return static_cast<std::size_t>(
        std::count_if(names.begin(), names.end(), [](const std::string& name) { return name.ends_with(".pfm"); }));
  }

  static std::size_t own_lines(const std::string& err) {
    std::istringstream text(err);
    std::size_t lines = 0;
    for (std::string line; std::getline(text, line);) lines += line.find("tessera: ") != std::string::npos ? 1 : 0;
    return lines;
  }

  const Folder folder_;
  const std::string volume_ = folder_ / "v.nrrd";
};

TEST_F(RankStarts, RanksWithDifferentArgumentsEndInOneLine) {
  const std::string a = folder_ / "a.pfm", b = folder_ / "b.pfm";
  const Words first{"render", volume_, "-o", a, "--quiet"};
  for (const auto& [other, words] : std::vector<std::pair<Words, std::string>>{
           {{"render", volume_, "-o", b, "--quiet"}, "argument 4: rank 2 of 3 was given '" + b},
           {{"render", volume_, "-o", a}, "argument 5: rank 2 of 3 was given nothing where the first was given '--qui"},
           {{"info", volume_, "-o", a, "--quiet"}, "argument 1: rank 2 of 3 was given 'info'"},
           {{"render", volume_, "-o", a, "--quiet", "--size", "9x9"}, "'--size' where the first was given nothing"}}) {
    Words command = mpirun_command(2, first);
    command.insert(command.end(), {":", "-n", "1", TESSERA_PROGRAM});
    command.insert(command.end(), other.begin(), other.end());
    const auto outcome = Running(command).wait_for(30);
    ASSERT_TRUE(outcome) << "hangs";
    EXPECT_EQ(outcome->status, 2) << outcome->err;
    EXPECT_EQ(own_lines(outcome->err), 1u) << outcome->err;
    EXPECT_NE(outcome->err.find(words), std::string::npos) << outcome->err;
    EXPECT_EQ(pictures(), 0u);
  }
}

/// Sends a signal to one rank a while after the start. False if that was too early or too late.
bool disturb(const std::string& word, milliseconds after, int signal) {
  std::this_thread::sleep_for(after);
  const auto ranks = ranks_with(word);
  return ranks.contains(1) && kill(ranks.at(1), signal) == 0;
}

TEST_F(RankStarts, ARankEndedAsMpiStartsEndsTheRun) {
  int disturbed = 0;
  for (const int after : {60, 100, 140, 180, 220, 260, 300, 400}) {
    Running running(mpirun_command(3, film(99)));
    if (!disturb(own_word(), milliseconds(after), SIGTERM)) continue;
    ++disturbed;
    const auto outcome = running.wait_for(30);
    ASSERT_TRUE(outcome) << after << " ms after the start: hangs";
    EXPECT_NE(outcome->status, 0) << after;
    EXPECT_LE(own_lines(outcome->err), 1u) << outcome->err;
  }
  EXPECT_GT(disturbed, 0);
}

TEST_F(RankStarts, ARankStoppedAsMpiStartsEndsTheRunWhereThatIsAsked) {
  int disturbed = 0;
  for (const int after : {100, 200, 300}) {
    Running running(mpirun_command(3, film(99, {"--on-stall", "abort", "--stall-timeout=0.5"})));
    if (!disturb(own_word(), milliseconds(after), SIGSTOP)) continue;
    ++disturbed;
    const auto outcome = running.wait_for(30);
    ASSERT_TRUE(outcome) << after << " ms after the start: hangs";
    EXPECT_EQ(outcome->status, 3) << outcome->err;
    EXPECT_EQ(own_lines(outcome->err), 1u) << outcome->err;
    EXPECT_NE(outcome->err.find("process is stopped or its machine hangs"), std::string::npos) << outcome->err;
  }
  EXPECT_GT(disturbed, 0);
}

// Its pictures are there, and by then the other ranks may be gone: nobody is left to miss it.
TEST_F(RankStarts, ARankStoppedAsMpiEndsDoesNotKeepTheLauncherWaiting) {
  for (const int after : {0, 4, 8, 12, 16, 20}) {
    constexpr std::size_t frames = 3;
    Running running(mpirun_command(
        3, film(frames, {"--on-stall", "abort", "--stall-timeout", "0.5", "--distribution", "sort-last"})));
    while (running.runs() && pictures() < frames) std::this_thread::sleep_for(std::chrono::microseconds(200));
    const bool disturbed = disturb(own_word(), milliseconds(after), SIGSTOP);
    const auto outcome = running.wait_for(30);
    ASSERT_TRUE(outcome) << after << " ms after the last picture: hangs";
    EXPECT_TRUE(outcome->status == 0 || (disturbed && outcome->status == 3)) << outcome->status << outcome->err;
    EXPECT_EQ(own_lines(outcome->err), outcome->status == 0 ? 0u : 1u) << outcome->err;
    EXPECT_EQ(pictures(), frames);
    for (const std::string& name : folder_.names())
      if (name.ends_with(".pfm")) std::filesystem::remove(folder_ / name);
  }
}

}  // namespace
}  // namespace tessera::apps
