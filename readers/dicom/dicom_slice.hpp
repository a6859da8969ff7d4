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

/// A frame of a multi-frame file.
struct DicomFrame {
  glm::dvec3 position{0}, row{1, 0, 0}, column{0, 1, 0};
  double slope = 1, intercept = 0;
  DicomTime time{};          ///< see DicomSlice::time
  glm::dvec2 spacing{1};     ///< between columns, and between rows
  std::int64_t segment = 0;  ///< number of its segment, in a segmentation; 0: none
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

/// The header of one DICOM file: one image, or several frames. Positions are in millimetres in the patient's frame: x
/// to the left, y to the back, z to the head (DICOM PS3.3, C.7.6.2).
struct DicomSlice {
  std::filesystem::path file;
  std::string series;          ///< its unique identifier
  std::string modality, unit;  ///< may be empty
  std::int64_t columns = 0, rows = 0, frames = 1;
  int components = 1;             ///< 3: colours
  bool is_packed = false;         ///< its samples are compressed
  bool is_mosaic = false;         ///< slices tiled in one image, as Siemens writes them
  std::uint64_t samples_end = 0;  ///< their end in the file, if not packed
  std::uint64_t bytes = 0;        ///< size of its samples, unpacked
  int bits = 8;                   ///< per sample, including unused ones
  bool has_position = false;      ///< otherwise its number in the series determines the position
  glm::dvec3 position{0}, row{1, 0, 0}, column{0, 1, 0};
  glm::dvec3 spacing{1};            ///< between columns, rows and slices (of frames, or as thickness)
  double slope = 1, intercept = 0;  ///< value = slope * sample + intercept
  std::int64_t number = 0;          ///< in the series
  DicomTime time{};                 ///< distinguishes slices at one position; 0 if there is nothing
  std::vector<DicomFrame> each{};   ///< for a multi-frame file
  std::int64_t frame = 0;           ///< index of this one among them
  std::string frames_note{};        ///< missing information about their positions; may be empty
  /// Samples in this closed range are padding, which no detector has measured.
  std::optional<std::array<double, 2>> padding{};
  DicomSegments segments{};
  /// The value in a slice of segments is the number of the last segment whose frame is not 0 there, else 0; where
  /// segments overlap, this is the largest number. Fractions have one frame with these values.
  bool joins_frames = false;
  std::vector<DicomFrameOfSegment> joined{};

  [[nodiscard]] glm::dvec3 normal() const;
};

/// No value if the file is not a DICOM file with images, or its header cannot be read. Does not read samples.
std::optional<DicomSlice> read_dicom_header(const std::filesystem::path& file);

/// Properties of the values, which determine how they are stored.
struct DicomValues {
  cells::NumberTally tally;
  bool are_whole = true;
  std::uint64_t shared = 0;  ///< samples in several segments
};

/// The samples of a file as stored, frame by frame, row by row.
class DicomSamples {
 public:
  /// Unpacks them. Throws Error(bad_input) in one line.
  explicit DicomSamples(const DicomSlice& slice);

  /// Size of one frame; values use the scale of the slice passed.
  [[nodiscard]] std::size_t frame_count() const { return frame_size_; }
  [[nodiscard]] DicomValues values(const DicomSlice& slice) const;

  /// Values [first, first + out.size()) of a slice's frame; NaN where a sample is padding.
  void read(const DicomSlice& slice, std::size_t first, std::span<double> out) const;

 private:
  void take_bits(const DicomSlice& slice);
  [[nodiscard]] int bit_at(std::size_t k) const { return static_cast<unsigned char>(bytes_[k / 8]) >> (k % 8) & 1; }
  void read_frame(const DicomSlice& slice, std::int64_t frame, std::size_t first, std::span<double> out) const;
  /// Reads joined frames; returns the number of samples that are in several segments.
  std::uint64_t read_joined(const DicomSlice& slice, std::size_t first, std::span<double> out) const;

  std::vector<char> bytes_;
  NumberType type_ = NumberType::uint8;
  int bits_ = 0;  ///< used bits of an integer sample; the others have another meaning
  std::size_t frame_size_ = 0;
  bool has_bits_ = false;  ///< samples have one bit, eight per byte
  std::optional<std::array<double, 2>> padding_;
};

}  // namespace tessera::readers
