// SPDX-License-Identifier: BSD-3-Clause
#include "apps/stderr_lines.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "apps/program.hpp"
#include "support/some_cases.hpp"

namespace tessera::apps {
namespace {

void expect_narrow(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), most_columns) << line;
}

TEST(StderrLines, BreakBetweenPartsThenBetweenWordsThenAnywhere) {
  EXPECT_EQ(in_lines("a; b"), "a; b");
  const std::string part(100, 'x');
  EXPECT_EQ(in_lines(part + "; " + part), part + "\n  " + part);
  std::string words = "w";
  for (int i = 0; i < 100; ++i) words += " word";
  expect_narrow(in_lines(words));
  EXPECT_EQ(in_lines(words).find("\n  word"), in_lines(words).find('\n'));
  expect_narrow(in_lines(std::string(1000, 'y')));
  std::string joined;
  std::istringstream lines(in_lines(std::string(1000, 'y')));
  for (std::string line; std::getline(lines, line);) joined += joined.empty() ? line : line.substr(2);
  EXPECT_EQ(joined, std::string(1000, 'y'));
}

TEST(StderrLines, NumbersHaveEnoughDigits) {
  EXPECT_EQ(time_words(1234), "1.23 s");
  EXPECT_EQ(time_words(12.34), "12.3 ms");
  EXPECT_EQ(range_words(0, 1), "0 to 1");
  EXPECT_EQ(range_words(1000000.25, 1000000.5), "1000000.25 to 1000000.5");
  EXPECT_EQ(range_words(3, 3), "3 to 3");
}

TEST(StderrLines, ArePartsOfRunsOverManyDataSets) {
  const Folder folder;
  test::SomeCases some(3);
  for (const char* kind : {"cube", "demo", "graded", "slivers", "regular"}) {
    if (!some.next()) continue;
    const std::string mesh = folder / (std::string(kind) + "_with_a_long_name_that_says_where_it_is_from.vtu");
    std::vector<std::string> make = {"generate", kind, mesh};
    if (std::string(kind) == "demo") make.emplace_back("resolution=0.2");
    ASSERT_EQ(tessera(make).status, 0) << kind;
    for (const char* output : {"one.png", "many_%02d.png"}) {
      std::vector<std::string> words = {"render", mesh, "-o", folder / output, "--size", "40x30"};
      if (std::string(output) != "one.png") words.insert(words.end(), {"--orbit", "2"});
      const Outcome run = tessera(words);
      EXPECT_EQ(run.status, 0) << run.err;
      expect_narrow(run.err);
      EXPECT_NE(run.err.find("transfer function"), std::string::npos);
    }
  }
  const Outcome grid = tessera({"render", folder.rectilinear(), "-o", folder / "g.png", "--size", "40x30"});
  EXPECT_EQ(grid.status, 0) << grid.err;
  expect_narrow(grid.err);
}

}  // namespace
}  // namespace tessera::apps
