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

/// One frame of a multi-frame file.
struct DicomFrame {
  glm::dvec3 position{0}, row{1, 0, 0}, column{0, 1, 0};
  double slope = 1, intercept = 0;
  DicomTime time{};          ///< see DicomSlice::time
  glm::dvec2 spacing{1};     ///< distances between columns, and between rows
  std::int64_t segment = 0;  ///< in a segmentation, the number of the frame's segment; otherwise 0
};

/// The parts of a segmentation (PS3.3, C.8.20.2).
struct DicomSegments {
  std::string type;  ///< BINARY, FRACTIONAL or LABELMAP; empty: the file is not a segmentation
  std::vector<std::pair<std::int64_t, std::string>> names;  ///< by number
};

/// A frame that contributes to a slice of segments.
struct DicomFrameOfSegment {
  std::int64_t frame = 0, segment = 0;
};

/// The header of one DICOM file, which contains one image or several frames. Positions are in millimetres in the
/// patient's frame: x to the left, y to the back, z to the head (DICOM PS3.3, C.7.6.2).
struct DicomSlice {
  std::filesystem::path file;
  std::string series;          ///< unique identifier of the series
  std::string modality, unit;  ///< may be empty
  std::int64_t columns = 0, rows = 0, frames = 1;
  int components = 1;             ///< 3: colours
  bool is_packed = false;         ///< the samples are compressed
  bool is_mosaic = false;         ///< slices tiled in one image, as Siemens writes them
  std::uint64_t samples_end = 0;  ///< where the samples end in the file, if they are not compressed
  std::uint64_t bytes = 0;        ///< size of the samples, uncompressed
  int bits = 8;                   ///< bits per sample, including unused bits
  bool has_position = false;      ///< if false, the slice's number in the series determines the position
  glm::dvec3 position{0}, row{1, 0, 0}, column{0, 1, 0};
  glm::dvec3 spacing{1};            ///< distances of columns, rows and slices (from frames, or the thickness)
  double slope = 1, intercept = 0;  ///< value = slope * sample + intercept
  std::int64_t number = 0;          ///< number of the slice in the series
  DicomTime time{};                 ///< distinguishes slices at one position; 0 if the file has no suitable value
  std::vector<DicomFrame> each{};   ///< the frames of a multi-frame file
  std::int64_t frame = 0;           ///< index of this slice in the frames of its file
  std::string frames_note{};        ///< which information about the frames' positions is missing; may be empty
  /// Samples in this closed range are padding, not measured by a detector.
  std::optional<std::array<double, 2>> padding{};
  DicomSegments segments{};
  /// The slice combines the frames of several segments: a value is the number of the last segment whose frame is not 0
  /// at the sample, or 0. Where segments overlap, this is the largest number. In a FRACTIONAL segmentation, the slice
  /// has one frame with the values.
  bool joins_frames = false;
  std::vector<DicomFrameOfSegment> joined{};

  [[nodiscard]] glm::dvec3 normal() const;
};

/// Reads the header of a file, but not its samples. No value if the file is not a DICOM file with images, or if its
/// header cannot be read.
std::optional<DicomSlice> read_dicom_header(const std::filesystem::path& file);

/// Properties of the values of a slice, which determine the type in which the values are stored.
struct DicomValues {
  cells::NumberTally tally;
  bool are_whole = true;
  std::uint64_t shared = 0;  ///< number of samples that are in several segments
};

/// The samples of a file in stored order: frame by frame, row by row.
class DicomSamples {
 public:
  /// Reads and unpacks the samples. Throws Error(bad_input) with a message of one line.
  explicit DicomSamples(const DicomSlice& slice);

  /// Number of samples of one frame, and properties of the values, which are scaled as `slice` states.
  [[nodiscard]] std::size_t frame_count() const { return frame_size_; }
  [[nodiscard]] DicomValues values(const DicomSlice& slice) const;

  /// Writes values [first, first + out.size()) of the frame of a slice; NaN where a sample is padding.
  void read(const DicomSlice& slice, std::size_t first, std::span<double> out) const;

 private:
  void take_bits(const DicomSlice& slice);
  [[nodiscard]] int bit_at(std::size_t k) const { return static_cast<unsigned char>(bytes_[k / 8]) >> (k % 8) & 1; }
  void read_frame(const DicomSlice& slice, std::int64_t frame, std::size_t first, std::span<double> out) const;
  /// Writes the values of a slice that joins frames. Returns the number of samples that are in several segments.
  std::uint64_t read_joined(const DicomSlice& slice, std::size_t first, std::span<double> out) const;

  std::vector<char> bytes_;
  NumberType type_ = NumberType::uint8;
  int bits_ = 0;  ///< number of bits that are used by an integer sample; the other bits have another meaning
  std::size_t frame_size_ = 0;
  bool has_bits_ = false;  ///< samples have one bit, eight of them per byte
  std::optional<std::array<double, 2>> padding_;
};

}  // namespace tessera::readers
