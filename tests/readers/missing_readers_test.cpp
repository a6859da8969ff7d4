// SPDX-License-Identifier: BSD-3-Clause
// A machine without reader programs: this test is built if none is found (CMakeLists.txt).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "io/files/reader_programs.hpp"
#include "io/formats/identify.hpp"
#include "io/mesh/triangle_file.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io::missing_readers_test {
namespace {

constexpr const char* tetrahedron_poly =
    "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 0\n"
    "1\n3 0 1 2\n1\n3 0 1 3\n1\n3 0 2 3\n1\n3 1 2 3\n0\n";

constexpr const char* tetrahedron_ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 2 3\n3 1 2 3\n";

constexpr const char* plot3d_cube = "2 2 2\n0 1 0 1 0 1 0 1\n0 0 1 1 0 0 1 1\n0 0 0 0 1 1 1 1\n";

std::string vtk_xml(const std::string& type, const std::string& inside = "") {
  return fmt::format("<VTKFile type=\"{0}\" version=\"1.0\"><{0}>{1}</{0}></VTKFile>\n", type, inside);
}

std::string vtk_legacy(const std::string& type) {
  return "# vtk DataFile Version 3.0\nwords\nASCII\nDATASET " + type + "\n";
}

/// The beginning of a file of each format, as far as this library examines it before it calls its reader; by the
/// format's name.
std::map<std::string, std::string> beginnings() {
  using namespace std::string_literals;
  std::string dicom(128, '\0');
  dicom += "DICM";
  return {{"VTK XML AMR", vtk_xml("vtkOverlappingAMR", "<DataSet index=\"0\" file=\"block.vti\"/>")},
          {"VTK XML HyperTreeGrid", vtk_xml("HyperTreeGrid")},
          {"Enzo", "GridRank = 3\n"},
          {"legacy VTK unstructured or curvilinear grid", vtk_legacy("UNSTRUCTURED_GRID")},
          {"Exodus II", "CDF\1 num_nodes"s},
          {"OpenFOAM case", ""},
          {"EnSight 6 or Gold", "FORMAT\ntype: ensight gold\n"},
          {"CGNS", "    ADF Database Version"},
          {"VTKHDF", "\x89HDF\r\n\x1a\n"},
          {"MED", "\x89HDF\r\n\x1a\n"},
          {"XDMF", "<Xdmf></Xdmf>"},
          {"HDF5", "\x89HDF\r\n\x1a\n"},
          {"Fluent", "(0 \"words\")\n"},
          {"GAMBIT", "CONTROL INFO 2.0\n"},
          {"AVS UCD", "1 1 0 0 0\n1 0 0 0\n"},
          {"Gmsh", "$MeshFormat\n4.1 0 8\n"},
          {"I-DEAS universal", "    -1\n"},
          {"PLOT3D", plot3d_cube},
          {"PLOT3D list", R"({"version": 1, "filenames": [{"time": 0, "xyz": "grid.xyz"}]})"},
          {"STL", "solid s\nfacet normal 0 0 1\n"},
          {"VTK surface", vtk_xml("PolyData")},
          {"PLY", tetrahedron_ply},
          {"TetGen surface", tetrahedron_poly},
          {"legacy VTK structured points or rectilinear grid", vtk_legacy("STRUCTURED_POINTS")},
          {"NetCDF grid", "CDF\1"s},
          {"MINC", "CDF\1 xspace yspace zspace"s},
          {"DICOM", dicom}};
}

class MissingReaders : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::ranges::any_of(reader_programs(), [](const ReaderProgram& p) { return has_reader(p.reader); }))
      GTEST_SKIP() << "a reader program is installed on this machine";
    folder.write("grid.xyz", plot3d_cube);
  }

  /// `file`: the subject of the message.
  static void expect_named(const test::Fault& fault, const std::string& file, const std::string& format,
                           const ReaderProgram& program) {
    EXPECT_EQ(fault.code, scene::ErrorCode::bad_input) << fault.message;
    EXPECT_EQ(fault.message.find('\n'), std::string::npos) << fault.message;
    const std::string begins = fmt::format(
        "{}: {} files are {} by {}, which is not installed; install it (scripts/"
        "readers.sh ",
        file, format, program.does, program.program);
    EXPECT_TRUE(fault.message.starts_with(begins)) << fault.message << "\n" << begins;
    EXPECT_NE(fault.message.find(", or "), std::string::npos) << fault.message;
  }

  test::TemporaryFolder folder;
};

TEST_F(MissingReaders, EveryFormatNamesItsReaderAndHowToGetIt) {
  const std::map<std::string, std::string> texts = beginnings();
  int read_by_programs = 0;
  for (const Format& row : formats()) {
    if (row.needs.empty()) continue;
    const ReaderProgram& program = reader_program(row.needs.front());
    const std::string extensions = row.extensions;
    // The reader detects FLASH; this library identifies such files as HDF5.
    if (extensions.empty() && row.recognizes == nullptr) continue;
    // For VTK XML of a kind without a row, this library itself reports the kind.
    if (row.container == Container::vtk_xml && !row.is_listed) continue;
    SCOPED_TRACE(row.name);
    ++read_by_programs;
    const auto text = texts.find(row.name);
    ASSERT_NE(text, texts.end()) << "give it a beginning here";
    const auto file = folder.write("a" + extensions.substr(0, extensions.find(' ')), text->second);
    const InputFile identified = identify(file);
    ASSERT_NE(identified.format, nullptr);
    const std::string format = identified.format->name;
    // This library opens lists; the files that they name need the reader.
    const std::string subject = format == "PLOT3D list" ? (folder / "grid.xyz").string() : file.string();
    if (row.holds != FileHolds::grid) expect_named(test::fault_of([&] { read_mesh(file); }), subject, format, program);
    if (row.holds == FileHolds::grid || row.holds == FileHolds::grid_or_mesh)
      expect_named(test::fault_of([&] { open_volume(file); }), subject, format, program);
    const bool is_looked_into = row.holds_grid != nullptr || format == "HDF5";
    EXPECT_EQ(is_volume(identified), row.open_volume != nullptr && !is_looked_into);
    EXPECT_EQ(is_mesh(identified), row.read_mesh != nullptr);
    std::filesystem::remove(file);
  }
  EXPECT_GT(read_by_programs, 25);
}

TEST_F(MissingReaders, RareContentOfOwnFormatsNamesTheOtherReader) {
  const auto file = folder.write("a.pvti", vtk_xml("PImageData"));
  const test::Fault fault = test::fault_of([&] { open_volume(file); });
  EXPECT_EQ(fault.message,
            file.string() +
                ": this VTK XML image data file has parts that are read only by tessera-read-vtk, which is not "
                "installed; install it (scripts/readers.sh of the sources builds it), or convert the file to .nrrd");
}

TEST_F(MissingReaders, SurfacesAreReadWhereOnlyFillingThemNeedsAReader) {
  EXPECT_EQ(read_triangles(identify(folder.write("a.ply", tetrahedron_ply))).triangles.size(), 4u);
  const auto file = folder.write("a.stl", "solid s\nfacet normal 0 0 1\n");
  expect_named(test::fault_of([&] { read_triangles(identify(file)); }), file.string(), "STL",
               reader_program(Reader::vtk));
}

TEST_F(MissingReaders, TheListOfFormatsNamesThem) {
  for (const FileFormat& format : file_formats()) {
    const auto row = std::ranges::find_if(formats(), [&](const Format& r) { return format.name == r.name; });
    ASSERT_NE(row, formats().end());
    EXPECT_EQ(format.left_out, row->needs.empty() ? "" : reader_program(row->needs.front()).program) << format.name;
  }
}

TEST(ReaderPrograms, AreInTheOrderOfTheirNumbers) {
  for (const ReaderProgram& program : reader_programs()) EXPECT_EQ(&reader_program(program.reader), &program);
}

}  // namespace
}  // namespace tessera::io::missing_readers_test
