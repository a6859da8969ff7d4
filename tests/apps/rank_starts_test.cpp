// Runs that are disturbed while MPI starts or ends, or whose ranks were not started alike.

#include <gtest/gtest.h>
#include <sys/types.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iterator>
#include <sstream>
#include <thread>

#include "apps/program.hpp"

namespace tessera::apps {
namespace {

using std::chrono::milliseconds;
using Words = std::vector<std::string>;

constexpr std::size_t frames = 999;  ///< some seconds: signals come long before the last

class RankStarts : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
    ASSERT_EQ(tessera({"generate", "ripples", volume_, "n=16", "--quiet"}).status, 0);
  }

  [[nodiscard]] Words film(std::size_t count, const Words& more = {}) const {
    Words words{"render",    volume_, "-o",     own_word(), "--size", "60x60", "--orbit", std::to_string(count),
                "--threads", "1",     "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  /// A word of the latest run's command lines alone: ranks of a run that was given up may be there a while yet.
  [[nodiscard]] std::string own_word() const { return folder_ / ("f" + std::to_string(run_) + "_%02d.pfm"); }

  /// Of the latest run.
  [[nodiscard]] std::size_t pictures() const {
    const auto names = folder_.names();
    const std::string begin = "f" + std::to_string(run_) + "_";
    return static_cast<std::size_t>(std::count_if(names.begin(), names.end(), [&](const std::string& name) {
      return name.starts_with(begin) && name.ends_with(".pfm");
    }));
  }

  static std::size_t own_lines(const std::string& err) {
    std::istringstream text(err);
    std::size_t lines = 0;
    for (std::string line; std::getline(text, line);) lines += line.find("tessera: ") != std::string::npos ? 1 : 0;
    return lines;
  }

  const Folder folder_;
  const std::string volume_ = folder_ / "v.nrrd";
  int run_ = 0;
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
    EXPECT_FALSE(std::filesystem::exists(a) || std::filesystem::exists(b));
  }
}

/// Sends a signal to one rank a while after the start. False if that was too early or too late.
bool disturb(const std::string& word, milliseconds after, int signal) {
  std::this_thread::sleep_for(after);
  const auto ranks = ranks_with(word);
  return ranks.contains(1) && kill(ranks.at(1), signal) == 0;
}

bool comes_true(int seconds, const std::function<bool()>& what) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
  while (!what() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(milliseconds(20));
  return what();
}

TEST_F(RankStarts, ARankEndedAsMpiStartsEndsTheRun) {
  int disturbed = 0;
  for (const int after : {60, 100, 140, 180, 220, 260, 300, 400}) {
    ++run_;
    Running running(mpirun_command(3, film(frames)));
    if (!disturb(own_word(), milliseconds(after), SIGTERM)) continue;
    const auto outcome = running.wait_for(30);
    ASSERT_TRUE(outcome) << after << " ms after the start: hangs";
    // Where this process was kept waiting the signal comes after the last picture, and is too late.
    EXPECT_TRUE(outcome->status != 0 || pictures() == frames) << after << ' ' << pictures();
    disturbed += outcome->status == 0 ? 0 : 1;
    EXPECT_LE(own_lines(outcome->err), 1u) << outcome->err;
  }
  EXPECT_GT(disturbed, 0);
}

// The launcher of Debian 12 may crash or hang in its own end when a rank stops while MPI starts; the ranks do not.
TEST_F(RankStarts, ARankStoppedAsMpiStartsEndsTheRunWhereThatIsAsked) {
  int said_so = 0;
  for (const int after : {100, 200, 300}) {
    ++run_;
    Running running(mpirun_command(3, film(frames, {"--on-stall", "abort", "--stall-timeout=0.5"})));
    if (!disturb(own_word(), milliseconds(after), SIGSTOP)) continue;
    EXPECT_TRUE(comes_true(30, [&] { return ranks_with(own_word()).empty(); }))
        << after << " ms after the start: hangs";
    const bool launcher_hangs = !comes_true(5, [&] { return !running.runs(); });
    if (launcher_hangs) kill(running.process(), SIGKILL);
    const Outcome outcome = running.wait();
    // Of a rank that crashes the launcher says by which signal it exited.
    const bool launcher_crashes =
        outcome.status == 128 + SIGSEGV && outcome.err.find("exited on signal 11") == std::string::npos;
    if (!launcher_hangs && !launcher_crashes) {
      EXPECT_EQ(outcome.status, 3) << outcome.err;
      ++said_so;
    }
    EXPECT_EQ(own_lines(outcome.err), 1u) << outcome.err;
    EXPECT_NE(outcome.err.find("process is stopped or its machine hangs"), std::string::npos) << outcome.err;
  }
  EXPECT_GT(said_so, 0);
}

// Its pictures are there, and by then the other ranks may be gone: nobody is left to miss it.
TEST_F(RankStarts, ARankStoppedAsMpiEndsDoesNotKeepTheLauncherWaiting) {
  for (const int after : {0, 4, 8, 12, 16, 20}) {
    constexpr std::size_t few = 3;
    ++run_;
    Running running(
        mpirun_command(3, film(few, {"--on-stall", "abort", "--stall-timeout", "0.5", "--distribution", "sort-last"})));
    while (running.runs() && pictures() < few) std::this_thread::sleep_for(std::chrono::microseconds(200));
    const bool disturbed = disturb(own_word(), milliseconds(after), SIGSTOP);
    const auto outcome = running.wait_for(30);
    ASSERT_TRUE(outcome) << after << " ms after the last picture: hangs";
    EXPECT_TRUE(outcome->status == 0 || (disturbed && outcome->status == 3)) << outcome->status << outcome->err;
    EXPECT_EQ(own_lines(outcome->err), outcome->status == 0 ? 0u : 1u) << outcome->err;
    EXPECT_EQ(pictures(), few);
  }
}

}  // namespace
}  // namespace tessera::apps
