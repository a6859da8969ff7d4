// SPDX-License-Identifier: BSD-3-Clause
// `--clip` and `--threshold` on the command line.

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "io/image/image_file.hpp"

namespace tessera::apps {
namespace {

using Names = std::vector<std::string>;

class ClipCommand : public ::testing::Test {
 protected:
  Outcome render(const Names& more) const {
    Names all = {"render", mesh, "-o", folder / "a.pfm", "--size", "40x30"};
    all.insert(all.end(), more.begin(), more.end());
    return tessera(all);
  }

  Folder folder;
  std::string mesh = folder.cube();  // [-1, 1]^3
};

TEST_F(ClipCommand, CountsAndVerifiesAgainstTheWholeMesh) {
  const Outcome outcome = render({"--clip", "-0.3,0,0,1,0.2,0", "--clip", "box:-2,-2,-2,2,0.5,0.4", "--integrator",
                                  "exact", "--verify", "1200", "--report", folder / "r.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err << outcome.out;
  EXPECT_NE(outcome.err.find(" clipped away, "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("1200 pixels"), std::string::npos) << outcome.out;
  const auto selection = nlohmann::json::parse(contents(folder / "r.json")).at("mesh").at("selection");
  EXPECT_GT(selection.at("cells_clipped"), 0);
  EXPECT_GT(selection.at("cells_cut"), 0);
  EXPECT_EQ(selection.at("cells_out_of_range"), 0);
}

TEST_F(ClipCommand, IsWrittenByConvert) {
  const std::string half = folder / "half.vtu";
  ASSERT_EQ(tessera({"convert", mesh, half, "--clip", "0,0,0,0,0,1", "--quiet"}).status, 0);
  const Outcome info = tessera({"info", half});
  ASSERT_EQ(info.status, 0) << info.err;
  EXPECT_NE(info.out.find("bounds    (-1 -1 0) to (1 1 1)"), std::string::npos) << info.out;
}

TEST_F(ClipCommand, ThresholdOfAVolumeLeavesOutVoxelsWithASampleOutOfIt) {
  // 2^3 voxels; the samples at their corners are all 1 except the first.
  std::string samples(27, '\1');
  samples[0] = '\5';
  const std::string volume = folder.file("v_3x3x3_uint8.raw", samples);
  const std::string function = folder.file("f.txt", "0 1 1 1 1000\n9 1 1 1 1000\n");
  const auto expect_alpha = [&](const Names& more, const std::array<float, 3>& wanted) {
    Names all{"render",   volume,           "-o",    folder / "a.exr", "--size", "40x40",  "--transfer-function",
              function,   "--view",         "front", "--verify",       "1600",   "--clip", "0,0.9,0,0,-1,0",
              "--report", folder / "r.json"};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = tessera(all);
    EXPECT_EQ(outcome.status, 0) << outcome.err << outcome.out;
    const auto image = io::read_image(folder / "a.exr");
    // The front view is along y, with z up: bottom left, bottom right, top left.
    const std::array<std::array<int, 2>, 3> places{{{15, 25}, {25, 25}, {15, 15}}};
    // The promised accuracy is 1e-4.
    for (std::size_t i = 0; i < places.size(); ++i)
      EXPECT_NEAR(image.rgba[4 * image.index(places[i][0], places[i][1]) + 3], wanted[i], 1e-4) << i;
  };
  expect_alpha({}, {1, 1, 1});
  expect_alpha({"--threshold", "0,4"}, {0, 1, 1});
  EXPECT_NE(contents(folder / "r.json").find("1 samples are blank or not in"), std::string::npos);
  const Outcome none = tessera({"render", volume, "-o", folder / "a.png", "--threshold", "6,7", "--quiet"});
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("no sample's value is in --threshold"), std::string::npos) << none.err;
}

TEST_F(ClipCommand, GivesOnePictureOnAnyNumberOfRanks) {
  if (!has_mpirun()) GTEST_SKIP() << "no mpirun";
  const std::string pieces = folder / "pieces.pvtu";
  ASSERT_EQ(tessera({"convert", mesh, pieces, "--pieces", "4", "--quiet"}).status, 0);
  const Names looks = {"--clip",
                       "0.1,0,0,-1,0.3,0.2",
                       "--threshold=-0.8,0.9",
                       "--exchange",
                       "segments",
                       "--threads",
                       "1",
                       "--transfer-function",
                       "viridis",
                       "--size",
                       "40x30",
                       "--quiet"};
  for (const std::string& input : {mesh, pieces}) {
    Names alone = {"render", input, "-o", folder / "one.pfm"}, ranks = {"render", input, "-o", folder / "three.pfm"};
    alone.insert(alone.end(), looks.begin(), looks.end());
    ranks.insert(ranks.end(), looks.begin(), looks.end());
    ranks.insert(ranks.end(), {"--verify", "100"});
    ASSERT_EQ(tessera(alone).status, 0);
    const Outcome outcome = mpirun(3, ranks);
    ASSERT_EQ(outcome.status, 0) << outcome.err << outcome.out;
    EXPECT_EQ(contents(folder / "one.pfm"), contents(folder / "three.pfm")) << input;
  }
}

}  // namespace
}  // namespace tessera::apps
