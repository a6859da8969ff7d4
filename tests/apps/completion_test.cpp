// SPDX-License-Identifier: BSD-3-Clause
// Completions offered to shells, and manual pages.

#include "apps/help/completion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>

#include "apps/command_line.hpp"
#include "apps/help/help_pages.hpp"
#include "apps/program.hpp"
#include "tessera/dataset.hpp"
#include "tessera/image_file.hpp"
#include "tessera/presets.hpp"

namespace tessera::apps {
namespace {

using Words = std::vector<std::string>;

bool holds(const Words& words, const std::string& word) { return std::ranges::find(words, word) != words.end(); }

TEST(Completion, CompletesCommandsOptionsWordsAndNames) {
  const Folder folder;
  const std::string mesh = folder.cube();
  EXPECT_EQ(completions({"re"}), Words{"render"});
  EXPECT_EQ(completions({"render", mesh, "--orb"}), Words{"--orbit"});
  EXPECT_TRUE(holds(completions({"render", "--view", ""}), "front"));
  EXPECT_EQ(completions({"render", "--view=fr"}), Words{"--view=front"});
  EXPECT_EQ(completions({"render", mesh, "--field", ""}), Words{"f"});
  const Words functions = completions({"render", "--transfer-function", "vir"});
  EXPECT_TRUE(holds(functions, "viridis")) << functions.size();
  EXPECT_TRUE(holds(functions, std::string(file_completion)));  // or a file
  EXPECT_EQ(completions({"info", ""}), Words{std::string(file_completion)});
  EXPECT_EQ(completions({"help", "gen"}), Words{"generate"});
  EXPECT_EQ(completions({"completion", "z"}), Words{"zsh"});
  EXPECT_EQ(completions({"generate", "rip"}), Words{"ripples"});
  EXPECT_TRUE(holds(completions({"render", "--transfer-function", "viridis:p"}), "viridis:peaks"));
  EXPECT_TRUE(holds(completions({"render", "--transfer-function=viridis:p"}), "--transfer-function=viridis:peaks"));
  EXPECT_TRUE(completions({"nonsense", ""}).empty());
  EXPECT_TRUE(completions({"render", "--size", ""}).empty());
}

/// bash's completions for a line; the words are split as bash splits them.
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
  // bash splits --view=fr into three words, and expects completions of the last word only.
  EXPECT_EQ(offered_by_bash(folder, "render --view = fr", file), Words{"front"});
}

/// Whether this shell is installed at its place in Debian.
bool has_shell(const std::string& name) { return std::filesystem::exists("/usr/bin/" + name); }

/// A directory whose `bin` contains the program by its name, for shells that search for it.
std::string path_with_tessera(const Folder& folder) {
  std::filesystem::create_directory(folder / "bin");
  std::filesystem::create_symlink(TESSERA_PROGRAM, folder / "bin/tessera");
  return folder / "bin:/usr/bin:/bin";
}

/// Text completed in zsh and fish, and its only possible completion.
const std::vector<std::array<std::string, 2>> typed = {
    {"tessera ren", "tessera render"},
    {"tessera render --orb", "tessera render --orbit"},
    {"tessera render cub", "tessera render cube.vtu"},
    {"tessera render cube.vtu --field ", "tessera render cube.vtu --field f"},
    {"tessera render cube.vtu --field=", "tessera render cube.vtu --field=f"},
    {"tessera render --view=fr", "tessera render --view=front"},
    {"tessera render --transfer-function viri", "tessera render --transfer-function viridis"},
    {"tessera render --transfer-function=viri", "tessera render --transfer-function=viridis"},
    {"tessera render --transfer-function viridis:p", "tessera render --transfer-function viridis:peaks"},
    {"tessera render --camera=cub", "tessera render --camera=cube.vtu"},
    {"tessera info a\\ vol", "tessera info a\\ volume.nrrd"},
    {"tessera generate rip", "tessera generate ripples"}};

TEST(Completion, WorksInFish) {
  if (!has_shell("fish")) GTEST_SKIP() << "fish is not installed";
  const Folder folder;
  static_cast<void>(folder.cube());
  static_cast<void>(folder.file("a volume.nrrd", ""));
  std::string script = "set -x PATH " + path_with_tessera(folder) + "\nset -x PATH (string split : $PATH)\n";
  script += "cd " + (folder / ".") + "\n" + tessera({"completion", "fish"}).out;
  for (const auto& [line, whole] : typed) script += "complete -C '" + line + "'\necho\n";
  const Outcome outcome = Running({"fish", "--no-config", folder.file("ask.fish", script)}).wait();
  EXPECT_EQ(outcome.err, "");
  std::istringstream offered(outcome.out);
  for (const auto& [line, whole] : typed) {
    std::string found, rest;
    std::getline(offered, found);
    EXPECT_TRUE(std::getline(offered, rest) && rest.empty()) << line << ": " << rest;
    // fish prints only the last word, without quotes.
    std::string word = whole.substr(line.find_last_of(' ') + 1);
    if (line.find("a\\ ") != std::string::npos) word = "a volume.nrrd";
    EXPECT_EQ(found, word) << line;
  }
}

TEST(Completion, WorksInZsh) {
  if (!has_shell("zsh")) GTEST_SKIP() << "zsh is not installed";
  const Folder folder;
  static_cast<void>(folder.cube());
  static_cast<void>(folder.file("a volume.nrrd", ""));
  const std::string script = folder.file("tessera.zsh", tessera({"completion", "zsh"}).out);
  // A shell at its own pseudo-terminal, in which lines are typed; Ctrl-X prints the current line.
  std::string driver = "zmodload zsh/zpty || exit 77\nexport PATH=" + path_with_tessera(folder) + "\ncd " +
                       (folder / ".") +
                       "\nzpty -b shell 'TERM=dumb zsh -f -i' || exit 77\nzpty -w shell \"PS1=; autoload -Uz " +
                       "compinit && compinit -D -u; source " + script + "; keep() { print -r -- \\\"\\$BUFFER\\\" >> " +
                       "kept; BUFFER=; }; zle -N keep; bindkey '^X' keep; print ready > ready\"\n" +
                       "for i in {1..3000}; do [[ -e ready ]] && break; sleep 0.1; done\nn=0\n" +
                       "ask() { zpty -n -w shell \"$1\"$'\\t\\x18'; (( n++ ))\n" +
                       "for i in {1..3000}; do [[ -e kept ]] && (( $(wc -l < kept) >= n )) && return; sleep 0.1; " +
                       "zpty -r -t shell > /dev/null; done }\n";
  for (const auto& [line, whole] : typed) driver += "ask '" + line + "'\n";
  driver += "zpty -d shell\n";
  const Outcome outcome = Running({"zsh", "-f", folder.file("ask.zsh", driver)}).wait();
  if (outcome.status == 77) GTEST_SKIP() << "zsh has no module zsh/zpty, or the machine no pseudo-terminals";
  std::istringstream kept(contents(folder / "kept"));
  for (const auto& [line, whole] : typed) {
    std::string found;
    std::getline(kept, found);
    while (found.ends_with(' ')) found.pop_back();
    EXPECT_EQ(found, whole);
  }
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
  for (const CommandRow& command : command_rows()) {
    const std::string name(command.name);
    const Outcome page = tessera({"help", "--man", name});
    ASSERT_EQ(page.status, 0);
    for (const OptionRow* row : option_rows(command.trait)) {
      std::string option = shown_name(*row);
      for (std::size_t at = 0; (at = option.find('-', at)) != std::string::npos; at += 2) option.insert(at, 1, '\\');
      EXPECT_NE(page.out.find(option), std::string::npos) << option;
    }
    if (!std::filesystem::exists("/usr/bin/groff")) continue;
    const Outcome read = Running({"groff", "-man", "-Tascii", "-ww", "-z", folder.file("page.1", page.out)}).wait();
    EXPECT_EQ(read.status, 0);
    EXPECT_EQ(read.err, "") << name;
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
