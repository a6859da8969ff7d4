// SPDX-License-Identifier: BSD-3-Clause
// The kind of a file is determined by its first bytes, then by its name.
#include "io/formats/identify.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "io/files/file_beginnings.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using testing::message_of;

class Identify : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }
  std::string name_of(const std::string& file, const std::string& text) const {
    const Format* const format = identify(write(file, text)).format;
    return format == nullptr ? "" : format->name;
  }
  test::TemporaryFolder folder;
};

TEST_F(Identify, FreeSurferVolumesAreNoBinaryMedit) {
  std::string header(284 + 24, '\0');  // version, then width, height, depth, frames, type: big-endian
  header[3] = 1, header[7] = 4, header[11] = 3, header[15] = 2, header[19] = 1;
  for (const char* name : {"a.mgh", "a.mgz"}) {
    EXPECT_EQ(name_of(name, header), "FreeSurfer volume");
    EXPECT_NE(message_of([&] { read_mesh(folder / name); }).find("mri_convert"), std::string::npos);
  }
  std::string medit(24, '\0');
  medit[3] = 1, medit[7] = 2, medit[11] = 3, medit[15] = 20, medit[19] = 3;
  EXPECT_EQ(name_of("a.meshb", medit), "Medit binary");
}

struct Beginning {
  const char* format;
  std::string_view text;
};
const Beginning beginnings[] = {
    {"VTK XML unstructured grid", "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\">"},
    {"VTK XML curvilinear grid", "<VTKFile version='1.0' type='StructuredGrid'>"},
    {"VTK XML multi-block", "<VTKFile type=\"vtkMultiBlockDataSet\">"},
    {"VTK XML image data", "<VTKFile type=\"ImageData\">"},
    {"VTK XML rectilinear grid", "<VTKFile type=\"PRectilinearGrid\">"},
    {"ParaView collection", "<VTKFile type=\"Collection\">"},
    {"ParaView file series", "{ \"file-series-version\" : \"1.0\", \"files\" : [] }"},
    {"legacy VTK unstructured or curvilinear grid",
     "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n"},
    {"legacy VTK structured points or rectilinear grid",
     "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\n"},
    {"HDF5", "\x89HDF\r\n\x1a\n"},
    {"CGNS",
     "\xc0\xa8\xa3\xa9"
     "ADF Database Version A02011>"},
    {"OpenFOAM case", "/* C++ */\nFoamFile\n{\n version 2.0;"},
    {"EnSight 6 or Gold", "# made\nFORMAT\ntype: ensight gold\n"},
    {"Fluent", "(0 machine configuration:)\n(4 (60 0 0 1 2 4 4))\n"},
    {"Fluent", "(0 \"grid written by\")\n(2 3)\n"},
    {"GAMBIT", "        CONTROL INFO 2.4.6\n** GAMBIT NEUTRAL FILE\n"},
    {"AVS UCD", "# comment\n8 1 1 0 0\n1 0 0 0\n"},
    {"Tecplot", "TITLE = \"a\"\nVARIABLES = \"X\"\n"},
    {"STL", "solid cube\n facet normal 0 0 1\n"},
    {"PLY", "ply\nformat ascii 1.0\n"},
    {"NRRD", "NRRD0004\ntype: short\n"},
    {"MetaImage", "ObjectType = Image\nNDims = 3\n"},
    {"Gmsh", "$MeshFormat\n4.1 0 8\n"},
    {"Medit", "MeshVersionFormatted 2\n"},
    {"Medit binary", std::string_view("\1\0\0\0\4\0\0\0\3\0\0\0\30\0\0\0\0\0\0\0\3\0\0\0", 24)},
    {"Medit binary", std::string_view("\0\0\0\1\0\0\0\2\0\0\0\3\0\0\0\24\0\0\0\3", 20)},
    {"MFEM", "MFEM mesh v1.0\n"},
    {"SU2", "% mesh\nNDIME= 3\n"},
    {"XDMF", "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">"},
    {"EnSight 6 or Gold", "FORMAT\ntype: master_server gold\nSERVERS\n"},
    {"PLOT3D list", "{ \"auto-detect-format\" : true, \"filenames\" : [ { \"xyz\" : \"a.xyz\" } ] }"},
    {"Abaqus or Ansys input", "*HEADING\nmodel\n"},
};

TEST_F(Identify, TheContentDecidesBeforeTheName) {
  for (const Beginning& b : beginnings)
    for (const char* name : {"x", "x.dat", "x.ply", "x.vtu", "x.nrrd", "x.cas"})
      EXPECT_EQ(name_of(name, std::string(b.text)), b.format) << name;
}

TEST_F(Identify, TheTypeOfVtkXmlIsItsOwnAttributeInAnyOrder) {
  EXPECT_EQ(vtk_xml_type("<?xml version=\"1.0\"?>\n<VTKFile header_type=\"UInt64\" type=\"ImageData\">"), "ImageData");
  EXPECT_EQ(vtk_xml_type("<VTKFile\n\ttype = 'RectilinearGrid' header_type='UInt32'>"), "RectilinearGrid");
  EXPECT_EQ(vtk_xml_type("<VTKFile header_type=\"UInt64\">\n<Piece type=\"ImageData\">"), "");
}

TEST_F(Identify, ClassicNetCdfIsExodusByItsDimensions) {
  EXPECT_EQ(name_of("x.dat", std::string("CDF\1\0\0\0\0\0\0\0\12", 12) + "num_nodes"), "Exodus II");
  EXPECT_EQ(name_of("x.dat", std::string("CDF\1\0\0\0\0\0\0\0\12", 12) + "latitude"), "NetCDF grid");
  EXPECT_EQ(name_of("x.dat", std::string("CDF\1\0\0\0\0\0\0\0\12", 12) + "zspace yspace xspace"), "MINC");
}

TEST_F(Identify, RecognizesBinaryStlByItsSize) {
  std::string text(84 + 50, '\0');
  text[80] = 1;
  EXPECT_EQ(name_of("x.dat", text), "STL");
  EXPECT_EQ(name_of("y.dat", text + '\0'), "");
}

TEST_F(Identify, TheNameDecidesWhereTheContentDoesNot) {
  EXPECT_EQ(name_of("a.XYZ", "abc"), "PLOT3D");
  EXPECT_EQ(name_of("a.tets", "abc"), "raw tetrahedra");
  EXPECT_EQ(name_of("a.node", "4 3 0 0\n1 0 0 0\n"), "TetGen mesh");
  EXPECT_EQ(name_of("a.vtu", "Dear reader"), "VTK XML unstructured grid");
  EXPECT_EQ(name_of("a.vti", "<VTKFile"), "VTK XML image data");
  EXPECT_EQ(name_of("d3plot01", "abc"), "LS-DYNA results");
}

TEST_F(Identify, ReportsUnknownAndUnsupportedFormats) {
  EXPECT_NE(message_of([&] { read_mesh(write("x.dat", "Dear reader,")); }).find("`tessera formats` lists them"),
            std::string::npos);
  EXPECT_NE(
      message_of([&] { read_mesh(write("x.vtu", "MFEM mesh v1.0\n")); }).find("its format (MFEM) is not supported"),
      std::string::npos);
  EXPECT_FALSE(is_mesh(identify(write("x.vtu", "MFEM mesh v1.0\n"))));
  EXPECT_FALSE(is_volume(write("x.vti", "ply\nformat ascii 1.0\n")));
}

TEST_F(Identify, APointerOfGitLfsIsNamedWhateverTheNameOfTheFile) {
  const std::string pointer =
      "version https://git-lfs.github.com/spec/v1\n"
      "oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n";
  const auto refusal_of = [](const std::filesystem::path& file) {
    return fmt::format("{}: it is a Git LFS pointer, not the file itself; `git lfs pull` downloads the file",
                       file.string());
  };
  for (const char* name : {"x", "x.vtu", "x.vtk", "x.stl", "x.msh", "x.med", "x.e", "x.cgns", "x.tets", "x.node"}) {
    const auto file = write(name, pointer);
    EXPECT_EQ(message_of([&] { read_mesh(file); }), refusal_of(file));
  }
  for (const char* name : {"x.vti", "x.nrrd", "x.mha", "x.nii.gz", "x.nc", "x.h5", "x_2x2x2_uint8.raw"}) {
    const auto file = write(name, pointer);
    EXPECT_EQ(message_of([&] { open_volume(file); }), refusal_of(file));
  }
  // Samples next to a header are files, too.
  write("samples.raw", pointer);
  const auto header =
      write("h.nhdr", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: samples.raw\n");
  EXPECT_EQ(message_of([&] { open_volume(header); }), refusal_of(folder / "samples.raw"));
}

TEST_F(Identify, AFileThatOnlyHasASolversExtensionIsNotRead) {
  const std::string text = "26 0 0 1\nPATRAN neutral\n";
  EXPECT_NE(message_of([&] { read_mesh(write("x.neu", text)); }).find("it does not begin like a file of GAMBIT"),
            std::string::npos);
  EXPECT_NE(message_of([&] { read_mesh(write("x.inp", text)); }).find("it does not begin like a file of AVS UCD"),
            std::string::npos);
}

TEST_F(Identify, ADirectoryIsACaseOrRefused) {
  std::filesystem::create_directories(folder / "case" / "system");
  EXPECT_NE(message_of([&] { identify(folder / "case"); }).find("it is a directory"), std::string::npos);
  write("case/system/controlDict", "FoamFile\n{\n}\n");
  const InputFile found = identify(folder / "case");
  ASSERT_NE(found.format, nullptr);
  EXPECT_STREQ(found.format->name, "OpenFOAM case");
  EXPECT_TRUE(found.is_folder && found.is_recognized);
  EXPECT_FALSE(is_volume(folder / "case"));
}

TEST_F(Identify, EveryExtensionBelongsToOneKindOfData) {
  // Only .vtk is both a mesh's and a grid's extension.
  std::map<std::string, int> rows;
  for (const FileFormat& format : file_formats()) {
    EXPECT_FALSE(format.name.empty());
    for (const std::string& extension : format.extensions) {
      EXPECT_TRUE(extension.starts_with('.')) << format.name;
      ++rows[extension];
    }
  }
  for (const auto& [extension, count] : rows) EXPECT_EQ(count, extension == ".vtk" ? 2 : 1) << extension;
}

}  // namespace
}  // namespace tessera::io
