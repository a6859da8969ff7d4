// SPDX-License-Identifier: BSD-3-Clause
// Volumes of any format in gzip files.
#include <gtest/gtest.h>
#include <zlib.h>

#include "io/files/reader_programs.hpp"
#include "support/read_files.hpp"
#include "support/volume_bytes.hpp"
#include "support/volume_checks.hpp"
#include "support/vtk_or_skip.hpp"

namespace tessera::io {
namespace {

using test::all_samples;
using test::bytes_of;
using test::counting;
using test::expect_no_volume;

class GzipVolumes : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = folder / name;
    gzFile out = gzopen(file.c_str(), "wb");
    EXPECT_EQ(gzwrite(out, content.data(), static_cast<unsigned>(content.size())), static_cast<int>(content.size()));
    gzclose(out);
    return file;
  }
  test::TemporaryFolder folder;
};

const std::string nrrd = "NRRD0004\ntype: short\ndimension: 3\nsizes: 4 3 2\nendian: little\nencoding: raw\n\n" +
                         bytes_of(counting<std::int16_t>(24));

TEST_F(GzipVolumes, ReadsEveryFormat) {
  const std::string meta =
      "ObjectType = Image\nNDims = 3\nDimSize = 4 3 2\nElementType = MET_SHORT\nElementDataFile = LOCAL\n" +
      bytes_of(counting<std::int16_t>(24));
  for (const auto& [name, content] : {std::pair{"a.nrrd.gz", nrrd},
                                      {"a.mha.gz", meta},
                                      {"b.gz", nrrd},
                                      {"no_extension", nrrd},
                                      {"a_4x3x2_int16.raw.gz", bytes_of(counting<std::int16_t>(24))},
                                      {"a.nii.gz", test::nifti()}}) {
    const std::filesystem::path file = write(name, content);
    EXPECT_TRUE(is_volume(file)) << name;
    const VolumeFile volume = open_volume(file);
    EXPECT_EQ(all_samples(*volume.source), counting<double>(24)) << name;
    EXPECT_EQ(volume.source->geometry().points, (scene::GridIndex{4, 3, 2})) << name;
  }
}

TEST_F(GzipVolumes, VtkReadsThemToo) {
  TESSERA_VTK_OR_SKIP();
  const auto file =
      write("a.vti.gz",
            "<VTKFile type=\"ImageData\" version=\"0.1\"><ImageData WholeExtent=\"0 1 0 1 0 1\" Origin=\"0 0 0\" "
            "Spacing=\"1 1 1\"><Piece Extent=\"0 1 0 1 0 1\"><PointData><DataArray type=\"Int32\" Name=\"a\" "
            "format=\"ascii\">0 1 2 3 4 5 6 7</DataArray></PointData></Piece></ImageData></VTKFile>");
  EXPECT_TRUE(is_volume(file));
  EXPECT_EQ(all_samples(*open_volume(file).source), counting<double>(8));
}

TEST_F(GzipVolumes, SeveralMembersAreOneFile) {
  const std::string first = test::contents(write("1.gz", nrrd.substr(0, 50))),
                    second = test::contents(write("2.gz", nrrd.substr(50)));
  EXPECT_EQ(all_samples(*open_volume(folder.write("a.nrrd.gz", first + second + std::string(100, '\0'))).source),
            counting<double>(24));
}

TEST_F(GzipVolumes, RefusesDamagedFilesByTheirOwnName) {
  const std::string whole = test::contents(write("a.nrrd.gz", nrrd));
  expect_no_volume(folder.write("cut.nrrd.gz", whole.substr(0, whole.size() - 12)), "cut.nrrd.gz: ");
  std::string broken = whole;
  broken[whole.size() - 6] = static_cast<char>(~broken[whole.size() - 6]);  // of the checksum
  expect_no_volume(folder.write("sum.nrrd.gz", broken), "end or break");
  expect_no_volume(write("short.nrrd.gz", nrrd.substr(0, nrrd.size() - 1)), "short.nrrd.gz: 4x3x2 samples of 1 int16");
  expect_no_volume(write("a_4x3x2_int16.raw.gz", "abc"), "48 bytes, but the file has 3");
  expect_no_volume(write("text.gz", "no volume"), "does not begin");
}

TEST_F(GzipVolumes, InflatesOnlyTheSamplesThatTheHeaderStates) {
  // Data after the samples take no memory. Damage in that part of the stream is not even detected.
  const std::string header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n\n";
  for (const auto& [name, begin] :
       {std::pair{"b.nrrd.gz", header},
        {"b.mha.gz",
         std::string(
             "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n")}}) {
    const auto samples = counting<std::uint8_t>(64);
    const std::string whole = test::contents(write(name, begin + bytes_of(samples) + std::string(100 << 20, '\0')));
    const VolumeFile volume =
        open_volume(folder.write(name, whole.substr(0, whole.size() / 2) + std::string(1000, 'x')));
    EXPECT_EQ(all_samples(*volume.source), counting<double>(64)) << name;
  }
}

TEST_F(GzipVolumes, RefusesContentOutOfProportionToTheFile) {
  const auto zeros = [](int mib) { return std::string(static_cast<std::size_t>(mib) << 20, '\0'); };
  for (const auto& [name, begin] :
       {std::pair{"b.stl.gz", "solid x\n"}, {"b.tets.gz", "x"}, {"b.ply.gz", "ply\nformat ascii 1.0\n"}})
    test::expect_bad_input([this, &zeros, name = name, begin = begin] { read_mesh(write(name, begin + zeros(100))); },
                           {name, "contain more than", "gunzip"});
  expect_no_volume(write("b_4x4x4_uint8.raw.gz", zeros(170)), "contain more than");
  // A mask compresses by a factor of hundreds.
  const auto mask = write("m_256x256x1000_uint8.raw.gz", std::string(256 * 256 * 1000, '\1'));
  EXPECT_EQ(open_volume(mask).source->geometry().points, (scene::GridIndex{256, 256, 1000}));
}

TEST_F(GzipVolumes, RefusesFormatsOfSeveralFiles) {
  folder.write("d.raw", std::string(64, 'a'));
  const std::string nhdr = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\ndata file: d.raw\n";
  const std::string mhd =
      "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\nElementDataFile = d.raw\n";
  expect_no_volume(write("a.nhdr.gz", nhdr), "a.nhdr.gz: it refers to other files");
  expect_no_volume(write("a.mhd.gz", mhd), "unpack it");
  for (const auto& [name, text] : {std::pair{"a.node.gz", "4 3 0 0\n"},
                                   {"a.case.gz", "FORMAT\ntype: ensight gold\n"},
                                   {"a.foam.gz", "FoamFile\n{\n}\n"},
                                   {"a.pvtu.gz", "<VTKFile type=\"PUnstructuredGrid\"></VTKFile>"},
                                   {"a.vtm.gz", "<VTKFile type=\"vtkMultiBlockDataSet\"></VTKFile>"}}) {
    if (std::string_view(name) != "a.node.gz" && !has_reader(Reader::vtk)) continue;
    const std::string path = write(name, text);
    test::expect_bad_input([&] { read_mesh(path); }, {name, "it refers to other files", "unpack it"});
  }
}

}  // namespace
}  // namespace tessera::io
