// `tessera info`, `convert` and `generate`.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/program.hpp"

namespace tessera::apps {
namespace {

TEST(Info, SaysWhatTheFileHoldsForPeopleAndForMachines) {
  const Folder folder;
  const auto mesh = folder.cube();
  const auto text = tessera({"info", mesh});
  EXPECT_EQ(text.status, 0) << text.err;
  for (const char* word : {"384 of 384 cells", "125", "bounds", "fields", "renders", "unit distance", "orthographic"})
    EXPECT_NE(text.out.find(word), std::string::npos) << word << " in " << text.out;

  const auto machine = tessera({"info", "--json", mesh});
  ASSERT_EQ(machine.status, 0) << machine.err;
  const auto json = nlohmann::json::parse(machine.out);
  EXPECT_EQ(json.at("cells").at("read"), 384);
  EXPECT_EQ(json.at("points").at("read"), 125);
  EXPECT_EQ(json.at("fields").size(), 1u);
  EXPECT_TRUE(json.at("renders").at("view").contains("parallel_scale"));
}

TEST(Convert, KeepsThePicture) {
  const Folder folder;
  const auto mesh = folder.cube();
  const auto converted = tessera({"convert", mesh, folder / "again.vtu"});
  ASSERT_EQ(converted.status, 0) << converted.err;
  EXPECT_EQ(converted.error_lines(), 1u);
  ASSERT_EQ(tessera({"render", mesh, "-o", folder / "a.exr", "--size", "32x32"}).status, 0);
  ASSERT_EQ(tessera({"render", folder / "again.vtu", "-o", folder / "b.exr", "--size", "32x32"}).status, 0);
  EXPECT_TRUE(contents(folder / "a.exr") == contents(folder / "b.exr"));
}

TEST(Convert, WritesTetsThatReadBack) {
  const Folder folder;
  ASSERT_EQ(tessera({"convert", folder.cube(), folder / "c.tets", "--quiet"}).status, 0);
  EXPECT_EQ(contents(folder / "c.tets").size(), 16u + 125 * 16 + 384 * 16);
  const auto info = tessera({"info", "--json", folder / "c.tets"});
  EXPECT_EQ(nlohmann::json::parse(info.out).at("tets"), 384);
}

TEST(Convert, RefusesFormatsItDoesNotWrite) {
  const Folder folder;
  const auto mesh = folder.cube();
  for (const char* name : {"a.stl", "a.pvtu", "a"}) {
    const auto run = tessera({"convert", mesh, folder / name});
    EXPECT_EQ(run.status, 2) << name;
    EXPECT_EQ(run.error_lines(), 1u);
    EXPECT_FALSE(std::filesystem::exists(folder / name));
  }
}

TEST(Generate, MakesEveryKindThatItsHelpLists) {
  const Folder folder;
  const auto run = tessera({"generate", "tet", folder / "tet.vtu"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.err.find("1 tets"), std::string::npos) << run.err;
}

TEST(Generate, RefusesUnknownKindsAndParametersWithTheList) {
  const Folder folder;
  for (const std::vector<std::string>& words : {std::vector<std::string>{"castle"},
                                                {"cube", "towers=3"},
                                                {"cube", "n"},
                                                {"cube", "n=many"},
                                                {"cube", "n=2", "n=3"},
                                                {"cube", "n=1e9"}}) {
    std::vector<std::string> arguments = {"generate", words[0], folder / "a.vtu"};
    arguments.insert(arguments.end(), words.begin() + 1, words.end());
    const auto run = tessera(arguments);
    EXPECT_EQ(run.status, 2) << words.back();
    EXPECT_EQ(run.error_lines(), 1u) << run.err;
    EXPECT_EQ(folder.names().size(), 0u);
  }
}

}  // namespace
}  // namespace tessera::apps
