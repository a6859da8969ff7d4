// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"

namespace tessera::apps {
namespace {

/// A small generated volume.
std::string ripples(const Folder& folder, const std::string& name, const std::string& bits = "32") {
  const Outcome made = tessera({"generate", "ripples", folder / name, "n=20", "bits=" + bits, "--quiet"});
  EXPECT_EQ(made.status, 0) << made.err;
  return folder / name;
}

TEST(VolumeCommands, AVolumeRendersWithinTheVerifiedPromise) {
  const Folder folder;
  for (const char* bits : {"8", "16", "32"})
    for (const char* projection : {"orthographic", "perspective"}) {
      const Outcome run =
          tessera({"render", ripples(folder, "a.vti", bits), "-o", folder / "a.png", "--size", "60x50", "--projection",
                   projection, "--accuracy", "1e-5", "--verify", "3000", "--report", folder / "r.json"});
      EXPECT_EQ(run.status, 0) << run.out << run.err;
      EXPECT_EQ(run.error_lines(), 1u) << run.err;
      const auto report = nlohmann::json::parse(contents(folder / "r.json"));
      EXPECT_EQ(report["volume"]["points"], (std::vector<int>{20, 20, 20}));
      EXPECT_LT(report["frames"][0]["verify"]["max_error"], 1e-5);
      EXPECT_GT(report["frames"][0]["counters"]["voxels_visited"], 0);
      EXPECT_TRUE(report["transfer_function"].contains("unit_distance"));
    }
}

TEST(VolumeCommands, AShadedPictureIsVerifiedToo) {
  const Folder folder;
  const std::string volume = ripples(folder, "a.vti");
  std::string pictures;
  for (const char* light : {"0,0,1", "0.5,1,0.7", "world:0.5,1,0.7"}) {
    const Outcome run = tessera({"render", volume, "-o", folder / "a.pfm", "--size", "60x50", "--shade", "--light",
                                 light, "--verify", "3000", "--report", folder / "r.json"});
    EXPECT_EQ(run.status, 0) << light << run.out << run.err;
    const auto report = nlohmann::json::parse(contents(folder / "r.json"));
    EXPECT_LT(report["frames"][0]["verify"]["max_error"], 1e-4) << light;
    EXPECT_EQ(report["method"]["light"]["frame"], std::string(light).starts_with("world") ? "world" : "camera");
    EXPECT_NE(contents(folder / "a.pfm"), pictures) << light;
    pictures = contents(folder / "a.pfm");
  }
}

/// Along the diagonal of a voxel with alternating corners, the field is an odd cubic: its values in the middle and at
/// both ends do not reveal its range between these positions.
TEST(VolumeCommands, BumpsInsideAVoxelAreSeenThroughASteepFunction) {
  const Folder folder;
  ASSERT_EQ(tessera({"generate", "checker", folder / "k.vti", "n=2", "--quiet"}).status, 0);
  std::ofstream(folder / "step.txt") << "0 .1 .2 .9 0\n.501 .1 .2 .9 0\n.501 .9 .4 .1 1\n1 .9 .4 .1 1\n";
  const Outcome run = tessera({"render", folder / "k.vti", "-o", folder / "a.png", "--size", "64x64",
                               "--transfer-function", folder / "step.txt", "--verify", "4096"});
  EXPECT_EQ(run.status, 0) << run.out << run.err;
}

TEST(VolumeCommands, WithoutAnyOfItsMechanismsThePictureIsTheSame) {
  const Folder folder;
  const std::string volume = folder / "a.vti";
  ASSERT_EQ(tessera({"generate", "ripples", volume, "n=48", "bits=8", "--quiet"}).status, 0);
  const std::string function =
      folder.file("high.txt", "0 .1 .2 .9 0\n237 .1 .2 .9 0\n242 .9 .6 .1 30\n255 1 .2 .1 90\n");
  const auto render = [&](const std::string& without) {
    std::vector<std::string> words = {
        "render", volume,         "-o", folder / "a.pfm", "--transfer-function", function,   "--size",
        "48x48",  "--brick-size", "16", "--report",       folder / "r.json",     "--verify", "2000"};
    if (!without.empty()) words.insert(words.end(), {"--without", without});
    const auto run = tessera(words);
    EXPECT_EQ(run.status, 0) << without << run.out << run.err;
    return nlohmann::json::parse(contents(folder / "r.json"))["frames"][0]["counters"];
  };
  const auto all = render("");
  EXPECT_GT(all["bricks_invisible"], 0);
  const auto culling = render("culling");
  EXPECT_EQ(culling["bricks_invisible"], 0);
  const auto skipping = render("skipping");
  EXPECT_EQ(skipping["bricks_invisible"], all["bricks_invisible"]);
  const auto both = render("culling,skipping");
  EXPECT_GT(both["voxels_visited"], all["voxels_visited"]);
  EXPECT_EQ(both["bricks_invisible"], 0);
  const auto termination = render("termination");
  EXPECT_GE(termination["voxels_visited"], all["voxels_visited"]);
  render("culling,skipping,termination,lattice,sharing,merging");
}

TEST(VolumeCommands, EveryFormatThatConvertWritesGivesTheSamePicture) {
  const Folder folder;
  const std::string original = ripples(folder, "a.vti");
  ASSERT_EQ(tessera({"render", original, "-o", folder / "a.pfm", "--size", "40x40", "--quiet"}).status, 0);
  for (const char* name : {"b.nrrd", "b.vtr", "b.bricks"}) {
    ASSERT_EQ(tessera({"convert", original, folder / name, "--block", "8", "--quiet"}).status, 0);
    const Outcome run = tessera({"render", folder / name, "-o", folder / "b.pfm", "--size", "40x40", "--quiet"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(contents(folder / "b.pfm"), contents(folder / "a.pfm")) << name;
  }
}

TEST(VolumeCommands, RectilinearGridsAreVolumesToo) {
  const Folder folder;
  const std::string grid = folder.rectilinear();
  const Outcome run = tessera({"render", grid, "-o", folder / "a.exr", "-o", folder / "a.deep.exr", "--size", "40x40",
                               "--verify", "1000", "--report", folder / "r.json"});
  EXPECT_EQ(run.status, 0) << run.out << run.err;
  const auto report = nlohmann::json::parse(contents(folder / "r.json"));
  EXPECT_TRUE(report["volume"]["rectilinear"]);
  // 1e-5 for approximation by lines, plus 2.5e-5 for light that is omitted because rays end at a transmittance of a
  // quarter of 1e-4.
  EXPECT_LT(report["frames"][0]["verify"]["max_error"], 3.5e-5);
  const Outcome stepped = tessera({"render", grid, "-o", folder / "b.exr", "--integrator", "sampled"});
  EXPECT_EQ(stepped.status, 2);
  EXPECT_EQ(stepped.error_lines(), 1u) << stepped.err;
}

TEST(VolumeCommands, InfoPrintsTheContentsOfAVolume) {
  const Folder folder;
  const Outcome text = tessera({"info", ripples(folder, "a.bricks")});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("20x20x20 float32 samples"), std::string::npos) << text.out;
  const auto json = nlohmann::json::parse(tessera({"info", folder / "a.bricks", "--json"}).out);
  EXPECT_EQ(json["bounds"][0], (std::vector<double>{-1, -1, -1}));
  EXPECT_TRUE(json["renders"].contains("view"));
}

TEST(VolumeCommands, TheReportOfAPictureListsWhatInfoLists) {
  // Ranges are computed by two scans, one of info and one of the renderer, which must agree on blanks, components and
  // lengths.
  const Folder folder;
  std::vector<float> numbers;
  for (int i = 0; i < 3 * 13 * 12 * 11; ++i)
    numbers.push_back(i % 77 == 5 ? NAN : std::sin(0.3f * static_cast<float>(i)));
  const std::string bytes(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float));
  const std::string raw = folder.file("a_39x12x11_float32.raw", bytes);
  const std::string vectors = folder.file(
      "b.nrrd", "NRRD0004\ntype: float\ndimension: 4\nsizes: 3 13 12 11\nencoding: raw\nendian: little\n\n" + bytes);
  for (const auto& [file, field] : std::initializer_list<std::pair<std::string, std::string>>{
           {raw, "samples"}, {vectors, "samples"}, {vectors, "samples:1"}}) {
    const Outcome run = tessera({"render", file, "--field", field, "-o", folder / "a.pfm", "--size", "20x20", "--quiet",
                                 "--report", folder / "r.json"});
    ASSERT_EQ(run.status, 0) << run.err;
    auto info = nlohmann::json::parse(tessera({"info", file, "--field", field, "--json"}).out);
    info.erase("renders");
    EXPECT_GT(info["field"]["blank"], 0);
    EXPECT_EQ(nlohmann::json::parse(contents(folder / "r.json"))["volume"], info) << field;
  }
}

TEST(VolumeCommands, FaultsOfVolumesAreOneLineAndLeaveNothing) {
  const Folder folder;
  const std::string raw = folder.file("x_4x4x4_uint8.raw", std::string(63, 'x'));
  const std::string vti = ripples(folder, "a.vti"), mesh = folder.cube();
  const auto before = folder.names();
  const std::vector<std::pair<std::vector<std::string>, std::string>> faults = {
      {{raw}, "but the file has 63"},
      {{vti, "--integrator", "sampled:3"}, "sampled:3"},
      {{vti, "--step", "2"}, "--step"},
      {{vti, "-o", folder / "a.deep.exr", "--shade"}, "--shade"},
      {{vti, "--light", "0,0,1"}, "--shade"},
      {{vti, "--shade", "--light", "eye:0,0,1"}, "--light"},
      {{vti, "--field", "heat"}, "heat"},
      {{mesh, "--no-shade"}, "--no-shade"},
      {{folder / "absent.nii.gz"}, "no such file"},
      {{folder / "absent.vtr", "--shade"}, "no such file"},
      {{folder / "absent.vtk", "--shade"}, "no such file"},
      {{folder / "absent.vti", "--smooth"}, "no such file"},
      {{folder / "absent.vti", "--projectors", "1"}, "no such file"},
      {{folder / "absent_%d.vtk", "--shade"}, "no file has a name of this pattern"},
      {{folder / "absent_%d.vtr", "--shade"}, "no file has a name of this pattern"},
      {{folder / ""}, ""}};
  for (const auto& [arguments, words] : faults) {
    std::vector<std::string> all = {"render"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    for (const char* more : {"-o", "", "--quiet"}) all.emplace_back(more);
    all[all.size() - 2] = folder / "a.png";
    const Outcome run = tessera(all);
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_EQ(run.error_lines(), 1u) << run.err;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  }
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"info", folder / "absent.vti", "--check"},
        std::vector<std::string>{"convert", folder / "absent.vtk", folder / "b.vti"}}) {
    const Outcome run = tessera(arguments);
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_EQ(run.error_lines(), 1u) << run.err;
    EXPECT_NE(run.err.find("no such file"), std::string::npos) << run.err;
  }
  EXPECT_EQ(folder.names(), before);
}

}  // namespace
}  // namespace tessera::apps
