// SPDX-License-Identifier: BSD-3-Clause
// `--help`, `tessera help`, and suggestions for misspelled names.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "apps/command_line.hpp"
#include "apps/help/help_pages.hpp"
#include "apps/program.hpp"

namespace tessera::apps {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(Help, OfRenderIsAScreenfulWithThreeExamples) {
  const Outcome help = tessera({"render", "--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_TRUE(help.err.empty()) << help.err;
  const auto lines = lines_of(help.out);
  EXPECT_LE(lines.size(), 60U);
  EXPECT_EQ(std::ranges::count_if(lines, [](const std::string& l) { return l.starts_with("  tessera render "); }), 3);
}

TEST(Help, IsAtMostHundredColumnsWide) {
  for (const CommandRow& command : command_rows())
    for (const std::vector<std::string>& words : {std::vector<std::string>{std::string(command.name), "--help"},
                                                  {"help", "--all", std::string(command.name)}}) {
      const Outcome help = tessera(words);
      EXPECT_EQ(help.status, 0);
      for (const std::string& line : lines_of(help.out)) EXPECT_LE(line.size(), 100U) << command.name << line;
    }
}

TEST(Help, AllHasEveryOption) {
  const std::string page = tessera({"render", "--help-all"}).out;
  EXPECT_EQ(page, tessera({"help", "render", "--all"}).out);
  for (const OptionRow* row : option_rows(Trait::render))
    EXPECT_NE(page.find("  " + option_form(*row, true) + (row->is(Trait::positional) ? " " : "")), std::string::npos)
        << row->names;
}

TEST(Help, TheManualNamesExistingOptions) {
  std::string manual;
  for (const char* page : {"GUIDE.md", "REFERENCE.md", "FORMATS.md", "SERVER.md"})
    manual += contents(std::string(TESSERA_SOURCE_DIR "/docs/") + page);
  // Options of this program's help, and of mpirun and timeout.
  std::set<std::string> there = {"--help", "--help-all", "--version", "--oversubscribe", "--timeout"};
  for (const OptionTopic& topic : option_topics())
    for (const OptionRow& row : topic.rows) {
      const std::vector<std::string> names = written_names(row);
      there.insert(names.begin(), names.end());
      if (!row.is(Trait::positional | Trait::help)) {
        EXPECT_TRUE(
            std::ranges::any_of(names, [&](const std::string& n) { return manual.find(n) != std::string::npos; }))
            << row.names << " is in no page";
      }
    }
  const std::regex option("--[a-z]+(-[a-z]+)*");
  for (std::sregex_iterator at(manual.begin(), manual.end(), option), end; at != end; ++at)
    EXPECT_TRUE(there.contains(at->str())) << at->str() << " is not an option";
}

TEST(Help, ManualHasTheKeysOfStates) {
  const std::string page = contents(TESSERA_SOURCE_DIR "/docs/SERVER.md");
  for (const OptionRow* row : option_rows(Trait::state))
    EXPECT_NE(page.find('`' + std::string(row->key()) + '`'), std::string::npos) << row->key();
}

TEST(Help, TheServersPageNamesExistingOptions) {
  const std::string script = contents(TESSERA_SOURCE_DIR "/server/web/wording.js");
  const std::size_t begin = script.find("controls = {");
  const std::string controls = script.substr(begin, script.find("};", begin) - begin);
  const std::regex key("\"?([a-z]+(-[a-z]+)*)\"?: \"");
  int count = 0;
  for (std::sregex_iterator at(controls.begin(), controls.end(), key), end; at != end; ++at, ++count)
    EXPECT_NE(find_option(Trait::serve, (*at)[1].str()), nullptr) << (*at)[1];
  EXPECT_GT(count, 30);
}

TEST(Help, OfACommandIsTheCommandsOwnHelp) {
  EXPECT_EQ(tessera({"help", "render"}).out, tessera({"render", "--help"}).out);
  EXPECT_EQ(tessera({"help"}).out, tessera({"--help"}).out);
}

TEST(Help, NamesTheNearestName) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const std::string other = folder / "other.png";
  struct Case {
    std::vector<std::string> words;
    std::string meant;
  };
  const std::vector<Case> cases = {
      {{"render", mesh, "-o", other, "--feild", "s"}, "did you mean --field?"},
      {{"render", mesh, "-o", other, "--color-bra=left"}, "did you mean --color-bar?"},
      {{"rendr", mesh}, "did you mean render?"},
      {{"help", "inof"}, "did you mean info?"},
      {{"render", mesh, "-o", other, "--transfer-function", "virids"}, "did you mean viridis?"},
      {{"render", mesh, "-o", other, "--transfer-function", "viridis:peask"}, "did you mean viridis:peaks?"},
      {{"render", mesh, "-o", other, "--field", "ponit:f"}, "did you mean 'point:f'?"},
      {{"info", folder / "cubee.vtu"}, "did you mean " + mesh + "?"},
  };
  for (const Case& c : cases) {
    const Outcome outcome = tessera(c.words);
    EXPECT_EQ(outcome.status, 2) << c.meant;
    EXPECT_EQ(outcome.error_lines(), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(c.meant), std::string::npos) << c.meant << '\n' << outcome.err;
  }
}

TEST(Help, GuessesNothingFarFetched) {
  const Outcome outcome = tessera({"info", "a.vtu", "--wibble"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err.find("did you mean"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace tessera::apps
