// SPDX-License-Identifier: BSD-3-Clause
// The program on a machine without reader programs: commands that open a file refuse it in one line that names the
// reader. readers/missing_readers_test.cpp covers all formats.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "apps/program.hpp"
#include "io/files/reader_programs.hpp"

namespace tessera::apps {
namespace {

class WithoutReaders : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::filesystem::exists(TESSERA_INSTALLED_READERS)) GTEST_SKIP() << "reader programs are installed";
    // The built program under another name, from which no directory with reader programs is found.
    const std::filesystem::path copy = folder / "alone/bin/tessera";
    std::filesystem::create_directories(copy.parent_path());
    std::error_code other_disk;
    std::filesystem::create_hard_link(TESSERA_PROGRAM, copy, other_disk);
    if (other_disk) std::filesystem::copy_file(TESSERA_PROGRAM, copy);
    program = copy.string();
  }

  [[nodiscard]] Outcome run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), program);
    return Running(arguments).wait();
  }

  void expect_refused(const Outcome& outcome, const std::string& begins) const {
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_EQ(outcome.error_lines(), 1u) << outcome.err;
    const std::string line = outcome.err.substr(0, outcome.err.find('\n'));
    EXPECT_TRUE(line.starts_with("tessera: " + begins)) << line;
    EXPECT_NE(line.find("which is not installed; install it (scripts/readers.sh"), std::string::npos) << line;
  }

  Folder folder;
  std::string program;
};

TEST_F(WithoutReaders, CommandsNameTheReaderOfAFile) {
  const struct {
    std::string file, words;
  } cases[] = {{folder.file("bracket.ex2", "CDF\1num_nodes"), ": Exodus II files are read by tessera-read-vtk, "},
               {folder.file("part.msh", "$MeshFormat\n4.1 0 8\n"), ": Gmsh files are read by tessera-read-gmsh, "},
               {folder.file("slice.dcm", "words"), ": DICOM files are read by tessera-read-dicom, "},
               {folder.file("cells.xmf", "<Xdmf></Xdmf>"), ": XDMF files are read by tessera-read-xdmf, "},
               {folder.file("heat.nc", "CDF\1"), ": NetCDF grid files are read by tessera-read-vtk, "}};
  for (const auto& each : cases) {
    SCOPED_TRACE(each.file);
    expect_refused(run({"info", each.file}), each.file + each.words);
    expect_refused(run({"render", each.file, "-o", folder / "a.png", "--size", "16x16"}), each.file + each.words);
    const bool is_volume = each.file.ends_with(".dcm");
    expect_refused(run({"convert", each.file, folder / (is_volume ? "b.nrrd" : "b.tets")}), each.file + each.words);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

TEST_F(WithoutReaders, RanksRefuseAFileInOneLine) {
  if (!has_mpirun()) GTEST_SKIP() << "there is no mpirun";
  const std::string file = folder.file("bracket.ex2", "CDF\1num_nodes");
  std::vector<std::string> command = mpirun_command(3, {"render", file, "-o", folder / "a.png", "--size", "16x16"});
  *std::ranges::find(command, std::string(TESSERA_PROGRAM)) = program;
  const Outcome outcome = Running(command).wait();
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  std::istringstream err(outcome.err);
  int lines = 0;
  for (std::string line; std::getline(err, line);)
    if (line.starts_with("tessera: ")) {
      ++lines;
      EXPECT_TRUE(line.starts_with("tessera: " + file + ": Exodus II files are read by tessera-read-vtk, ")) << line;
    }
  EXPECT_EQ(lines, 1) << outcome.err;
}

TEST_F(WithoutReaders, AProgramThatAnotherUserCanReplaceIsNotUsed) {
  const std::string file = folder.file("bracket.ex2", "CDF\1num_nodes"), marker = folder / "it_ran";
  const std::filesystem::path readers = folder / "alone/libexec/tessera", reader = readers / "tessera-read-vtk";
  std::filesystem::create_directories(readers);
  std::ofstream(reader) << "#!/bin/sh\ntouch '" << marker << "'\n";
  using std::filesystem::perms;
  std::filesystem::permissions(reader, perms::owner_all);
  for (const std::filesystem::path& open : {reader, readers, readers.parent_path()}) {
    std::filesystem::permissions(open, perms::others_write, std::filesystem::perm_options::add);
    expect_refused(run({"info", file}), file + ": Exodus II files are read by tessera-read-vtk, ");
    std::filesystem::permissions(open, perms::others_write, std::filesystem::perm_options::remove);
  }
  EXPECT_FALSE(std::filesystem::exists(marker));
  EXPECT_EQ(run({"info", file}).status, 3) << "it is taken, and ends at once";
  EXPECT_TRUE(std::filesystem::exists(marker));
}

TEST_F(WithoutReaders, FormatsMarksThem) {
  const Outcome listed = run({"formats"});
  EXPECT_EQ(listed.status, 0);
  EXPECT_NE(listed.out.find("needs tessera-read-vtk, which is not installed"), std::string::npos) << listed.out;
  EXPECT_NE(listed.out.find("needs tessera-read-med, which is not installed"), std::string::npos) << listed.out;
}

}  // namespace
}  // namespace tessera::apps
