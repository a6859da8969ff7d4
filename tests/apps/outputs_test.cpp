// Where pictures and reports go: films through a stand-in for ffmpeg, standard streams.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace tessera::apps {
namespace {

namespace fs = std::filesystem;

/// Puts a program named ffmpeg alone on PATH (with what a shell script needs), for as long as it lives.
class StandIn {
 public:
  explicit StandIn(const Folder& folder, const std::string& script) : path_(std::getenv("PATH")) {
    fs::create_directory(folder / "bin");
    const std::string program = folder.file("bin/ffmpeg", "#!/bin/sh\n" + script);
    fs::permissions(program, fs::perms::owner_all);
    ::setenv("PATH", (folder / "bin:/usr/bin:/bin").c_str(), 1);
  }
  ~StandIn() { ::setenv("PATH", path_.c_str(), 1); }
  StandIn(const StandIn&) = delete;
  StandIn& operator=(const StandIn&) = delete;

 private:
  std::string path_;
};

// Keeps the pictures as they come; the file is the last word.
const char* const keeps = "for last; do :; done\nexec cat > \"$last\"\n";

TEST(Outputs, AFilmIsAllFramesInOneFile) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const StandIn ffmpeg(folder, keeps);
  const Outcome run = tessera({"render", mesh, "-o", folder / "a.mp4", "--orbit", "3", "--size", "20x10", "--quiet"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(fs::file_size(folder / "a.mp4"), 3u * 20 * 10 * 3);
}

TEST(Outputs, AFilmThatFailsLeavesNothingAndSaysWhy) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const StandIn ffmpeg(folder, "head -c 100 > /dev/null\necho 'no such encoder' >&2\nexit 1\n");
  const Outcome run = tessera({"render", mesh, "-o", folder / "a.mp4", "--orbit", "9", "--size", "200x100", "--quiet"});
  EXPECT_EQ(run.status, 3);
  EXPECT_EQ(run.error_lines(), 1u);
  EXPECT_NE(run.err.find("no such encoder"), std::string::npos) << run.err;
  for (const std::string& name : folder.names()) EXPECT_TRUE(name == "bin" || name.ends_with(".vtu")) << name;
}

TEST(Outputs, WithoutFfmpegAFilmIsRefusedBeforeAnythingIsRead) {
  const Folder folder;
  const std::string mesh = folder.cube(), path = std::getenv("PATH");
  ::setenv("PATH", "/nowhere", 1);
  const Outcome run = tessera({"render", mesh, "-o", folder / "a.mp4", "--orbit", "3"});
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(run.error_lines(), 1u);
  for (const char* words : {"ffmpeg", "apt install", "_%04d.png"})
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
}

TEST(Outputs, APictureOnStandardOutputIsTheFile) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const Outcome piped =
      tessera({"render", mesh, "-o", "-", "-o", folder / "a.png", "--size", "50x40", "--repeat", "2"});
  ASSERT_EQ(piped.status, 0) << piped.err;
  EXPECT_EQ(piped.out, contents(folder / "a.png"));
  EXPECT_NE(piped.err.find("frame_ms median"), std::string::npos);
}

TEST(Outputs, AReportOnStandardOutputIsAllThatIsThere) {
  const Folder folder;
  const Outcome run = tessera({"render", folder.cube(), "-o", folder / "a.png", "--size", "50x40", "--repeat", "2",
                               "--verify", "10", "--report", "-"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out).at("frames").size(), 1u);
}

TEST(Outputs, WhatCannotGoTogetherIsRefused) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const std::vector<std::vector<std::string>> wrong = {{"-o", "-", "--report", "-"},
                                                       {"-o", "-", "--resume"},
                                                       {"-o", folder / "a.png", "--frame-rate", "25"},
                                                       {"-o", "-", "-o", "-"}};
  for (const auto& words : wrong) {
    std::vector<std::string> all = {"render", mesh};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome run = tessera(all);
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_EQ(run.error_lines(), 1u) << run.err;
    EXPECT_TRUE(run.out.empty());
  }
}

TEST(Outputs, AnEmptyStandardInputIsSaid) {
  const Folder folder;
  const Outcome run = tessera({"render", "-", "-o", folder / "a.png"});
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("standard input: it is empty"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace tessera::apps
