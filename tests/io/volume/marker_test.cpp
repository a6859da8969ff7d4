// SPDX-License-Identifier: BSD-3-Clause
// The 48 orientations of every medical format that this test can write: left stays left.
#include "support/marker.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "io/files/reader_programs.hpp"
#include "io/volume/volume_writer.hpp"
#include "support/dicom_writing.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_bytes.hpp"

namespace tessera::io::marker_test {
namespace {

using test::MarkedVolume;
using test::put;

std::string nifti_of(const MarkedVolume& v) {
  std::string file = test::nifti_header();
  for (std::size_t a = 0; a < 3; ++a) {
    put<std::int16_t>(file, 42 + 2 * a, static_cast<std::int16_t>(v.size[a]));
    put<float>(file, 80 + 4 * a, static_cast<float>(v.spacing[static_cast<int>(a)]));
  }
  return file + test::bytes_of(v.samples());
}

std::string nifti_by_sform(const MarkedVolume& v) {
  std::string file = nifti_of(v);
  put<std::int16_t>(file, 254, 1);
  for (int row = 0; row < 3; ++row) {
    const auto at = 280 + 16 * static_cast<std::size_t>(row);
    for (int a = 0; a < 3; ++a)
      put<float>(file, at + 4 * static_cast<std::size_t>(a), static_cast<float>(v.axes[a][row] * v.spacing[a]));
    put<float>(file, at + 12, static_cast<float>(v.origin[row]));
  }
  return file;
}

/// The unit quaternion (a, b, c, d), a >= 0, of a rotation: the largest component from the diagonal, the others from
/// sums and differences across it.
std::array<double, 4> quaternion_of(const glm::dmat3& columns) {
  const auto r = [&](int row, int column) { return columns[column][row]; };
  const double trace = r(0, 0) + r(1, 1) + r(2, 2);
  std::array<double, 4> q{
      std::sqrt(std::max(0.0, 1 + trace)) / 2, std::sqrt(std::max(0.0, 1 + 2 * r(0, 0) - trace)) / 2,
      std::sqrt(std::max(0.0, 1 + 2 * r(1, 1) - trace)) / 2, std::sqrt(std::max(0.0, 1 + 2 * r(2, 2) - trace)) / 2};
  if (q[0] > 1e-3) {
    q[1] = std::copysign(q[1], r(2, 1) - r(1, 2)), q[2] = std::copysign(q[2], r(0, 2) - r(2, 0));
    q[3] = std::copysign(q[3], r(1, 0) - r(0, 1));
  } else if (q[1] > 1e-3) {
    q[2] = std::copysign(q[2], r(0, 1) + r(1, 0)), q[3] = std::copysign(q[3], r(0, 2) + r(2, 0));
  } else {
    q[3] = std::copysign(q[3], r(1, 2) + r(2, 1));
  }
  return q;
}

std::string nifti_by_qform(const MarkedVolume& v) {
  std::string file = nifti_of(v);
  glm::dmat3 rotation = v.axes;
  const bool is_mirrored = glm::determinant(rotation) < 0;
  if (is_mirrored) rotation[2] = -rotation[2];
  put<std::int16_t>(file, 252, 1);
  put<float>(file, 76, is_mirrored ? -1 : 1);
  const auto q = quaternion_of(rotation);
  for (std::size_t k = 0; k < 3; ++k) {
    put<float>(file, 256 + 4 * k, static_cast<float>(q[k + 1]));
    put<float>(file, 268 + 4 * k, static_cast<float>(v.origin[static_cast<int>(k)]));
  }
  return file;
}

std::string comma_vector(const glm::dvec3& v) { return fmt::format("({},{},{})", v.x, v.y, v.z); }

/// `signs` converts x, y and z of the file's space to right-anterior-superior.
std::string nrrd_of(const MarkedVolume& v, const char* space, const glm::dvec3& signs) {
  std::string head = fmt::format(
      "NRRD0005\ntype: short\ndimension: 3\nsizes: {} {} {}\nencoding: raw\nendian: little\nspace: {}\n"
      "space directions:",
      v.size[0], v.size[1], v.size[2], space);
  for (int a = 0; a < 3; ++a) head += " " + comma_vector(signs * v.axes[a] * v.spacing[a]);
  return head + "\nspace origin: " + comma_vector(signs * v.origin) + "\n\n" + test::bytes_of(v.samples());
}

/// As written by ITK: coordinates left, posterior, superior, and letters for where the axes start.
std::string meta_of(const MarkedVolume& v) {
  std::string matrix, letters = v.letters();
  for (int a = 0; a < 3; ++a) {
    const glm::dvec3 axis = test::turned_to_lps(v.axes[a]);
    matrix += fmt::format(" {} {} {}", axis.x, axis.y, axis.z);
  }
  constexpr std::string_view here = "RLAPSI", opposite = "LRPAIS";
  for (char& letter : letters) letter = opposite[here.find(letter)];
  const glm::dvec3 origin = test::turned_to_lps(v.origin);
  return fmt::format(
             "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = "
             "False\nTransformMatrix ={}\nOffset = {} {} {}\nCenterOfRotation = 0 0 0\nAnatomicalOrientation = {}\n"
             "ElementSpacing = {} {} {}\nDimSize = {} {} {}\nElementType = MET_SHORT\nElementDataFile = LOCAL\n",
             matrix, origin.x, origin.y, origin.z, letters, v.spacing.x, v.spacing.y, v.spacing.z, v.size[0], v.size[1],
             v.size[2]) +
         test::bytes_of(v.samples());
}

std::string cosines_of(const MarkedVolume& v) {
  const glm::dvec3 row = test::turned_to_lps(v.axes[0]), column = test::turned_to_lps(v.axes[1]);
  return fmt::format("{}\\{}\\{}\\{}\\{}\\{}", row.x, row.y, row.z, column.x, column.y, column.z);
}

std::string dicom_frames_of(const MarkedVolume& v) {
  test::DicomFrames file{.columns = v.size[0], .rows = v.size[1]};
  file.shared = test::dicom_orientation(cosines_of(v)) + test::dicom_measures(v.spacing.y, v.spacing.x, v.spacing.z);
  for (int k = 0; k < v.size[2]; ++k)
    file.each.push_back(test::dicom_position(test::turned_to_lps(v.place({0, 0, k}))));
  file.frames = file.each.size();
  file.samples = v.samples();
  return test::dicom_file(file);
}

/// One file per slice, named in reverse order.
std::filesystem::path write_slices(const std::filesystem::path& folder, const MarkedVolume& v) {
  std::filesystem::create_directories(folder);
  const std::vector<std::int16_t> all = v.samples();
  const auto each = static_cast<std::size_t>(v.size[0] * v.size[1]);
  for (int k = 0; k < v.size[2]; ++k) {
    const glm::dvec3 p = test::turned_to_lps(v.place({0, 0, k}));
    test::DicomFrames file{.storage = "1.2.840.10008.5.1.4.1.1.2", .columns = v.size[0], .rows = v.size[1]};
    file.above = test::dicom_element(0x20, 0xe, "UI", "1.2.3") +
                 test::dicom_element(0x20, 0x13, "IS", fmt::format("{}", 9 - k)) +
                 test::dicom_element(0x20, 0x32, "DS", fmt::format("{}\\{}\\{}", p.x, p.y, p.z)) +
                 test::dicom_element(0x20, 0x37, "DS", cosines_of(v));
    file.spacing = fmt::format("{}\\{}", v.spacing.y, v.spacing.x);
    file.frames = 1;
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(each) * k;
    file.samples.assign(first, first + static_cast<std::ptrdiff_t>(each));
    std::ofstream(folder / fmt::format("{}.dcm", 9 - k), std::ios::binary) << test::dicom_file(file);
  }
  return folder;
}

TEST(Marker, LeftIsLeftInAllOrientationsOfFilesReadHere) {
  const test::TemporaryFolder folder;
  const auto in = [&](const char* name, const std::function<std::string(const MarkedVolume&)>& bytes) {
    return [&folder, name, bytes](const MarkedVolume& v) { return folder.write(name, bytes(v)); };
  };
  const auto nrrd = [](const char* space, const glm::dvec3& signs) {
    return [space, signs](const MarkedVolume& v) { return nrrd_of(v, space, signs); };
  };
  test::expect_markers({{"NIfTI sform", in("s.nii", nifti_by_sform)},
                        {"NIfTI qform", in("q.nii", nifti_by_qform)},
                        {"NRRD RAS", in("r.nrrd", nrrd("RAS", {1, 1, 1}))},
                        {"NRRD LPS", in("l.nrrd", nrrd("left-posterior-superior", {-1, -1, 1}))},
                        {"NRRD LAS", in("a.nrrd", nrrd("left-anterior-superior", {-1, 1, 1}))},
                        {"MetaImage", in("m.mha", meta_of)}});
}

/// The normal of the slices is row x column, so half of the orientations need the files in another order.
TEST(Marker, LeftIsLeftInAllOrientationsOfDicom) {
  if (!has_reader(Reader::dicom)) GTEST_SKIP() << "tessera-read-dicom is not installed";
  const test::TemporaryFolder folder;
  test::expect_markers(
      {{"DICOM frames", [&](const MarkedVolume& v) { return folder.write("f.dcm", dicom_frames_of(v)); }},
       {"DICOM slices", [&](const MarkedVolume& v) { return write_slices(folder / "slices", v); }}});
}

TEST(Marker, ConvertedFilesKeepThePatientsAxesInAllOrientations) {
  const test::TemporaryFolder folder;
  const auto converted = [&](const char* name, const std::function<std::string(const MarkedVolume&)>& bytes) {
    return [&folder, name, bytes](const MarkedVolume& v) {
      const VolumeFile volume = open_volume(folder.write("in", bytes(v)));
      write_volume(*volume.source, folder / name, 8, volume.body_axes, volume.tags);
      return folder / name;
    };
  };
  test::expect_markers({{".bricks of NIfTI", converted("n.bricks", nifti_by_sform)},
                        {".nrrd of NIfTI", converted("n.nrrd", nifti_by_sform)},
                        {".nrrd of MetaImage", converted("m.nrrd", meta_of)},
                        {".bricks of MetaImage", converted("m.bricks", meta_of)}});
}

TEST(Marker, ConvertedVtkFilesKeepThePatientsAxesInAllOrientations) {
  const test::TemporaryFolder folder;
  test::expect_markers({{".vti of NIfTI", [&](const MarkedVolume& v) {
                           const VolumeFile volume = open_volume(folder.write("in.nii", nifti_by_sform(v)));
                           write_volume(*volume.source, folder / "n.vti", 8, volume.body_axes, volume.tags);
                           return folder / "n.vti";
                         }}});
}

}  // namespace
}  // namespace tessera::io::marker_test
