// SPDX-License-Identifier: BSD-3-Clause
// Layers of images on the command line.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/program.hpp"
#include "io/image/image_file.hpp"

namespace tessera::apps {
namespace {

using Words = std::vector<std::string>;

std::string volume(const Folder& folder) {
  EXPECT_EQ(tessera({"generate", "ripples", folder / "v.vti", "n=16", "--quiet"}).status, 0);
  return folder / "v.vti";
}

bool has(const Folder& folder, const std::string& name) {
  const auto names = folder.names();
  return std::ranges::find(names, name) != names.end();
}

TEST(Peeling, WritesThePictureAndItsLayers) {
  const Folder folder;
  for (const std::string& input : {folder.cube(), volume(folder)}) {
    const Outcome run =
        tessera({"render", input, "-o", folder / "a.exr", "-o", folder / "a.png", "-o", folder / "a.deep.exr", "--size",
                 "40x30", "--opacity", "5", "--peel", "0.6:3", "--verify", "500", "--report", folder / "r.json"});
    ASSERT_EQ(run.status, 0) << run.out << run.err;
    EXPECT_NE(run.out.find("3 layers: max"), std::string::npos) << run.out;
    const scene::Image whole = io::read_image(folder / "a.exr");
    std::vector<scene::Image> layers;
    for (const char* name : {"a.layer1.exr", "a.layer2.exr", "a.layer3.exr"})
      layers.push_back(io::read_image(folder / name));
    for (std::size_t p = 0; p < whole.depth.size(); ++p) {
      double red = 0, through = 1;
      for (const scene::Image& layer : layers) {
        red += through * layer.rgba[4 * p];
        through *= 1 - layer.rgba[4 * p + 3];
      }
      ASSERT_NEAR(red, whole.rgba[4 * p], 1e-4);
      ASSERT_NEAR(1 - through, whole.rgba[4 * p + 3], 1e-4);
    }
    EXPECT_TRUE(has(folder, "a.layer3.png"));
    EXPECT_FALSE(has(folder, "a.layer4.png"));
    EXPECT_FALSE(has(folder, "a.deep.layer1.exr"));
    EXPECT_NE(contents(folder / "a.deep.exr").find("deepscanline"), std::string::npos);
    const auto report = nlohmann::json::parse(contents(folder / "r.json"));
    EXPECT_EQ(report["method"]["peel"]["threshold"], 0.6);
    EXPECT_EQ(report["method"]["peel"]["layers"], 3);
    EXPECT_EQ(report["frames"][0]["verify"]["layers"]["layers"].size(), 3u);
    EXPECT_EQ(report["frames"][0]["outputs"].size(), 9u);
  }
}

TEST(Peeling, LayersOfAFilmHaveItsNumbersAndNoBackground) {
  const Folder folder;
  const Words film = {"render",
                      folder.cube(),
                      "-o",
                      folder / "f_%03d.exr",
                      "--size",
                      "20x20",
                      "--orbit",
                      "2",
                      "--peel",
                      "0.9",
                      "--background",
                      "white",
                      "--quiet",
                      "--annotate",
                      "text",
                      "--annotation-layer",
                      folder / "t_%03d.png"};
  ASSERT_EQ(tessera(film).status, 0);
  for (const char* name : {"f_000.exr", "f_001.exr", "f_000.layer1.exr", "f_001.layer4.exr", "t_001.png"})
    EXPECT_TRUE(has(folder, name)) << name;
  EXPECT_EQ(io::read_image(folder / "f_001.exr").rgba[3], 1);
  EXPECT_EQ(io::read_image(folder / "f_001.layer1.exr").rgba[3], 0);
  // On resume, a frame with missing layers is rendered again.
  std::filesystem::remove(folder / "f_001.layer4.exr");
  ASSERT_EQ(tessera(joined(film, {"--resume"})).status, 0);
  EXPECT_TRUE(has(folder, "f_001.layer4.exr"));
}

TEST(Peeling, WritesEmptyLayers) {
  const Folder folder;
  const Outcome run = tessera({"render", folder.cube(), "-o", folder / "a.exr", "--size", "20x20", "--opacity", "0.01",
                               "--peel", "0.9:2", "--quiet"});
  ASSERT_EQ(run.status, 0) << run.err;
  const scene::Image second = io::read_image(folder / "a.layer2.exr");
  EXPECT_TRUE(std::ranges::all_of(second.rgba, [](float v) { return v == 0; }));
  EXPECT_TRUE(std::ranges::all_of(second.depth, [](float z) { return std::isinf(z); }));
}

TEST(Peeling, RefusesOtherThresholdsAndLayers) {
  const Folder folder;
  const std::string mesh = folder.cube();
  for (const std::string bad : {"0", "1", "nan", "-0.5", "x", ":4", "0.5x", "1.5:2", "0.5:0", "0.5:65",
                                "0.5:", "0.5:1.5", "0.5:many", "0.5:nan"}) {
    const Outcome run = tessera({"render", mesh, "-o", folder / "a.png", "--quiet", "--peel=" + bad});
    EXPECT_EQ(run.status, 2) << bad << run.err;
    EXPECT_NE(run.err.find("--peel: '" + bad), std::string::npos) << run.err;
  }
  EXPECT_FALSE(has(folder, "a.png"));
}

TEST(Peeling, RanksWriteTheBytesOfOneProcess) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  const Folder folder;
  const auto expect_refused = [](const Words& words) {
    const Outcome refused = mpirun(2, words);
    EXPECT_EQ(refused.status, 2) << refused.err;
    // mpirun prints lines of its own.
    const std::size_t first = refused.err.find("tessera: ");
    ASSERT_NE(first, std::string::npos) << refused.err;
    EXPECT_EQ(refused.err.find("tessera: ", first + 1), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("--peel"), std::string::npos) << refused.err;
  };
  for (const std::string& input : {folder.cube(), volume(folder)}) {
    const Words words = {"render", input, "--size", "33x25", "--opacity", "5", "--quiet"};
    const auto outputs = [&](const std::string& name) -> Words {
      return {"-o", folder / (name + ".exr"), "-o", folder / (name + ".deep.exr"), "--peel", "0.6:3"};
    };
    ASSERT_EQ(tessera(joined(words, outputs("one"))).status, 0);
    const Outcome run = mpirun(2, joined(words, outputs("two")));
    ASSERT_EQ(run.status, 0) << run.err;
    for (const char* name : {".layer1.exr", ".layer3.exr", ".deep.exr"})
      EXPECT_EQ(contents(folder / (std::string("two") + name)), contents(folder / (std::string("one") + name))) << name;
    expect_refused(joined(words, {"-o", folder / "bad.exr", "--peel", "2"}));
  }
  const Words words = {"render", folder.cube(),      "--size", "16x16", "--quiet",
                       "-o",     folder / "bad.exr", "--peel", "0.5"};
  expect_refused(joined(words, {"--rasterizer", "scanline"}));
  expect_refused(joined(words, {"--exchange", "runs"}));
  EXPECT_FALSE(has(folder, "bad.exr"));
}

}  // namespace
}  // namespace tessera::apps
