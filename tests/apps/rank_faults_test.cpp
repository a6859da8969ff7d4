// What happens to a run while it goes on: threads and memory that there are not, an output folder that is removed,
// ranks that are ended, that stop, or that cannot start. One line in all, the status of the design, no noise beside it.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "apps/program.hpp"

namespace tessera::apps {
namespace {

using std::chrono::milliseconds;
using Words = std::vector<std::string>;

/// One that takes address space without end has no use for limits of it.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

Words own_lines_of(const std::string& err) {
  Words lines;
  std::istringstream text(err);
  for (std::string line; std::getline(text, line);)
    if (line.find("tessera: ") != std::string::npos) lines.push_back(line);
  return lines;
}

/// A mesh and a volume, and films of them that last long enough to be disturbed.
class RankFaults : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(tessera({"generate", "cube", inputs_[0], "n=8", "--quiet"}).status, 0);
    ASSERT_EQ(tessera({"generate", "ripples", inputs_[1], "n=32", "--quiet"}).status, 0);
    std::filesystem::create_directory(pictures_);
  }

  [[nodiscard]] Words film(const std::string& input, Words more = {}, const std::string& frames = "400") const {
    Words words{"render",    input, "-o",     pictures_ + "/f_%04d.pfm", "--size", "150x150", "--orbit", frames,
                "--threads", "1",   "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  /// Of one process if `ranks` is 0.
  static Words command(int ranks, const Words& arguments) {
    if (ranks > 0) return mpirun_command(ranks, arguments);
    Words words{TESSERA_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return words;
  }

  [[nodiscard]] std::size_t pictures() const {
    std::error_code gone;
    const std::filesystem::directory_iterator begin(pictures_, gone);
    return static_cast<std::size_t>(std::distance(begin, std::filesystem::directory_iterator()));
  }

  /// Until so many pictures are there; false if the run ends before.
  bool wait_for_pictures(const Running& running, std::size_t count) const {
    while (pictures() < count) {
      if (!running.runs()) return false;
      std::this_thread::sleep_for(milliseconds(5));
    }
    return true;
  }

  const Folder folder_;
  const std::string inputs_[2] = {folder_ / "m.vtu", folder_ / "v.nrrd"};
  const std::string pictures_ = folder_ / "pictures";
};

TEST_F(RankFaults, MoreThreadsThanCoresAreNoWarning) {
  for (const std::string& input : inputs_)
    for (const char* threads : {"1", "3", "64", "1024"}) {
      const Outcome outcome = tessera({"render", input, "-o", folder_ / "a.pfm", "--size", "40x40", "--threads",
                                       threads, "--verify", "50", "--quiet"});
      EXPECT_EQ(outcome.status, 0) << input << " " << threads;
      EXPECT_EQ(outcome.err, "") << input << " " << threads;
    }
}

TEST_F(RankFaults, AnOutputFolderRemovedInMidRunIsTheSystemsFault) {
  for (const std::string& input : inputs_)
    for (const int ranks : {0, 1, 2, 3}) {
      if (ranks > 0 && !has_mpirun()) continue;
      std::filesystem::create_directory(pictures_);
      Running running(command(ranks, film(input)));
      ASSERT_TRUE(wait_for_pictures(running, 3)) << running.wait().err;
      std::filesystem::rename(pictures_, folder_ / "elsewhere");
      const Outcome outcome = running.wait();
      std::filesystem::remove_all(folder_ / "elsewhere");
      EXPECT_EQ(outcome.status, 3) << input << " " << ranks << "\n" << outcome.err;
      const Words lines = own_lines_of(outcome.err);
      ASSERT_EQ(lines.size(), 1u) << outcome.err;
      EXPECT_NE(lines[0].find("pictures/f_"), std::string::npos) << lines[0];
    }
}

TEST_F(RankFaults, AFolderThatIsMissingFromTheStartIsTheUsers) {
  std::filesystem::remove(pictures_);
  for (const std::string& input : inputs_) EXPECT_EQ(tessera(film(input)).status, 2);
}

TEST_F(RankFaults, AStepOfASeriesThatIsRemovedInMidRunIsTheSystemsFault) {
  for (const std::string& input : inputs_) {
    const std::string later = folder_ / ("later" + std::filesystem::path(input).extension().string());
    std::filesystem::copy_file(input, later);
    Running running(command(0, film(input, {later}, "60")));
    ASSERT_TRUE(wait_for_pictures(running, 3)) << running.wait().err;
    std::filesystem::remove(later);
    const Outcome outcome = running.wait();
    std::filesystem::remove_all(pictures_);
    std::filesystem::create_directory(pictures_);
    EXPECT_EQ(outcome.status, 3) << outcome.err;
    EXPECT_EQ(own_lines_of(outcome.err).size(), 1u) << outcome.err;
    EXPECT_NE(outcome.err.find("later"), std::string::npos) << outcome.err;
  }
}

TEST_F(RankFaults, ARankThatIsEndedEndsTheRunInOneLine) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  for (const std::string& input : inputs_)
    for (const int ranks : {2, 4})
      for (const int ended : {0, ranks - 1}) {
        std::filesystem::create_directory(pictures_);
        Running running(command(ranks, film(input)));
        ASSERT_TRUE(wait_for_pictures(running, 3)) << running.wait().err;
        kill(ranks_with(pictures_).at(ended), SIGTERM);
        const Outcome outcome = running.wait();
        std::filesystem::remove_all(pictures_);
        EXPECT_EQ(outcome.status, 3) << outcome.err;
        const Words lines = own_lines_of(outcome.err);
        ASSERT_EQ(lines.size(), 1u) << ended << " of " << ranks << "\n" << outcome.err;
        EXPECT_NE(lines[0].find("rank " + std::to_string(ended) + " of " + std::to_string(ranks)), std::string::npos)
            << lines[0];
      }
}

TEST_F(RankFaults, AllRanksEndedAtOnceOrTheLauncherEndedGiveOneLineToo) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  for (const std::string& input : inputs_)
    for (const bool launcher : {false, true}) {
      std::filesystem::create_directory(pictures_);
      Running running(command(3, film(input)));
      ASSERT_TRUE(wait_for_pictures(running, 3)) << running.wait().err;
      if (launcher)
        kill(running.process(), SIGTERM);
      else
        for (const auto& [rank, process] : ranks_with(pictures_)) kill(process, SIGTERM);
      const Outcome outcome = running.wait();
      std::filesystem::remove_all(pictures_);
      EXPECT_NE(outcome.status, 0);
      EXPECT_EQ(own_lines_of(outcome.err).size(), 1u) << outcome.err;
    }
}

Words limited(int mebibytes, const Words& command) {
  Words words{"sh", "-c", "ulimit -v " + std::to_string(mebibytes << 10) + " && exec \"$@\"", "sh"};
  words.insert(words.end(), command.begin(), command.end());
  return words;
}

/// The least limit under which the loader comes as far as our code, MiB.
int least_limit() {
  int mebibytes = 64;
  while (mebibytes < 4096 && Running(limited(mebibytes, {TESSERA_PROGRAM, "--version"})).wait().status != 0)
    mebibytes += 2;
  return mebibytes;
}

/// Whatever the limit: the picture, or one line that says what to do.
void expect_one_line(const Outcome& outcome, const std::string& what) {
  if (outcome.status == 0) return;
  const Words lines = own_lines_of(outcome.err);
  EXPECT_EQ(lines.size(), 1u) << what << "\n" << outcome.err;
  EXPECT_EQ(outcome.err.find("please report"), std::string::npos) << what << "\n" << outcome.err;
  EXPECT_EQ(outcome.err.find("terminate called"), std::string::npos) << what << "\n" << outcome.err;
}

TEST_F(RankFaults, UnderAMemoryLimitThereIsOneLineThatSaysWhatToDo) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers take all address space";
  const int least = least_limit();
  for (const std::string& input : inputs_)
    for (const int more : {0, 2, 4, 6, 8, 12, 16, 24, 40, 80, 160}) {
      const Outcome outcome = Running(limited(least + more, {TESSERA_PROGRAM, "render", input, "-o", folder_ / "a.pfm",
                                                             "--size", "40x40", "--threads", "64", "--quiet"}))
                                  .wait();
      expect_one_line(outcome, input + " " + std::to_string(least + more));
      EXPECT_TRUE(outcome.status == 0 || outcome.status == 3) << outcome.status;
    }
}

TEST_F(RankFaults, UnderAMemoryLimitRanksSayOneLineInAllWhereverTheyDie) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers take all address space";
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  const int least = least_limit();
  for (const std::string& input : inputs_)
    for (const int more : {0, 4, 30, 60, 110, 150, 200, 250}) {
      Words words =
          mpirun_command(2, {"render", input, "-o", folder_ / "a.pfm", "--size", "40x40", "--threads", "4", "--quiet"});
      const Words shell = limited(least + more, {});
      words.insert(std::find(words.begin(), words.end(), TESSERA_PROGRAM), shell.begin(), shell.end());
      // Near the least limit Open MPI itself may lose messages between ranks that are well: 20 s to notice.
      const std::optional<Outcome> outcome = Running(words).wait_for(60);
      ASSERT_TRUE(outcome) << input << " " << least + more << ": hangs";
      expect_one_line(*outcome, input + " " + std::to_string(least + more));
    }
}

TEST_F(RankFaults, AStoppedRankIsNamedAndWaitedFor) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  for (const std::string& input : inputs_)
    for (const auto& [ranks, stopped] : input == inputs_[0] ? std::vector<std::pair<int, int>>{{2, 1}, {3, 0}}
                                                            : std::vector<std::pair<int, int>>{{2, 0}, {3, 2}}) {
      std::filesystem::create_directory(pictures_);
      Words words = film(input, {"--stall-timeout", "1.5"}, "60");
      if (input == inputs_[0]) words.insert(words.end(), {"--exchange", "segments"});  // the bytes of one process
      std::erase(words, "--quiet");
      Running running(command(ranks, words));
      // By then each rank has had the others' first sign of life, which says their process.
      ASSERT_TRUE(wait_for_pictures(running, 20)) << running.wait().err;
      const pid_t process = ranks_with(pictures_).at(stopped);
      kill(process, SIGSTOP);
      std::this_thread::sleep_for(milliseconds(4000));
      EXPECT_TRUE(running.runs());
      kill(process, SIGCONT);
      const Outcome outcome = running.wait();
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      const std::string name = "rank " + std::to_string(stopped) + " of " + std::to_string(ranks) + " (process " +
                               std::to_string(process) + " on ";
      EXPECT_NE(outcome.err.find(name), std::string::npos) << outcome.err;
      EXPECT_NE(outcome.err.find(" has been silent for "), std::string::npos) << outcome.err;
      EXPECT_NE(outcome.err.find(" is back after "), std::string::npos) << outcome.err;
      EXPECT_TRUE(own_lines_of(outcome.err).empty()) << outcome.err;

      const Folder alone;
      ASSERT_EQ(tessera({"render", input, "-o", alone / "f_%04d.pfm", "--size", "150x150", "--orbit", "60", "--quiet"})
                    .status,
                0);
      for (const auto& picture : alone.names())
        EXPECT_EQ(contents(pictures_ + "/" + picture), contents(alone / picture)) << picture;
      std::filesystem::remove_all(pictures_);
    }
}

TEST_F(RankFaults, AStoppedRankEndsTheRunWhereThatIsAsked) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  for (const std::string& input : inputs_)
    for (const auto& [ranks, stopped] : input == inputs_[0] ? std::vector<std::pair<int, int>>{{2, 0}, {4, 3}}
                                                            : std::vector<std::pair<int, int>>{{2, 1}, {4, 0}}) {
      std::filesystem::create_directory(pictures_);
      Running running(command(ranks, film(input, {"--stall-timeout", "1.5", "--on-stall", "abort"})));
      ASSERT_TRUE(wait_for_pictures(running, 3)) << running.wait().err;
      kill(ranks_with(pictures_).at(stopped), SIGSTOP);
      const Outcome outcome = running.wait();
      std::filesystem::remove_all(pictures_);
      EXPECT_EQ(outcome.status, 3) << outcome.err;
      const Words lines = own_lines_of(outcome.err);
      ASSERT_EQ(lines.size(), 1u) << outcome.err;
      EXPECT_NE(lines[0].find("rank " + std::to_string(stopped) + " of " + std::to_string(ranks)), std::string::npos);
      EXPECT_EQ(outcome.err.find("waiting for it"), std::string::npos) << outcome.err;
    }
}

TEST_F(RankFaults, ARankThatComputesForLongIsNotStopped) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  for (const std::string& input : inputs_) {  // the first rank alone verifies, for some seconds
    const Outcome outcome = mpirun(2, {"render", input, "-o", folder_ / "a.pfm", "--size", "1024x1024", "--threads",
                                       "1", "--verify", "60000", "--stall-timeout", "1.5", "--on-stall", "abort"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("silent"), std::string::npos) << outcome.err;
  }
}

TEST_F(RankFaults, StallOptionsThatMakeNoSenseAreRefused) {
  for (const Words& words : std::vector<Words>{{"--stall-timeout", "-1"},
                                               {"--stall-timeout", "soon"},
                                               {"--stall-timeout", "0.001"},
                                               {"--on-stall", "panic"},
                                               {"--on-stall", "abort", "--stall-timeout", "0"}}) {
    const Outcome outcome = tessera(film(inputs_[0], words));
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(own_lines_of(outcome.err).size(), 1u) << outcome.err;
  }
  for (const Words& words : std::vector<Words>{{"--stall-timeout", "0"}, {"--stall-timeout=5", "--on-stall=abort"}})
    EXPECT_EQ(tessera(film(inputs_[0], words, "2")).status, 0);
}

/// Memory of the process's own, KiB.
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
  if (is_sanitized) GTEST_SKIP() << "sanitizers keep freed memory";
  for (const std::string& input : inputs_)
    for (const int ranks : {0, 2}) {
      if (ranks > 0 && !has_mpirun()) continue;
      std::filesystem::create_directory(pictures_);
      const Words words{"render",    input, "-o",     pictures_ + "/f_%04d.pfm", "--size", "16x16", "--orbit", "800",
                        "--threads", "1",   "--quiet"};
      Running running(command(ranks, words));
      ASSERT_TRUE(wait_for_pictures(running, 300)) << running.wait().err;
      const pid_t process = ranks > 0 ? ranks_with(pictures_).at(0) : running.process();
      const long early = own_memory(process);
      ASSERT_TRUE(wait_for_pictures(running, 750)) << running.wait().err;
      const long late = own_memory(process);
      EXPECT_EQ(running.wait().status, 0);
      std::filesystem::remove_all(pictures_);
      EXPECT_GT(early, 0);
      // Records of 3 KB a frame would be 1,350.
      EXPECT_LT(late - early, 600) << input << " on " << ranks;
    }
}

}  // namespace
}  // namespace tessera::apps
