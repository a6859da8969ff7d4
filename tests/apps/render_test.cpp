// SPDX-License-Identifier: BSD-3-Clause
// `tessera render` as users run it: images, frames, reports.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "apps/program.hpp"
#include "io/image/image_file.hpp"

namespace tessera::apps {
namespace {

using Names = std::vector<std::string>;

TEST(Render, ADefaultPictureFillsTheMiddleAndLeavesTheCornersEmpty) {
  const Folder folder;
  const auto run = tessera({"render", folder.cube(), "-o", folder / "a.exr", "--size", "64x48"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto image = io::read_image(folder / "a.exr");
  ASSERT_EQ(image.size, (scene::ImageSize{64, 48}));
  const auto alpha = [&](int x, int y) { return image.rgba[4 * image.index(x, y) + 3]; };
  EXPECT_GT(alpha(32, 24), 0.1);
  EXPECT_LT(alpha(32, 24), 0.99);
  for (const int x : {0, 63})
    for (const int y : {0, 47}) EXPECT_EQ(alpha(x, y), 0);
  EXPECT_TRUE(std::isfinite(image.depth[image.index(32, 24)]));
  EXPECT_TRUE(std::isinf(image.depth[0]));
}

TEST(Render, PrintsItsChoicesInOneLineOnStderrAndNothingOnStdout) {
  const Folder folder;
  const auto run = tessera({"render", folder.cube(), "-o", folder / "a.png", "--size=16x16"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.error_lines(), 1u) << run.err;
  for (const char* word : {"384 of 384 cells", "field", "transfer function cool-warm", "unit distance", "(default)",
                           "orthographic", "16x16", "384 tets projected", "0 invisible", "auto to 0.0001"})
    EXPECT_NE(run.err.find(word), std::string::npos) << word << " in " << run.err;
  EXPECT_EQ(run.out, "");
}

TEST(Render, SaysHowMuchIsInDoublePrecision) {
  const Folder folder;
  const std::string cube = folder.cube(), picture = folder / "a.png", trace = folder / "trace.json";
  const auto said = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", cube, "-o", picture, "--size=16x16", "--timing", trace};
    words.insert(words.end(), more.begin(), more.end());
    const auto run = tessera(words);
    EXPECT_EQ(run.status, 0) << run.err;
    return std::pair(run.err, tessera({"timing", trace}).out);
  };
  const auto [line, times] = said({"--without", "lattice"});
  EXPECT_NE(line.find(", 100 % of the ray segments in double precision"), std::string::npos) << line;
  EXPECT_NE(times.find("; 100 % in double precision"), std::string::npos) << times;
  const auto [line_of_lanes, times_of_lanes] = said({});
  const bool has_lanes =
      line_of_lanes.find("AVX") != std::string::npos || line_of_lanes.find("SSE4") != std::string::npos;
  EXPECT_EQ(line_of_lanes.find("double precision") == std::string::npos, has_lanes) << line_of_lanes;
  EXPECT_NE(times_of_lanes.find(" % in double precision"), std::string::npos) << times_of_lanes;
}

TEST(Render, QuietLeavesNothingOnStderr) {
  const Folder folder;
  const auto run = tessera({"render", folder.cube(), "-o", folder / "a.png", "--size", "16x16", "--quiet"});
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.err, "");
}

TEST(Render, AcceptsJsonInsteadOfAFilesName) {
  const Folder folder;
  const std::string near = R"({"position": [4, 3, 5], "focal_point": [0.5, 0.5, 0.5], "parallel_scale": 1})",
                    far = R"({"position": [4, 3, 5], "focal_point": [0.5, 0.5, 0.5], "view_angle": 20})",
                    views = "[" + near + "," + far + "]";
  const std::string function = R"({"knots": [[0, 1, 0.5, 0, 0], [0.5, 0, 1, 0, 4], [1, 0, 0, 1, 1]]})";
  const auto render = [&](const std::string& name, const std::string& camera, const std::string& colors) {
    return tessera({"render", folder.cube(), "-o", folder / name, "--size", "40x30", "--camera", camera,
                    "--transfer-function", colors});
  };
  const auto one = render("a.png", near, function);
  ASSERT_EQ(one.status, 0) << one.err;
  EXPECT_NE(one.err.find("transfer function JSON"), std::string::npos) << one.err;
  ASSERT_EQ(render("b.png", folder.file("near.json", near), folder.file("f.json", function)).status, 0);
  EXPECT_EQ(contents(folder / "a.png"), contents(folder / "b.png"));
  ASSERT_EQ(render("v%d.png", views, function).status, 0);
  EXPECT_EQ(contents(folder / "v0.png"), contents(folder / "a.png"));
  EXPECT_NE(contents(folder / "v1.png"), contents(folder / "a.png"));

  // The texts are longer than any file name.
  EXPECT_EQ(render("c.png", near + std::string(5000, ' '), function + std::string(5000, ' ')).status, 0);
  for (const auto& [camera, colors, words] :
       {std::array<std::string, 3>{R"({"position": [1, 2]})", function, "tessera: --camera: "},
        {"[]", function, "tessera: --camera: is an empty list"},
        {near, "{", "tessera: --transfer-function: line 1, column"},
        {near, R"({"knots": 2})", "tessera: --transfer-function: knots is not a list"}}) {
    const auto wrong = render("d.png", camera, colors);
    EXPECT_EQ(wrong.status, 2);
    EXPECT_EQ(wrong.err.rfind(words, 0), 0u) << wrong.err;
    EXPECT_EQ(wrong.error_lines(), 1u) << wrong.err;
  }
}

TEST(Render, ShadesMeshesAndVerifiesThem) {
  const Folder folder;
  const auto mesh = folder.cube();
  std::string last = "";
  for (const char* light : {"0,0,1", "0.5,1,0.7", "world:0.5,1,0.7"}) {
    const auto run = tessera({"render", mesh, "-o", folder / "a.pfm", "--size", "40x30", "--integrator", "exact",
                              "--shade", "--light", light, "--verify", "1200", "--report", folder / "r.json"});
    EXPECT_EQ(run.status, 0) << light << run.err;
    EXPECT_NE(run.err.find("exact, shaded"), std::string::npos) << run.err;
    const auto report = nlohmann::json::parse(contents(folder / "r.json"));
    EXPECT_LT(report["frames"][0]["verify"]["max_error"], 2e-5) << light;
    EXPECT_EQ(report["method"]["shade"], true);
    EXPECT_NE(contents(folder / "a.pfm"), last) << light;
    last = contents(folder / "a.pfm");
  }
}

TEST(Render, WritesOneFrameInSeveralFormats) {
  const Folder folder;
  const auto mesh = folder.cube();
  const auto run = tessera({"render", "-o", folder / "a.exr", "-o", folder / "a.png", "--output=" + (folder / "a.pfm"),
                            mesh, "--size", "8x8"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(folder.names(), (Names{"a.exr", "a.pfm", "a.png", "cube.vtu"}));
}

TEST(Render, OneAndTwoThreadsAndAnyTileSizeGiveTheSameBytes) {
  const Folder folder;
  const auto mesh = folder.cube();
  const auto picture = [&](const std::string& name, const std::string& threads, const std::string& tile) {
    const auto run = tessera({"render", mesh, "-o", folder / name, "--size", "70x50", "--threads", threads,
                              "--tile-size", tile, "--projection", "perspective"});
    EXPECT_EQ(run.status, 0) << run.err;
    return contents(folder / name);
  };
  const auto one = picture("1.exr", "1", "32");
  EXPECT_GT(one.size(), 1000u);
  EXPECT_TRUE(one == picture("2.exr", "2", "32"));
  EXPECT_TRUE(one == picture("3.exr", "2", "7"));
}

TEST(Render, VerifyMeetsItsBoundAndReportsPixels) {
  const Folder folder;
  for (const char* integrator : {"exact", "auto", "sampled:4"}) {
    const auto run = tessera({"render", folder.cube(), "-o", folder / "a.pfm", "--size", "40x40", "--integrator",
                              integrator, "--verify", "200"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(std::regex_search(
        run.out, std::regex("verify frame 0: 200 pixels, max .* rms .* worst at .* excused; "
                            "(bound .* met|no bound promised); worst: [a-z]+; chosen: [0-9]+ random, ")))
        << run.out;
  }
}

TEST(Render, AnAccuracyThatCannotBeMetGivesStatusFourAndStillThePicture) {
  const Folder folder;
  // For such bright light the last place of a float exceeds the accuracy.
  const std::string bright = folder.file("bright.txt", "0 1e5 2e5 3e5 0\n1 3e5 1e5 2e5 0\n");
  const auto run = tessera({"render", folder.cube(), "-o", folder / "a.pfm", "--size", "40x40", "--transfer-function",
                            bright, "--emission", "independent", "--accuracy", "1e-6", "--verify", "400"});
  EXPECT_EQ(run.status, 4) << run.err << run.out;
  EXPECT_NE(run.out.find("NOT met"), std::string::npos) << run.out;
  EXPECT_EQ(folder.names(), (Names{"a.pfm", "bright.txt", "cube.vtu"}));
}

TEST(Render, AnAccuracyBelowThatOfPicturesIsRefused) {
  const Folder folder;
  const auto run = tessera({"render", folder.cube(), "-o", folder / "a.pfm", "--accuracy", "9e-7"});
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(run.err,
            "tessera: --accuracy 9e-07: images consist of 32-bit floats, which are accurate to 1e-06 at best; give "
            "this or more\n");
  EXPECT_EQ(folder.names(), Names{"cube.vtu"});
}

TEST(Render, RepeatPrintsMedianAndMinimum) {
  const Folder folder;
  const auto run = tessera({"render", folder.cube(), "-o", folder / "a.pfm", "--size", "20x20", "--repeat", "3"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(std::regex_match(run.out, std::regex("frame_ms median [0-9.]+ min [0-9.]+\n"))) << run.out;
}

TEST(Render, OrbitNumbersItsFramesAndTurnsTheView) {
  const Folder folder;
  const auto run = tessera({"render", folder.cube(), "-o", folder / "f_%03d.pfm", "--size", "24x24", "--orbit", "4"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(folder.names(), (Names{"cube.vtu", "f_000.pfm", "f_001.pfm", "f_002.pfm", "f_003.pfm"}));
  EXPECT_NE(contents(folder / "f_000.pfm"), contents(folder / "f_001.pfm"));
}

TEST(Render, ResumeRendersOnlyMissingFrames) {
  const Folder folder;
  const auto mesh = folder.cube();
  const Names arguments = {"render", mesh, "-o", folder / "f_%d.pfm", "--size", "24x24", "--orbit", "3", "--resume"};
  ASSERT_EQ(tessera(arguments).status, 0);
  const auto middle = contents(folder / "f_1.pfm");
  std::filesystem::remove(folder / "f_1.pfm");
  (void)folder.file("f_0.pfm", "left alone");
  EXPECT_EQ(tessera(arguments).status, 0);
  EXPECT_EQ(contents(folder / "f_0.pfm"), "left alone");
  EXPECT_EQ(contents(folder / "f_1.pfm"), middle);
  const auto again = tessera(arguments);
  EXPECT_EQ(again.status, 0);
  EXPECT_NE(again.err.find("all 3 frames exist already"), std::string::npos) << again.err;
}

TEST(Render, ATransferFunctionFileIsUsedAsItIsUnlessRescaled) {
  const Folder folder;
  const auto mesh = folder.cube();
  // Visible only far above the field's values.
  const auto map = folder.file("map.json", R"([{"ColorSpace": "RGB", "RGBPoints": [1000, 1, 0, 0, 2000, 1, 1, 1],
    "Points": [1000, 0, 0.5, 0, 2000, 0.5, 0.5, 0]}])");
  const auto largest_alpha = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {
        "render", mesh, "-o", folder / "a.exr", "--size", "16x16", "--quiet", "--transfer-function", map};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto run = tessera(arguments);
    EXPECT_EQ(run.status, 0) << run.err;
    const auto image = io::read_image(folder / "a.exr");
    float alpha = 0;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) alpha = std::max(alpha, image.rgba[i]);
    return alpha;
  };
  EXPECT_EQ(largest_alpha({}), 0);
  EXPECT_GT(largest_alpha({"--rescale"}), 0.1);
}

TEST(Render, ACameraFileIsAPathAndSizeWinsOverItsOwn) {
  const Folder folder;
  const auto mesh = folder.cube();
  const auto path = folder.file("path.json", R"([
    {"position": [0.5, 0.5, 9], "focal_point": [0.5, 0.5, 0.5], "parallel_scale": 1, "size": [12, 10]},
    {"position": [9, 0.5, 0.5], "focal_point": [0.5, 0.5, 0.5], "view_up": [0, 0, 1], "view_angle": 20}])");
  ASSERT_EQ(tessera({"render", mesh, "-o", folder / "a%d.pfm", "--camera", path}).status, 0);
  EXPECT_EQ(io::read_image(folder / "a0.pfm").size, (scene::ImageSize{12, 10}));
  EXPECT_EQ(io::read_image(folder / "a1.pfm").size, (scene::ImageSize{1024, 1024}));
  ASSERT_EQ(tessera({"render", mesh, "-o", folder / "b%d.pfm", "--camera", path, "--size", "9x8"}).status, 0);
  EXPECT_EQ(io::read_image(folder / "b0.pfm").size, (scene::ImageSize{9, 8}));
}

TEST(Render, ReportAndTimingAreJsonOfTheRun) {
  const Folder folder;
  const auto run = tessera({"render", folder.cube(), "-o", folder / "a.pfm", "--size", "30x20", "--report",
                            folder / "report.json", "--timing", folder / "trace.json", "--verify", "50"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto report = nlohmann::json::parse(contents(folder / "report.json"));
  EXPECT_EQ(report.at("mesh").at("tets"), 384);
  EXPECT_EQ(report.at("method").at("integrator"), "auto to 0.0001");
  EXPECT_GT(report.at("transfer_function").at("unit_distance").at("value"), 0);
  const auto& frame = report.at("frames").at(0);
  EXPECT_EQ(frame.at("counters").at("tets_total"), 384);
  EXPECT_GT(frame.at("counters").at("segments"), 384);
  const auto& verify = frame.at("verify");
  EXPECT_EQ(verify.at("pixels"), 50);
  int pixels = verify.at("random").at("pixels").get<int>();
  EXPECT_GE(pixels, 17);
  for (const auto& tally : verify.at("chosen")) pixels += tally.at("pixels").get<int>();
  EXPECT_EQ(pixels, 50);
  EXPECT_TRUE(verify.at("worst_chosen") == "random" ||
              verify.at("chosen").contains(verify.at("worst_chosen").get<std::string>()));
  EXPECT_EQ(frame.at("view").at("size"), (nlohmann::json{30, 20}));

  const auto trace = nlohmann::json::parse(contents(folder / "trace.json"));
  std::vector<std::string> stages;
  for (const auto& event : trace.at("traceEvents")) stages.push_back(event.at("name"));
  for (const char* stage : {"read", "write", "verify"})
    EXPECT_NE(std::find(stages.begin(), stages.end(), stage), stages.end()) << stage;
}

TEST(Render, AReportedViewIsACameraFileThatGivesTheSamePicture) {
  const Folder folder;
  const auto mesh = folder.cube();
  ASSERT_EQ(tessera({"render", mesh, "-o", folder / "a.exr", "--size", "33x21", "--projection=perspective", "--report",
                     folder / "r.json"})
                .status,
            0);
  const auto report = nlohmann::json::parse(contents(folder / "r.json"));
  const auto camera = folder.file("camera.json", report.at("frames").at(0).at("view").dump());
  const auto run = tessera({"render", mesh, "-o", folder / "b.exr", "--camera", camera});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contents(folder / "a.exr") == contents(folder / "b.exr"));
}

TEST(Render, WritesADeepImageInAdditionToAFlatOne) {
  const Folder folder;
  const auto mesh = folder.cube();
  ASSERT_EQ(tessera({"render", mesh, "-o", folder / "alone.exr", "--size", "30x20"}).status, 0);
  const auto run = tessera({"render", mesh, "-o", folder / "a.deep.exr", "-o", folder / "a.exr", "--size", "30x20",
                            "--deep-accuracy", "1e-2", "--report", folder / "r.json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const scene::Image beside = io::read_image(folder / "a.exr"), alone = io::read_image(folder / "alone.exr");
  EXPECT_EQ(beside.rgba, alone.rgba);
  EXPECT_NE(contents(folder / "a.deep.exr").find("deepscanline"), std::string::npos);
  const auto report = nlohmann::json::parse(contents(folder / "r.json"));
  EXPECT_EQ(report.at("method").at("deep_accuracy"), 0.01);
  EXPECT_GT(report.at("frames").at(0).at("counters").at("deep_samples"), 100);
}

TEST(Render, ProgressIsATemporaryLine) {
  const Folder folder;
  const auto run =
      tessera({"render", folder.cube(), "-o", folder / "%d.pfm", "--size", "8x8", "--orbit", "2", "--progress"});
  EXPECT_EQ(run.status, 0);
  EXPECT_NE(run.err.find("frame 2 of 2"), std::string::npos);
  EXPECT_EQ(run.error_lines(), 3u);  // one for the run, and one for each frame
  EXPECT_TRUE(run.err.ends_with("\x1b[K"));
}

/// Counters show for each optimization that it was disabled, and the image stays within the accuracy.
TEST(Render, WithoutAnyOfItsMechanismsThePictureIsTheSame) {
  const Folder folder;
  const std::string mesh = folder.cube();
  const std::string function = folder.file("peaks.txt", "0 .1 .2 .9 0\n.4 .1 .2 .9 0\n.5 .9 .6 .1 40\n1 1 .2 .1 90\n");
  const auto render = [&](const std::string& without) {
    std::vector<std::string> words = {"render",
                                      mesh,
                                      "-o",
                                      folder / "a.pfm",
                                      "--transfer-function",
                                      function,
                                      "--report",
                                      folder / "r.json",
                                      "--size",
                                      "64x64",
                                      "--verify",
                                      "4096"};
    if (!without.empty()) words.insert(words.end(), {"--without", without});
    const auto run = tessera(words);
    EXPECT_EQ(run.status, 0) << without << run.out << run.err;
    return nlohmann::json::parse(contents(folder / "r.json"));
  };
  const auto all = render("");
  const auto counter = [](const nlohmann::json& report, const char* name) {
    return report["frames"][0]["counters"][name].get<std::uint64_t>();
  };
  EXPECT_FALSE(all["method"].contains("without"));
  EXPECT_GT(counter(all, "tets_invisible"), 0u);
  EXPECT_EQ(all["frames"][0]["arithmetic"], "lattice");

  const auto culling = render("culling");
  EXPECT_EQ(counter(culling, "tets_invisible"), 0u);
  EXPECT_EQ(culling["method"]["without"], "culling");
  const auto lattice = render("lattice");
  EXPECT_EQ(lattice["frames"][0]["arithmetic"], "double");
  const auto termination = render("termination");
  // The number of segments that termination saves differs between builds, so termination is disabled in both runs.
  EXPECT_GT(counter(render("culling,termination"), "segments"), counter(termination, "segments"));
  EXPECT_LE(termination["frames"][0]["verify"]["max_error"], all["frames"][0]["verify"]["max_error"]);
  render("culling,skipping,termination,lattice,sharing,merging");

  for (const char* words : {"foo", "culling,", ",culling", "culling,,lattice"}) {
    const auto run = tessera({"render", mesh, "-o", folder / "a.pfm", "--without", words});
    EXPECT_EQ(run.status, 2) << words;
    EXPECT_EQ(run.error_lines(), 1u) << run.err;
  }
  EXPECT_EQ(tessera({"render", mesh, "-o", folder / "a.pfm", "--exchange", "runs", "--without", "merging"}).status, 2);
}

}  // namespace
}  // namespace tessera::apps
