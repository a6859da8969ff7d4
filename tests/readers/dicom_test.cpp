// SPDX-License-Identifier: BSD-3-Clause
// DICOM series, written here byte by byte (PS3.5, explicit little-endian elements).
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "io/files/reader_programs.hpp"
#include "io/formats/identify.hpp"
#include "io/volume/volume_formats.hpp"
#include "support/dicom_writing.hpp"
#include "support/read_files.hpp"
#include "support/some_cases.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_bytes.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io {
namespace {

using scene::GridIndex;
using test::all_samples;
constexpr auto element = test::dicom_element;
constexpr auto little = test::dicom_little;
using test::expect_no_volume;
using test::has_note;

struct Slice {
  double z = 0;
  double shift = 0;  ///< to the left
  std::string series = "1.2.3";
  int number = 1;
  double slope = 1, intercept = 0;
  int time = 0;  ///< 0: not stated
  std::string image_type = "ORIGINAL\\PRIMARY";
  int columns = 4, rows = 3, colours = 1;
  std::string spacing = "0.75\\0.5";
  bool is_placed = true;
  std::vector<std::int16_t> samples{};
  std::vector<std::int16_t> padding{};  ///< empty, a value, or a value and the limit of a range
  bool is_deflated = false;
  bool is_wide = false;  ///< samples are the upper halves of unsigned 32-bit numbers; all lower halves are 1
};

constexpr const char* ct_storage = "1.2.840.10008.5.1.4.1.1.2";

/// Without a header, padded to an even number of bytes (PS3.5, A.5).
std::string deflated(const std::string& bytes) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out + stream.total_out % 2);
  deflateEnd(&stream);
  return packed;
}

std::string dicom(const Slice& s) {
  const std::uint32_t bits = s.colours > 1 ? 8 : s.is_wide ? 32 : 16;
  const std::string about = element(2, 2, "UI", ct_storage) + element(2, 3, "UI", fmt::format("1.2.{}", s.number)) +
                            element(2, 0x10, "UI", s.is_deflated ? "1.2.840.10008.1.2.1.99" : "1.2.840.10008.1.2.1");
  std::string data = element(8, 8, "CS", s.image_type) + element(8, 0x16, "UI", ct_storage) +
                     element(8, 0x60, "CS", "CT") + element(0x18, 0x50, "DS", "2") +
                     element(0x20, 0xe, "UI", s.series) + element(0x20, 0x13, "IS", fmt::format("{}", s.number)) +
                     (s.is_placed ? element(0x20, 0x32, "DS", fmt::format("{}\\-20\\{}", 10 + s.shift, s.z)) : "") +
                     element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0");
  if (s.time > 0) data += element(0x20, 0x100, "IS", fmt::format("{}", s.time));
  data += element(0x28, 2, "US", little(static_cast<std::uint32_t>(s.colours), 2)) +
          element(0x28, 4, "CS", s.colours == 1 ? "MONOCHROME2" : "RGB");
  if (s.colours > 1) data += element(0x28, 6, "US", little(0, 2));
  data += element(0x28, 0x10, "US", little(static_cast<std::uint32_t>(s.rows), 2)) +
          element(0x28, 0x11, "US", little(static_cast<std::uint32_t>(s.columns), 2)) +
          element(0x28, 0x30, "DS", s.spacing) + element(0x28, 0x100, "US", little(bits, 2)) +
          element(0x28, 0x101, "US", little(bits, 2)) + element(0x28, 0x102, "US", little(bits - 1, 2)) +
          element(0x28, 0x103, "US", little(bits == 16 ? 1 : 0, 2));
  for (std::size_t k = 0; k < s.padding.size(); ++k)
    data +=
        element(0x28, 0x120 + static_cast<std::uint32_t>(k), "SS", little(static_cast<std::uint16_t>(s.padding[k]), 2));
  data += element(0x28, 0x1052, "DS", fmt::format("{}", s.intercept)) +
          element(0x28, 0x1053, "DS", fmt::format("{}", s.slope)) + element(0x28, 0x1054, "LO", "HU");
  std::string samples = s.colours == 1 ? test::bytes_of(s.samples)
                                       : std::string(static_cast<std::size_t>(s.columns * s.rows * s.colours), 'c');
  if (s.is_wide) {
    samples.clear();
    for (const std::int16_t upper : s.samples) samples += little(1, 2) + little(static_cast<std::uint16_t>(upper), 2);
  }
  data += element(0x7fe0, 0x10, "OW", samples);
  return std::string(128, '\0') + "DICM" + element(2, 0, "UL", little(static_cast<std::uint32_t>(about.size()), 4)) +
         about + (s.is_deflated ? deflated(data) : data);
}

/// Samples first, first + 1, ...
std::vector<std::int16_t> twelve(int first) {
  std::vector<std::int16_t> samples;
  samples.reserve(12);
  for (int k = 0; k < 12; ++k) samples.push_back(static_cast<std::int16_t>(first + k));
  return samples;
}

class Dicom : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_reader(Reader::dicom)) GTEST_SKIP() << "tessera-read-dicom is not installed";
  }
  std::filesystem::path write(const std::string& name, const Slice& slice) { return folder.write(name, dicom(slice)); }
  test::TemporaryFolder folder;
};

TEST_F(Dicom, ADirectoryOfSlicesIsOneVolumeOrderedByPosition) {
  // The names and the numbers are in another order than the positions.
  const double z[] = {5, 3, 7};
  for (int k = 0; k < 3; ++k)
    write(fmt::format("{}.dcm", k), {.z = z[k], .number = 3 - k, .intercept = -1000, .samples = twelve(100 * k)});
  folder.write("notes.txt", std::string(200, 'x'));
  EXPECT_TRUE(is_volume(folder.path()));
  for (const auto& input : {folder.path(), folder / "1.dcm"}) {
    const VolumeFile volume = open_volume(input);
    const scene::GridGeometry& g = volume.source->geometry();
    EXPECT_EQ(g.points, (GridIndex{4, 3, 3}));
    EXPECT_EQ(g.origin, glm::dvec3(10, -20, 3));
    EXPECT_EQ(g.spacing, glm::dvec3(0.5, 0.75, 2));
    EXPECT_EQ(g.direction, glm::dmat3(1));
    const std::vector<double> samples = all_samples(*volume.source);
    EXPECT_EQ(samples[0], 100 - 1000);
    EXPECT_EQ(samples[12 + 5], 5 - 1000);
    EXPECT_EQ(samples[24 + 11], 211 - 1000);
    EXPECT_EQ(volume.range, (scene::ValueRange{-1000, -789, 0}));
    EXPECT_EQ(volume.fields.front().low, -1000);
    EXPECT_EQ(volume.source->grid().type, scene::SampleType::int16);
    EXPECT_TRUE(has_note(volume, "1 * sample + -1000"));
    EXPECT_TRUE(has_note(volume, "HU"));
    EXPECT_EQ(volume.format, "DICOM CT");
  }
}

TEST_F(Dicom, IsRefusedByNameIfItIsDeflated) {
  const auto file = write("0.dcm", {.samples = twelve(0), .is_deflated = true});
  for (const auto& name : {folder.path(), file})
    expect_no_volume(name,
                     "0.dcm: its data set is deflated, which is not supported; convert it with dcmtk: dcmconv +te");
}

TEST_F(Dicom, WithoutPositionsAreSpacedByTheirThickness) {
  for (int k = 0; k < 3; ++k)
    write(fmt::format("{}.dcm", k), {.number = 3 - k, .is_placed = false, .samples = twelve(100 * (2 - k))});
  const VolumeFile volume = open_volume(folder.path());
  EXPECT_EQ(volume.source->geometry().spacing, glm::dvec3(0.5, 0.75, 2));
  EXPECT_EQ(all_samples(*volume.source).front(), 0);  // by their numbers
  EXPECT_TRUE(has_note(volume, "by their numbers, 2 mm apart"));
}

TEST_F(Dicom, OtherSpacingsAreSeparateStacks) {
  for (int k = 0; k < 4; ++k)
    write(fmt::format("{}.dcm", k),
          {.z = 1.0 * k, .number = k, .spacing = k == 0 ? "0.75\\0.6" : "0.75\\0.5", .samples = twelve(k)});
  const VolumeFile volume = open_volume(folder.path());
  EXPECT_EQ(volume.source->geometry().points, (GridIndex{4, 3, 3}));
  EXPECT_EQ(volume.source->geometry().spacing.x, 0.5);
  EXPECT_TRUE(has_note(
      volume, "slices of 2 different series, sizes, spacings or directions; only the 3 slices of one group are shown"));
}

TEST_F(Dicom, RefusesMosaics) {
  for (int k = 0; k < 2; ++k)
    write(fmt::format("{}.dcm", k),
          {.z = 1.0 * k, .number = k, .image_type = "ORIGINAL\\PRIMARY\\M\\MOSAIC", .samples = twelve(k)});
  expect_no_volume(folder.path(), "mosaic), which is not supported; convert it: dcm2niix");
}

TEST_F(Dicom, ReportsAndKeepsGapsAndShearsTiltedStacks) {
  const double z[] = {0, 2, 6, 8};
  for (int k = 0; k < 4; ++k) write(fmt::format("{}.dcm", k), {.z = z[k], .number = k, .samples = twelve(k)});
  const VolumeFile gap = open_volume(folder.path());
  EXPECT_TRUE(gap.source->geometry().rectilinear());
  EXPECT_TRUE(has_note(gap, "2 to 4 mm apart, with the widest gap after 1.dcm; there 1 slice may be missing"));
  const scene::Box box = scene::bounds(gap.source->geometry());
  EXPECT_EQ(box.low, glm::dvec3(10, -20, 0));
  EXPECT_EQ(box.high, glm::dvec3(11.5, -18.5, 8));
  EXPECT_EQ(gap.source->geometry().coordinates[2], (std::vector<double>{0, 2, 6, 8}));
  for (int k = 0; k < 4; ++k)
    write(fmt::format("{}.dcm", k), {.z = 2.0 * k, .shift = 2.0 * k, .number = k, .samples = twelve(k)});
  const VolumeFile tilted = open_volume(folder.path());
  EXPECT_FALSE(tilted.source->geometry().rectilinear());
  EXPECT_NEAR(tilted.source->geometry().spacing.z, std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(tilted.source->geometry().direction[2].x, std::sqrt(0.5), 1e-12);
  EXPECT_TRUE(has_note(tilted, "by 45.0 degrees"));
}

TEST_F(Dicom, EachSliceIsScaledByItsOwnHeader) {
  for (int k = 0; k < 2; ++k) write(fmt::format("{}.dcm", k), {.z = 1.0 * k, .slope = 0.5 + k, .samples = twelve(1)});
  const VolumeFile volume = open_volume(folder.path());
  const std::vector<double> samples = all_samples(*volume.source);
  EXPECT_EQ(samples[0], 0.5);
  EXPECT_EQ(samples[12], 1.5);
  EXPECT_EQ(volume.source->grid().type, scene::SampleType::float32);
  EXPECT_TRUE(has_note(volume, "each slice has its own scale"));
}

TEST_F(Dicom, SlicesAtOnePositionAreTimeSteps) {
  for (int k = 0; k < 6; ++k)
    write(fmt::format("{}.dcm", k),
          {.z = k < 3 ? 0.0 : 1.0, .number = k, .time = 1 + k % 3, .samples = twelve(100 * k)});
  const VolumeFile last = open_volume(folder.path());
  EXPECT_EQ(last.source->geometry().points, (GridIndex{4, 3, 2}));
  EXPECT_EQ(all_samples(*last.source)[0], 200);
  EXPECT_EQ(all_samples(*last.source)[12], 500);
  EXPECT_EQ(last.time_step.step, 2u);
  const VolumeFile first = open_volume(folder.path(), {.time_step = 0});
  EXPECT_EQ(all_samples(*first.source)[12], 300);
  expect_no_volume(folder.path(), "no time step 3, the series has 3", {.time_step = 3});
}

TEST_F(Dicom, ShowsTheLargestOrTheNamedSeries) {
  for (int k = 0; k < 5; ++k)
    write(fmt::format("{}.dcm", k), {.z = 1.0 * k, .series = k < 3 ? "1.1" : "1.2", .samples = twelve(k)});
  write("scout.dcm", {.series = "1.1", .columns = 3, .rows = 4, .samples = twelve(50)});
  for (int k = 0; k < 9; ++k) write(fmt::format("rgb{}.dcm", k), {.z = 1.0 * k, .colours = 3, .samples = {}});
  const VolumeFile largest = open_volume(folder.path());
  EXPECT_EQ(largest.source->geometry().points, (GridIndex{4, 3, 3}));
  EXPECT_TRUE(has_note(
      largest,
      "slices of 4 different series, sizes, spacings or directions; only the 3 slices of one group are shown"));
  EXPECT_EQ(all_samples(*open_volume(folder / "4.dcm").source)[0], 3);
  expect_no_volume(folder / "rgb1.dcm", "coloured");
  expect_no_volume(folder / "scout.dcm", "single slice");
}

TEST_F(Dicom, DamagedFilesAreNamedAndOtherFilesLeftOut) {
  for (int k = 0; k < 3; ++k) write(fmt::format("{}.dcm", k), {.z = 1.0 * k, .samples = twelve(k)});
  folder.write("plan.dcm", std::string(128, '\0') + "DICM" + element(2, 0x10, "UI", "1.2.840.10008.1.2.1"));
  const VolumeFile others = open_volume(folder.path());
  EXPECT_EQ(others.source->geometry().points, (GridIndex{4, 3, 3}));
  EXPECT_TRUE(has_note(others, "left out 1 DICOM file without an image that GDCM can read; the first is plan.dcm"));
  expect_no_volume(folder / "plan.dcm", "plan.dcm");
  const std::string whole = dicom({.z = 1, .samples = twelve(1)});
  folder.write("1.dcm", whole.substr(0, whole.size() - 10));
  expect_no_volume(folder.path(), "1.dcm: it ends before its samples do");
  // Changes any one byte of a header.
  test::SomeCases some(7);
  for (std::size_t at = 132; at < whole.size(); at += 3) {
    if (!some.next()) continue;
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    folder.write("1.dcm", damaged);
    const test::Fault fault = test::fault_of([&] { open_volume(folder.path()); });
    EXPECT_EQ(fault.message.find('\n'), std::string::npos) << fault.message;
    EXPECT_TRUE(fault.message.empty() || fault.code == scene::ErrorCode::bad_input) << fault.message;
  }
  expect_no_volume(folder.write("text.dcm", std::string(200, 'x')), "GDCM finds no images");
  expect_no_volume(folder.write("cut.dcm", whole.substr(0, 300)), "ends within its header");
}

TEST_F(Dicom, PaddingIsBlank) {
  // One slice has a padding value, the other a padding range, given from its upper end. Samples are scaled, padding
  // values are not.
  write("0.dcm", {.z = 0, .number = 1, .slope = 2, .intercept = 10, .samples = twelve(-3), .padding = {-2}});
  write("1.dcm", {.z = 1, .number = 2, .slope = 2, .intercept = 10, .samples = twelve(0), .padding = {5, 3}});
  const VolumeFile volume = open_volume(folder.path());
  const std::vector<double> samples = all_samples(*volume.source);
  for (std::size_t k = 0; k < 24; ++k) {
    const bool is_padding = k == 1 || (k >= 12 + 3 && k <= 12 + 5);
    EXPECT_EQ(std::isnan(samples[k]), is_padding) << k;
    if (!is_padding) {
      EXPECT_EQ(samples[k], 2 * (k < 12 ? static_cast<double>(k) - 3 : static_cast<double>(k) - 12) + 10);
    }
  }
  EXPECT_TRUE(has_note(volume, "4 samples have the padding value"));
  EXPECT_EQ(volume.source->grid().type, scene::SampleType::float32);
  EXPECT_EQ(volume.range.low, 4);
}

TEST_F(Dicom, WholeValuesBeyondThirtyOneBitsAreExact) {
  // 65536 s + 1, not representable as float.
  std::vector<std::int16_t> upper = twelve(0);
  upper[5] = -1;  // 65535, because the samples are unsigned
  for (int k = 0; k < 2; ++k)
    write(fmt::format("{}.dcm", k), {.z = 1.0 * k, .number = k, .samples = upper, .is_wide = true});
  const VolumeFile volume = open_volume(folder.path());
  EXPECT_EQ(volume.source->grid().type, scene::SampleType::uint32);
  EXPECT_EQ(all_samples(*volume.source)[5], 4294901761.0);
  EXPECT_EQ(all_samples(*volume.source)[11], 720897.0);
  for (int k = 0; k < 2; ++k)
    write(fmt::format("{}.dcm", k), {.z = 1.0 * k, .number = k, .intercept = -10, .samples = upper, .is_wide = true});
  const VolumeFile beyond = open_volume(folder.path());  // values begin at -9: no 32-bit integer type fits
  EXPECT_EQ(beyond.source->grid().type, scene::SampleType::float64);
  EXPECT_EQ(all_samples(*beyond.source)[5], 4294901751.0);
}

}  // namespace
}  // namespace tessera::io
