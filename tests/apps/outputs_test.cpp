// SPDX-License-Identifier: BSD-3-Clause
// Destinations of images and reports: films through a fake ffmpeg, standard streams.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"

namespace tessera::apps {
namespace {

namespace fs = std::filesystem;

/// Makes a fake ffmpeg the only one on PATH (with the commands that a shell script needs) during its lifetime.
class FakeProgram {
 public:
  explicit FakeProgram(const Folder& folder, const std::string& script) : path_(std::getenv("PATH")) {
    fs::create_directory(folder / "bin");
    const std::string program = folder.file("bin/ffmpeg", "#!/bin/sh\n" + script);
    fs::permissions(program, fs::perms::owner_all);
    ::setenv("PATH", (folder / "bin:/usr/bin:/bin").c_str(), 1);
  }
  ~FakeProgram() { ::setenv("PATH", path_.c_str(), 1); }
  FakeProgram(const FakeProgram&) = delete;
  FakeProgram& operator=(const FakeProgram&) = delete;

 private:
  std::string path_;
};

// Stores the images as they arrive; the file is the last argument.
const char* const keeps = "for last; do :; done\nexec cat > \"$last\"\n";

TEST(Outputs, AFilmIsAllFramesInOneFile) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const FakeProgram ffmpeg(folder, keeps);
  const Outcome run = tessera({"render", mesh, "-o", folder / "a.mp4", "--orbit", "3", "--size", "20x10", "--quiet"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(fs::file_size(folder / "a.mp4"), 3u * 20 * 10 * 3);
}

TEST(Outputs, AFilmAloneIsAnnotated) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const FakeProgram ffmpeg(folder, keeps);
  const auto film = [&](const std::vector<std::string>& more) {
    const Outcome run =
        tessera(joined({"render", mesh, "-o", folder / "a.mp4", "--orbit", "2", "--size", "200x150"}, more));
    EXPECT_EQ(run.status, 0) << run.err;
    return contents(folder / "a.mp4");
  };
  const std::string bare = film({});
  for (const char* option : {"--color-bar", "--axes", "--outline", "--scale-bar", "--annotate=top:text"})
    EXPECT_NE(film({option}), bare) << option;
}

TEST(Outputs, AFailedFilmLeavesNothingAndReportsTheReason) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const FakeProgram ffmpeg(folder, "head -c 100 > /dev/null\necho 'no such encoder' >&2\nexit 1\n");
  const Outcome run = tessera({"render", mesh, "-o", folder / "a.mp4", "--orbit", "9", "--size", "200x100", "--quiet"});
  EXPECT_EQ(run.status, 3);
  EXPECT_EQ(run.error_lines(), 1u);
  EXPECT_NE(run.err.find("no such encoder"), std::string::npos) << run.err;
  for (const std::string& name : folder.names()) EXPECT_TRUE(name == "bin" || name.ends_with(".vtu")) << name;
}

/// The first frame of a film as 24-bit RGB, decoded as BT.709, and the number of frames.
struct Decoded {
  std::string rgb;
  std::size_t pictures = 0;
};
Decoded decoded(const std::string& film, std::size_t bytes_each, bool is_video) {
  const std::string filter = is_video ? "scale=in_color_matrix=bt709:in_range=tv" : "null";
  const Outcome all = Running({"ffmpeg", "-v", "error", "-nostdin", "-i", film, "-vf", filter, "-f", "rawvideo",
                               "-pix_fmt", "rgb24", "-"})
                          .wait();
  EXPECT_EQ(all.status, 0) << all.err;
  return {all.out.substr(0, bytes_each), all.out.size() / bytes_each};
}

// The background has a colour for which the two matrices of encoders differ by up to 30 of 255. Chroma in half
// resolution, 8 bits and compression change a uniform background by at most 6.
TEST(Outputs, FilmsOfARealFfmpegHaveAllPicturesInTheirColours) {
  if (!Running({"sh", "-c", "command -v ffmpeg"}).wait().out.ends_with("ffmpeg\n"))
    GTEST_SKIP() << "ffmpeg is not installed";
  const Folder folder;
  const std::string mesh = folder.cube();
  constexpr std::size_t width = 64, height = 48, bytes = 3 * width * height;
  for (const std::string name : {"a.mp4", "a.mov", "a.mkv", "a.webm", "a.gif"}) {
    const Outcome run = tessera({"render", mesh, "-o", folder / name, "--orbit", "3", "--size", "64x48", "--zoom",
                                 "0.2", "--background", "#1e9628", "--quiet"});
    ASSERT_EQ(run.status, 0) << run.err;
    const Decoded film = decoded(folder / name, bytes, name != "a.gif");
    EXPECT_EQ(film.pictures, 3u) << name;
    ASSERT_EQ(film.rgb.size(), bytes) << name;
    const std::array<int, 3> ground = {0x1e, 0x96, 0x28};
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(static_cast<unsigned char>(film.rgb[3 * (width * 2 + 2) + c]), ground[c], 6) << name;
  }
  // Odd sides are extended by a line of the background.
  const Outcome odd = tessera({"render", mesh, "-o", folder / "odd.mp4", "--size", "63x47", "--quiet"});
  EXPECT_EQ(odd.status, 0) << odd.err;
  EXPECT_EQ(decoded(folder / "odd.mp4", bytes, true).pictures, 1u);
}

TEST(Outputs, AnImageOnStandardOutputEqualsTheFile) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const Outcome piped =
      tessera({"render", mesh, "-o", "-", "-o", folder / "a.png", "--size", "50x40", "--repeat", "2"});
  ASSERT_EQ(piped.status, 0) << piped.err;
  EXPECT_EQ(piped.out, contents(folder / "a.png"));
  EXPECT_NE(piped.err.find("frame_ms median"), std::string::npos);
}

TEST(Outputs, AReportOnStandardOutputIsTheOnlyOutput) {
  const Folder folder;
  const Outcome run = tessera({"render", folder.cube(), "-o", folder / "a.png", "--size", "50x40", "--repeat", "2",
                               "--verify", "10", "--report", "-"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out).at("frames").size(), 1u);
}

}  // namespace
}  // namespace tessera::apps
