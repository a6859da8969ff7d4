// SPDX-License-Identifier: BSD-3-Clause
// Ranks that read different files with the same name, for example an outdated copy.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <utility>

#include "apps/program.hpp"

namespace tessera::apps {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// Runs the program on two ranks. Rank N runs in the directory N of `folder`.
Outcome in_own_folders(const Folder& folder, const Words& arguments) {
  Words command = mpirun_command(2, {});
  command.pop_back();
  for (const char* word :
       {"sh", "-c", "cd \"$1/$OMPI_COMM_WORLD_RANK\" && shift && exec \"$0\" \"$@\"", TESSERA_PROGRAM})
    command.emplace_back(word);
  command.push_back(folder / "");
  command.insert(command.end(), arguments.begin(), arguments.end());
  return Running(command).wait();
}

class SameFiles : public ::testing::Test {
 protected:
  SameFiles() {
    fs::create_directory(folder_ / "0");
    fs::create_directory(folder_ / "1");
  }
  void SetUp() override {
    if (!has_mpirun()) GTEST_SKIP() << "mpirun is not installed";
  }

  void make(const std::string& name, const Words& words) const {
    const Outcome run = tessera(words);
    ASSERT_EQ(run.status, 0) << run.err;
    ASSERT_TRUE(fs::exists(folder_ / name)) << name;
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  void same_for_both(const std::string& name) const { fs::copy(folder_ / ("0/" + name), folder_ / ("1/" + name)); }

  void expect_reported(const Words& arguments, const std::string& file) const {
    const Outcome run = in_own_folders(folder_, arguments);
    EXPECT_EQ(run.status, 2) << run.err;
    ASSERT_EQ(run.own_lines().size(), 1u) << run.err;
    EXPECT_NE(run.err.find(file + ": ranks 0 and 1 have different files of this name"), std::string::npos) << run.err;
  }

  const Folder folder_;
};

TEST_F(SameFiles, ReportsDifferentMeshes) {
  make("0/m.tets", {"generate", "cube", folder_ / "0/m.tets", "n=4"});
  make("1/m.tets", {"generate", "cube", folder_ / "1/m.tets", "n=3"});
  expect_reported({"render", "m.tets", "-o", "a.png", "--size", "16x16"}, "m.tets");
}

TEST_F(SameFiles, ReportsDifferentPieces) {
  make("0/m.tets", {"generate", "cube", folder_ / "0/m.tets", "n=4"});
  make("1/m.tets", {"generate", "cube", folder_ / "1/m.tets", "n=3"});
  for (const char* rank : {"0", "1"})
    make(std::string(rank) + "/p.pvtu", {"convert", folder_ / (std::string(rank) + "/m.tets"),
                                         folder_ / (std::string(rank) + "/p.pvtu"), "--pieces", "2", "--quiet"});
  fs::copy_file(folder_ / "0/p.pvtu", folder_ / "1/p.pvtu", fs::copy_options::overwrite_existing);
  expect_reported({"render", "p.pvtu", "-o", "a.png", "--size", "16x16"}, "p_0001.vtu");
}

// Without this check, the ranks would wait for each other's cells without end.
TEST_F(SameFiles, ReportsDifferentVolumes) {
  const std::string header = "NRRD0004\ntype: uint8\ndimension: 3\nencoding: raw\nsizes: ";
  for (const auto& [rank, n] : {std::pair{"0", 8}, std::pair{"1", 6}}) {
    const auto half = static_cast<std::size_t>(n * n * n / 2);
    std::string text = header;
    for (int axis = 0; axis < 3; ++axis) text += std::to_string(n) + ' ';
    text += "\n\n";
    text.append(half, '\1').append(half, '\7');
    write(std::string(rank) + "/v.nrrd", text);
  }
  expect_reported({"render", "v.nrrd", "-o", "a_%02d.png", "--orbit", "3", "--size", "16x16"}, "v.nrrd");
}

TEST_F(SameFiles, ReportsDifferentSamplesOfAHeader) {
  for (const char* rank : {"0", "1"}) {
    write(std::string(rank) + "/d.mhd",
          "ObjectType = Image\nNDims = 3\nDimSize = 5 5 5\nElementType = MET_UCHAR\nElementDataFile = d.raw\n");
    std::string samples;
    for (int i = 0; i < 125; ++i) samples += static_cast<char>(*rank == '0' ? i : 124 - i);
    write(std::string(rank) + "/d.raw", samples);
  }
  expect_reported({"render", "d.mhd", "-o", "a.png", "--size", "16x16"}, "d.raw");
}

TEST_F(SameFiles, ReportsDifferentCamerasAndFunctions) {
  make("0/m.tets", {"generate", "cube", folder_ / "0/m.tets", "n=4"});
  same_for_both("m.tets");
  write("0/cam.json", R"({"position":[0.5,0.5,9],"focal_point":[0.5,0.5,0.5],"parallel_scale":1})");
  write("1/cam.json", R"({"position":[0.5,0.5,9],"focal_point":[0.5,0.5,0.5],"parallel_scale":2})");
  expect_reported({"render", "m.tets", "-o", "a.png", "--size", "16x16", "--camera", "cam.json"}, "cam.json");
  write("0/tf.json", R"({"knots":[[0,1,0,0,1],[1,0,0,1,1]]})");
  write("1/tf.json", R"({"knots":[[0,1,0,0,1],[1,0,0,1,2]]})");
  expect_reported({"render", "m.tets", "-o", "a.png", "--size", "16x16", "--transfer-function", "tf.json"}, "tf.json");
}

TEST_F(SameFiles, CopiesOfOneFileAreTheSameWhateverTheirTime) {
  make("0/m.tets", {"generate", "cube", folder_ / "0/m.tets", "n=4"});
  same_for_both("m.tets");
  fs::last_write_time(folder_ / "1/m.tets", fs::last_write_time(folder_ / "0/m.tets") - std::chrono::hours(24));
  const Outcome run = in_own_folders(folder_, {"render", "m.tets", "-o", "a.png", "--size", "16x16"});
  EXPECT_EQ(run.status, 0) << run.err;
}

}  // namespace
}  // namespace tessera::apps
