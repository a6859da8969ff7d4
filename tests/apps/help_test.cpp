// SPDX-License-Identifier: BSD-3-Clause
// `--help`, `tessera help`, and suggestions for misspelled names.

#include <gtest/gtest.h>

#include <algorithm>
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

TEST(Help, OfACommandIsTheCommandsOwnHelp) {
  EXPECT_EQ(tessera({"help", "render"}).out, tessera({"render", "--help"}).out);
  EXPECT_EQ(tessera({"help"}).out, tessera({"--help"}).out);
}

TEST(Help, GuessesNothingFarFetched) {
  const Outcome outcome = tessera({"info", "a.vtu", "--wibble"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err.find("did you mean"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace tessera::apps
