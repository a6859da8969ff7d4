// SPDX-License-Identifier: BSD-3-Clause
// What is opened and how: only regular files, wherever their names come from; files that are shortened while they are
// read; and a process without descriptors.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>

#include "io/files/input_file.hpp"
#include "io/files/reader_programs.hpp"
#include "io/files/whole_file.hpp"
#include "io/mesh/amrex_file.hpp"
#include "io/mesh/tets_file.hpp"
#include "io/scene/time_series.hpp"
#include "support/amr_files.hpp"
#include "support/foam_case.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "system/idle_watch.hpp"
#include "system/positional_file.hpp"

namespace tessera::io {
namespace {

using test::expect_bad_input;
using test::TemporaryFolder;

std::filesystem::path make_pipe(const std::filesystem::path& name) {
  EXPECT_EQ(::mkfifo(name.c_str(), 0600), 0) << name;
  return name;
}

/// A case of one cube; returns its directory.
std::filesystem::path write_cube_case(const TemporaryFolder& folder) {
  const auto path = folder / "case";
  testing::write_foam(path, testing::Cubes(1), [](int) { return true; });
  testing::write_control(path);
  return path;
}

// Each of these once waited without end for a writer of the pipe.
TEST(InputFiles, PipesAreRefusedByThemselves) {
  const TemporaryFolder folder;
  for (const char* name : {"p.vtu", "p.vtk", "p.stl", "p.ply", "p.tets", "p.mesh", "p.su2", "p.bdf", "p.dat", "p.ele"})
    expect_bad_input([&] { read_mesh(make_pipe(folder / name)); }, {name, "not a regular file"});
  for (const char* name : {"p.nrrd", "p.nhdr", "p.mha", "p.mhd", "p.nii", "p.vti", "p_4x4x4_uint8.raw"})
    expect_bad_input([&] { open_volume(make_pipe(folder / name)); }, {name, "not a regular file"});
  for (const char* name : {"p.pvd", "p.series"})
    expect_bad_input([&] { read_time_series(make_pipe(folder / name)); }, {name, "not a regular file"});
}

TEST(InputFiles, PipesAreRefusedWhereAFileNamesThem) {
  const TemporaryFolder folder;
  make_pipe(folder / "pipe");
  const struct {
    const char *name, *text;
  } meshes[] = {{"a.pvtu",
                 "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece Source=\"pipe\"/>"
                 "</PUnstructuredGrid></VTKFile>"},
                {"a.vtm",
                 "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet><DataSet file=\"pipe\"/>"
                 "</vtkMultiBlockDataSet></VTKFile>"},
                {"a.bdf", "BEGIN BULK\nINCLUDE 'pipe'\nENDDATA\n"}};
  for (const auto& each : meshes) expect_bad_input([&] { read_mesh(folder.write(each.name, each.text)); }, {"pipe"});
  const std::string nrrd = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\ndata file: pipe\nencoding: ";
  for (const char* encoding : {"raw", "gzip", "ascii", "hex"})
    expect_bad_input([&] { open_volume(folder.write("a.nhdr", nrrd + encoding + "\n")); }, {"pipe"});
  expect_bad_input(
      [&] {
        open_volume(folder.write("a.mhd",
                                 "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
                                 "ElementDataFile = pipe\n"));
      },
      {"pipe"});
  const auto plot = testing::write_amrex(folder, testing::nested_blocks(), testing::wavy);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(plot))
    if (entry.path().filename().string().starts_with("Cell_D")) {
      std::filesystem::remove(entry.path());
      make_pipe(entry.path());
    }
  expect_bad_input([&] { read_mesh(plot); }, {"Cell_D", "not a regular file"});
  folder.write("a.ele", "1 4 0\n1 1 2 3 4\n");
  make_pipe(folder / "a.node");
  expect_bad_input([&] { read_mesh(folder / "a.ele"); }, {"a.node", "not a regular file"});
}

TEST(InputFiles, PipesAreRefusedWhereReaderProgramsFindThem) {
  if (!has_reader(Reader::vtk)) GTEST_SKIP() << "no tessera-read-vtk";
  const TemporaryFolder folder;
  make_pipe(folder / "pipe");
  const std::string ensight = "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: ";
  expect_bad_input([&] { read_mesh(folder.write("a.case", ensight + "pipe\n")); }, {"pipe", "not a regular file"});
  folder.write("a.geo", "x\ny\nnode id assign\nelement id assign\npart\n1\nz\ncoordinates\n0\n");
  expect_bad_input([&] { read_mesh(folder.write("b.case", ensight + "a.geo\nVARIABLE\nscalar per node: s pipe\n")); },
                   {"pipe", "not a regular file"});
  const auto cube = write_cube_case(folder);
  EXPECT_EQ(read_mesh(cube).counts.cells_read, 1u);
  std::filesystem::remove(cube / "constant/polyMesh/points");
  make_pipe(cube / "constant/polyMesh/points");
  expect_bad_input([&] { read_mesh(cube); }, {"points is not a regular file"});
}

TEST(InputFiles, RefusesOtherIrregularFiles) {
  expect_bad_input([] { require_file("/dev/zero"); }, {"not a regular file"});
  expect_bad_input([] { require_file("/proc/self/maps"); }, {"it is empty"});
  expect_bad_input([] { system::PositionalFile(std::string(300, 'y')); }, {"there is no such file"});
}

TEST(InputFiles, RunningOutOfDescriptorsIsASystemFailure) {
  const TemporaryFolder folder;
  const auto file = folder.write("m.tets", "some bytes");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none{0, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  const test::Fault fault = test::fault_of([&] { require_file(file); });
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(fault.code, scene::ErrorCode::system_failure) << fault.message;
  EXPECT_NE(fault.message.find("ulimit -n"), std::string::npos) << fault.message;
}

// A mapping of these files once ended the process by SIGBUS when it was accessed.
TEST(InputFiles, ShortenedBeforeTheyAreReadIsAnError) {
  const TemporaryFolder folder;
  const auto expect_failure = [](const auto& action, const char* what) {
    const test::Fault fault = test::fault_of(action);
    EXPECT_EQ(fault.code, scene::ErrorCode::system_failure) << what << ": " << fault.message;
    EXPECT_NE(fault.message.find("shortened"), std::string::npos) << what << ": " << fault.message;
  };
  std::string tets(16 + 16 * 20000 + 16, '\0');
  const std::int64_t vertices = 20000, cells = 1;
  std::memcpy(tets.data(), &vertices, 8);
  std::memcpy(tets.data() + 8, &cells, 8);
  const auto file = folder.write("m.tets", tets);
  const system::PositionalFile opened(file);
  const TetsBytes bytes(opened);
  std::filesystem::resize_file(file, 100000);
  expect_failure([&] { parse_tets(bytes, "m.tets"); }, "whole");
  expect_failure([&] { parse_tets_range(bytes, 0, 1, "m.tets"); }, "a range");

  const auto plot = testing::write_amrex(folder, testing::nested_blocks(), testing::wavy);
  const OpenedAmr amr = open_amrex(plot);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(plot))
    if (entry.path().filename().string().starts_with("Cell_D")) std::filesystem::resize_file(entry.path(), 200);
  const cells::BlockField& field = amr.fields.front().fields.front();
  std::vector<double> values(field.tuples);
  expect_failure([&] { field.read(0, 0, values); }, "AMReX");
}

TEST(InputFiles, AWholeFileThatEndsBeforeItsSizeIsAnError) {
  // Files of the kernel have a page's size and a few words.
  const std::filesystem::path words = "/sys/kernel/mm/transparent_hugepage/enabled";
  std::error_code unknown;
  if (std::filesystem::file_size(words, unknown) == 0 || unknown) GTEST_SKIP() << "no " << words;
  const test::Fault fault = test::fault_of([&] { const WholeFile file(words); });
  EXPECT_EQ(fault.code, scene::ErrorCode::system_failure) << fault.message;
  EXPECT_NE(fault.message.find("shortened"), std::string::npos) << fault.message;
}

TEST(IdleWatch, DistinguishesASleepingFromARunningProcess) {
  system::IdleWatch own(::getpid());
  for (int look = 0; look < 3; ++look) EXPECT_EQ(own.look().count(), 0) << "this thread runs";
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::pause();
    ::_exit(0);
  }
  system::IdleWatch watch(child);
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  std::chrono::steady_clock::duration idle{};
  while (idle.count() == 0 && std::chrono::steady_clock::now() < give_up) idle = watch.look();
  EXPECT_GT(idle.count(), 0);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(watch.look().count(), 0) << "it is gone";
}

}  // namespace
}  // namespace tessera::io
