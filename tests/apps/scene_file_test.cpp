// SPDX-License-Identifier: BSD-3-Clause
// Options in a file: --config reads what --save-config writes.

#include <gtest/gtest.h>

#include "apps/program.hpp"

namespace tessera::apps {
namespace {

TEST(SceneFile, IsReadBackUnchanged) {
  const Folder folder;
  const std::string mesh = folder.cube(), scene = folder / "scene.toml", picture = folder / "a.png";
  const Outcome first = tessera({"render",
                                 mesh,
                                 "-o",
                                 picture,
                                 "--size",
                                 "32x24",
                                 "--range",
                                 "-1,2",
                                 "--axes",
                                 "--color-bar=left",
                                 "--color-bar-title",
                                 "p = \"1, 2\"",
                                 "--annotate",
                                 "top: one, two",
                                 "--annotate",
                                 "it's {field}",
                                 "--opacity",
                                 "2",
                                 "--save-config",
                                 scene});
  ASSERT_EQ(first.status, 0) << first.err;
  const std::string bytes = contents(picture), saved = contents(scene);
  const std::string again = folder / "again.toml";
  ASSERT_EQ(tessera({"render", "--config", scene, "-o", folder / "b.png", "--save-config", again}).status, 0);
  EXPECT_EQ(contents(folder / "b.png"), bytes);
  std::string expected = saved;
  expected.replace(expected.find(picture), picture.size(), folder / "b.png");
  EXPECT_EQ(contents(again), expected);
}

TEST(SceneFile, TheCommandLineOverridesIt) {
  const Folder folder;
  const std::string scene =
      folder.file("s.toml", "input = \"" + (folder / "none.vtu") + "\"\nsize = \"8x8\"\nquiet = true\n" +
                                "output = \"" + (folder / "a.png") + "\"\n");
  const Outcome run = tessera({"render", folder.cube(), "--config", scene});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(tessera({"render", "--config", scene}).status, 2);  // none.vtu
}

TEST(SceneFile, KeepsAnyCharacter) {
  const Folder folder;
  const std::string scene = folder / "s.toml", picture = folder / "a.png";
  const std::vector<std::string> texts = {"# 1", R"(a\b "c" it's)", "two\nlines", "\xc3\xa9\t[x]", "true", ""};
  std::vector<std::string> words = {"render", folder.cube(), "-o", picture, "--size", "32x24", "--save-config", scene};
  for (const std::string& text : texts) words.insert(words.end(), {"--annotate", text});
  const Outcome first = tessera(words);
  ASSERT_EQ(first.status, 0) << first.err;
  const std::string bytes = contents(picture), saved = contents(scene);
  const Outcome second = tessera({"render", "--config", scene, "--save-config", folder / "t.toml"});
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_EQ(contents(picture), bytes);
  EXPECT_EQ(contents(folder / "t.toml"), saved);
}

TEST(SceneFile, RefusesAHostileOneInOneShortLine) {
  const Folder folder;
  const std::string mesh = folder.cube();
  std::string sections = "[a";
  for (int i = 0; i < 100'000; ++i) sections += ".a";
  const std::string key(1'000'000, 'k');
  for (const std::string& text :
       {sections + "]\n", std::string(1'000'000, '['), "iso = " + std::string(1'000'000, '['), key, key + " = 1\n",
        "size = \"" + key, "size = " + key, std::string("\xff\xfes\0=\0", 6), std::string("size\0 = 1", 9)}) {
    const std::string scene = folder.file("hostile.toml", text);
    const Outcome run = tessera({"render", mesh, "-o", folder / "a.png", "--config", scene});
    EXPECT_EQ(run.status, 2) << text.substr(0, 40);
    EXPECT_EQ(run.error_lines(), 1U) << text.substr(0, 40);
    EXPECT_TRUE(run.err.starts_with("tessera: ")) << run.err.substr(0, 200);
    EXPECT_LT(run.err.size(), 3000U) << text.substr(0, 40);
  }
}

}  // namespace
}  // namespace tessera::apps
