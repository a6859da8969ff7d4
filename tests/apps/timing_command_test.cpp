// SPDX-License-Identifier: BSD-3-Clause
// `tessera timing` as a user runs it.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/program.hpp"
#include "apps/traced_pipeline.hpp"

namespace tessera::apps {
namespace {

/// The words of the first line that begins with `word`, after `after`.
std::vector<std::string> line_of(const std::string& text, const std::string& after, const std::string& word) {
  std::istringstream lines(text.substr(std::min(text.find(after), text.size())));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::vector<std::string> found;
    for (std::string w; words >> w;) found.push_back(w);
    if (!found.empty() && found[0] == word) return found;
  }
  return {};
}

TEST(Timing, PrintsTheBreakdownOfATracedRender) {
  const Folder folder;
  const auto mesh = folder.cube();
  ASSERT_EQ(tessera({"render", mesh, "-o", folder / "a%d.pfm", "--orbit", "3", "--size", "40x30", "--timing",
                     folder / "trace.json", "--quiet"})
                .status,
            0);
  const auto run = tessera({"timing", folder / "trace.json"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_NE(run.out.find("384 tets, 3 frames of 40x30"), std::string::npos) << run.out;
  for (const char* stage : {"transform", "cull", "project", "sort", "integrate", "composite", "write", "other"})
    EXPECT_EQ(line_of(run.out, "Process", stage).size(), stage == std::string("other") ? 4u : 5u) << stage << run.out;
  EXPECT_EQ(line_of(run.out, "Process", "whole")[2], "100.0");
  EXPECT_EQ(run.out.find("Exchange"), std::string::npos);
}

TEST(Timing, PrintsRolesExchangeOverlapAndTheTableOfSeveralRuns) {
  const Folder folder;
  TracedPipeline{2, 1, false, 3, 120, 120}.write(folder / "small.json");
  TracedPipeline{4, 2, false, 3, 50, 50}.write(folder / "large.json");
  const auto run = tessera({"timing", folder / "small.json", folder / "large.json"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(line_of(run.out, "Projectors", "project"),
            (std::vector<std::string>{"project", "40.0", "33.3", "%", "76.0", "40.0", "0"}));
  EXPECT_EQ(line_of(run.out, "Compositors", "wait")[1], "60.0");
  // 2 projectors x 2 threads x 1000 bytes a frame, in 6 ms of each thread.
  EXPECT_EQ(line_of(run.out, "Exchange", "send"),
            (std::vector<std::string>{"send", "6.0", "ms", "5.0", "%", "4.00", "kB", "8", "0"}));
  EXPECT_NE(run.out.find("2 of 2 frames began projecting before"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("efficiency"), std::string::npos);
}

TEST(Timing, CsvHasALineForEachStageOfEachRoleAndRun) {
  const Folder folder;
  TracedPipeline{2, 1}.write(folder / "a, \"b\".json");
  const auto run = tessera({"timing", folder / "a, \"b\".json", "--csv", folder / "t.csv"});
  ASSERT_EQ(run.status, 0) << run.err;
  std::istringstream lines(contents(folder / "t.csv"));
  std::string line;
  std::getline(lines, line);
  const auto columns = std::count(line.begin(), line.end(), ',');
  int count = 0;
  while (std::getline(lines, line)) {
    ++count;
    EXPECT_NE(line.find("a, \"\"b\"\".json\","), std::string::npos);
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns + 1) << line;  // one in the name
  }
  // 8 stages of projectors and 6 stages of compositors; for each role also `other`, `whole` and `read`.
  EXPECT_EQ(count, 8 + 6 + 2 * 3);
}

TEST(Timing, FiguresArePicturesOfTheirKind) {
  const Folder folder;
  TracedPipeline{2, 1}.write(folder / "a.json");
  TracedPipeline{2, 2, true}.write(folder / "b.json");
  for (const char* name : {"t.png", "t.svg"}) {
    const auto run = tessera({"timing", folder / "a.json", folder / "b.json", "--figure", folder / name});
    ASSERT_EQ(run.status, 0) << run.err;
  }
  EXPECT_TRUE(contents(folder / "t.png").starts_with("\x89PNG\r\n"));
  const auto svg = contents(folder / "t.svg");
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

TEST(Timing, BadTracesEndInOneLineAndLeaveNothing) {
  const Folder folder;
  TracedPipeline{2, 1}.write(folder / "good.json");
  const auto good = contents(folder / "good.json");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {folder.file("cut.json", good.substr(0, good.size() / 2)), "not valid JSON"},
      {folder.file("other.json", R"({"traceEvents":[{"name":"v8","ph":"X","ts":1,"dur":1}]})"),
       "no spans recorded by Tessera"},
      {folder.file("empty.json", ""), "empty"},
      {folder.file("text.json", "hello"), "not valid JSON"},
      {folder / "none.json", "none.json"},
  };
  const auto names = folder.names();
  for (const auto& [trace, words] : cases) {
    const auto run =
        tessera({"timing", folder / "good.json", trace, "--csv", folder / "t.csv", "--figure", folder / "t.svg"});
    EXPECT_EQ(run.status, 2) << trace;
    EXPECT_EQ(run.error_lines(), 1u) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(trace), std::string::npos) << run.err;
  }
  EXPECT_EQ(folder.names(), names);
}

TEST(Timing, OutputsAreCheckedBeforeTracesAreRead) {
  const Folder folder;
  TracedPipeline{1, 1}.write(folder / "a.json");
  for (const auto& [option, file] :
       std::vector<std::pair<std::string, std::string>>{{"--figure", folder / "t.jpg"},
                                                        {"--figure", folder / "none/t.svg"},
                                                        {"--csv", folder / "none/t.csv"},
                                                        {"--csv", folder / "a.json"}}) {
    const auto run = tessera({"timing", folder / "a.json", option, file});
    EXPECT_EQ(run.status, 2) << file;
    EXPECT_EQ(run.error_lines(), 1u) << run.err;
    EXPECT_NE(run.err.find(file), std::string::npos) << run.err;
  }
  EXPECT_EQ(tessera({"timing"}).status, 2);
}

}  // namespace
}  // namespace tessera::apps
