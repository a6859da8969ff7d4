// SPDX-License-Identifier: BSD-3-Clause
// Errors of users and of the machine: one line on stderr, the documented status, no incomplete files.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "apps/program.hpp"
#include "support/some_cases.hpp"
#include "system/free_memory.hpp"

namespace tessera::apps {
namespace {

using Names = std::vector<std::string>;

/// Runs quietly and expects one error line in the program's format that contains all of `words`.
void expect_fault(int status, Names arguments, const Names& words) {
  const auto run = tessera(arguments);
  std::string called;
  for (const auto& argument : arguments) called += argument + " ";
  EXPECT_EQ(run.status, status) << called << "\n" << run.err;
  EXPECT_EQ(run.error_lines(), 1u) << called << "\n" << run.err;
  EXPECT_TRUE(run.err.starts_with("tessera: ")) << called << "\n" << run.err;
  EXPECT_EQ(run.out, "") << called;
  for (const auto& word : words) EXPECT_NE(run.err.find(word), std::string::npos) << word << " in " << run.err;
}

TEST(Faults, HelpAndVersionSucceed) {
  for (const Names& arguments : {Names{"--help"}, Names{"--version"}, Names{"render", "--help"}, Names{"info", "-h"},
                                 Names{"convert", "--help"}, Names{"generate", "--help"}}) {
    const auto run = tessera(arguments);
    EXPECT_EQ(run.status, 0) << arguments[0];
    EXPECT_EQ(run.err, "");
    EXPECT_NE(run.out, "");
  }
}

TEST(Faults, InvalidArgumentsNameTheOption) {
  const Folder folder;
  const auto mesh = folder.cube();
  const Names head = {"render", mesh, "--quiet", "-o", folder / "a.png"};
  const std::vector<std::pair<Names, std::string>> cases = {
      {{"--size=1000000000x1000000000"}, "--size"},
      {{"--size", "wide"}, "WxH"},
      {{"--size", "10x"}, "WxH"},
      {{"--orbit", "0"}, "--orbit"},
      {{"--orbit", "3"}, "_%04d.png"},
      {{"--threads", "two"}, "--threads: 'two'"},
      {{"--tile-size", "0"}, "--tile-size"},
      {{"--memory", "5"}, "--memory: '5'"},
      {{"--accuracy", "0"}, "--accuracy"},
      {{"--accuracy", "nan"}, "--accuracy"},
      {{"--accuracy", "1e-3", "--integrator", "exact"}, "has no effect"},
      {{"--integrator", "sampled:0"}, "sampled:N"},
      {{"--integrator", "preintegrated:1000"}, "8 to 512"},
      {{"--integrator", "partial", "--emission", "independent"}, "supports only --emission absorption"},
      {{"--rasterizer", "spans"}, "planes, scanline or device"},
      {{"--rasterizer", "device", "--compositor", "gl-fragment", "--backend", "osmesa"}, "takes ray segments"},
      {{"--deep-accuracy", "fine", "-o", folder / "d.deep.exr"}, "--deep-accuracy: 'fine'"},
      {{"--deep-accuracy", "2", "-o", folder / "d.deep.exr"}, "1e-6 to 1"},
      {{"--rasterizer", "scanline", "-o", folder / "d.deep.exr"}, "use planes"},
      {{"--backend", "vulkan"}, "auto, cpu, osmesa or egl"},
      {{"--compositor", "gl-mesh"}, "cpu, gl-compute or gl-fragment"},
      {{"--compositor", "gl-compute", "--backend", "cpu"}, "needs osmesa, egl or auto"},
      {{"--framebuffer", "half"}, "gl-fragment"},
      {{"--compositor", "gl-fragment", "--framebuffer", "double"}, "half or float"},
      {{"--egl-device", "0"}, "is for --backend egl"},
      {{"--backend", "osmesa", "-o", folder / "d.deep.exr"}, "composited on the CPU"},
      {{"--emission", "both"}, "absorption or independent"},
      {{"--blend", "soft"}, "linear or display"},
      {{"--png-bits", "12"}, "8 or 16"},
      {{"--background", "-1,0,0"}, "R,G,B"},
      {{"--unit-distance", "-1"}, "--unit-distance: '-1'"},
      {{"--repeat", "0"}, "--repeat"},
      {{"--verify", "all"}, "--verify"},
      {{"--projection", "fisheye"}, "orthographic or perspective"},
      {{"--frobnicate"}, "--frobnicate"},
      {{"--repeat"}, "--repeat"},
      {{"--field", "nowhere"}, "nowhere"},
      {{"--transfer-function", "no-such-preset"}, "no-such-preset"},
      {{"--camera", "nowhere.json"}, "nowhere.json"},
      {{"-o", folder / "a.png"}, "given twice as an output"},
      {{"-o", folder / "none/a.png"}, "none/a.png"},
      {{"--report", folder / "none/r.json"}, "none/r.json"},
      {{"--timing", "/"}, "/"},
  };
  test::SomeCases some(5);
  for (const auto& [arguments, word] : cases) {
    if (!some.next()) continue;
    Names all = head;
    all.insert(all.end(), arguments.begin(), arguments.end());
    expect_fault(2, all, {word});
  }
  EXPECT_EQ(folder.names(), (Names{"cube.vtu"}));
}

TEST(Faults, ReportsMissingCommandInputAndOutput) {
  expect_fault(2, {}, {"tessera --help"});
  expect_fault(2, {"paint"}, {"'paint'", "render"});
  expect_fault(2, {"render"}, {"INPUT"});
  expect_fault(2, {"render", "a.vtu"}, {"--output"});
  expect_fault(2, {"render", "a.vtu", "-o", "a.png", "--quiet"}, {"a.vtu"});
}

TEST(Faults, AMissingFieldListsTheExistingOnes) {
  const Folder folder;
  expect_fault(2, {"render", folder.cube(), "--quiet", "-o", folder / "a.png", "--field", "heat"}, {"heat", "field"});
}

TEST(Faults, BrokenInputsLeaveNothingBehind) {
  const Folder folder;
  const std::string whole = contents(folder.cube());
  const auto truncated = folder.file("truncated.vtu", whole.substr(0, whole.size() / 2));
  const auto text = folder.file("text.vtu", "this is not a mesh\n");
  const auto empty = folder.file("empty.vtu", "");
  const auto tets = folder.file("short.tets", "12345678");
  const auto strange = folder.file("mesh.xyzzy", "1 2 3");
  const auto before = folder.names();
  for (const auto& mesh : {truncated, text, empty, tets, strange})
    expect_fault(2, {"render", mesh, "--quiet", "-o", folder / "a.png"}, {std::filesystem::path(mesh).filename()});
  expect_fault(2, {"render", folder / "", "--quiet", "-o", folder / "a.png"}, {});
  EXPECT_EQ(folder.names(), before);
}

TEST(Faults, CamerasWithoutAViewAreRefused) {
  const Folder folder;
  const auto mesh = folder.cube();
  const auto still = folder.file("still.txt", "position 1 1 1\nfocal_point 1 1 1\nparallel_scale 1\n");
  const auto list = folder.file("list.json", "[]");
  const auto wrong = folder.file("wrong.txt", "position 1 1 1\nfocal_point 0 0 0\nparallel_scale 1\nzoom 3\n");
  for (const auto& camera : {still, list, wrong})
    expect_fault(2, {"render", mesh, "--quiet", "-o", folder / "a.png", "--camera", camera},
                 {std::filesystem::path(camera).filename()});
}

TEST(Faults, AnInputIsNeverOverwritten) {
  const Folder folder;
  const auto mesh = folder.cube();
  const auto before = contents(mesh);
  expect_fault(2, {"convert", mesh, mesh, "--quiet"}, {"overwritten"});
  expect_fault(2, {"render", mesh, "--quiet", "-o", folder / "a.png", "--report", mesh}, {"overwritten"});
  EXPECT_EQ(contents(mesh), before);
}

TEST(Faults, AFileNameWithALineBreakStillGivesOneLine) {
  expect_fault(2, {"render", "two\nlines.vtu", "--quiet", "-o", "a.png"}, {"two lines.vtu"});
}

TEST(Faults, ReportsAnUnreadableDirectoryBeforeReading) {
  if (geteuid() == 0) GTEST_SKIP() << "root writes everywhere";
  const Folder folder;
  std::filesystem::permissions(folder / "", std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  expect_fault(2, {"render", "nowhere.vtu", "--quiet", "-o", folder / "a.png"}, {"a.png"});
  std::filesystem::permissions(folder / "", std::filesystem::perms::owner_all);
}

TEST(Faults, OutputsAreCheckedBeforeTheMeshIsRead) {
  expect_fault(2, {"render", "nowhere.vtu", "--quiet", "-o", "/nowhere/a.png"}, {"/nowhere/a.png"});
}

TEST(Faults, AFullDiskBehindStandardOutputIsASystemFailure) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const Folder folder;
  const auto run = tessera_to("/dev/full", {"info", folder.cube()});
  EXPECT_EQ(run.status, 3);
  EXPECT_EQ(run.error_lines(), 1u) << run.err;
}

TEST(Faults, APictureLargerThanMemoryIsRefusedInTime) {
  const Folder folder;
  const auto free = static_cast<double>(system::available_memory());
  const int side = static_cast<int>(std::sqrt(2 * free / 22));  // twice the available memory
  if (side > 65536) GTEST_SKIP() << "this machine could hold any";
  const std::string size = std::to_string(side) + "x" + std::to_string(side);
  expect_fault(3, {"render", folder.cube(), "--quiet", "-o", folder / "a.png", "--size", size}, {"GiB", "are free"});
}

TEST(Faults, AnAbsentVolumeIsNamed) {
  for (const char* name : {"a.vti", "a.nrrd", "a.nii", "a.nii.gz", "a.mhd", "a.raw"})
    expect_fault(2, {"render", name, "--quiet", "-o", "a.png"}, {name, "no such file"});
}

}  // namespace
}  // namespace tessera::apps
