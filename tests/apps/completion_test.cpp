// What a shell is told when somebody presses Tab, and manual pages.

#include "apps/completion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "apps/command_line.hpp"
#include "apps/program.hpp"
#include "tessera/dataset.hpp"
#include "tessera/image_file.hpp"
#include "tessera/presets.hpp"

namespace tessera::apps {
namespace {

using Words = std::vector<std::string>;

bool holds(const Words& words, const std::string& word) { return std::ranges::find(words, word) != words.end(); }

TEST(Completion, KnowsCommandsOptionsWordsAndNames) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const CommandLine line;
  EXPECT_EQ(completions(line, {"re"}), Words{"render"});
  EXPECT_EQ(completions(line, {"render", mesh, "--orb"}), Words{"--orbit"});
  EXPECT_TRUE(holds(completions(line, {"render", "--view", ""}), "front"));
  EXPECT_EQ(completions(line, {"render", "--view=fr"}), Words{"--view=front"});
  EXPECT_EQ(completions(line, {"render", mesh, "--field", ""}), Words{"f"});
  const Words functions = completions(line, {"render", "--transfer-function", "vir"});
  EXPECT_TRUE(holds(functions, "viridis")) << functions.size();
  EXPECT_TRUE(holds(functions, std::string(file_completion)));  // or a file
  EXPECT_EQ(completions(line, {"info", ""}), Words{std::string(file_completion)});
  EXPECT_EQ(completions(line, {"help", "gen"}), Words{"generate"});
  EXPECT_EQ(completions(line, {"completion", "z"}), Words{"zsh"});
  EXPECT_TRUE(completions(line, {"nonsense", ""}).empty());
  EXPECT_TRUE(completions(line, {"render", "--size", ""}).empty());
}

/// What bash has to offer for a line; the words as it splits them.
Words offered_by_bash(const Folder& folder, const std::string& words, const std::string& script) {
  const std::string program = folder.file("ask.sh", "source '" + script + "'\ncd '" + (folder / ".") + "'\n" +
                                                        "compopt() { :; }\nCOMP_WORDS=(" TESSERA_PROGRAM " " + words +
                                                        ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_tessera\n" +
                                                        "printf '%s\\n' \"${COMPREPLY[@]}\"\n");
  const Outcome outcome = Running({"bash", program}).wait();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  Words offered;
  std::istringstream in(outcome.out);
  for (std::string word; std::getline(in, word);) offered.push_back(word);
  return offered;
}

TEST(Completion, WorksInBash) {
  if (!std::filesystem::exists("/bin/bash")) GTEST_SKIP() << "no bash";
  const Folder folder;
  const std::string mesh = folder.cube();
  const Outcome script = tessera({"completion", "bash"});
  ASSERT_EQ(script.status, 0);
  const std::string file = folder.file("tessera.bash", script.out);
  EXPECT_EQ(offered_by_bash(folder, "ren", file), Words{"render"});
  EXPECT_EQ(offered_by_bash(folder, "render --orb", file), Words{"--orbit"});
  EXPECT_EQ(offered_by_bash(folder, "render cub", file), Words{"cube.vtu"});
  EXPECT_EQ(offered_by_bash(folder, "render cube.vtu --field ''", file), Words{"f"});
  // bash splits --view=fr into three words, and wants the last alone.
  EXPECT_EQ(offered_by_bash(folder, "render --view = fr", file), Words{"front"});
}

TEST(Completion, ShellsTakeTheirScripts) {
  const Folder folder;
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    const std::string file = folder.file("script." + shell, tessera({"completion", shell}).out);
    if (!std::filesystem::exists("/usr/bin/" + shell)) continue;
    const Outcome checked = Running({shell, "-n", file}).wait();
    EXPECT_EQ(checked.status, 0) << checked.err;
  }
  EXPECT_EQ(tessera({"completion", "tcsh"}).status, 2);
}

TEST(ManualPage, HoldsEveryOptionAndIsGoodRoff) {
  const Folder folder;
  const CommandLine line;
  for (const CLI::App* command : line.commands()) {
    const Outcome page = tessera({"help", "--man", command->get_name()});
    ASSERT_EQ(page.status, 0);
    for (const CLI::Option* option : command->get_options()) {
      if (!option->nonpositional() || option->get_group().empty() || option == command->get_help_ptr() ||
          option == command->get_help_all_ptr())
        continue;
      std::string name = "--" + option->get_lnames().front();
      for (std::size_t at = 0; (at = name.find('-', at)) != std::string::npos; at += 2) name.insert(at, 1, '\\');
      EXPECT_NE(page.out.find(name), std::string::npos) << name;
    }
    if (!std::filesystem::exists("/usr/bin/groff")) continue;
    const Outcome read = Running({"groff", "-man", "-Tascii", "-ww", "-z", folder.file("page.1", page.out)}).wait();
    EXPECT_EQ(read.status, 0);
    EXPECT_EQ(read.err, "") << command->get_name();
  }
}

TEST(Presets, AreListedAndDrawn) {
  const Folder folder;
  const Outcome list = tessera({"presets"});
  EXPECT_EQ(list.status, 0);
  EXPECT_NE(list.out.find("viridis\n"), std::string::npos);
  const Outcome drawn = tessera({"presets", "-o", folder / "presets.exr"});
  ASSERT_EQ(drawn.status, 0) << drawn.err;
  const Image sheet = read_image(folder / "presets.exr");
  const TransferFunction first = preset_function(preset_names().front());
  const auto red = [&](int x, int y) { return sheet.rgba[4 * sheet.index(x, y)]; };
  EXPECT_NEAR(red(8, 40), first.evaluate(0).color.r, 0.01);  // a pixel is 1 / 384 of the map
  EXPECT_NEAR(red(391, 40), first.evaluate(1).color.r, 0.01);
  float darkest = 1;  // of its name
  for (int y = 0; y < 28; ++y)
    for (int x = 0; x < 400; ++x) darkest = std::min(darkest, red(x, y));
  EXPECT_LT(darkest, 0.2f);
}

}  // namespace
}  // namespace tessera::apps
