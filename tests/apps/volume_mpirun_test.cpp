// SPDX-License-Identifier: BSD-3-Clause
// Volumes on several ranks, started as by users.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "apps/program.hpp"
#include "support/some_cases.hpp"

namespace tessera::apps {
namespace {

class VolumeMpirun : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
    ASSERT_EQ(tessera({"generate", "ripples", volume_, "n=24", "--quiet"}).status, 0);
  }
  /// `render` of the volume with these options, small, quiet, one thread per rank.
  [[nodiscard]] std::vector<std::string> render(const std::string& output, std::vector<std::string> more = {}) const {
    std::vector<std::string> words{"render", volume_, "-o", output, "--size", "70x50", "--threads", "1", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  /// The program's own lines on stderr; mpirun may add others.
  static std::size_t own_lines(const Outcome& outcome) {
    std::istringstream err(outcome.err);
    std::size_t count = 0;
    for (std::string line; std::getline(err, line);) count += line.starts_with("tessera: ") ? 1 : 0;
    return count;
  }

  const Folder folder_;
  const std::string volume_ = folder_ / "v.nrrd";
};

TEST_F(VolumeMpirun, AnyNumberOfProcessesGivesTheBytesOfOne) {
  ASSERT_EQ(tessera(render(folder_ / "one_%d.exr", {"--orbit", "2"})).status, 0);
  const std::pair<int, const char*> runs[] = {{2, "accurate"}, {3, "backface"}, {6, "learned"},
                                              {3, "previous"}, {2, "even"},     {3, "splatting"}};
  for (const auto& [ranks, balance] : runs) {
    const Outcome outcome = mpirun(ranks, render(folder_ / "ranks_%d.exr", {"--orbit", "2", "--balance", balance}));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    for (const char* number : {"0", "1"})
      EXPECT_EQ(contents(folder_ / "ranks_" + number + ".exr"), contents(folder_ / "one_" + number + ".exr"))
          << ranks << " by " << balance;
  }
}

TEST_F(VolumeMpirun, RectilinearGridsHaveTheBytesOfOneProcessToo) {
  const std::string grid = folder_.rectilinear();
  const auto film = [&](const std::string& name) {
    return std::vector<std::string>{"render",    grid,
                                    "-o",        folder_ / (name + "_%d.exr"),
                                    "-o",        folder_ / (name + "_%d.deep.exr"),
                                    "--orbit",   "2",
                                    "--size",    "70x50",
                                    "--threads", "1",
                                    "--quiet"};
  };
  ASSERT_EQ(tessera(film("one")).status, 0);
  EXPECT_NE(contents(folder_ / "one_0.exr"), contents(folder_ / "one_1.exr"));
  test::SomeCases some(3);
  for (const int ranks : {3, 2, 6}) {
    if (!some.next()) continue;
    const Outcome outcome = mpirun(ranks, film("ranks"));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    for (const char* end : {"_0.exr", "_1.exr", "_0.deep.exr", "_1.deep.exr"})
      EXPECT_EQ(contents(folder_ / (std::string("ranks") + end)), contents(folder_ / (std::string("one") + end)))
          << ranks << end;
  }
}

TEST_F(VolumeMpirun, AllProcessesFindTheSameLabelsAndFillValues) {
  // Boxes of four labels, one of which is only in a corner, and fill values: one that is blanked, one that is only
  // noted.
  constexpr int side = 16;
  std::string labels = "NRRD0004\ntype: float\ndimension: 3\nsizes: 16 16 16\nendian: little\nencoding: ascii\n\n",
              filled = labels;
  for (int n = 0; n < side * side * side; ++n) {
    const int i = n % side, j = n / side % side, k = n / side / side;
    const int label = i > 12 && j > 12 && k > 12 ? 40 : i / 6 + 3 * (j / 9);
    labels += n == 0 ? "1e20 " : fmt::format("{} ", label);
    filled += n == 0 ? "1e20 " : i == 0 ? "-9999 " : fmt::format("{:.6} ", 0.37 * i + 0.11 * j * k);
  }
  const auto count = [](const std::string& text, const std::string& words) {
    std::size_t found = 0;
    for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++found;
    return found;
  };
  const auto run = [&](const std::string& file, int ranks, const std::string& output) {
    const std::vector<std::string> words{"render", file, "-o", output, "--size", "70x50", "--threads", "1"};
    const Outcome outcome = ranks == 1 ? tessera(words) : mpirun(ranks, words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out + outcome.err;
  };
  const std::string label_file = folder_.file("labels.nrrd", labels), fill_file = folder_.file("fill.nrrd", filled);
  run(label_file, 1, folder_ / "labels_one.exr");
  run(fill_file, 1, folder_ / "fill_one.exr");
  test::SomeCases some(2);
  for (const int ranks : {3, 2}) {
    if (!some.next()) continue;
    const std::string notes = run(label_file, ranks, folder_ / "labels.exr");
    EXPECT_EQ(count(notes, "values are labels, 7 of them"), 1u) << notes;
    EXPECT_EQ(contents(folder_ / "labels.exr"), contents(folder_ / "labels_one.exr")) << ranks;
    const std::string noted = run(fill_file, ranks, folder_ / "fill.exr");
    EXPECT_EQ(count(noted, "1 samples have the value 1e+20, a fill value"), 1u) << noted;
    EXPECT_EQ(count(noted, "255 samples have the value -9999, which looks like a fill value"), 1u) << noted;
    EXPECT_EQ(contents(folder_ / "fill.exr"), contents(folder_ / "fill_one.exr")) << ranks;
  }
}

TEST_F(VolumeMpirun, TheReportAndTheTraceHaveEveryRanksPart) {
  const Outcome outcome = mpirun(3, render(folder_ / "a.exr", {"--verify", "300", "--report", folder_ / "r.json",
                                                               "--timing", folder_ / "t.json"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1) << outcome.out;
  const auto report = nlohmann::json::parse(contents(folder_ / "r.json"));
  EXPECT_EQ(report.at("method").at("ranks"), 3);
  const auto& frame = report.at("frames").at(0);
  ASSERT_EQ(frame.at("balance").at("processes").size(), 3u);
  std::uint64_t samples = 0, loads = 0;
  int pixels = 0;
  for (const auto& process : frame.at("balance").at("processes")) {
    samples += process.at("samples").get<std::uint64_t>();
    loads += process.at("counters").at("bricks_loaded").get<std::uint64_t>();
    const auto r = process.at("rectangle").get<std::vector<int>>();
    pixels += (r[2] - r[0]) * (r[3] - r[1]);
  }
  EXPECT_EQ(samples, frame.at("counters").at("samples").get<std::uint64_t>());
  EXPECT_GT(loads, 0u);
  EXPECT_EQ(loads, frame.at("counters").at("bricks_loaded").get<std::uint64_t>());
  EXPECT_EQ(pixels, 70 * 50);
  const auto trace = nlohmann::json::parse(contents(folder_ / "t.json"));
  std::set<int> ranks;
  for (const auto& event : trace.at("traceEvents")) ranks.insert(event.at("pid").get<int>());
  EXPECT_EQ(ranks, (std::set<int>{0, 1, 2}));
}

TEST_F(VolumeMpirun, DeepPicturesHaveTheBytesOfOneProcess) {
  ASSERT_EQ(tessera(render(folder_ / "one_%d.deep.exr", {"--orbit", "2", "-o", folder_ / "one_%d.pfm"})).status, 0);
  const Outcome three =
      mpirun(3, render(folder_ / "three_%d.deep.exr", {"--orbit", "2", "-o", folder_ / "three_%d.pfm"}));
  ASSERT_EQ(three.status, 0) << three.err;
  for (const char* end : {"_0.deep.exr", "_1.deep.exr", "_1.pfm"})
    EXPECT_EQ(contents(folder_ / (std::string("three") + end)), contents(folder_ / (std::string("one") + end))) << end;
}

TEST_F(VolumeMpirun, WeightsGiveAProcessMoreOfTheWork) {
  ASSERT_EQ(mpirun(2, render(folder_ / "a.exr", {"--balance-weights", "3,1", "--report", folder_ / "r.json"})).status,
            0);
  const auto report = nlohmann::json::parse(contents(folder_ / "r.json"));
  const auto& processes = report.at("frames").at(0).at("balance").at("processes");
  EXPECT_GT(processes.at(0).at("samples").get<double>(), 2 * processes.at(1).at("samples").get<double>());
}

TEST_F(VolumeMpirun, ResumeRendersOnlyMissingFrames) {
  const auto film = render(folder_ / "f_%d.pfm", {"--orbit", "4", "--resume"});
  ASSERT_EQ(mpirun(2, film).status, 0);
  const std::string third = contents(folder_ / "f_2.pfm");
  std::filesystem::remove(folder_ / "f_2.pfm");
  const auto untouched = std::filesystem::last_write_time(folder_ / "f_3.pfm");
  ASSERT_EQ(mpirun(3, film).status, 0);
  EXPECT_EQ(contents(folder_ / "f_2.pfm"), third);
  EXPECT_EQ(std::filesystem::last_write_time(folder_ / "f_3.pfm"), untouched);
}

TEST_F(VolumeMpirun, ASeriesBrokenOffAndResumedHasTheBytesOfOneRun) {
  ASSERT_EQ(tessera({"generate", "ripples", folder_ / "w.nrrd", "n=18", "--quiet"}).status, 0);
  const std::string path = folder_.file(
      "path.json",
      R"([{"position":[4,3,5],"focal_point":[0,0,0],"view_angle":30},{"position":[1,3,5],"focal_point":[0,0,0],"view_angle":30}])");
  const auto film = [&](const std::string& name) {
    return render(folder_ / name, {folder_ / "w.nrrd", "--camera", path, "--resume"});
  };
  ASSERT_EQ(mpirun(3, film("whole_%d.exr")).status, 0);
  // These files are left by a run that ended within its second time step; an image is either complete or missing.
  for (const char* number : {"0", "1", "2"})
    std::filesystem::copy_file(folder_ / "whole_" + number + ".exr", folder_ / "part_" + number + ".exr");
  std::filesystem::remove(volume_);  // a step whose images all exist is not read, except for the defaults of the first
  ASSERT_NE(mpirun(2, film("part_%d.exr")).status, 0);
  ASSERT_EQ(tessera({"generate", "ripples", volume_, "n=24", "--quiet"}).status, 0);
  ASSERT_EQ(mpirun(2, film("part_%d.exr")).status, 0);
  for (const char* number : {"0", "1", "2", "3"})
    EXPECT_EQ(contents(folder_ / "part_" + number + ".exr"), contents(folder_ / "whole_" + number + ".exr")) << number;
}

TEST_F(VolumeMpirun, ShowBalanceDrawsBricksAndTheCostMap) {
  ASSERT_EQ(mpirun(2, render(folder_ / "a.png", {"--show", "balance", "--brick-size", "8"})).status, 0);
  ASSERT_EQ(tessera(render(folder_ / "b.png")).status, 0);
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"a.cost.png", "a.png", "b.png", "v.nrrd"}));
  EXPECT_NE(contents(folder_ / "a.png"), contents(folder_ / "b.png"));
}

TEST_F(VolumeMpirun, FaultsAreOneLineInAllAndLeaveNothing) {
  const std::vector<std::vector<std::string>> wrong{
      {"--balance", "fair"}, {"--balance-resolution", "2"}, {"--balance-weights", "1,2"}, {"--balance-weights", "1,x"},
      {"--show", "me"},      {"--projectors", "1"},         {"--field", "nothing"},       {"--camera", folder_ / "no"},
      {"--preload", "3"}};
  test::SomeCases some(4);
  for (const auto& words : wrong) {
    if (!some.next()) continue;
    const Outcome outcome = mpirun(3, render(folder_ / "a.png", words));
    EXPECT_EQ(outcome.status, 2) << words[0] << outcome.err;
    EXPECT_EQ(own_lines(outcome), 1u) << words[0] << outcome.err;
  }
  const Outcome flat = mpirun(2, {"render", folder_.file("x_9x9x9_uint8.raw", "short"), "-o", folder_ / "a.png"});
  EXPECT_EQ(flat.status, 2);
  EXPECT_EQ(own_lines(flat), 1u) << flat.err;
  // Only all ranks together know that all samples are blank.
  const std::string nothing(std::size_t{4} * 9 * 9 * 40, '\xff');  // NaN
  const Outcome blank = mpirun(3, {"render", folder_.file("n_9x9x40_float32.raw", nothing), "-o", folder_ / "a.png"});
  EXPECT_EQ(blank.status, 2);
  EXPECT_EQ(own_lines(blank), 1u) << blank.err;
  EXPECT_NE(blank.err.find("none of its 3240 samples"), std::string::npos) << blank.err;
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"n_9x9x40_float32.raw", "v.nrrd", "x_9x9x9_uint8.raw"}));
}

}  // namespace
}  // namespace tessera::apps
