// SPDX-License-Identifier: BSD-3-Clause
// The program's defaults, and the options that override them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "apps/program.hpp"

namespace tessera::apps {
namespace {

nlohmann::json report_of(const std::string& file) { return nlohmann::json::parse(contents(file)); }

TEST(FirstPicture, SeveralRanksChooseViewRangeAndFunctionOfOne) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  const Folder folder;
  // More tets than are examined (2^16), so that it matters which are left out.
  ASSERT_EQ(tessera({"generate", "cube", folder / "a.vtu", "n=23", "--quiet"}).status, 0);
  const std::vector<std::string> command{"render",  folder / "a.vtu", "-o", folder / "a.pfm", "--size", "32x24",
                                         "--quiet", "--threads",      "1",  "--report"};
  std::vector<std::string> one = command, three = command;
  one.push_back(folder / "one.json");
  three.insert(three.end(), {folder / "three.json", "--partition", "random"});
  ASSERT_EQ(tessera(one).status, 0);
  const Outcome outcome = mpirun(3, three);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto a = report_of(folder / "one.json"), b = report_of(folder / "three.json");
  EXPECT_EQ(a.at("transfer_function"), b.at("transfer_function"));
  EXPECT_EQ(a.at("frames").at(0).at("view"), b.at("frames").at(0).at("view"));
}

TEST(FirstPicture, WarnsOfAnInvisibleFunctionWithTheOptionThatFixesIt) {
  const Folder folder;
  const std::string far_off = folder.file("far.txt", "100 1 0 0 0\n200 0 1 0 5\n");
  const std::vector<std::string> command{"render", folder.cube(),         "-o",   folder / "a.png", "--size",
                                         "16x16",  "--transfer-function", far_off};
  const Outcome nothing = tessera(command);
  EXPECT_EQ(nothing.status, 0);
  EXPECT_NE(nothing.err.find("tessera: warning: "), std::string::npos) << nothing.err;
  EXPECT_NE(nothing.err.find("--rescale"), std::string::npos) << nothing.err;
  for (const std::vector<std::string>& remedy : {std::vector<std::string>{"--rescale"}, {"--range", "0,1"}}) {
    std::vector<std::string> with = command;
    with.insert(with.end(), remedy.begin(), remedy.end());
    const Outcome shown = tessera(with);
    EXPECT_EQ(shown.status, 0);
    EXPECT_EQ(shown.err.find("warning"), std::string::npos) << shown.err;
  }
}

TEST(FirstPicture, AMeshWithoutFieldShowsItsShapeUnlessAFunctionIsNamed) {
  const Folder folder;
  const std::string mesh = folder.file("a.node", "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
  std::ignore = folder.file("a.ele", "1 4 0\n0 0 1 2 3\n");
  const Outcome shape = tessera({"render", mesh, "-o", folder / "a.png", "--size", "16x16"});
  ASSERT_EQ(shape.status, 0) << shape.err;
  EXPECT_NE(shape.err.find("shape by depth"), std::string::npos) << shape.err;
  const Outcome one =
      tessera({"render", mesh, "-o", folder / "a.png", "--size", "16x16", "--transfer-function", "white"});
  EXPECT_NE(one.err.find("field none (point) 1 to 1"), std::string::npos) << one.err;
}

TEST(FirstPicture, OptionsOfViewAndFunctionListTheirValues) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const auto refused = [&](const std::vector<std::string>& more, const std::string& word) {
    std::vector<std::string> command{"render", mesh, "-o", folder / "a.png"};
    command.insert(command.end(), more.begin(), more.end());
    const Outcome outcome = tessera(command);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.error_lines(), 1u) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  };
  refused({"--view", "sideways"}, "iso");
  refused({"--up", "0,0,0"}, "--up");
  refused({"--view", "top", "--up", "0,0,1"}, "--up");
  refused({"--zoom", "0"}, "--zoom");
  refused({"--fit"}, "--camera");
  refused({"--range", "2,1"}, "--range");
  refused({"--opacity-points", "0.5:0.1,0.2:0.1"}, "--opacity-points");
  refused({"--background", "#12345"}, "#rrggbb");
  refused({"--log", "--range", "-2,-1"}, "--log");
}

}  // namespace
}  // namespace tessera::apps
