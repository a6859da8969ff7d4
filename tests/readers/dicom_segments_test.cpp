// SPDX-License-Identifier: BSD-3-Clause
// DICOM segmentations: one-bit samples, segments in separate frames, omitted frames (PS3.3, A.51).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/files/reader_programs.hpp"
#include "support/dicom_writing.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io::dicom_segments_test {
namespace {

using scene::GridIndex;
using test::all_samples;
using test::dicom_element;
using test::dicom_group;
using test::dicom_little;
using test::DicomFrames;
using test::expect_no_volume;
using test::has_note;

constexpr std::size_t columns = 5, rows = 3, frame_size = columns * rows;  // only the first frame is byte-aligned

/// A frame of a segment at z = 5 + 2.5 * place: 1 for the samples [first, last).
struct Frame {
  std::uint32_t segment = 1;
  int place = 0;
  std::size_t first = 0, last = 0;
};

std::string name_of(std::uint32_t number, const std::string& name) {
  return test::dicom_item(dicom_element(0x62, 4, "US", dicom_little(number, 2)) + dicom_element(0x62, 5, "LO", name));
}

/// The first sample of a byte is its lowest bit.
std::string bits_of(const std::vector<Frame>& frames) {
  std::string bytes((frames.size() * frame_size + 7) / 8, '\0');
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (std::size_t k = f * frame_size + frames[f].first; k < f * frame_size + frames[f].last; ++k)
      bytes[k / 8] = static_cast<char>(static_cast<unsigned char>(bytes[k / 8]) | 1u << (k % 8));
  return bytes;
}

std::string bytes_of(const std::vector<Frame>& frames, unsigned char value) {
  std::string bytes(frames.size() * frame_size, '\0');
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (std::size_t k = frames[f].first; k < frames[f].last; ++k) bytes[f * frame_size + k] = static_cast<char>(value);
  return bytes;
}

DicomFrames segmentation(const std::vector<Frame>& frames, const std::string& type = "BINARY") {
  DicomFrames file;
  file.storage = "1.2.840.10008.5.1.4.1.1.66.4", file.modality = "SEG";
  file.columns = columns, file.rows = rows;
  file.frames = frames.size();
  file.below = dicom_element(0x62, 1, "CS", type) +
               dicom_element(0x62, 2, "SQ", name_of(1, "liver") + name_of(2, "spleen") + name_of(3, "")) +
               (type == "FRACTIONAL" ? dicom_element(0x62, 0xe, "US", dicom_little(200, 2)) : "");
  file.shared = test::dicom_orientation("1\\0\\0\\0\\1\\0") + test::dicom_measures(0.75, 0.5, 2.5);
  for (const Frame& f : frames)
    file.each.push_back(test::dicom_position({10, -20, 5 + 2.5 * f.place}) +
                        dicom_group(0x62, 0xa, dicom_element(0x62, 0xb, "US", dicom_little(f.segment, 2))));
  file.bits = type == "BINARY" ? 1 : 8;
  file.packed = type == "BINARY" ? bits_of(frames) : bytes_of(frames, 50);
  return file;
}

/// Samples at `places` positions: those of the frames are `value` or, if that is 0, the number of their segment.
std::vector<double> wanted(const std::vector<Frame>& frames, int places, double value = 0) {
  std::vector<double> samples(static_cast<std::size_t>(places) * frame_size);
  for (const Frame& f : frames)
    for (std::size_t k = f.first; k < f.last; ++k)
      samples[static_cast<std::size_t>(f.place) * frame_size + k] = value > 0 ? value : f.segment;
  return samples;
}

class DicomSegments : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_reader(Reader::dicom)) GTEST_SKIP() << "tessera-read-dicom is not installed";
  }
  VolumeFile open(const DicomFrames& file, const ReadOptions& options = {}) {
    return open_volume(folder.write("a.dcm", test::dicom_file(file)), options);
  }
  test::TemporaryFolder folder;
};

TEST_F(DicomSegments, OfOneBitAreLabelsOfOneVolumeWhateverTheirOrder) {
  const std::vector<Frame> by_segment = {{1, 0, 2, 7},  {1, 1, 0, 9},   {1, 2, 4, 5},
                                         {2, 0, 9, 15}, {2, 1, 11, 12}, {2, 2}};
  const std::vector<Frame> by_place = {by_segment[5], by_segment[2], by_segment[4],
                                       by_segment[1], by_segment[3], by_segment[0]};
  for (const std::vector<Frame>& frames : {by_segment, by_place}) {
    const VolumeFile volume = open(segmentation(frames));
    EXPECT_EQ(volume.source->geometry().points, (GridIndex{5, 3, 3}));
    EXPECT_EQ(volume.source->geometry().origin, glm::dvec3(10, -20, 5));
    EXPECT_EQ(volume.source->geometry().spacing, glm::dvec3(0.5, 0.75, 2.5));
    EXPECT_EQ(all_samples(*volume.source), wanted(frames, 3));
    EXPECT_TRUE(volume.tags.labels);
    EXPECT_LE(volume.time_step.count, 1u);
    EXPECT_TRUE(has_note(volume, "0 outside all segments: 1 liver, 2 spleen"));
  }
}

TEST_F(DicomSegments, OfLabelsAreNotTimeSteps) {
  const auto file = folder.write("a.dcm", test::dicom_file(segmentation({{1, 0, 2, 7}, {1, 1, 0, 9}, {2, 1, 9, 12}})));
  EXPECT_EQ(open_volume(file, {.time_step = 0}).range, (scene::ValueRange{0, 2, 0}));
  expect_no_volume(file, "there is no time step 1", {.time_step = 1});
}

TEST_F(DicomSegments, ShowTheLastOfThoseThatOverlapWithANote) {
  const VolumeFile volume = open(segmentation({{2, 0, 3, 8}, {2, 1}, {1, 0, 0, 5}, {1, 1, 0, 5}}));
  EXPECT_EQ(all_samples(*volume.source), wanted({{1, 0, 0, 5}, {1, 1, 0, 5}, {2, 0, 3, 8}}, 2));
  EXPECT_TRUE(has_note(volume, "2 samples are in several segments"));
}

TEST_F(DicomSegments, AreZeroWhereFramesAreOmitted) {
  // Segment 1 is at places 0 and 1, segment 3 at place 4.
  const std::vector<Frame> frames = {{1, 0, 2, 7}, {1, 1, 0, 9}, {3, 4, 1, 4}};
  const VolumeFile volume = open(segmentation(frames));
  EXPECT_EQ(volume.source->geometry().points, (GridIndex{5, 3, 5}));
  EXPECT_FALSE(volume.source->geometry().rectilinear());
  EXPECT_EQ(all_samples(*volume.source), wanted(frames, 5));
  EXPECT_TRUE(has_note(volume, "1 liver, 3"));
  expect_no_volume(folder.write("b.dcm", test::dicom_file(segmentation({{1, 0, 2, 7}, {2, 0, 0, 9}}))),
                   "all its segments are in one slice");
  expect_no_volume(folder.write("c.dcm", test::dicom_file(segmentation({{1, 0, 2, 7}, {1, 90000, 0, 9}, {2, 1}}))),
                   "more than 65536 slices");
}

TEST_F(DicomSegments, OfFractionsAreValuesOfASegmentEach) {
  const std::vector<Frame> frames = {{1, 0, 2, 7}, {1, 1, 0, 9}, {2, 1, 3, 4}, {2, 3, 1, 4}};
  const DicomFrames file = segmentation(frames, "FRACTIONAL");
  const VolumeFile last = open(file);
  EXPECT_EQ(last.time_step.count, 2u);
  EXPECT_FALSE(last.tags.labels);
  EXPECT_EQ(all_samples(*last.source), wanted({frames[2], frames[3]}, 4, 0.25));
  EXPECT_TRUE(has_note(last, "fractions of segment 2 spleen"));
  EXPECT_EQ(all_samples(*open(file, {.time_step = 0}).source), wanted({frames[0], frames[1]}, 4, 0.25));
  expect_no_volume(folder.write("b.dcm", test::dicom_file(file)), "no time step 2, the series has 2", {.time_step = 2});
}

TEST_F(DicomSegments, ThatEndEarlyAreRefused) {
  DicomFrames file = segmentation({{1, 0, 2, 7}, {1, 1, 0, 9}, {1, 2, 1, 4}});
  file.packed.resize(4);
  expect_no_volume(folder.write("b.dcm", test::dicom_file(file)), "ends before its samples do");
  file.bits = 4;
  expect_no_volume(folder.write("c.dcm", test::dicom_file(file)), "its samples have 4 bits, which is not supported");
}

}  // namespace
}  // namespace tessera::io::dicom_segments_test
