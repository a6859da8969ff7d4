// SPDX-License-Identifier: BSD-3-Clause
// Missing and unusual parts in files of other programs are reported correctly, and the remaining parts are read.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "cells/mesh_assembly.hpp"
#include "io/formats/identify.hpp"
#include "support/foam_case.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/vtk_or_skip.hpp"

namespace tessera::io::messages_test {
namespace {

using testing::message_of;

class Messages : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }
  test::TemporaryFolder folder;
};

bool has_note(const cells::MeshFile& file, const std::string& words) {
  return std::any_of(file.notes.begin(), file.notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{:12.5e}\n", value);
  return text;
}

/// A tet with a point field `f` and a cell field `g` at three times, in files numbered from 7 on.
class EnsightMessages : public Messages {
 protected:
  EnsightMessages() {
    write("a.case",
          "FORMAT\ntype: ensight gold\n\nGEOMETRY\nmodel: a.geo\n\nVARIABLE\nscalar per node: 1 f a.f****\n"
          "scalar per element: 1 g a.g****\n\nTIME\ntime set: 1\nnumber of steps: 3\nfilename start number: 7\n"
          "filename increment: 2\ntime values: 0.0 0.5\n1.0\n");
    write("a.geo", "made\nhere\nnode id off\nelement id off\npart\n         1\nbox\ncoordinates\n         4\n" +
                       numbers({0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}) +
                       "tetra4\n         1\n         1         2         3         4\n");
    for (const int step : {7, 9, 11}) {
      write(fmt::format("a.f{:04}", step), "f\npart\n         1\ncoordinates\n" + numbers({0, 1, 2, 3.0 * step}));
      write(fmt::format("a.g{:04}", step), "g\npart\n         1\ntetra4\n" + numbers({1.0 * step}));
    }
  }
};

TEST_F(EnsightMessages, AVariableWithoutItsFileIsLeftOutOfThatStep) {
  TESSERA_VTK_OR_SKIP();
  EXPECT_EQ(read_mesh(folder / "a.case").mesh.field_name, "f");
  std::filesystem::remove(folder / "a.f0011");
  const cells::MeshFile last = read_mesh(folder / "a.case");
  EXPECT_EQ(last.mesh.field_name, "g");
  EXPECT_EQ(last.mesh.scalars.front(), 11);
  EXPECT_TRUE(has_note(last, "f is left out: its file a.f0011, which the case names, is missing"));
  ReadOptions options;
  options.time_step = 1;
  EXPECT_EQ(read_mesh(folder / "a.case", options).mesh.field_name, "f");
  options.time_step = 2, options.field = "f";
  EXPECT_NE(message_of([&] { read_mesh(folder / "a.case", options); }).find("is in a.f0011, but there is no such file"),
            std::string::npos);
}

TEST_F(EnsightMessages, AMissingGeometryIsNamed) {
  TESSERA_VTK_OR_SKIP();
  std::filesystem::remove(folder / "a.geo");
  const std::string message = message_of([&] { read_mesh(folder / "a.case"); });
  EXPECT_NE(message.find("it names a.geo, but there is no such file"), std::string::npos) << message;
}

TEST_F(Messages, AMarkOfAnOpenFoamCaseMayBeEmptyByEitherName) {
  TESSERA_VTK_OR_SKIP();
  const testing::Cubes cubes(2);
  testing::write_foam(folder / "case", cubes, [](int) { return true; });
  for (const char* name : {"case/a.foam", "case/a.OpenFOAM"}) {
    write(name, "");
    EXPECT_EQ(read_mesh(folder / name).counts.cells_read, 8u) << name;
  }
  std::filesystem::remove(folder / "case/constant/polyMesh/faces");
  const std::string message = message_of([&] { read_mesh(folder / "case/a.foam"); });
  EXPECT_NE(message.find("polyMesh/faces, but there is no such file"), std::string::npos) << message;
}

TEST_F(Messages, AMissingBlockIsNamedWithItsList) {
  const auto list = write("a.vtm",
                          "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet>"
                          "<DataSet index=\"0\" name=\"a\" file=\"gone.vtu\"/></vtkMultiBlockDataSet></VTKFile>");
  EXPECT_EQ(message_of([&] { read_mesh(list); }),
            fmt::format("{}: there is no such file, but {} lists it; put the file there",
                        (folder / "gone.vtu").string(), list.string()));
}

/// Two tets with a point field in which `odd` is a value of the second's.
std::string legacy(const std::string& odd) {
  return "# vtk DataFile Version 3.0\nmade\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0\n1 0 0\n0 1 0\n"
         "0 0 1\n1 1 1\nCELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10\n10\nPOINT_DATA 5\nSCALARS nan double 1\n"
         "LOOKUP_TABLE default\n0 1 2 3 " +
         odd + "\nFIELD FieldData 1\ninf 1 5 float\n4 5 6 7 " + odd + "\n";
}

TEST_F(Messages, NanInLegacyTextIsANumber) {
  TESSERA_VTK_OR_SKIP();
  for (const std::string odd : {"nan", "NaN", "-nan", "inf", "-Infinity", "1.#QNAN"})
    for (const std::string field : {"nan", "inf"}) {
      ReadOptions options;
      options.field = field;
      const cells::MeshFile read = read_mesh(write("a.vtk", legacy(odd)), options);
      EXPECT_EQ(read.counts.cells_read, 2u) << odd;
      EXPECT_EQ(read.counts.cells_nan, 1u) << odd;
      EXPECT_EQ(read.mesh.scalars[3], field == "nan" ? 3 : 7) << odd;
    }
  EXPECT_EQ(read_mesh(write("a.vtk", legacy("9"))).counts.cells_nan, 0u);
}

/// Bytes of numbers, in the order of legacy VTK files or the opposite one.
template <class T>
std::string binary(const std::vector<T>& numbers, bool is_little) {
  std::string bytes;
  for (const T number : numbers) {
    std::string own(sizeof number, '\0');
    std::memcpy(own.data(), &number, sizeof number);
    if (is_little != (std::endian::native == std::endian::little)) std::ranges::reverse(own);
    bytes += own;
  }
  return bytes + "\n";
}

TEST_F(Messages, LittleEndianLegacyFilesAreNamed) {
  TESSERA_VTK_OR_SKIP();
  const std::vector<double> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<float> values = {0, 1, 2, 3, 4, 5, 6, 0.5F};
  const std::string head = "# vtk DataFile Version 3.0\nmade\nBINARY\nDATASET ";
  const auto expect = [&](bool is_little, const std::string& text, bool is_volume = false) {
    const auto file = write("a.vtk", text);
    const std::string message =
        test::fault_of([&] { is_volume ? void(open_volume(file)) : void(read_mesh(file)); }).message;
    if (is_little)
      EXPECT_NE(message.find("a.vtk: its binary numbers are little-endian"), std::string::npos) << message;
    else
      EXPECT_EQ(message.find("little-endian"), std::string::npos) << message;
  };
  for (const bool is_little : {true, false}) {
    SCOPED_TRACE(is_little);
    const std::string float64 = "POINTS 4 double\n" + binary(points, is_little),
                      whole =
                          "POINTS 4 int\n" + binary(std::vector<std::int32_t>(points.begin(), points.end()), is_little);
    for (const std::string& coordinates : {float64, whole}) {
      expect(is_little, head + "UNSTRUCTURED_GRID\n" + coordinates + "CELLS 1 5\n" +
                            binary<std::int32_t>({4, 0, 1, 2, 3}, is_little) + "CELL_TYPES 1\n" +
                            binary<std::int32_t>({10}, is_little));
      expect(is_little, head + "POLYDATA\n" + coordinates + "POLYGONS 4 16\n" +
                            binary<std::int32_t>({3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 0, 3, 2}, is_little));
    }
    expect(is_little,
           head + "STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 8\n" +
               "SCALARS f float 1\nLOOKUP_TABLE default\n" + binary(values, is_little),
           true);
    // One value that is unusual only in the correct order.
    expect(false,
           head + "STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 8\n" +
               "SCALARS f float 1\nLOOKUP_TABLE default\n" + binary(std::vector<float>(8, 1e-35F), false),
           true);
  }
}

TEST_F(Messages, NanInTextOfGridsAndUcdIsANumber) {
  TESSERA_VTK_OR_SKIP();
  const auto grid =
      write("g.vtk",
            "# vtk DataFile Version 3.0\none\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 3\nORIGIN 0 "
            "0 0\nSPACING 1 1 1\nPOINT_DATA 12\nSCALARS f float 1\nLOOKUP_TABLE default\n0 1 2 3 4 5 6 7 8 "
            "9 10 nan\n");
  const VolumeFile volume = open_volume(grid);
  EXPECT_EQ(volume.range.blanks, 1u);
  EXPECT_EQ(volume.range.high, 10);
  const auto ucd = write("a.inp",
                         "5 2 1 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n1 1 tet 1 2 3 4\n2 1 tet 2 3 4 5\n1 "
                         "1\nf, none\n1 0\n2 1\n3 2\n4 3\n5 nan\n");
  const cells::MeshFile mesh = read_mesh(ucd);
  EXPECT_EQ(mesh.counts.cells_nan, 1u);
  EXPECT_EQ(mesh.counts.cells_read, 2u);
}

TEST_F(Messages, ListsOfSurfacesAndPlaneMeshesAreRefusedWithTheReason) {
  const auto list = write("a.vtm",
                          "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet><DataSet index=\"0\" "
                          "name=\"skin\" file=\"a.vtp\"/></vtkMultiBlockDataSet></VTKFile>");
  write("a.vtp", "<VTKFile type=\"PolyData\"><PolyData/></VTKFile>");
  EXPECT_NE(message_of([&] { read_mesh(list); }).find("it lists surfaces only (skin)"), std::string::npos);
  TESSERA_VTK_OR_SKIP();
  for (const std::string first : {"(0 \"flat\")\n(2 2)\n", "(2 2)\n"}) {
    const auto flat = write("a.msh", first + "(10 (0 1 5 0 2))\n(12 (0 1 3 0))\n(12 (2 1 3 1))\n");
    const std::string message = message_of([&] { read_mesh(flat); });
    EXPECT_NE(message.find("a two-dimensional Fluent mesh"), std::string::npos) << message;
  }
  const auto untyped = write("b.msh", "(0 \"solid\")\n(2 3)\n(10 (0 1 5 0 3))\n(12 (0 1 3 0))\n(12 (2 1 3 1))\n");
  const std::string message = message_of([&] { read_mesh(untyped); });
  EXPECT_NE(message.find("the section of cells of zone 2 does not state the types of its cells"), std::string::npos)
      << message;
}

TEST_F(Messages, CellsWithTheirNodesInAnotherOrderAreWarnedOf) {
  const auto block_of = [](const std::vector<std::uint32_t>& order) {
    cells::CellBlock block;
    for (int k = 0; k < 12; ++k) block.positions.emplace_back(k % 2, k / 2 % 2, k / 4);
    block.types = {12, 12};
    block.offsets = {0, 8, 16};
    for (const std::uint32_t first : {0u, 4u})
      for (const std::uint32_t corner : order) block.connectivity.push_back(first + corner);
    return block;
  };
  std::vector<cells::CellBlock> right, voxels;
  right.push_back(block_of({0, 1, 3, 2, 4, 5, 7, 6}));
  voxels.push_back(block_of({0, 1, 2, 3, 4, 5, 6, 7}));
  const cells::MeshFile good = cells::assemble_mesh(std::move(right), {}, "a"),
                        tangled = cells::assemble_mesh(std::move(voxels), {}, "a");
  EXPECT_TRUE(cells::warnings_on_cells(good.counts, good.higher_order).empty());
  const auto warnings = cells::warnings_on_cells(tangled.counts, tangled.higher_order);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings.front().find("all 2 hexahedra are tangled"), 0u) << warnings.front();
}

TEST_F(Messages, OfVtkAreCleanedAndReportDamageOnlyIfThereIsSome) {
  TESSERA_VTK_OR_SKIP();
  const std::string whole = legacy("9");
  const std::string cut = message_of([&] { read_mesh(write("a.vtk", whole.substr(0, 150))); });
  EXPECT_NE(cut.find("truncated or damaged"), std::string::npos) << cut;
  std::string other = whole;
  other.replace(other.find("SCALARS nan double"), 18, "SCALARS nan quater");
  const std::string unknown = message_of([&] { read_mesh(write("a.vtk", other)); });
  EXPECT_EQ(unknown.find("damaged"), std::string::npos) << unknown;
  for (const char* words : {"vtk", "0x", "Debug", "ERROR:"})
    EXPECT_EQ(unknown.substr(unknown.find(": ")).find(words), std::string::npos) << unknown;
}

TEST_F(Messages, NameUnexpectedWordsOfLegacyFilesWithTheirLine) {
  TESSERA_VTK_OR_SKIP();
  const struct {
    std::string old, other, words;
  } cases[] = {
      {"ASCII", "ASCI", "line 3: it has 'ASCI' where ASCII or BINARY is expected"},
      {"DATASET UNSTRUCTURED_GRID", "DATASET UNSTRUCTRED_GRID",
       "line 4: it has 'UNSTRUCTRED_GRID' where a kind of data set"},
      {"POINTS 5 double", "POINTS 5 duble", "line 5: it has 'duble' where a type of numbers is expected"},
      {"POINTS 5 double", "POINTS five double", "line 5: it has 'five' where a number is expected"},
      {"\n0 1 0\n", "\n0 foo 0\n", "line 8: it has 'foo' where a number is expected"},
      {"4 1 2 3 4", "4 1 foo 3 4", "line 13: it has 'foo' where a number is expected"},
      {"CELL_TYPES", "CEL_TYPES", "line 14: it has 'CEL_TYPES' where a number or a keyword of the format is expected"},
      {"\n10\n10", "\n10\nten", "line 16: it has 'ten' where a number or a keyword of the format is expected"},
      {"POINT_DATA", "POINTS_DATA", "line 17: it has 'POINTS_DATA' where"},
      {"SCALARS", "SCALRS", "line 18: it has 'SCALRS' where"},
      {"LOOKUP_TABLE", "LOKUP_TABLE", "line 19: it has 'LOKUP_TABLE' where"},
      {"0 1 2 3 9", "0 1,5 2 3 9", "line 20: it has '1,5' where a number is expected"},
      {"4 5 6 7 9", "4 5 6 x 9", "line 23: it has 'x' where a number is expected"},
      {"0 1 2 3 9", "0 1 2 3 9 10.5", "it has a number, 10.5, where the next array is expected"},
  };
  for (const auto& [old, other, words] : cases) {
    std::string text = legacy("9");
    text.replace(text.find(old), old.size(), other);
    const std::string message = message_of([&] { read_mesh(write("a.vtk", text)); });
    EXPECT_NE(message.find("a.vtk: " + words), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace tessera::io::messages_test
