// SPDX-License-Identifier: BSD-3-Clause
// Frames of one DICOM file: order, position, scale and time of each.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "io/files/reader_programs.hpp"
#include "support/dicom_writing.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io::dicom_frames_test {
namespace {

using scene::GridIndex;
using test::all_samples;
using test::dicom_element;
using test::dicom_group;
using test::DicomFrames;
using test::expect_no_volume;
using test::has_note;

constexpr std::size_t frame_size = 12;
const std::string upright = "1\\0\\0\\0\\1\\0";

/// The stored samples of all frames. With the slope of its frame, a frame at place p has the samples 100 p, 100 p + 1,
/// ...
std::vector<std::int16_t> samples_of(const std::vector<int>& places, const std::vector<double>& slopes = {}) {
  std::vector<std::int16_t> samples;
  for (std::size_t f = 0; f < places.size(); ++f)
    for (std::size_t k = 0; k < frame_size; ++k)
      samples.push_back(
          static_cast<std::int16_t>((100 * places[f] + static_cast<int>(k)) / (slopes.empty() ? 1 : slopes[f])));
  return samples;
}

/// Frames at z = 5 + 2.5 * place.
DicomFrames frames_at(const std::vector<int>& places, const std::vector<double>& slopes = {}) {
  DicomFrames file;
  file.shared = test::dicom_orientation(upright) + test::dicom_measures(0.75, 0.5, 9);
  for (std::size_t f = 0; f < places.size(); ++f)
    file.each.push_back(test::dicom_position({10, -20, 5 + 2.5 * places[f]}) +
                        (slopes.empty() ? "" : test::dicom_scale(slopes[f], 0)));
  file.frames = places.size();
  file.samples = samples_of(places, slopes);
  return file;
}

class DicomFrameFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_reader(Reader::dicom)) GTEST_SKIP() << "tessera-read-dicom is not installed";
  }
  VolumeFile open(const DicomFrames& file, const ReadOptions& options = {}) {
    return open_volume(folder.write("a.dcm", test::dicom_file(file)), options);
  }
  test::TemporaryFolder folder;
};

std::vector<double> wanted(int places) {
  std::vector<double> values;
  for (int p = 0; p < places; ++p)
    for (std::size_t k = 0; k < frame_size; ++k) values.push_back(100.0 * p + static_cast<double>(k));
  return values;
}

TEST_F(DicomFrameFiles, ArePlacedByTheirPositionsInAnyOrder) {
  for (const std::vector<int>& order : {std::vector{0, 1, 2, 3}, std::vector{3, 2, 1, 0}, std::vector{2, 0, 3, 1}}) {
    const VolumeFile volume = open(frames_at(order));
    const scene::GridGeometry& g = volume.source->geometry();
    EXPECT_EQ(g.points, (GridIndex{4, 3, 4}));
    EXPECT_EQ(g.origin, glm::dvec3(10, -20, 5));
    EXPECT_EQ(g.spacing, glm::dvec3(0.5, 0.75, 2.5));  // from the positions, not from the thickness
    EXPECT_EQ(all_samples(*volume.source), wanted(4));
    EXPECT_EQ(volume.body_axes, BodyAxes::lps);
    EXPECT_EQ(volume.tags.modality, "CT");
  }
}

TEST_F(DicomFrameFiles, HaveScalesOfTheirOwn) {
  const VolumeFile volume = open(frames_at({0, 1, 2}, {1, 0.5, 0.25}));
  EXPECT_EQ(all_samples(*volume.source), wanted(3));
  EXPECT_TRUE(has_note(volume, "each slice has its own scale"));
  DicomFrames shared = frames_at({0, 1});
  shared.shared += test::dicom_scale(2, -1000);
  EXPECT_EQ(open(shared).range, (scene::ValueRange{-1000, 2 * 111 - 1000, 0}));
}

TEST_F(DicomFrameFiles, AtOnePositionAreTimeSteps) {
  // Temporal positions determine the order of the steps; here they are in the reverse order of the frames.
  DicomFrames file = frames_at({0, 1, 2, 0, 1, 2});
  for (std::size_t f = 0; f < 6; ++f)
    file.each[f] = dicom_group(0x20, 0x9111, dicom_element(0x20, 0x9128, "UL", test::dicom_little(f < 3 ? 2 : 1, 4))) +
                   file.each[f];
  for (std::size_t k = 0; k < 3 * frame_size; ++k) file.samples[k] = static_cast<std::int16_t>(-file.samples[k]);
  const VolumeFile last = open(file);
  EXPECT_EQ(last.time_step.count, 2);
  EXPECT_EQ(last.source->geometry().points, (GridIndex{4, 3, 3}));
  EXPECT_EQ(last.range, (scene::ValueRange{-211, 0, 0}));
  EXPECT_EQ(all_samples(*open(file, {.time_step = 0}).source), wanted(3));
  // Without temporal positions, the order of the frames decides: one volume after the other, or position by position.
  DicomFrames after = frames_at({0, 1, 2, 0, 1, 2});
  for (std::size_t k = 3 * frame_size; k < 6 * frame_size; ++k) after.samples[k] = 7;
  EXPECT_EQ(all_samples(*open(after, {.time_step = 0}).source), wanted(3));
  EXPECT_EQ(open(after, {.time_step = 1}).range, (scene::ValueRange{7, 7, 0}));
  DicomFrames between = frames_at({0, 0, 1, 1, 2, 2});
  for (std::size_t f = 1; f < 6; f += 2)
    for (std::size_t k = 0; k < frame_size; ++k) between.samples[f * frame_size + k] = 7;
  EXPECT_EQ(all_samples(*open(between, {.time_step = 0}).source), wanted(3));
  EXPECT_EQ(open(between).range, (scene::ValueRange{7, 7, 0}));
}

TEST_F(DicomFrameFiles, HaveTheirTimesInSecondsFromTheFirst) {
  const auto times = [&](const std::vector<std::string>& groups) {
    DicomFrames file = frames_at({0, 1, 0, 1, 0, 1});
    for (std::size_t f = 0; f < 6; ++f) file.each[f] += groups[f / 2];
    return open(file).time_step.times;
  };
  const auto moment = [](const char* at) { return dicom_group(0x20, 0x9111, dicom_element(0x18, 0x9151, "DT", at)); };
  EXPECT_EQ(times({moment("20240229235958.5"), moment("20240229235959"), moment("20240229235959.75")}),
            (std::vector<double>{0, 0.5, 1.25}));
  EXPECT_EQ(times({moment("20240229235958.5"), moment("20240301000000"), moment("20240301000001")}),
            (std::vector<double>{0, 1.5, 2.5}));
  const auto delay = [](double milliseconds) {
    return dicom_group(0x18, 0x9118, dicom_element(0x20, 0x9153, "FD", test::bytes_of(std::vector{milliseconds})));
  };
  EXPECT_EQ(times({delay(20), delay(520), delay(1520)}), (std::vector<double>{0, 0.5, 1.5}));
  const auto offset = [](double seconds) {
    return dicom_group(0x20, 0x9310, dicom_element(0x20, 0x930d, "FD", test::bytes_of(std::vector{seconds})));
  };
  EXPECT_EQ(times({offset(1), offset(3), offset(4)}), (std::vector<double>{0, 2, 3}));
  const auto index = [](std::uint32_t number) {
    return dicom_group(0x20, 0x9111, dicom_element(0x20, 0x9128, "UL", test::dicom_little(number, 4)));
  };
  EXPECT_TRUE(times({index(1), index(2), index(3)}).empty());
}

TEST_F(DicomFrameFiles, WithoutPositionsUseTheFilesSpacingWithANote) {
  DicomFrames file;
  file.storage = "1.2.840.10008.5.1.4.1.1.7.2", file.modality = "OT";
  file.frames = 3, file.samples = samples_of({0, 1, 2});
  const VolumeFile nothing = open(file);
  EXPECT_EQ(nothing.source->geometry().spacing.z, 1);
  EXPECT_EQ(all_samples(*nothing.source), wanted(3));
  EXPECT_TRUE(has_note(nothing, "state neither their positions nor their distance"));
  file.above = dicom_element(0x18, 0x50, "DS", "4");
  EXPECT_EQ(open(file).source->geometry().spacing.z, 4);
  EXPECT_TRUE(has_note(open(file), "4 mm apart, the stated slice thickness"));
  file.above += dicom_element(0x18, 0x88, "DS", "2.5");
  EXPECT_EQ(open(file).source->geometry().spacing.z, 2.5);
  EXPECT_TRUE(has_note(open(file), "2.5 mm apart, the stated spacing between slices"));
}

TEST_F(DicomFrameFiles, OfADoseArePlacedAtTheirOffsetsAndScaled) {
  DicomFrames file;
  file.storage = "1.2.840.10008.5.1.4.1.1.481.2", file.modality = "RTDOSE";
  file.above = dicom_element(0x20, 0x32, "DS", "10\\-20\\5") + dicom_element(0x20, 0x37, "DS", upright);
  file.frames = 3;
  const auto with = [&](const char* offsets, const std::vector<int>& places) {
    file.below = dicom_element(0x3004, 0x2, "CS", "GY") + dicom_element(0x3004, 0xc, "DS", offsets) +
                 dicom_element(0x3004, 0xe, "DS", "0.5");
    file.samples = samples_of(places);
    return open(file);
  };
  const VolumeFile upwards = with("0\\3\\6", {0, 1, 2});
  EXPECT_EQ(upwards.source->geometry().spacing.z, 3);
  EXPECT_EQ(upwards.source->geometry().origin, glm::dvec3(10, -20, 5));
  EXPECT_EQ(upwards.range, (scene::ValueRange{0, 211 / 2.0, 0}));
  EXPECT_EQ(upwards.tags.unit, "GY");
  const VolumeFile downwards = with("0\\-3\\-6", {2, 1, 0});
  EXPECT_EQ(downwards.source->geometry().origin, glm::dvec3(10, -20, -1));
  EXPECT_EQ(all_samples(*downwards.source), all_samples(*upwards.source));
  const VolumeFile places = with("5\\8\\11", {0, 1, 2});  // along the patient instead of from the first
  EXPECT_EQ(places.source->geometry().origin, glm::dvec3(10, -20, 5));
  EXPECT_EQ(all_samples(*places.source), all_samples(*upwards.source));
  EXPECT_TRUE(with("0\\3\\9", {0, 1, 2}).source->geometry().rectilinear());
}

TEST_F(DicomFrameFiles, ShowOneOfSeveralDirectionsAndRefuseASinglePosition) {
  DicomFrames file = frames_at({0, 1, 2, 0});
  file.each.back() = test::dicom_position({0, 0, 0}) + test::dicom_orientation("0\\1\\0\\0\\0\\1");
  const VolumeFile most = open(file);
  EXPECT_EQ(all_samples(*most.source), wanted(3));
  EXPECT_TRUE(has_note(most, "frames have 2 different directions or spacings, and only the 3 frames of one are read"));
  // First one frame has another spacing; then all frames have a spacing that differs from the file's.
  file.each.back() = test::dicom_position({10, -20, 12.5}) + test::dicom_measures(1.5, 1, 9);
  EXPECT_EQ(all_samples(*open(file).source), wanted(3));
  for (std::string& each : file.each) each += test::dicom_measures(1.5, 1, 9);
  file.each.back() = test::dicom_position({10, -20, 12.5});
  EXPECT_EQ(open(file).source->geometry().spacing, glm::dvec3(1, 1.5, 2.5));
  expect_no_volume(folder.write("b.dcm", test::dicom_file(frames_at({1, 1, 1}))),
                   "all its 3 frames are at one position");
}

}  // namespace
}  // namespace tessera::io::dicom_frames_test
