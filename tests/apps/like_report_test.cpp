// SPDX-License-Identifier: BSD-3-Clause
// `--like`: another run's view, field and transfer function.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"

namespace tessera::apps {
namespace {

using Json = nlohmann::json;
using Words = std::vector<std::string>;

Json report_of(const Folder& folder, const Words& words) {
  Words command = {"render", "-o", folder / "a_%02d.png", "--report", folder / "r.json", "--quiet"};
  command.insert(command.end(), words.begin(), words.end());
  const Outcome run = tessera(command);
  EXPECT_EQ(run.status, 0) << run.err;
  return Json::parse(contents(folder / "r.json"));
}

/// A mesh of one tet with these values, of twice the size if `large`.
std::string tet_with(const Folder& folder, const std::string& name, const std::string& values, bool large = false) {
  return folder.file(
      name, "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 " +
                std::string(large ? "2 0 0 0 2 0 0 0 2" : "1 0 0 0 1 0 0 0 1") +
                "\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\nPOINT_DATA 4\nSCALARS p float 1\nLOOKUP_TABLE default\n" +
                values + "\nSCALARS q float 1\nLOOKUP_TABLE default\n9 8 7 6\n");
}

class LikeReport : public ::testing::Test {
 protected:
  LikeReport() {
    const Outcome readable = tessera({"info", first_});
    can_read_ = readable.status == 0;
  }
  void SetUp() override {
    if (!can_read_) GTEST_SKIP() << "legacy VTK needs its reader, which is not installed";
  }
  const Folder folder_;
  const std::string first_ = tet_with(folder_, "first.vtk", "0 1 2 3"),
                    second_ = tet_with(folder_, "second.vtk", "0 40 2 1", true);
  bool can_read_ = false;
};

TEST_F(LikeReport, GivesOtherDataTheSameColoursAndView) {
  const Json like = report_of(folder_, {first_, "--size", "40x30", "--field", "p", "--opacity", "3"});
  const std::string file = folder_.file("like.json", like.dump());
  const Json alone = report_of(folder_, {second_, "--field", "p"});
  const Json same = report_of(folder_, {second_, "--like", file});
  EXPECT_NE(alone.at("transfer_function").at("knots"), like.at("transfer_function").at("knots"));
  EXPECT_EQ(same.at("transfer_function").at("knots"), like.at("transfer_function").at("knots"));
  EXPECT_EQ(same.at("frames")[0].at("view"), like.at("frames")[0].at("view"));
  EXPECT_EQ(same.at("mesh").at("field").at("name"), "p");
}

TEST_F(LikeReport, GivesTheSameDataTheSamePicture) {
  const std::string again = folder_ / "again.png", first = folder_ / "first.png";
  for (const Words& options :
       {Words{}, Words{"--view", "top", "--zoom", "2"}, Words{"--log"}, Words{"--transfer-function", "magma:ramp"},
        Words{"--blend", "display"}, Words{"--emission", "independent"}, Words{"--shade", "--light", "world:1,2,3"}}) {
    Words command = {"render", first_, "-o", first, "--report", folder_ / "like.json", "--size", "40x30"};
    command.insert(command.end(), options.begin(), options.end());
    const Outcome made = tessera(command);
    ASSERT_EQ(made.status, 0) << made.err;
    const Outcome run = tessera({"render", first_, "-o", again, "--like", folder_ / "like.json"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(contents(again), contents(first)) << (options.empty() ? "" : options.front());
  }
}

TEST_F(LikeReport, GivesAColorBarTheSameScale) {
  const std::string again = folder_ / "again.png", first = folder_ / "first.png", report = folder_ / "like.json";
  const Words bar = {"--color-bar=right", "--color-bar-title", "p"};
  for (const Words& options : {Words{}, Words{"--log"}, Words{"--log", "--color-bar-range", "0.5,2"}}) {
    Words command = {"render", first_, "-o", first, "--report", report, "--size", "160x120"};
    command.insert(command.end(), bar.begin(), bar.end());
    command.insert(command.end(), options.begin(), options.end());
    const Outcome made = tessera(command);
    ASSERT_EQ(made.status, 0) << made.err;
    Words like = {"render", first_, "-o", again, "--like", report};
    like.insert(like.end(), bar.begin(), bar.end());
    const Outcome run = tessera(like);
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(contents(again) == contents(first), options.size() < 2) << options.size();
  }
}

TEST_F(LikeReport, OtherOptionsOverrideIt) {
  const Json like = report_of(folder_, {first_, "--size", "40x30", "--field", "p"});
  const std::string file = folder_.file("like.json", like.dump());
  const Json other = report_of(folder_, {second_, "--like", file, "--field", "q", "--transfer-function", "magma:ramp",
                                         "--view", "top", "--size", "20x20"});
  EXPECT_EQ(other.at("mesh").at("field").at("name"), "q");
  EXPECT_NE(other.at("transfer_function").at("knots"), like.at("transfer_function").at("knots"));
  EXPECT_NE(other.at("frames")[0].at("view"), like.at("frames")[0].at("view"));
}

TEST_F(LikeReport, HasAllViewsOfAnOrbit) {
  const Json like = report_of(folder_, {first_, "--size", "40x30", "--orbit", "3"});
  const std::string file = folder_.file("like.json", like.dump());
  const Json same = report_of(folder_, {second_, "--like", file});
  ASSERT_EQ(same.at("frames").size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(same.at("frames")[i].at("view"), like.at("frames")[i].at("view"));
}

TEST(LikeReportOfVolumes, GivesOtherSamplesTheSameColours) {
  const Folder folder;
  for (const char* n : {"12", "16"})
    ASSERT_EQ(
        tessera({"generate", "ripples", folder / (std::string(n) + ".nrrd"), std::string("n=") + n, "--quiet"}).status,
        0);
  const Json like = report_of(folder, {folder / "12.nrrd", "--size", "40x30", "--range", "0.2,0.6"});
  const std::string file = folder.file("like.json", like.dump());
  const Json same = report_of(folder, {folder / "16.nrrd", "--like", file});
  EXPECT_EQ(same.at("transfer_function").at("knots"), like.at("transfer_function").at("knots"));
  EXPECT_EQ(same.at("frames")[0].at("view"), like.at("frames")[0].at("view"));
}

}  // namespace
}  // namespace tessera::apps
