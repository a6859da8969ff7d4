// SPDX-License-Identifier: BSD-3-Clause
// `--time-step` for files with several steps: one of them, or a film.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"

namespace tessera::apps {
namespace {

using Names = std::vector<std::string>;

class TimeSteps : public ::testing::Test {
 protected:
  /// 5^3 samples at four times: a ramp along x shifted by 10 per step.
  void SetUp() override {
    std::string text =
        "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 5 5 5 4\nkinds: domain domain domain time\n"
        "spacings: 1 1 1 nan\nencoding: raw\n\n";
    for (int step = 0; step < 4; ++step)
      for (int sample = 0; sample < 125; ++sample) text += static_cast<char>(10 * step + sample % 5);
    std::ofstream(volume, std::ios::binary) << text;
  }

  Outcome render(const std::string& output, const std::string& steps, const Names& more = {}) const {
    Names all = {"render", volume, "-o", folder / output, "--size", "20x20", "--range", "0,40"};
    if (!steps.empty()) all.insert(all.end(), {"--time-step", steps});
    all.insert(all.end(), more.begin(), more.end());
    return tessera(all);
  }

  Folder folder;
  std::string volume = folder / "v.nrrd";
};

TEST_F(TimeSteps, AFilmHasThePictureOfEachStep) {
  const Names looks = {"--transfer-function", "viridis", "--no-shade"};
  const Outcome all =
      render("all_%d.pfm", "all",
             {"--report", folder / "r.json", "--verify", "50", "--transfer-function", "viridis", "--no-shade"});
  ASSERT_EQ(all.status, 0) << all.err;
  const auto frames = nlohmann::json::parse(contents(folder / "r.json")).at("frames");
  ASSERT_EQ(frames.size(), 4u);
  for (std::size_t step = 0; step < 4; ++step) {
    EXPECT_EQ(frames.at(step).at("time_step"), step);
    ASSERT_EQ(render("one.pfm", std::to_string(step), looks).status, 0);
    EXPECT_EQ(contents(folder / "one.pfm"), contents(folder / ("all_" + std::to_string(step) + ".pfm"))) << step;
  }
  ASSERT_EQ(render("some_%d.pfm", "1:3:2", looks).status, 0);
  EXPECT_EQ(contents(folder / "some_0.pfm"), contents(folder / "all_1.pfm"));
  EXPECT_EQ(contents(folder / "some_1.pfm"), contents(folder / "all_3.pfm"));
  EXPECT_NE(contents(folder / "all_1.pfm"), contents(folder / "all_3.pfm"));
}

TEST_F(TimeSteps, ReportsTheShownStepAndHowToSeeAll) {
  const Outcome one = render("a.pfm", "");
  EXPECT_NE(
      one.err.find(
          "note: time step 3 of 0 to 3, which is the last and the default; --time-step all shows all steps as a film"),
      std::string::npos)
      << one.err;
}

TEST_F(TimeSteps, ColorsSpanTheExaminedSteps) {
  const Names film = {"render",
                      volume,
                      "-o",
                      folder / "w_%d.pfm",
                      "--size",
                      "8x8",
                      "--time-step",
                      "all",
                      "--report",
                      folder / "range.json",
                      "--transfer-function",
                      "viridis"};
  const Outcome outcome = tessera(film);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto knots = nlohmann::json::parse(contents(folder / "range.json")).at("transfer_function").at("knots");
  EXPECT_EQ(knots.front().at(0), 0);
  EXPECT_EQ(knots.back().at(0), 34);
  EXPECT_EQ(outcome.err.find("spans all"), std::string::npos) << outcome.err;
}

TEST_F(TimeSteps, AStepOfASeriesIsChosenTheSameWay) {
  const std::string cube = folder.cube();
  const std::string list =
      folder.file("f.pvd", "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" file=\"" + cube +
                               "\"/><DataSet timestep=\"2\" file=\"" + cube + "\"/></Collection></VTKFile>");
  EXPECT_EQ(tessera({"render", list, "-o", folder / "s.png", "--size", "8x8", "--time-step", "1"}).status, 0);
  const Outcome beyond = tessera({"render", list, "-o", folder / "s.png", "--size", "8x8", "--time-step", "2"});
  EXPECT_EQ(beyond.status, 2);
  EXPECT_NE(beyond.err.find("there is no time step 2, it has only 2"), std::string::npos) << beyond.err;
}

}  // namespace
}  // namespace tessera::apps
