// SPDX-License-Identifier: BSD-3-Clause
// AMReX plot files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "io/files/file_beginnings.hpp"
#include "io/formats/identify.hpp"
#include "io/mesh/amrex_header.hpp"
#include "support/amr_files.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using namespace testing;

ReadOptions field_f(bool smooth) {
  ReadOptions options;
  options.field = std::string("f");
  options.smooth = smooth;
  return options;
}

TEST(Amrex, CellsHaveTheirValuesHoweverTheyAreStored) {
  const test::TemporaryFolder folder;
  const AmrScene scene = nested_blocks();
  for (const bool single : {false, true})
    for (const bool big_endian : {false, true})
      for (const int around : {0, 2})
        for (const int first_cell : {0, -3, 5}) {
          const auto plot = write_amrex(folder, scene, wavy,
                                        {.single = single,
                                         .big_endian = big_endian,
                                         .first_cell = first_cell,
                                         .around = around,
                                         .two_files = around > 0});
          for (const auto& file : {plot, plot / "Header"}) {
            const cells::MeshFile read = read_mesh(file, field_f(false));
            EXPECT_EQ(read.counts.cells_read, 64u - 8 - 1 + 64 - 8 + 2 * 64);
            expect_cells(read.mesh, scene, 4, wavy, single ? 2e-7 : 1e-12);
          }
        }
}

TEST(Amrex, SmoothedItIsContinuousAcrossLevelsAndLinearInside) {
  const test::TemporaryFolder folder;
  const AmrScene scene = nested_blocks();
  for (const auto& at : {linear, wavy}) {
    const cells::MeshFile read = read_mesh(write_amrex(folder, scene, at), field_f(true));
    scene::validate(read.mesh, "amrex");
    expect_smooth(read.mesh, scene, 4, at, at == linear, 1e-9);
  }
}

TEST(Amrex, ListsFieldsAndIdentifiesTheDirectoryByItsHeader) {
  const test::TemporaryFolder folder;
  const auto plot = write_amrex(folder, nested_blocks(), wavy);
  const cells::MeshFile read = read_mesh(plot);
  ASSERT_EQ(read.fields.size(), 2u);
  EXPECT_EQ(read.fields[0].name, "other one");
  EXPECT_EQ(read.fields[1].name, "f");
  EXPECT_EQ(read.mesh.field_name, "f") << "the one that varies";
  EXPECT_EQ(read.format, "AMReX plot file");
  ASSERT_NE(identify(plot).format, nullptr);
  EXPECT_STREQ(identify(plot).format->name, "AMReX plot file");
  // The contents identify a Header.
  EXPECT_FALSE(looks_like_amrex("Header of something\n2\na\nb\n3\n"));
  EXPECT_FALSE(looks_like_amrex("HyperCLaw-V1.1\n2\na\nb\n7\n"));
  EXPECT_FALSE(looks_like_amrex(""));
  EXPECT_TRUE(looks_like_amrex("HyperCLaw-V1.1\n2\na\nb\n3\n"));
}

TEST(Amrex, ReportsDamageWithItsPlace) {
  const test::TemporaryFolder folder;
  const auto fault = [&](const std::string& in, const std::string& from, const std::string& to) {
    const auto plot = write_amrex(folder, nested_blocks(), wavy);
    std::string text = test::contents(plot / in);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    std::ofstream(plot / in, std::ios::binary) << text;
    const std::string message = message_of([&] { read_mesh(plot); });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  };
  const auto has = [](const std::string& message, const char* words) {
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  has(fault("Header", "other one\nf\n3", "other one\nf\n2"), "it has 2 dimensions; give a data set of three");
  has(fault("Header", "\n0\n0\n0 1 ", "\n1\n0\n0 1 "), "its coordinates are cylindrical");
  has(fault("Header", "3\n0.25\n2", "3\n0.25\n99"), "line 7: the finest level is '99'");
  has(fault("Header", "0.7 0.7 0.7", "0.7 x 0.7"), "a level's cell size is 'x', but must be a number");
  has(fault("Header", "Level_2/Cell", "Level_7/Cell"), "Level_7/Cell_H: there is no such file");
  has(fault("Level_1/Cell_H", "1\n1\n2", "3\n1\n2"), "write it with vismf.headerversion = 1");
  has(fault("Level_1/Cell_H", "1\n1\n2", "1\n1\n5"), "it has 5 fields, but the Header lists 2");
  has(fault("Level_1/Cell_H", "((2,2,2) (5,5,5)", "((2,2,2) (5,5,6)"), "but its box has cells 2 to 6");
  has(fault("Level_1/Cell_H", "((2,2,2) (5,5,5)", "((2,2,2) (5,5,1)"), "ends before it begins");
  has(fault("Level_1/Cell_H", "(0,0,0))", "(1,0,0))"), "has values at nodes");
  has(fault("Level_1/Cell_H", "Cell_D_00000 0", "Cell_D_00000 8"), "the values there do not begin with FAB");
  has(fault("Level_1/Cell_H", "Cell_D_00000 0", "Cell_D_00000 99999999"), "the values there do not begin with FAB");
  has(fault("Level_1/Cell_H", "FabOnDisk", "FabOnDesk"), "FabOnDisk: is required");
  has(fault("Level_1/Cell_D_00000", "64 11 52", "64 12 51"), "write IEEE numbers");
  has(fault("Level_1/Cell_D_00000", ") 2\n", ") 9\n"), "it has 9 fields there, but the Header lists 2");
  has(fault("Level_1/Cell_D_00000", ") 2\n", ") 2\n" + std::string(1, '\0')), "");
  const auto plot = write_amrex(folder, nested_blocks(), wavy);
  std::filesystem::resize_file(plot / "Level_2" / "Cell_D_00000", 2000);
  has(message_of([&] { read_mesh(plot); }), "truncated");
  // Both boxes of level 2 at one place.
  std::string text = test::contents(plot / "Level_2" / "Cell_H");
  const std::size_t second = text.rfind("Cell_D_00000 ");
  text.replace(second, text.find('\n', second) - second, "Cell_D_00000 0");
  std::ofstream(plot / "Level_2" / "Cell_H") << text;
  EXPECT_NE(message_of([&] { read_mesh(plot); }), "");
}

TEST(Amrex, ChangedBytesAreReadOrRefused) {
  const test::TemporaryFolder folder;
  const auto plot = write_amrex(folder, nested_blocks(), wavy);
  for (const char* file : {"Header", "Level_1/Cell_H", "Level_1/Cell_D_00000"})
    expect_read_or_refused(plot / "Header", plot / file, 200);
}

}  // namespace
}  // namespace tessera::io
