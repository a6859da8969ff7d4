// SPDX-License-Identifier: BSD-3-Clause
// Process state set by the caller: closed streams, limits.
#include <gtest/gtest.h>

#include <filesystem>

#include "apps/program.hpp"

namespace tessera::apps {
namespace {

/// Runs the program in a shell, which first executes `before` and then applies these redirections.
Outcome by_shell(const std::string& before, const std::vector<std::string>& arguments,
                 const std::string& redirections = "") {
  std::vector<std::string> command = {"bash", "-c", before + " exec \"$0\" \"$@\" " + redirections, TESSERA_PROGRAM};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return Running(command).wait();
}

// Without precautions, output to a closed stream would go into the first file that gets its number, for example into
// one of the program's own pipes, which would interpret letters as signals.
TEST(Environment, ClosedStreamsChangeNothing) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const auto run = [&](const std::string& input, const std::string& redirections) {
    return by_shell("", {"render", input, "-o", folder / "a.png", "--size", "16x16", "--report", folder / "r.json"},
                    redirections);
  };
  ASSERT_EQ(run(mesh, "").status, 0);
  const std::string picture = contents(folder / "a.png");
  for (const char* closed : {"<&-", ">&-", "2>&-", "<&- >&-", "<&- 2>&-", ">&- 2>&-", "<&- >&- 2>&-"}) {
    std::filesystem::remove(folder / "a.png");
    const Outcome good = run(mesh, closed);
    EXPECT_EQ(good.status, 0) << closed << good.err;
    EXPECT_EQ(contents(folder / "a.png"), picture) << closed;
    EXPECT_EQ(run(folder / "none.vtu", closed).status, 2) << closed;
    EXPECT_EQ(by_shell("", {"render", mesh, "--zoom", "0", "-o", folder / "b.png"}, closed).status, 2) << closed;
  }
}

TEST(Environment, AResultForAClosedStandardOutputFails) {
  const Folder folder;
  const Outcome run = by_shell("", {"info", folder.cube()}, ">&-");
  EXPECT_EQ(run.status, 3);
  EXPECT_EQ(run.error_lines(), 1u) << run.err;
}

TEST(Environment, ReportsAFileSizeLimit) {
  const Folder folder;
  const Outcome run = by_shell("ulimit -f 8;", {"render", folder.cube(), "-o", folder / "a.pfm", "--size", "200x200"});
  EXPECT_EQ(run.status, 3) << run.err;
  EXPECT_EQ(run.error_lines(), 1u) << run.err;
  EXPECT_NE(run.err.find("a.pfm"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "a.pfm"));
}

TEST(Environment, ReportsASmallStack) {
  const Folder folder;
  const Outcome run = by_shell("ulimit -s 256;", {"render", folder.cube(), "-o", folder / "a.png"});
  EXPECT_EQ(run.status, 3) << run.err;
  EXPECT_NE(run.err.find("ulimit -s"), std::string::npos) << run.err;
  // A limit that may be raised is raised.
  EXPECT_EQ(by_shell("ulimit -S -s 256;", {"render", folder.cube(), "-o", folder / "a.png"}).status, 0);
}

}  // namespace
}  // namespace tessera::apps
