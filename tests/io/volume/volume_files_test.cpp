// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <random>
#include <string>
#include <tuple>

#include "io/files/reader_programs.hpp"
#include "io/volume/volume_writer.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/volume_bytes.hpp"
#include "support/volume_checks.hpp"
#include "support/vtk_or_skip.hpp"

namespace tessera::io {
namespace {

using scene::Association;
using scene::GridIndex;
using scene::SampleType;
using test::all_samples;
using test::bytes_of;
using test::counting;
using test::put;

const std::filesystem::path volumes = std::filesystem::path(TESSERA_SOURCE_DIR) / ".." / "shared" / "data" / "volumes";

/// Names of files in every format that is written and that this build reads.
std::vector<std::string> names_written() {
  std::vector<std::string> names = {"a.nrrd", "a.bricks", "a_21x10x17_float32.raw"};
  if (has_reader(Reader::vtk)) names.insert(names.end(), {"a.vti", "a.vtr"});
  return names;
}

class VolumeFiles : public ::testing::Test {
 protected:
  /// Opens the file and expects a one-line error that contains `words`.
  void expect_refused(const std::filesystem::path& file, const std::string& words, const ReadOptions& options = {}) {
    const test::Fault fault = test::fault_of([&] { open_volume(file, options); });
    EXPECT_EQ(fault.code, scene::ErrorCode::bad_input) << fault.message;
    EXPECT_NE(fault.message.find(words), std::string::npos) << fault.message;
    EXPECT_EQ(fault.message.find('\n'), std::string::npos) << fault.message;
    EXPECT_NE(fault.message.find("; "), std::string::npos) << "no remedy: " << fault.message;
  }
  test::TemporaryFolder folder;
};

TEST_F(VolumeFiles, TheFourPublicVolumesAreReadAsDescribed) {
  TESSERA_VTK_OR_SKIP();
  if (!std::filesystem::exists(volumes)) GTEST_SKIP() << "no " << volumes << ": the public volumes are not here";
  const VolumeFile heptane = open_volume(volumes / "heptane.nii.gz");
  EXPECT_EQ(heptane.source->geometry().points, (GridIndex{302, 302, 302}));
  EXPECT_EQ(heptane.source->grid().type, SampleType::uint8);
  EXPECT_EQ(heptane.range, (scene::ValueRange{0, 255, 0}));
  const VolumeFile lidc = open_volume(volumes / "LIDC2.vti");
  EXPECT_EQ(lidc.source->geometry().points, (GridIndex{256, 256, 133}));
  EXPECT_EQ(lidc.source->geometry().spacing, glm::dvec3(1.40625, 1.40625, 2.5));
  EXPECT_EQ(lidc.source->grid().type, SampleType::uint8);
  const VolumeFile engine = open_volume(volumes / "engine.nii.gz");
  EXPECT_EQ(engine.source->geometry().points, (GridIndex{256, 256, 128}));
  EXPECT_EQ(engine.source->geometry().origin, glm::dvec3(-127, -127, -64));
  const VolumeFile carotid = open_volume(volumes / "carotid.vtk");
  EXPECT_EQ(carotid.source->geometry().points, (GridIndex{76, 49, 45}));
  EXPECT_EQ(carotid.source->geometry().origin, glm::dvec3(100, 80, 1));
  EXPECT_EQ(carotid.source->grid().field_name, "scalars");
  EXPECT_NEAR(carotid.range.high, 580, 1);  // as stated in the data's README, in integers
  const VolumeFile speed = open_volume(volumes / "carotid.vtk", {.field = "vectors"});
  EXPECT_EQ(speed.source->grid().field_name, "vectors:mag");
  const VolumeFile x = open_volume(volumes / "carotid.vtk", {.field = "vectors:x"});
  const VolumeFile y = open_volume(volumes / "carotid.vtk", {.field = "vectors:1"});
  const VolumeFile z = open_volume(volumes / "carotid.vtk", {.field = "vectors:z"});
  std::vector<double> s(8), a(8), b(8), c(8);
  const scene::SampleBox box{{30, 20, 20}, {32, 22, 22}};
  speed.source->read(box, std::span(s)), x.source->read(box, std::span(a)), y.source->read(box, std::span(b));
  z.source->read(box, std::span(c));
  for (std::size_t k = 0; k < 8; ++k)
    EXPECT_NEAR(s[k], std::sqrt(a[k] * a[k] + b[k] * b[k] + c[k] * c[k]), 1e-6 * s[k]);  // rounding of floats
}

TEST_F(VolumeFiles, DistinguishesMeshesFromVolumesByContentNotByName) {
  EXPECT_TRUE(is_volume(folder.write("a.dat", test::nifti())));
  EXPECT_TRUE(is_volume(folder.write("a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\n")));
  EXPECT_TRUE(is_volume(folder.write("b.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET RECTILINEAR_GRID\n")));
  EXPECT_FALSE(is_volume(folder.write("c.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n")));
  EXPECT_FALSE(is_volume(folder.write("d.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_GRID\n")));
  EXPECT_TRUE(is_volume(folder.write("a.vtu", "<?xml?><VTKFile type=\"ImageData\">")));
  EXPECT_FALSE(is_volume(folder.write("b.vtu", "<?xml?><VTKFile type=\"UnstructuredGrid\">")));
  EXPECT_TRUE(is_volume(folder.write("damaged.vtr", "nothing")));
  EXPECT_FALSE(is_volume(folder.write("b.vtr", "<?xml?><VTKFile type=\"UnstructuredGrid\">")));
  EXPECT_TRUE(is_volume(folder.write("x.raw", "abc")));
}

TEST_F(VolumeFiles, NiftiPlacesByItsSpacingThenQformThenSform) {
  std::string file = test::nifti();
  VolumeFile volume = open_volume(folder.write("a.nii", file));
  EXPECT_EQ(volume.source->geometry().points, (GridIndex{4, 3, 2}));
  EXPECT_EQ(volume.source->geometry().spacing, glm::dvec3(1, 2, 3));
  EXPECT_EQ(volume.source->geometry().origin, glm::dvec3(0));
  EXPECT_EQ(all_samples(*volume.source)[23], 23);

  put<std::int16_t>(file, 252, 1);  // qform: a quarter turn around z (d = sin 45 degrees), then the third axis mirrored
  put<float>(file, 264, static_cast<float>(std::sqrt(0.5)));
  put<float>(file, 268, 10), put<float>(file, 272, 20), put<float>(file, 276, 30);
  put<float>(file, 76, -1);
  volume = open_volume(folder.write("b.nii", file));
  const glm::dvec3 corner = scene::world_of_index(volume.source->geometry(), {3, 2, 1});
  EXPECT_LT(glm::length(corner - glm::dvec3(10 - 4, 20 + 3, 30 - 3)), 1e-5);  // the quaternion is a float

  put<std::int16_t>(file, 254, 2);  // sform takes precedence
  const float rows[] = {0, 0, 2, 5, 3, 0, 0, 6, 0, 4, 0, 7};
  std::memcpy(file.data() + 280, rows, sizeof rows);
  volume = open_volume(folder.write("c.nii", file));
  EXPECT_EQ(scene::world_of_index(volume.source->geometry(), {3, 2, 1}), glm::dvec3(5 + 2, 6 + 9, 7 + 8));
}

TEST_F(VolumeFiles, NiftiSlopeAndInterceptApplyAndZeroSlopeMeansNone) {
  std::string file = test::nifti();
  put<float>(file, 112, 0.5f), put<float>(file, 116, -3);
  VolumeFile volume = open_volume(folder.write("a.nii", file));
  EXPECT_EQ(volume.range, (scene::ValueRange{-3, 8.5, 0}));
  EXPECT_EQ(volume.source->grid().value(4), -1);
  put<float>(file, 112, 0);
  EXPECT_EQ(open_volume(folder.write("b.nii", file)).range, (scene::ValueRange{0, 23, 0}));
}

TEST_F(VolumeFiles, NiftiOfTheOtherByteOrderReadsTheSame) {
  const std::string file = test::nifti();
  std::string other = file;
  const auto swap = [&](std::size_t at, std::size_t size) { std::reverse(&other[at], &other[at] + size); };
  swap(0, 4);
  for (std::size_t k = 0; k < 8; ++k) swap(40 + 2 * k, 2), swap(76 + 4 * k, 4);
  for (const std::size_t at : {70, 72, 252, 254}) swap(at, 2);
  swap(108, 4);
  for (std::size_t k = 0; k < 24; ++k) swap(352 + 2 * k, 2);
  EXPECT_EQ(all_samples(*open_volume(folder.write("a.nii", other)).source), counting<double>(24));
}

TEST_F(VolumeFiles, NiftiOfMoreDimensionsTooManySamplesOrTooFewBytesIsRefused) {
  std::string file = test::nifti();
  put<std::int16_t>(file, 40, 6), put<std::int16_t>(file, 52, 3);
  expect_refused(folder.write("six.nii", file), "6 dimensions");
  file = test::nifti();
  put<std::int16_t>(file, 40, 5);  // further dimensions have length one: still a volume
  EXPECT_NO_THROW(open_volume(folder.write("ones.nii", file)));
  for (const std::size_t at : {42, 44, 46}) put<std::int16_t>(file, at, 30000);
  expect_refused(folder.write("huge.nii", file), "but the file has 48");
  expect_refused(folder.write("short.nii", test::nifti().substr(0, 399)), "48 bytes");
  expect_refused(folder.write("header.nii", test::nifti().substr(0, 200)), "NIfTI header");
  file = test::nifti();
  put<std::int16_t>(file, 70, 32);
  expect_refused(folder.write("complex.nii", file), "data type 32");
  put<std::int16_t>(file, 70, 4), put<std::int16_t>(file, 46, 1);
  expect_refused(folder.write("flat.nii", file), "1 point along z");
}

TEST_F(VolumeFiles, NrrdSpaceDirectionsPlaceAndComponentsAreChosen) {
  const std::string head =
      "NRRD0005\n# comment\ntype: float\ndimension: 4\nsizes: 2 3 2 2\nspace: left-posterior-superior\n"
      "space directions: none (0,2,0) (-3,0,0) (0,0,4)\nspace origin: (1,2,3)\nkinds: vector domain domain domain\n"
      "endian: little\nencoding: raw\nuser:=key\n\n";
  const auto file = folder.write("a.nrrd", head + bytes_of(counting<float>(24)));
  const VolumeFile second = open_volume(file, {.field = "samples:y"});
  EXPECT_EQ(all_samples(*second.source)[3], 7);
  EXPECT_EQ(scene::world_of_index(second.source->geometry(), {1, 1, 1}), glm::dvec3(1 - 3, 2 + 2, 3 + 4));
  EXPECT_EQ(open_volume(file).source->grid().field_name, "samples:mag");
  expect_refused(file, "no field 'pressure'", {.field = "pressure"});
}

TEST_F(VolumeFiles, NrrdDetachedSkippedAndBigEndianSamplesAreRead) {
  folder.write("a.dat", std::string("skip") + std::string("\0\1\0\2\0\3\0\4\0\5\0\6\0\7\0\10", 16));
  const auto file =
      folder.write("a.nhdr",
                   "NRRD0001\ntype: ushort\ndimension: 3\nsizes: 2 2 2\nspacings: 1 nan 2\naxis mins: 5 0 0\nendian: "
                   "big\nencoding: raw\nbyte skip: 4\ndata file: a.dat\n");
  const VolumeFile volume = open_volume(file);
  EXPECT_EQ(all_samples(*volume.source), (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(volume.source->geometry().spacing, glm::dvec3(1, 1, 2));
  EXPECT_EQ(volume.source->geometry().origin, glm::dvec3(5, 0, 0));
}

TEST_F(VolumeFiles, NrrdSamplesMayBeTextHexadecimalWideOrAfterSkippedBytes) {
  const auto head = [](const std::string& type, const std::string& encoding, const std::string& more = "") {
    return "NRRD0004\ntype: " + type + "\ndimension: 3\nsizes: 2 2 2\nendian: little\nencoding: " + encoding + "\n" +
           more + "\n";
  };
  const std::vector<double> wanted{0, 1, -2, 3, 4, 5, 6, 127};
  const auto samples_of = [&](const std::string& content) {
    return all_samples(*open_volume(folder.write("a.nrrd", content)).source);
  };
  EXPECT_EQ(samples_of(head("int8", "ascii") + "0 1 -2\n3,4 5 +6\r\n127"), wanted);
  EXPECT_EQ(samples_of(head("float", "text") + "0 1e0 -2.0 3 4 5 6 127 beyond"), wanted);
  EXPECT_EQ(samples_of(head("signed char", "hex") + "00 01 fe\n03 04 05 06 7F"), wanted);
  const std::string bytes = bytes_of(std::vector<std::int8_t>(wanted.begin(), wanted.end()));
  EXPECT_EQ(samples_of(head("int8", "raw", "line skip: 2\nbyte skip: 1\n") + "one\ntwo\n?" + bytes), wanted);
  EXPECT_EQ(samples_of(head("longlong", "raw") + bytes_of(std::vector<std::int64_t>(wanted.begin(), wanted.end()))),
            wanted);
  const VolumeFile blank = open_volume(folder.write("b.nrrd", head("double", "text") + "0 1 2 nan 4 inf 6 7"));
  EXPECT_EQ(blank.range, (scene::ValueRange{0, 7, 2}));
}

TEST_F(VolumeFiles, NrrdFaultsAreNamed) {
  const auto with = [&](const std::string& lines) {
    return folder.write("a.nrrd", "NRRD0004\n" + lines + "\n" + std::string(8, 'x'));
  };
  expect_refused(with("type: uint8\ndimension: 3\nsizes: 2 2\nencoding: raw\n"), "2 sizes for 3 dimensions");
  expect_refused(with("type: uint8\ndimension: 3\nsizes: 2 2 -2\nencoding: raw\n"), "sizes is '-2'");
  expect_refused(with("type: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: bzip2\n"), "'bzip2'");
  expect_refused(with("type: block\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"), "'block'");
  expect_refused(with("type: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: hex\n"), "after 4 of 8 bytes");
  expect_refused(with("type: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n1 2 3 4 5 6 7 300 "), "'300 ");
  expect_refused(with("type: uint8\ndimension: 3\nsizes: 9000 9000 9000\nencoding: text\n"), "of 729000000000 numbers");
  expect_refused(with("type: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nline skip: 9\n"), "fewer lines");
  expect_refused(with("type: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: LIST\na.raw\nb.raw"),
                 "'a.raw', but there is no such file");
  expect_refused(with("type: uint16\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"),
                 "add a line 'endian: little', or big");
  expect_refused(with("type: uint8\ndimension: 3\nsizes: 2 2 3\nencoding: raw\n"), "12 bytes, but the file has 8");
  expect_refused(with("type: uint8\ndimension: 3\nsizes: 2 2 2\nspacings: 1 0 1\nencoding: raw\n"), "along y is 0");
  expect_refused(with("type: uint8\ndimension: 3\nsizes: 60000 60000 60000\nencoding: gzip\n"), "cannot contain");
  expect_refused(with("type: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: gone\n"), "no such file");
}

TEST_F(VolumeFiles, MetaImagePlacesScalesAndReadsLocalAndSeparateSamples) {
  const std::string head =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\n"
      "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 1 2 3\nElementSpacing = 2 3 4\nDimSize = 3 2 2\n"
      "ElementToIntensityFunctionSlope = 2\nElementToIntensityFunctionOffset = -1\nElementType = MET_SHORT\n";
  const std::string samples = bytes_of(counting<std::int16_t>(12));
  const VolumeFile local = open_volume(folder.write("a.mha", head + "ElementDataFile = LOCAL\n" + samples));
  folder.write("b.raw", "????" + samples);
  const VolumeFile separate = open_volume(folder.write("b.mhd", head + "HeaderSize = -1\nElementDataFile = b.raw\n"));
  for (const VolumeFile* volume : {&local, &separate}) {
    EXPECT_EQ(all_samples(*volume->source), counting<double>(12));
    EXPECT_EQ(volume->range, (scene::ValueRange{-1, 21, 0}));
    EXPECT_EQ(scene::world_of_index(volume->source->geometry(), {2, 1, 1}), glm::dvec3(1 - 3, 2 + 4, 3 + 4));
  }
  std::string text = head;
  text.replace(text.find("BinaryData = True"), 17, "BinaryData = False");
  EXPECT_EQ(
      all_samples(
          *open_volume(folder.write("t.mha", text + "ElementDataFile = LOCAL\n0 1 2 3 4 5 6 7 8 9 10 11\n")).source),
      counting<double>(12));
  std::string wide = head;
  wide.replace(wide.find("MET_SHORT"), 9, "MET_ULONG_LONG");
  EXPECT_EQ(all_samples(*open_volume(folder.write("w.mha", wide + "ElementDataFile = LOCAL\n" +
                                                               bytes_of(counting<std::uint64_t>(12))))
                             .source),
            counting<double>(12));
  expect_refused(folder.write("c.mha", head + "ElementDataFile = LOCAL\n" + samples.substr(1)), "but the file has 23");
  expect_refused(folder.write("d.mha", head), "no ElementDataFile");
  expect_refused(folder.write("e.mhd", "NDims = 2\nElementDataFile = LOCAL\n"), "2 dimensions");
  for (const char* folder_name : {"", ".", "..", "./"})
    expect_refused(folder.write("f.mhd", head + "ElementDataFile = " + folder_name + "\n"),
                   "f.mhd: ElementDataFile is '" + std::string(folder_name) + "', but there is no such file");
}

TEST_F(VolumeFiles, RawFilesAreDescribedByOptionsOrByName) {
  const std::string samples = bytes_of(counting<std::uint16_t>(24));
  const VolumeFile named = open_volume(folder.write("skull_4x3x2_uint16.raw", samples));
  EXPECT_EQ(all_samples(*named.source), counting<double>(24));
  ReadOptions options;
  options.dims = GridIndex{2, 3, 4};
  options.type = SampleType::uint16;
  options.spacing = glm::dvec3(1, 2, 0.5);
  options.skip = 3;
  const VolumeFile described = open_volume(folder.write("x.raw", "abc" + samples), options);
  EXPECT_EQ(described.source->geometry().points, (GridIndex{2, 3, 4}));
  EXPECT_EQ(described.source->geometry().spacing, glm::dvec3(1, 2, 0.5));
  expect_refused(folder.write("y.raw", samples), "dimensions and type");
  expect_refused(folder.write("y_4x3x3_uint16.raw", samples), "72 bytes, but the file has 48");
  expect_refused(folder.write("y_4x3x1_uint16.raw", samples), "1 point along z");
  expect_refused(folder.write("y_2x3x2_uint16.raw", samples), "24 bytes, but the file has 48");
  expect_refused(folder.write("y.nii", test::nifti()), "`dims`", options);
  expect_refused(folder.path(), "directory");
  expect_refused(folder / "absent.raw", "no such file");
}

TEST_F(VolumeFiles, NanSamplesAreCountedAndNothingElseIsRefused) {
  auto values = counting<float>(24);
  values[3] = std::nanf(""), values[8] = INFINITY;
  const VolumeFile volume = open_volume(folder.write("a_4x3x2_float32.raw", bytes_of(values)));
  EXPECT_EQ(volume.range, (scene::ValueRange{0, 23, 2}));
  EXPECT_NE(volume.notes.back().find("2 samples are NaN"), std::string::npos);
  expect_refused(folder.write("b_4x3x2_float32.raw", bytes_of(std::vector<float>(24, std::nanf("")))), "finite");
}

TEST_F(VolumeFiles, VtkImagesKeepExtentDirectionCellDataAndHiddenSamples) {
  TESSERA_VTK_OR_SKIP();
  const auto file = folder.write(
      "a.vti",
      "<?xml version=\"1.0\"?><VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\">"
      "<ImageData WholeExtent=\"5 7 0 1 0 1\" Origin=\"1 2 3\" Spacing=\"2 3 4\" Direction=\"0 -1 0 1 0 0 0 0 1\">"
      "<Piece Extent=\"5 7 0 1 0 1\"><CellData Scalars=\"c\">"
      "<DataArray type=\"Float32\" Name=\"c\" format=\"ascii\">1.5 2.5</DataArray>"
      "<DataArray type=\"Int64\" Name=\"long\" format=\"ascii\">-7 9</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"vtkGhostType\" format=\"ascii\">0 32</DataArray></CellData>"
      "</Piece></ImageData></VTKFile>");
  const VolumeFile volume = open_volume(file, {.field = "c"});
  const scene::GridGeometry& g = volume.source->geometry();
  EXPECT_EQ(g.association, Association::cell);
  EXPECT_EQ(g.points, (GridIndex{3, 2, 2}));
  EXPECT_EQ(g.samples(), (GridIndex{2, 1, 1}));
  EXPECT_EQ(g.origin, glm::dvec3(1, 2 + 10, 3));
  EXPECT_EQ(scene::world_of_index(g, {1, 1, 1}), glm::dvec3(1 - 3, 12 + 2, 3 + 4));
  EXPECT_EQ(volume.range, (scene::ValueRange{1.5, 1.5, 1}));
  const VolumeFile wide = open_volume(file, {.field = "long"});
  EXPECT_EQ(wide.source->grid().type, SampleType::float64);
  EXPECT_EQ(all_samples(*wide.source)[0], -7);
}

TEST_F(VolumeFiles, ImagesInPiecesAreOneAndGapsOrHugeExtentsAreRefused) {
  TESSERA_VTK_OR_SKIP();
  const auto piece = [](const std::string& extent, const std::string& numbers) {
    return "<?xml version=\"1.0\"?><VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\"><ImageData "
           "WholeExtent=\"" +
           extent + "\" Origin=\"1 2 3\" Spacing=\"2 3 4\" Direction=\"0 -1 0 1 0 0 0 0 1\"><Piece Extent=\"" + extent +
           "\"><PointData Scalars=\"c\"><DataArray type=\"Float32\" Name=\"c\" format=\"ascii\">" + numbers +
           "</DataArray></PointData></Piece></ImageData></VTKFile>";
  };
  folder.write("p0.vti", piece("0 1 0 1 0 1", "0 1 3 4 6 7 9 10"));
  folder.write("p1.vti", piece("1 2 0 1 0 1", "1 2 4 5 7 8 10 11"));
  const auto whole = [](const std::string& extent, const std::string& second) {
    return "<?xml version=\"1.0\"?><VTKFile type=\"PImageData\" version=\"1.0\" "
           "byte_order=\"LittleEndian\"><PImageData "
           "WholeExtent=\"" +
           extent +
           "\" GhostLevel=\"0\" Origin=\"1 2 3\" Spacing=\"2 3 4\"><PPointData Scalars=\"c\"><PDataArray "
           "type=\"Float32\" Name=\"c\"/></PPointData><Piece Extent=\"0 1 0 1 0 1\" Source=\"p0.vti\"/>" +
           second + "</PImageData></VTKFile>";
  };
  const std::string second = "<Piece Extent=\"1 2 0 1 0 1\" Source=\"p1.vti\"/>";
  const VolumeFile volume = open_volume(folder.write("p.pvti", whole("0 2 0 1 0 1", second)));
  EXPECT_EQ(all_samples(*volume.source), counting<double>(12));
  EXPECT_EQ(volume.source->geometry().origin, glm::dvec3(1, 2, 3));
  // Direction of the pieces; VTK's reader drops it.
  EXPECT_EQ(volume.source->geometry().direction[0], glm::dvec3(0, 1, 0));
  expect_refused(folder.write("gap.pvti", whole("0 2 0 1 0 1", "")), "1 of its 2 cells");
  expect_refused(folder.write("huge.pvti", whole("0 1000 0 1000 0 1000", second)), "cells");
  expect_refused(folder.write("gone.pvti", whole("0 2 0 1 0 1", "<Piece Extent=\"1 2 0 1 0 1\" Source=\"no.vti\"/>")),
                 "no such file");
  const std::string numbers = "1 2 4 5 7 8 10 11", extent = "1 2 0 1 0 1";
  const std::tuple<const char*, std::string, const char*> wrong[] = {
      {"few", piece(extent, "1 2 4"), "few.vti: "},
      {"cut", piece(extent, numbers).substr(0, 300), "cut.vti: "},
      {"elsewhere", piece("5 6 0 1 0 1", numbers), "elsewhere.vti: its points are 5 6"},
      {"name", piece(extent, numbers), "array 'c' is missing"},
      {"type", piece(extent, numbers), "array 'c' is double x 1"},
      {"components", piece(extent, numbers + " " + numbers), "array 'c' is float x 2"}};
  for (auto [name, text, words] : wrong) {
    SCOPED_TRACE(name);
    const auto replace = [&, &text = text](const std::string& old, const std::string& by) {
      for (std::size_t at = text.find(old); at != std::string::npos; at = text.find(old, at + by.size()))
        text.replace(at, old.size(), by);
    };
    if (name == std::string("name")) replace("\"c\"", "\"d\"");
    if (name == std::string("type")) replace("Float32", "Float64");
    if (name == std::string("components")) replace("Name=\"c\"", "Name=\"c\" NumberOfComponents=\"2\"");
    folder.write(name + std::string(".vti"), text);
    expect_refused(
        folder.write(name + std::string(".pvti"),
                     whole("0 2 0 1 0 1", "<Piece Extent=\"1 2 0 1 0 1\" Source=\"" + std::string(name) + ".vti\"/>")),
        words);
  }
  expect_refused(folder.write("huge.vti", piece("0 1500 0 1500 0 1500", "1 2")), "damaged");
}

TEST_F(VolumeFiles, RectilinearGridsInPiecesAreOneVolumeAndBadPiecesAreNamed) {
  TESSERA_VTK_OR_SKIP();
  const std::string head = "<?xml version=\"1.0\"?><VTKFile version=\"1.0\" byte_order=\"LittleEndian\" type=\"";
  const auto piece = [&](const std::string& extent, const std::string& x, const std::string& numbers) {
    const auto array = [](const std::string& type, const std::string& name, const std::string& values) {
      return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"ascii\">" + values + "</DataArray>";
    };
    return head + "RectilinearGrid\"><RectilinearGrid WholeExtent=\"" + extent + "\"><Piece Extent=\"" + extent +
           "\"><PointData Scalars=\"c\">" + array("Float32", "c", numbers) + "</PointData><Coordinates>" +
           array("Float64", "x", x) + array("Float64", "y", "0 2") + array("Float64", "z", "-1 1") +
           "</Coordinates></Piece></RectilinearGrid></VTKFile>";
  };
  const std::string left = "0 1 0 1 0 1", right = "1 3 0 1 0 1", all = "0 3 0 1 0 1";
  const std::string right_numbers = "1 2 3 5 6 7 9 10 11 13 14 15";
  folder.write("p0.vtr", piece(left, "0.1 1", "0 1 4 5 8 9 12 13"));
  folder.write("p1.vtr", piece(right, "1 3 9", right_numbers));
  const auto part = [](const std::string& extent, const std::string& file) {
    return "<Piece Extent=\"" + extent + "\" Source=\"" + file + "\"/>";
  };
  const auto whole = [&](const std::string& extent, const std::string& pieces) {
    return head + "PRectilinearGrid\"><PRectilinearGrid WholeExtent=\"" + extent +
           "\" GhostLevel=\"0\"><PPointData Scalars=\"c\"><PDataArray type=\"Float32\" Name=\"c\"/></PPointData>"
           "<PCoordinates><PDataArray type=\"Float64\" Name=\"x\"/><PDataArray type=\"Float64\" Name=\"y\"/>"
           "<PDataArray type=\"Float64\" Name=\"z\"/></PCoordinates>" +
           pieces + "</PRectilinearGrid></VTKFile>";
  };
  const std::string first = part(left, "p0.vtr");
  const auto file = folder.write("p.pvtr", whole(all, first + part(right, "p1.vtr")));
  EXPECT_TRUE(is_volume(file));
  const VolumeFile volume = open_volume(file);
  EXPECT_EQ(all_samples(*volume.source), counting<double>(16));
  EXPECT_EQ(volume.source->geometry().coordinates[0], (std::vector<double>{0.1, 1, 3, 9}));
  EXPECT_EQ(volume.source->geometry().points, (GridIndex{4, 2, 2}));
  EXPECT_EQ(read_mesh(file).counts.cells_read, 3u);  // convert reads its cells as a mesh

  const auto with = [&](const std::string& name) { return whole(all, first + part(right, name)); };
  expect_refused(folder.write("gap.pvtr", whole(all, first)), "1 of its 3 cells");
  expect_refused(folder.write("twice.pvtr", whole(all, first + first + first)), "1 of its 3 cells");
  expect_refused(folder.write("gone.pvtr", with("no.vtr")), "no.vtr: there is no such file");
  expect_refused(folder.write("mesh.pvtr", with("p.pvtr")), "p.pvtr: it is a piece of");
  expect_refused(folder.write("huge.pvtr", whole("0 1500 0 1500 0 1500", first)), "1 of its 3375000000 cells");
  expect_refused(folder.write("claims.pvtr", whole(all, first + part(all, "p1.vtr"))), "p1.vtr: its points are 1 3");
  folder.write("cut.vtr", piece(right, "1 3 9", right_numbers).substr(0, 300));
  expect_refused(folder.write("cut.pvtr", with("cut.vtr")), "cut.vtr");
  folder.write("moved.vtr", piece(right, "1.5 3 9", right_numbers));
  expect_refused(folder.write("moved.pvtr", with("moved.vtr")), "point 1 along x is at 1");
  folder.write("few.vtr", piece(right, "1 3 9", "1 2 3"));
  expect_refused(folder.write("few.pvtr", with("few.vtr")), "few.vtr: ");
  folder.write("short.vtr", piece(right, "1 3", right_numbers));
  expect_refused(folder.write("short.pvtr", with("short.vtr")), "short.vtr: ");
  std::string other = piece(right, "1 3 9", right_numbers);
  folder.write("other.vtr", other.replace(other.find("Name=\"c\""), 8, "Name=\"d\""));
  expect_refused(folder.write("other.pvtr", with("other.vtr")), "array 'c' is missing");
}

TEST_F(VolumeFiles, FallingRectilinearCoordinatesAreReversed) {
  TESSERA_VTK_OR_SKIP();
  const auto file = folder.write("a.vtk",
                                 "# vtk DataFile Version 3.0\nt\nASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 3 2 2\n"
                                 "X_COORDINATES 3 double\n4 1 0\nY_COORDINATES 2 float\n0 2\nZ_COORDINATES 2 float\n"
                                 "1 9\nPOINT_DATA 12\nSCALARS s float 1\nLOOKUP_TABLE default\n"
                                 "0 1 2 3 4 5 6 7 8 9 10 11\n");
  const VolumeFile volume = open_volume(file);
  const scene::GridGeometry& g = volume.source->geometry();
  EXPECT_EQ(scene::world_of_index(g, {0, 0, 0}), glm::dvec3(4, 0, 1));
  EXPECT_EQ(scene::world_of_index(g, {1, 1, 1}), glm::dvec3(1, 2, 9));
  EXPECT_EQ(all_samples(*volume.source)[2], 2);
  EXPECT_EQ(scene::bounds(g), (scene::Box{{0, 0, 1}, {4, 2, 9}}));
}

/// A volume of odd sizes with every property that formats may lose.
scene::Grid wavy_grid() {
  scene::Grid grid;
  grid.geometry.points = {21, 10, 17};
  grid.geometry.spacing = {0.1, 0.7, 3};
  grid.geometry.origin = {1e6, -2, 0.3};
  grid.field_name = "a \"b\" <c>";
  return grid;
}
std::vector<float> wavy_values() {
  std::vector<float> values(21 * 10 * 17);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(static_cast<float>(i));
  values[77] = std::nanf("");
  return values;
}

TEST_F(VolumeFiles, RoundTripsUnchanged) {
  const auto source = scene::MemorySource::of(wavy_grid(), wavy_values());
  const auto expected = all_samples(*source);
  for (const std::string& name : names_written()) {
    SCOPED_TRACE(name);
    write_volume(*source, folder / name, 8);
    const VolumeFile back = open_volume(folder / name);
    const auto values = all_samples(*back.source);
    for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_TRUE(i == 77 || values[i] == expected[i]) << i;
    EXPECT_TRUE(std::isnan(values[77]));
    EXPECT_EQ(back.range, scene::value_range(*source));
    if (name.ends_with(".raw")) continue;
    const glm::dvec3 corner = scene::world_of_index(back.source->geometry(), {20, 9, 16});
    EXPECT_LT(glm::length(corner - scene::world_of_index(source->geometry(), {20, 9, 16})), 1e-9);
  }
}

TEST_F(VolumeFiles, ABrickFileWhoseCountsAreNoWholeNumbersIsRefused) {
  write_volume(*scene::MemorySource::of(wavy_grid(), wavy_values()), folder / "a.bricks", 8);
  std::ifstream in(folder / "a.bricks", std::ios::binary);
  const std::string intact(std::istreambuf_iterator<char>(in), {});
  std::uint64_t length = 0;
  std::memcpy(&length, intact.data() + 8, sizeof length);
  for (const char* word : {"\"block\":", "\"blanks\":", "\"points\":["}) {
    std::string header = intact.substr(16, length);
    const std::size_t at = header.find(word);
    ASSERT_NE(at, std::string::npos) << word;
    const std::size_t number = at + std::string_view(word).size();
    header.replace(number, header.find_first_of(",]}", number) - number, "1e38");
    const std::uint64_t longer = header.size();
    std::ofstream out(folder / "b.bricks", std::ios::binary);
    out.write(intact.data(), 8).write(reinterpret_cast<const char*>(&longer), sizeof longer);
    out << header << intact.substr(16 + length);
    out.close();
    EXPECT_EQ(io::testing::message_of([&] { open_volume(folder / "b.bricks"); }),
              (folder / "b.bricks").string() +
                  ": its header lacks a keyword or a number; the file is truncated or damaged, write it again")
        << word;
  }
}

TEST_F(VolumeFiles, ABrickFileKeepsGeometryScaleAndRangesAndReadsAnyBox) {
  scene::Grid grid = wavy_grid();
  grid.geometry.association = Association::cell;
  grid.geometry.points = {22, 11, 18};
  grid.geometry.direction = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  grid.geometry.coordinates[1] = {0, 1, 2, 4, 8, 9, 10, 11, 12, 13, 14.5};
  grid.scale = -0.25;
  grid.shift = 3;
  const auto source = scene::MemorySource::of(grid, wavy_values());
  write_volume(*source, folder / "a.bricks", 8);
  const VolumeFile back = open_volume(folder / "a.bricks");
  EXPECT_EQ(back.source->geometry(), grid.geometry);
  EXPECT_EQ(back.source->grid().scale, -0.25);
  EXPECT_EQ(back.range, scene::value_range(*source));
  for (const scene::SampleBox box : {scene::SampleBox{{0, 0, 0}, {21, 10, 17}},
                                     {{7, 7, 7}, {9, 9, 9}},
                                     {{8, 0, 8}, {16, 8, 16}},
                                     {{20, 9, 16}, {21, 10, 17}},
                                     {{0, 0, 7}, {21, 1, 9}}}) {
    std::vector<float> ours(static_cast<std::size_t>(box.count())), theirs(ours.size());
    source->read(box, std::span(ours));
    back.source->read(box, std::span(theirs));
    EXPECT_EQ(bytes_of(ours), bytes_of(theirs));
    scene::ValueRange seen;
    for (const float v : ours)
      if (std::isfinite(v)) {
        seen.low = std::min(seen.low, grid.value(v));
        seen.high = std::max(seen.high, grid.value(v));
      }
    const auto known = back.source->known_range(box);
    ASSERT_TRUE(known);
    EXPECT_LE(known->low, seen.low);
    EXPECT_GE(known->high, seen.high);
  }
}

TEST_F(VolumeFiles, EvenRectilinearCoordinatesMakeARegularGridDespiteRounding) {
  TESSERA_VTK_OR_SKIP();
  const auto geometry = [&](const std::string& type, const std::string& axis) {
    const std::string array = "<DataArray type=\"" + type + "\" format=\"ascii\">" + axis + "</DataArray>";
    folder.write(
        "a.vtr",
        "<VTKFile type=\"RectilinearGrid\" version=\"1.0\" byte_order=\"LittleEndian\">"
        "<RectilinearGrid WholeExtent=\"0 3 0 3 0 3\"><Piece Extent=\"0 3 0 3 0 3\"><PointData>"
        "<DataArray type=\"UInt8\" Name=\"f\" format=\"ascii\">" +
            [] {
              std::string samples;
              for (int i = 0; i < 64; ++i) samples += std::to_string(i) + " ";
              return samples;
            }() +
            "</DataArray></PointData><Coordinates>" + array + array + array +
            "</Coordinates></Piece></RectilinearGrid></VTKFile>");
    return open_volume(folder / "a.vtr").source->geometry();
  };
  for (const char* type : {"Float32", "Float64", "Int32"}) {
    const bool whole = std::string(type) == "Int32";
    const scene::GridGeometry even = geometry(type, whole ? "5 8 11 14" : "-0.7 -0.6 -0.5 -0.4");
    EXPECT_FALSE(even.rectilinear()) << type;
    const double first = whole ? 5 : -0.7, last = whole ? 14 : -0.4,
                 place = std::string(type) == "Float32" ? 5e-8 : 1e-15;
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(scene::world_of_index(even, {0, 0, 0})[a], first, place) << type;
      EXPECT_NEAR(scene::world_of_index(even, {3, 3, 3})[a], last, place) << type;
    }
    // Reversed.
    const scene::GridGeometry falling = geometry(type, whole ? "14 11 8 5" : "-0.4 -0.5 -0.6 -0.7");
    EXPECT_FALSE(falling.rectilinear()) << type;
    EXPECT_NEAR(scene::world_of_index(falling, {0, 0, 0}).x, last, place) << type;
    EXPECT_NEAR(scene::world_of_index(falling, {3, 0, 0}).x, first, place) << type;
  }
  // The deviation exceeds the rounding error of the coordinates' type.
  EXPECT_TRUE(geometry("Float32", "-0.7 -0.6 -0.500001 -0.4").rectilinear());
  EXPECT_TRUE(geometry("Float64", "-0.7 -0.6 -0.50000001 -0.4").rectilinear());
  EXPECT_TRUE(geometry("Int32", "5 8 12 14").rectilinear());
  // The coordinates are so far from zero that rounding is a large part of a step.
  EXPECT_TRUE(geometry("Float32", "1e6 1000000.125 1000000.1875 1000000.375").rectilinear());
}

TEST_F(VolumeFiles, FormatsRefuseWhatTheyCannotStore) {
  scene::Grid grid = wavy_grid();
  grid.geometry.coordinates[1] = counting<double>(10);
  const auto rectilinear = scene::MemorySource::of(grid, wavy_values());
  EXPECT_THROW(write_volume(*rectilinear, folder / "a.vti"), scene::Error);
  grid = wavy_grid();
  grid.geometry.association = Association::cell;
  grid.geometry.points = {22, 11, 18};
  EXPECT_THROW(write_volume(*scene::MemorySource::of(grid, wavy_values()), folder / "a.nrrd"), scene::Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  // Formats suggested by a message can be written.
  for (const bool cell : {false, true})
    for (const bool is_rectilinear : {false, true})
      for (const bool is_turned : {false, true}) {
        grid = wavy_grid();
        if (cell) grid.geometry.association = Association::cell, grid.geometry.points = {22, 11, 18};
        grid.geometry.direction = is_turned ? glm::dmat3{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}} : glm::dmat3(1);
        if (is_rectilinear) {
          grid.geometry.coordinates[1] = counting<double>(cell ? 11 : 10);
          grid.geometry.coordinates[1].back() += 0.5;
        }
        const auto source = scene::MemorySource::of(grid, wavy_values());
        for (const std::string extension : {".vti", ".vtr", ".nrrd", ".raw"}) {
          const std::string message = testing::message_of([&] { write_volume(*source, folder / ("a" + extension)); });
          if (message.empty()) continue;
          const std::string others = message.substr(message.find("; write "));
          for (const std::string other : {".vti", ".vtr", ".nrrd", ".bricks"})
            EXPECT_EQ(testing::message_of([&] { write_volume(*source, folder / ("b" + other)); }).empty(),
                      others.find(other) != std::string::npos)
                << message;
        }
      }
}

/// Every format, truncated and with bytes changed: opened, or refused in one line, never a crash.
TEST_F(VolumeFiles, DamagedFilesAreRefusedOrReadButNeverCrash) {
  const auto source = scene::MemorySource::of(wavy_grid(), wavy_values());
  for (const std::string& name : names_written()) write_volume(*source, folder / name, 8);
  folder.write("a.nii", test::nifti());
  folder.write("a.mha",
               "ObjectType = Image\nNDims = 3\nDimSize = 3 2 2\nElementType = MET_UCHAR\nElementSpacing = 1 1 1\n"
               "ElementDataFile = LOCAL\nabcdefghijkl");
  if (has_reader(Reader::vtk) && std::filesystem::exists(volumes))
    std::filesystem::copy_file(volumes / "carotid.vtk", folder / "carotid.vtk");
  for (const std::string& name : folder.names()) {
    SCOPED_TRACE(name);
    const std::string original = test::contents(folder / name);
    const auto opened = [&](const std::string& bytes) {
      const auto file = folder.write("damaged_" + name, bytes);
      const test::Fault fault = test::fault_of([&] { all_samples(*open_volume(file).source); });
      if (!fault.code) return true;
      EXPECT_EQ(fault.code, scene::ErrorCode::bad_input) << fault.message;
      EXPECT_EQ(fault.message.find('\n'), std::string::npos) << fault.message;
      return false;
    };
    ASSERT_TRUE(opened(original));
    for (std::size_t k = 0; k < 24; ++k) {
      const std::size_t size = (original.size() - 12) * k / 24 + 1;  // text may lack its last line end
      EXPECT_FALSE(opened(original.substr(0, size))) << size << " of " << original.size() << " bytes";
    }
    for (unsigned seed = 1; seed <= 40; ++seed) {
      SCOPED_TRACE(seed);
      std::mt19937 random(seed);
      std::string bytes = original;
      const std::size_t reach = std::min(bytes.size(), std::size_t{700});
      for (unsigned k = 0; k < 1 + seed % 4; ++k) bytes[random() % reach] = static_cast<char>(random());
      opened(bytes);
    }
  }
}

}  // namespace
}  // namespace tessera::io
