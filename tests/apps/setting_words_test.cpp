// SPDX-License-Identifier: BSD-3-Clause
// The program prints settings in the library's messages as options, and leaves all other text in backquotes unchanged.

#include <gtest/gtest.h>

#include "apps/program.hpp"
#include "tessera/program/options.hpp"

namespace tessera::apps {
namespace {

TEST(SettingWords, KnownNamesBecomeOptions) {
  EXPECT_EQ(with_options("`deep_accuracy` 0.5: it must be 1e-6 to 1"), "--deep-accuracy 0.5: it must be 1e-6 to 1");
  EXPECT_EQ(with_options("raise `memory`"), "raise --memory");
  EXPECT_EQ(with_options("`exchange` runs: `rasterizer` scanline; use `exchange` segments"),
            "--exchange runs: --rasterizer scanline; use --exchange segments");
  EXPECT_EQ(with_options("`integrator`: of `dims`, `type` (`max_volume` sets it; or `q`)"),
            "--integrator: of --dims, --type (--max-volume sets it; or --q)");
  EXPECT_EQ(with_options("waiting (`on_stall` abort ends the run)"), "waiting (--on-stall abort ends the run)");
}

TEST(SettingWords, OtherTextIsUnchanged) {
  for (const char* text :
       {"", "`", "``", "a ` b", "no setting", "`memory", "memory`", "`no_setting`", "`deep-accuracy`", "--memory",
        "has a broken header; it is `PF`, width and height", "each line is `value r g b extinction`",
        // File names, and quoted words.
        "`memory`.vtu: is empty", "data/`memory`/a.vtu: is empty", "a`memory`: is empty", "no field '`memory`'"})
    EXPECT_EQ(with_options(text), text);
  EXPECT_EQ(with_options("it`s `memory` `` `size`"), "it`s --memory `` --size");
}

/// The line that `tessera` prints on stderr, without the line end.
std::string error_line(const std::vector<std::string>& arguments) {
  std::string words = tessera(arguments).err;
  if (words.ends_with('\n')) words.pop_back();
  return words;
}

TEST(SettingWords, RunLineReportAndNotesNameOptions) {
  const Folder folder;
  const auto mesh = folder.cube(), report = folder / "r.json";
  const auto line_of = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", mesh, "-o", folder / "a.png", "--size", "8x8", "--report", report});
    return error_line(more);
  };
  const auto holds = [](const std::string& text, const std::string& words) {
    EXPECT_NE(text.find(words), std::string::npos) << words << " in " << text;
  };
  holds(line_of({"--unit-distance", "2"}), ", unit distance 2 (--unit-distance)\n");
  holds(contents(report), "\"source\": \"--unit-distance\"");
  const auto plain = folder.file("t.txt", "0 1 1 1 2\n");
  const std::string assumed = "t.txt (extinctions as given; --unit-distance does not apply)";
  holds(line_of({"--transfer-function", plain, "--unit-distance", "2"}), assumed);
  holds(contents(report), assumed);
  const auto map = folder.file("m.json", R"([{"RGBPoints": [200, 0, 0, 0, 400, 1, 1, 1], "Name": "m"}])");
  holds(line_of({"--transfer-function", map}), "range, 200 to 400: --rescale stretches the transfer function)");

  const std::vector<std::string> raw = {"--dims", "2x2x2", "--type", "uint8"};
  std::vector<std::string> volume = {"render", folder.file("v.raw", std::string(8, '\1')), "-o", folder / "v.png"};
  volume.insert(volume.end(), raw.begin(), raw.end());
  volume.insert(volume.end(), {"--size", "8x8", "--unit-distance", "3"});
  holds(error_line(volume), ", unit distance 3 (--unit-distance)\n");
}

}  // namespace
}  // namespace tessera::apps
