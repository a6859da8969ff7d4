// SPDX-License-Identifier: BSD-3-Clause
// Volumes in formats that are read as a whole, on several ranks: stored once, in an unnamed file. And the actual memory
// of ranks, and of programs with a budget.
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/program.hpp"
#include "io/files/reader_programs.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "support/await.hpp"
#include "support/some_cases.hpp"

extern char** environ;

namespace tessera::apps {
namespace {

using Words = std::vector<std::string>;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

/// A NIfTI-1 header of n^3 bytes.
std::string nifti_header(std::int16_t n) {
  std::string h(352, '\0');
  const auto put = [&](std::size_t at, const auto& value) { std::memcpy(h.data() + at, &value, sizeof value); };
  put(0, std::int32_t{348});
  put(40, std::array<std::int16_t, 8>{3, n, n, n, 1, 1, 1, 1});
  put(70, std::int16_t{2});
  put(72, std::int16_t{8});
  put(76, std::array<float, 4>{1, 1, 1, 1});
  put(108, 352.0f);
  put(344, std::array<char, 3>{'n', '+', '1'});
  return h;
}

/// A ball in a box of n^3 bytes, slice by slice.
template <class Write>
void each_slice(int n, const Write& write) {
  std::string slice(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), '\0');
  const auto place = [&](int i) { return (2.0f * static_cast<float>(i) + 1) / static_cast<float>(n) - 1; };
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      const float beside = place(j) * place(j) + place(k) * place(k);
      for (int i = 0; i < n; ++i)
        slice[static_cast<std::size_t>(j * n + i)] =
            static_cast<char>(static_cast<int>(std::clamp(255 * (1.2f - place(i) * place(i) - beside), 0.0f, 255.0f)));
    }
    write(slice);
  }
}

class SharedVolumes : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
    std::filesystem::create_directory(scratch_);
  }

  [[nodiscard]] std::string zipped(int n) const {
    std::string file = folder_ / "v.nii.gz";
    gzFile out = gzopen(file.c_str(), "wb1");
    const auto write = [&](const std::string& bytes) {
      gzwrite(out, bytes.data(), static_cast<unsigned>(bytes.size()));
    };
    write(nifti_header(static_cast<std::int16_t>(n)));
    each_slice(n, write);
    gzclose(out);
    return file;
  }

  /// Returns the command line on `ranks` ranks, whose temporary files go to `scratch`; mpirun's own temporary files go
  /// elsewhere. The shell of each rank executes `first` before the program.
  [[nodiscard]] static Words on_ranks(int ranks, const std::string& scratch, const Words& arguments,
                                      const std::string& first = ":") {
    Words words = mpirun_command(ranks, arguments);
    const auto program = std::ranges::find(words, std::string(TESSERA_PROGRAM));
    const Words shell{"env", "TMPDIR=" + scratch, "sh", "-c", first + " && exec \"$@\"", "sh"};
    words.insert(program, shell.begin(), shell.end());
    return words;
  }
  static Words render(const std::string& volume, const std::string& output, Words more = {}) {
    Words words{"render", volume, "-o", output, "--size", "70x50", "--threads", "1"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  static Words of_size(const std::string& size, Words words) {
    *(std::ranges::find(words, std::string("--size")) + 1) = size;
    return words;
  }
  [[nodiscard]] bool nothing_left() const { return std::filesystem::is_empty(scratch_); }
  static std::size_t count_of(const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
    return count;
  }

  const Folder folder_;
  const std::string scratch_ = folder_ / "scratch";
};

TEST_F(SharedVolumes, HaveTheBytesOfOneProcess) {
  Words volumes{zipped(40)};
  if (io::has_reader(io::Reader::vtk)) {
    volumes.push_back(folder_ / "v.vti");
    volumes.push_back(folder_.rectilinear());
    ASSERT_EQ(tessera({"convert", volumes[0], volumes[1], "--quiet"}).status, 0);
  }
  test::SomeCases some(4);
  for (const std::string& volume : volumes) {
    const Words orbit{"--orbit", "2", "--quiet"};
    ASSERT_EQ(tessera(render(volume, folder_ / "one_%d.exr", orbit)).status, 0);
    EXPECT_NE(contents(folder_ / "one_0.exr"), contents(folder_ / "one_1.exr"));
    for (const int ranks : {3, 1, 2}) {
      if (!some.next()) continue;
      const Outcome outcome = Running(on_ranks(ranks, scratch_, render(volume, folder_ / "r_%d.exr", orbit))).wait();
      ASSERT_EQ(outcome.status, 0) << volume << "\n" << outcome.err;
      for (const char* end : {"_0.exr", "_1.exr"})
        EXPECT_EQ(contents(folder_ / (std::string("r") + end)), contents(folder_ / (std::string("one") + end)))
            << volume << " by " << ranks;
      EXPECT_TRUE(nothing_left());
    }
  }
}

TEST_F(SharedVolumes, InPartsHaveTheBytesOfFilesThatAreReadInPlace) {
  const std::string volume = zipped(40), bricks = folder_ / "v.bricks";
  ASSERT_EQ(tessera({"convert", volume, bricks, "--quiet"}).status, 0);
  const Words last{"--distribution", "sort-last", "--quiet"};
  for (const int ranks : {2, 3}) {
    ASSERT_EQ(Running(on_ranks(ranks, scratch_, render(bricks, folder_ / "bricks.exr", last))).wait().status, 0);
    ASSERT_EQ(Running(on_ranks(ranks, scratch_, render(volume, folder_ / "whole.exr", last))).wait().status, 0);
    EXPECT_EQ(contents(folder_ / "whole.exr"), contents(folder_ / "bricks.exr")) << ranks;
  }
}

TEST_F(SharedVolumes, AreAnnouncedOnce) {
  const std::string volume = zipped(40);
  const Words words = render(volume, folder_ / "a.pfm", {"--report", folder_ / "r.json"});
  const Outcome outcome = Running(on_ranks(3, scratch_, words)).wait();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "note: v.nii.gz is read as a whole: its samples are kept once for 3 ranks"), 1u)
      << outcome.err;
  EXPECT_EQ(count_of(outcome.err, scratch_), 1u) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(contents(folder_ / "r.json")).at("volume").at("notes").size(), 1u);
  const Outcome quiet = Running(on_ranks(3, scratch_, render(volume, folder_ / "a.pfm", {"--quiet"}))).wait();
  EXPECT_EQ(count_of(quiet.err, "tessera") + count_of(quiet.err, "note"), 0u) << quiet.err;
  // No other process needs the samples.
  EXPECT_EQ(count_of(Running(on_ranks(1, scratch_, words)).wait().err, "read as a whole"), 0u);
  EXPECT_EQ(count_of(tessera(words).err, "read as a whole"), 0u);
}

TEST_F(SharedVolumes, WithoutRoomEndTheRunInOneLineWithAWorkingRemedy) {
  // The volume has 27 MB, which is more than the limit. The limit is large enough for the memory shared by MPI's ranks.
  const std::string volume = zipped(300), missing = folder_ / "nowhere";
  const Words words = render(volume, folder_ / "a.pfm", {"--quiet"});
  for (const int ranks : {2, 3})
    for (const auto& [folder, limit] : {std::pair{missing, ":"}, {scratch_, "ulimit -f 40000"}}) {
      const Outcome outcome = Running(on_ranks(ranks, folder, words, limit)).wait();
      EXPECT_EQ(outcome.status, 2) << outcome.err;
      EXPECT_EQ(count_of(outcome.err, "tessera: "), 1u) << outcome.err;
      for (const std::string& part : {volume, folder, std::string("27 MB"), std::string("set TMPDIR"),
                                      std::string("convert it to .bricks once and render that")})
        EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
      EXPECT_TRUE(nothing_left());
    }
  EXPECT_EQ(Running(on_ranks(2, scratch_, words)).wait().status, 0);
  ASSERT_EQ(tessera({"convert", volume, folder_ / "v.bricks", "--quiet"}).status, 0);
  const Words bricks = render(folder_ / "v.bricks", folder_ / "a.pfm", {"--quiet"});
  EXPECT_EQ(Running(on_ranks(2, missing, bricks)).wait().status, 0);
}

/// Whether a process has a file open that is, or was, in a directory.
bool has_open_in(const std::string& folder, pid_t process) {
  std::error_code gone;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/fd", gone))
    if (std::filesystem::read_symlink(entry.path(), gone).string().starts_with(folder + "/")) return true;
  return false;
}

TEST_F(SharedVolumes, LeaveNothingWhenARankIsEnded) {
  const std::string volume = zipped(400);
  int number = 0;
  test::SomeCases some(3);
  // The signal is sent while the leader (rank 0) writes, or once another rank (2) reads.
  for (const int opened : {0, 2})
    for (const int signal : {SIGKILL, SIGTERM})
      for (const int ended : {0, 1}) {
        if (!some.next()) continue;
        // A unique name: a rank of the previous run may still be ending.
        const std::string pictures = folder_ / ("f" + std::to_string(++number) + "_");
        Running running(on_ranks(3, scratch_, render(volume, pictures + "%03d.pfm", {"--orbit", "9999", "--quiet"})));
        std::map<int, pid_t> ranks;
        ASSERT_TRUE(test::await([&] {
          ranks = ranks_with(pictures);  // each time: a rank's child first looks like the rank
          return !running.runs() || (ranks.size() == 3 && has_open_in(scratch_, ranks.at(opened)));
        }));
        ASSERT_TRUE(running.runs()) << running.wait().err;
        EXPECT_TRUE(nothing_left()) << "it has a name";
        kill(ranks.at(ended), signal);
        SCOPED_TRACE(testing::Message() << "rank " << ended << " gets " << signal << " and " << opened << " reads");
        EXPECT_NE(running.wait().status, 0);
        EXPECT_TRUE(nothing_left());
      }
}

/// Peak memory of a running process, KiB.
long peak_of(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stol(line.substr(6));
  return 0;
}

TEST_F(SharedVolumes, AreInNoRanksMemoryAsAWhole) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers take memory of their own";
  const std::string volume = zipped(400);
  constexpr long budget = 64l << 10;  // KiB; all samples take 62,500
  Words words = of_size("256x256", render(volume, folder_ / "g_%03d.pfm", {"--orbit", "9999", "--memory", "64M"}));
  Running running(on_ranks(3, scratch_, words));
  ASSERT_TRUE(test::await([&] { return !running.runs() || std::filesystem::exists(folder_ / "g_002.pfm"); }));
  const std::map<int, pid_t> ranks = ranks_with(folder_ / "g_");
  ASSERT_EQ(ranks.size(), 3u);
  for (const auto& [rank, process] : ranks) {
    EXPECT_GT(peak_of(process), 0);
    // The program and MPI take 28 MiB of the budget. Holding the volume once would exceed the budget by far.
    EXPECT_LT(peak_of(process), budget) << rank;
  }
  kill(running.process(), SIGTERM);
  running.wait();
}

/// Runs a command. Returns its status, and the largest peak memory, in KiB, of the command and of all processes for
/// which it has waited.
std::pair<int, long> peak_of(const Words& command) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t process = 0;
  if (posix_spawnp(&process, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0) return {-1, 0};
  int status = 0;
  rusage usage{};
  return {wait4(process, &status, 0, &usage) == process ? status : -1, usage.ru_maxrss};
}

TEST_F(SharedVolumes, InFormatsThatAreUnpackedFitTheBudgetOfOneProcess) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers take memory of their own";
  const std::string packed = zipped(400);
  const auto alone = [&](const std::string& picture, const std::string& memory) {
    Words command{TESSERA_PROGRAM};
    const Words words = of_size("256x256", render(packed, folder_ / picture, {"--quiet", "--memory", memory}));
    command.insert(command.end(), words.begin(), words.end());
    return peak_of(command);
  };
  const auto small = alone("small.pfm", "64M"), large = alone("large.pfm", "4G");
  EXPECT_EQ(small.first, 0);
  EXPECT_EQ(large.first, 0);
  EXPECT_LE(small.second, 64l << 10);
  EXPECT_GT(large.second, 400l * 400 * 400 / 1024);  // with enough memory, the samples stay in memory
  EXPECT_EQ(contents(folder_ / "small.pfm"), contents(folder_ / "large.pfm"));
}

TEST_F(SharedVolumes, InASmallPictureKeepTheBudget) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers take memory of their own";
  // A tile of 32 x 32 pixels covers almost all of the volume: 20 MiB of samples at a time.
  const std::string volume = folder_ / "v_400x400x400_uint8.raw";
  {
    std::ofstream out(volume, std::ios::binary);
    each_slice(400, [&](const std::string& slice) { out << slice; });
  }
  for (const int ranks : {2, 3}) {
    const auto [status, peak] = peak_of(
        mpirun_command(ranks, render(volume, folder_ / "a_%d.pfm", {"--orbit", "4", "--quiet", "--memory", "64M"})));
    EXPECT_EQ(status, 0);
    EXPECT_GT(peak, 20l << 10);
    EXPECT_LE(peak, 64l << 10) << ranks;
  }
}

TEST_F(SharedVolumes, FarLargerThanTheBudgetKeepIt) {
  if (is_sanitized) GTEST_SKIP() << "sanitizers take memory of their own";
  const std::string volume = folder_ / "v_512x512x512_uint8.raw";
  {
    std::ofstream out(volume, std::ios::binary);
    each_slice(512, [&](const std::string& slice) { out << slice; });
  }
  const Words words =
      of_size("512x512", render(volume, folder_ / "a_%d.pfm", {"--orbit", "3", "--quiet", "--memory", "64M"}));
  constexpr long budget = 64l << 10;
  Words alone{TESSERA_PROGRAM};
  alone.insert(alone.end(), words.begin(), words.end());
  for (const Words& command : {alone, mpirun_command(2, words)}) {
    const auto [status, peak] = peak_of(command);
    EXPECT_EQ(status, 0);
    EXPECT_GT(peak, 20l << 10);
    EXPECT_LE(peak, budget) << command.front();
  }
}

}  // namespace
}  // namespace tessera::apps
