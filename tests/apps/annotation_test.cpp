// SPDX-License-Identifier: BSD-3-Clause
// `tessera render` with --color-bar, --axes, --outline, --scale-bar, --annotate and --annotation-layer.

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "tessera/image_file.hpp"

namespace tessera::apps {
namespace {

using Words = std::vector<std::string>;

const Words all{"--color-bar", "--axes=both", "--outline", "--scale-bar", "--annotate", "top:{field} {min} {max}"};

TEST(Annotations, TheLayerOverTheBarePictureIsTheAnnotatedOne) {
  const Folder folder;
  const Words render{"render", folder.cube(), "--size", "200x150", "--quiet"};
  ASSERT_EQ(tessera(joined(render, {"-o", folder / "bare.exr"})).status, 0);
  ASSERT_EQ(tessera(joined(joined(render, all), {"-o", folder / "annotated.exr"})).status, 0);
  const auto run =
      tessera(joined(joined(render, all), {"-o", folder / "kept.exr", "--annotation-layer", folder / "layer.exr"}));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_TRUE(contents(folder / "bare.exr") == contents(folder / "kept.exr"));
  const Image bare = read_image(folder / "bare.exr"), layer = read_image(folder / "layer.exr"),
              annotated = read_image(folder / "annotated.exr");
  std::size_t touched = 0;
  for (std::size_t i = 0; i < bare.rgba.size(); ++i) {
    const float alpha = layer.rgba[i / 4 * 4 + 3];
    if (alpha > 0) ++touched;
    ASSERT_NEAR(annotated.rgba[i], layer.rgba[i] + (1 - alpha) * bare.rgba[i], 2e-7);  // floats, perhaps fused
  }
  EXPECT_GT(touched, bare.rgba.size() / 50);
  EXPECT_EQ(annotated.depth, bare.depth);
}

TEST(Annotations, HaveTheSameBytesForAnyThreadsAndRanks) {
  const Folder folder;
  const auto mesh = folder.cube();
  const auto words = [&](const std::string& name, const std::string& threads) {
    return joined(joined({"render", mesh, "--size", "120x90", "--threads", threads}, all),
                  {"-o", folder / (name + ".exr"), "-o", folder / (name + ".png")});
  };
  ASSERT_EQ(tessera(words("one", "1")).status, 0);
  ASSERT_EQ(tessera(words("two", "2")).status, 0);
  EXPECT_TRUE(contents(folder / "one.exr") == contents(folder / "two.exr"));
  EXPECT_TRUE(contents(folder / "one.png") == contents(folder / "two.png"));
  if (!has_mpirun()) GTEST_SKIP() << "no mpirun";
  const auto run = mpirun(3, joined(words("ranks", "1"), {"--exchange", "segments"}));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contents(folder / "one.exr") == contents(folder / "ranks.exr"));
  EXPECT_TRUE(contents(folder / "one.png") == contents(folder / "ranks.png"));
}

TEST(Annotations, EachFrameOfAFilmHasItsOwn) {
  const Folder folder;
  const auto run = tessera({"render", folder.cube(), "--size", "80x60", "--orbit", "3", "-o", folder / "f%d.png",
                            "--annotate", "frame {frame}", "--annotation-layer", folder / "l%d.png"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(folder.names(), (Words{"cube.vtu", "f0.png", "f1.png", "f2.png", "l0.png", "l1.png", "l2.png"}));
  EXPECT_FALSE(contents(folder / "l0.png") == contents(folder / "l1.png"));
  // One layer for several frames is refused before anything is read.
  const auto one = tessera({"render", folder.cube(), "--size", "80x60", "--orbit", "3", "-o", folder / "f%d.png",
                            "--annotate", "frame", "--annotation-layer", folder / "l.png"});
  EXPECT_EQ(one.status, 2);
  EXPECT_EQ(one.error_lines(), 1u) << one.err;
}

TEST(Annotations, ThePictureIsVerifiedWithoutThem) {
  const Folder folder;
  const auto run = tessera(joined(
      {"render", folder.cube(), "--size", "60x60", "-o", folder / "a.png", "--verify", "500", "--integrator", "exact"},
      all));
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("bound 2e-05 met"), std::string::npos) << run.out;
}

TEST(Annotations, AreDrawnOnVolumesToo) {
  const Folder folder;
  const auto volume = folder / "a.nrrd";
  ASSERT_EQ(tessera({"generate", "ripples", volume, "n=16", "--quiet"}).status, 0);
  const auto run = tessera(joined({"render", volume, "--size", "160x120", "-o", folder / "a.exr", "--annotation-layer",
                                   folder / "layer.png", "--quiet"},
                                  all));
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_GT(contents(folder / "layer.png").size(), 500u);
}

TEST(Annotations, AreOnStandardOutputAsInAFile) {
  const Folder folder;
  const std::string mesh = folder.cube();
  ASSERT_EQ(tessera({"render", mesh, "--size", "200x150", "-o", folder / "a.png", "--color-bar"}).status, 0);
  ASSERT_EQ(tessera({"render", mesh, "--size", "200x150", "-o", folder / "bare.png"}).status, 0);
  const Outcome run = tessera({"render", mesh, "--size", "200x150", "-o", "-", "--color-bar"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, contents(folder / "a.png"));
  EXPECT_NE(run.out, contents(folder / "bare.png"));
}

TEST(Annotations, TheBarOfALogarithmIsLogarithmic) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const auto bytes = [&](const std::vector<std::string>& words) {
    const Outcome run = tessera(joined(
        {"render", mesh, "--size", "300x200", "-o", folder / "a.png", "--range", "0.01,1", "--log", "--color-bar"},
        words));
    EXPECT_EQ(run.status, 0) << run.err;
    return contents(folder / "a.png");
  };
  const std::string by_default = bytes({});
  EXPECT_EQ(by_default, bytes({"--color-bar-scale", "log"}));
  EXPECT_NE(by_default, bytes({"--color-bar-scale", "linear"}));
  // If a range has no logarithm because it begins at 0, the scale is linear.
  EXPECT_EQ(bytes({"--color-bar-range", "0,1"}), bytes({"--color-bar-range", "0,1", "--color-bar-scale", "linear"}));
}

TEST(Annotations, TheReportListsWhatWasGiven) {
  const Folder folder;
  const auto run =
      tessera({"render", folder.cube(), "--size", "60x60", "-o", folder / "a.png", "--report", folder / "r.json",
               "--color-bar=left", "--color-bar-title", "p", "--annotate", "a", "--annotate", "bottom:b"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto report = nlohmann::json::parse(contents(folder / "r.json"));
  EXPECT_EQ(report.at("method").at("annotation"),
            (nlohmann::json{{"color-bar", "left"}, {"color-bar-title", "p"}, {"annotate", {"a", "bottom:b"}}}));
  ASSERT_EQ(
      tessera({"render", folder.cube(), "--size", "8x8", "-o", folder / "b.png", "--report", folder / "s.json"}).status,
      0);
  EXPECT_FALSE(nlohmann::json::parse(contents(folder / "s.json")).at("method").contains("annotation"));
}

TEST(Annotations, ReportsAMachineWithoutFonts) {
  const Folder folder;
  const std::string none = folder.file("fonts.conf", "<?xml version=\"1.0\"?><fontconfig></fontconfig>");
  ASSERT_EQ(setenv("FONTCONFIG_FILE", none.c_str(), 1), 0);
  const auto run = tessera({"render", folder.cube(), "--size", "20x20", "-o", folder / "a.png", "--scale-bar"});
  unsetenv("FONTCONFIG_FILE");
  EXPECT_EQ(run.status, 3);
  EXPECT_EQ(run.error_lines(), 1u) << run.err;
  EXPECT_NE(run.err.find("no font was found; install one"), std::string::npos) << run.err;
  EXPECT_EQ(folder.names(), (Words{"cube.vtu", "fonts.conf"}));
}

}  // namespace
}  // namespace tessera::apps
