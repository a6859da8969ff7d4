// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "support/volume_bytes.hpp"

/// DICOM files byte by byte (PS3.5, explicit little-endian elements).
namespace tessera::test {

inline std::string dicom_little(std::uint32_t value, int bytes) {
  std::string text;
  for (int k = 0; k < bytes; ++k) text += static_cast<char>((value >> (8 * k)) & 0xff);
  return text;
}

inline std::string dicom_element(std::uint32_t group, std::uint32_t number, const std::string& kind,
                                 std::string value) {
  if (value.size() % 2 != 0) value += kind == "UI" ? '\0' : ' ';
  const bool is_long = kind == "OW" || kind == "OB" || kind == "SQ";
  return dicom_little(group, 2) + dicom_little(number, 2) + kind + (is_long ? std::string(2, '\0') : "") +
         dicom_little(static_cast<std::uint32_t>(value.size()), is_long ? 4 : 2) + value;
}

inline std::string dicom_item(const std::string& elements) {
  return dicom_little(0xe000fffe, 4) + dicom_little(static_cast<std::uint32_t>(elements.size()), 4) + elements;
}

/// A sequence with one item.
inline std::string dicom_group(std::uint32_t group, std::uint32_t number, const std::string& elements) {
  return dicom_element(group, number, "SQ", dicom_item(elements));
}

/// A multi-frame file; empty members are left out.
struct DicomFrames {
  std::string storage = "1.2.840.10008.5.1.4.1.1.2.1", modality = "CT";
  int columns = 4, rows = 3;
  std::string above{};              ///< elements of groups below 0028, in order
  std::string spacing{};            ///< between rows and columns, for the whole file
  std::string below{};              ///< elements of groups 0054 to 3004
  std::string shared{};             ///< functional groups of all frames
  std::vector<std::string> each{};  ///< functional groups per frame
  std::size_t frames = 0;           ///< frames of samples
  std::vector<std::int16_t> samples{};
  std::uint32_t bits = 16;  ///< per sample; signed if 16
  std::string packed{};     ///< samples of other bit depths, in stored form
};

inline std::string dicom_orientation(const std::string& cosines) {
  return dicom_group(0x20, 0x9116, dicom_element(0x20, 0x37, "DS", cosines));
}
inline std::string dicom_position(const glm::dvec3& p) {
  return dicom_group(0x20, 0x9113, dicom_element(0x20, 0x32, "DS", fmt::format("{}\\{}\\{}", p.x, p.y, p.z)));
}
/// Between rows, between columns.
inline std::string dicom_measures(double rows, double columns, double thickness) {
  return dicom_group(0x28, 0x9110,
                     dicom_element(0x18, 0x50, "DS", fmt::format("{}", thickness)) +
                         dicom_element(0x28, 0x30, "DS", fmt::format("{}\\{}", rows, columns)));
}
inline std::string dicom_scale(double slope, double intercept) {
  return dicom_group(0x28, 0x9145,
                     dicom_element(0x28, 0x1052, "DS", fmt::format("{}", intercept)) +
                         dicom_element(0x28, 0x1053, "DS", fmt::format("{}", slope)) +
                         dicom_element(0x28, 0x1054, "LO", "HU"));
}

inline std::string dicom_file(const DicomFrames& f) {
  const std::string about = dicom_element(2, 2, "UI", f.storage) + dicom_element(2, 3, "UI", "1.2.9") +
                            dicom_element(2, 0x10, "UI", "1.2.840.10008.1.2.1");
  std::string data = dicom_element(8, 0x16, "UI", f.storage) + dicom_element(8, 0x18, "UI", "1.2.9") +
                     dicom_element(8, 0x60, "CS", f.modality) + f.above;
  data += dicom_element(0x28, 2, "US", dicom_little(1, 2)) + dicom_element(0x28, 4, "CS", "MONOCHROME2") +
          dicom_element(0x28, 8, "IS", fmt::format("{}", f.frames)) +
          dicom_element(0x28, 0x10, "US", dicom_little(static_cast<std::uint32_t>(f.rows), 2)) +
          dicom_element(0x28, 0x11, "US", dicom_little(static_cast<std::uint32_t>(f.columns), 2)) +
          (f.spacing.empty() ? "" : dicom_element(0x28, 0x30, "DS", f.spacing)) +
          dicom_element(0x28, 0x100, "US", dicom_little(f.bits, 2)) +
          dicom_element(0x28, 0x101, "US", dicom_little(f.bits, 2)) +
          dicom_element(0x28, 0x102, "US", dicom_little(f.bits - 1, 2)) +
          dicom_element(0x28, 0x103, "US", dicom_little(f.bits == 16 ? 1 : 0, 2)) + f.below;
  if (!f.shared.empty()) data += dicom_group(0x5200, 0x9229, f.shared);
  std::string items;
  for (const std::string& groups : f.each) items += dicom_item(groups);
  if (!items.empty()) data += dicom_element(0x5200, 0x9230, "SQ", items);
  return std::string(128, '\0') + "DICM" +
         dicom_element(2, 0, "UL", dicom_little(static_cast<std::uint32_t>(about.size()), 4)) + about + data +
         dicom_element(0x7fe0, 0x10, f.bits == 16 ? "OW" : "OB", f.bits == 16 ? bytes_of(f.samples) : f.packed);
}

}  // namespace tessera::test
