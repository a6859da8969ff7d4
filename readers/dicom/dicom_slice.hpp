// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cells/number_tally.hpp"
#include "io/foreign/messages/foreign_data.hpp"
#include "readers/dicom/dicom_elements.hpp"

namespace tessera::readers {

/// One of the frames of a file.
struct DicomFrame {
  glm::dvec3 position{0}, row{1, 0, 0}, column{0, 1, 0};
  double slope = 1, intercept = 0;
  DicomTime time{};          ///< as DicomSlice::time
  glm::dvec2 spacing{1};     ///< between columns, and between rows
  std::int64_t segment = 0;  ///< the number of the segment that it shows, of a segmentation; 0: none
};

/// What the parts of a segmentation (PS3.3, C.8.20.2) are.
struct DicomSegments {
  std::string type;  ///< BINARY, FRACTIONAL or LABELMAP; empty: the file is not a segmentation
  std::vector<std::pair<std::int64_t, std::string>> names;  ///< by number
};

/// A frame as part of a slice of segments.
struct DicomFrameOfSegment {
  std::int64_t frame = 0, segment = 0;
};

/// What the header of one DICOM file says of its pictures: one, or the frames of several. Positions are millimetres in
/// the patient's frame: x to the left, y to the back, z to the head (DICOM PS3.3, C.7.6.2).
struct DicomSlice {
  std::filesystem::path file;
  std::string series;          ///< its unique identifier
  std::string modality, unit;  ///< may be empty
  std::int64_t columns = 0, rows = 0, frames = 1;
  int components = 1;             ///< 3: colours
  bool is_packed = false;         ///< its samples are compressed
  bool is_mosaic = false;         ///< slices side by side in one picture, as Siemens writes them
  std::uint64_t samples_end = 0;  ///< where they end in the file, if not packed
  std::uint64_t bytes = 0;        ///< of its samples, unpacked
  int bits = 8;                   ///< of a sample, with those not used
  bool has_position = false;      ///< else by its number in the series
  glm::dvec3 position{0}, row{1, 0, 0}, column{0, 1, 0};
  glm::dvec3 spacing{1};            ///< between columns, rows and, of frames or as thickness, slices
  double slope = 1, intercept = 0;  ///< value = slope * sample + intercept
  std::int64_t number = 0;          ///< in the series
  DicomTime time{};                 ///< whatever tells slices of one place apart; 0 without
  std::vector<DicomFrame> each{};   ///< of a file of several frames
  std::int64_t frame = 0;           ///< which of them this is
  std::string frames_note{};        ///< what the file does not say of their places; may be empty
  /// Samples from the first to the second are padding, which no detector has seen.
  std::optional<std::array<double, 2>> padding{};
  DicomSegments segments{};
  /// Of a slice of segments, its value is the number of the last segment whose frame is not 0 there, else 0. Of those
  /// that overlap that is the one with the largest number. Fractions have one frame, whose values these are.
  bool joins_frames = false;
  std::vector<DicomFrameOfSegment> joined{};

  [[nodiscard]] glm::dvec3 normal() const;
};

/// None if the file is no DICOM file with pictures, or its header cannot be read. Samples are not read.
std::optional<DicomSlice> read_dicom_header(const std::filesystem::path& file);

/// What values are, which says how they are held.
struct DicomValues {
  cells::NumberTally tally;
  bool are_whole = true;
  std::uint64_t shared = 0;  ///< samples in several segments
};

/// The samples of a file as they are stored, frame by frame, row by row.
class DicomSamples {
 public:
  /// Unpacks them. Throws Error(bad_input) in one line.
  explicit DicomSamples(const DicomSlice& slice);

  /// Of one frame, with that slice's scale.
  [[nodiscard]] std::size_t frame_count() const { return frame_size_; }
  [[nodiscard]] DicomValues values(const DicomSlice& slice) const;

  /// Values [first, first + out.size()) of a slice's frame; NaN where a sample is padding.
  void read(const DicomSlice& slice, std::size_t first, std::span<double> out) const;

 private:
  void take_bits(const DicomSlice& slice);
  [[nodiscard]] int bit_at(std::size_t k) const { return static_cast<unsigned char>(bytes_[k / 8]) >> (k % 8) & 1; }
  void read_frame(const DicomSlice& slice, std::int64_t frame, std::size_t first, std::span<double> out) const;
  /// The number of samples that are in several segments.
  std::uint64_t read_joined(const DicomSlice& slice, std::size_t first, std::span<double> out) const;

  std::vector<char> bytes_;
  NumberType type_ = NumberType::uint8;
  int bits_ = 0;  ///< of integers that are the sample's; the others are something else's
  std::size_t frame_size_ = 0;
  bool has_bits_ = false;  ///< samples are of one bit, eight a byte
  std::optional<std::array<double, 2>> padding_;
};

}  // namespace tessera::readers
