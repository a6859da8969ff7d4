// SPDX-License-Identifier: BSD-3-Clause
#include "readers/dicom/dicom_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "readers/dicom/dicom_elements.hpp"

namespace tessera::readers {
namespace {

std::optional<glm::dvec3> position_in(const gdcm::DataSet& data) {
  const std::vector<double> p = dicom_numbers(data, 0x0020, 0x0032);
  return p.size() == 3 ? std::optional(glm::dvec3(p[0], p[1], p[2])) : std::nullopt;
}

/// Returns the directions of rows and columns as unit vectors.
std::optional<std::array<glm::dvec3, 2>> orientation_in(const gdcm::DataSet& data) {
  const std::vector<double> axes = dicom_numbers(data, 0x0020, 0x0037);
  if (axes.size() != 6) return std::nullopt;
  const glm::dvec3 row(axes[0], axes[1], axes[2]), column(axes[3], axes[4], axes[5]);
  if (!(glm::length(glm::cross(row, column)) > 0.9)) return std::nullopt;
  return std::array{glm::normalize(row), glm::normalize(column)};
}

/// Values that functional groups state for frames. `slices_apart` and `thickness` are 0 if they are not stated.
struct FrameFacts {
  DicomFrame frame;
  bool has_position = false;
  glm::dvec3 spacing{1};
  double slices_apart = 0, thickness = 0;
};

/// Returns the first item of a group's sequence within an item.
std::optional<gdcm::DataSet> group_in(const gdcm::DataSet& groups, std::uint16_t group, std::uint16_t element) {
  std::vector<gdcm::DataSet> items = dicom_items(groups, group, element);
  return items.empty() ? std::nullopt : std::optional(std::move(items.front()));
}

void add_measures(const gdcm::DataSet& data, FrameFacts& facts) {
  const std::vector<double> between = dicom_numbers(data, 0x0028, 0x0030);
  if (between.size() == 2 && between[0] > 0 && between[1] > 0)
    facts.spacing.x = between[1], facts.spacing.y = between[0];  // the spacing between rows comes first
  if (const auto apart = dicom_number(data, 0x0018, 0x0088)) facts.slices_apart = *apart;
  if (const auto thick = dicom_number(data, 0x0018, 0x0050)) facts.thickness = std::abs(*thick);
}

/// Returns the key by which frames at one position are sorted.
std::optional<DicomTime> time_in(const gdcm::DataSet& groups) {
  if (const auto position = group_in(groups, 0x0020, 0x9310))
    if (const auto offset = dicom_double(*position, 0x0020, 0x930d)) return DicomTime{*offset, 1};
  if (const auto content = group_in(groups, 0x0020, 0x9111)) {
    if (const auto index = dicom_count(*content, 0x0020, 0x9128)) return DicomTime{*index, 0};  // temporal position
    for (const std::uint16_t element : {0x9151, 0x9074})  // reference, acquisition
      if (const auto moment = dicom_moment(dicom_text(*content, 0x0018, element))) return DicomTime{*moment, 1};
  }
  return std::nullopt;
}

/// Adds the values of an item of functional groups: the file's shared groups, or those of a frame.
void add_groups(const gdcm::DataSet& groups, FrameFacts& facts) {
  if (const auto plane = group_in(groups, 0x0020, 0x9113))
    if (const auto position = position_in(*plane)) facts.frame.position = *position, facts.has_position = true;
  if (const auto plane = group_in(groups, 0x0020, 0x9116))
    if (const auto axes = orientation_in(*plane)) facts.frame.row = (*axes)[0], facts.frame.column = (*axes)[1];
  if (const auto measures = group_in(groups, 0x0028, 0x9110)) add_measures(*measures, facts);
  if (const auto scale = group_in(groups, 0x0028, 0x9145)) {
    const auto slope = dicom_number(*scale, 0x0028, 0x1053), intercept = dicom_number(*scale, 0x0028, 0x1052);
    if (slope && intercept && *slope != 0) facts.frame.slope = *slope, facts.frame.intercept = *intercept;
  }
  if (const auto time = time_in(groups)) facts.frame.time = *time;
  if (const auto segment = group_in(groups, 0x0062, 0x000a))
    if (const auto number = dicom_count(*segment, 0x0062, 0x000b))
      facts.frame.segment = static_cast<std::int64_t>(*number);
  if (const auto heart = group_in(groups, 0x0018, 0x9118); heart && facts.frame.time.value == 0)
    if (const auto delay = dicom_double(*heart, 0x0020, 0x9153)) facts.frame.time = {*delay, 1e-3};
}

/// Returns the values that apply to all frames unless a frame states its own.
FrameFacts facts_of_file(const gdcm::DataSet& data, const DicomSlice& slice) {
  FrameFacts facts;
  facts.frame.row = slice.row, facts.frame.column = slice.column;
  facts.frame.slope = slice.slope, facts.frame.intercept = slice.intercept;
  facts.spacing = slice.spacing;
  facts.frame.position = slice.position;
  add_measures(data, facts);
  if (const auto axes = orientation_in(data)) facts.frame.row = (*axes)[0], facts.frame.column = (*axes)[1];
  if (const auto position = position_in(data)) facts.frame.position = *position;
  // In nuclear medicine, the item of a detector contains both orientation and position.
  for (const gdcm::DataSet& detector : dicom_items(data, 0x0054, 0x0022)) {
    if (const auto axes = orientation_in(detector)) facts.frame.row = (*axes)[0], facts.frame.column = (*axes)[1];
    if (const auto position = position_in(detector)) facts.frame.position = *position;
    break;
  }
  if (const auto dose = dicom_number(data, 0x3004, 0x000e); dose && *dose != 0)
    facts.frame.slope = *dose, facts.frame.intercept = 0;
  for (const gdcm::DataSet& shared : dicom_items(data, 0x5200, 0x9229)) add_groups(shared, facts);
  return facts;
}

/// Sets the positions of RT dose: the distance of each frame from the first along the normal. If the first number is
/// not zero, the numbers are positions along the patient's axis instead.
bool set_dose_places(const gdcm::DataSet& data, DicomSlice& slice) {
  const std::vector<double> offsets = dicom_numbers(data, 0x3004, 0x000c);
  if (offsets.size() != slice.each.size()) return false;
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    DicomFrame& frame = slice.each[k];
    const glm::dvec3 normal = glm::normalize(glm::cross(frame.row, frame.column));
    const bool are_places = offsets[0] != 0 && std::abs(normal.z) > 0.999;
    frame.position += (offsets[k] - offsets[0]) * (are_places ? glm::dvec3(0, 0, 1) : normal);
  }
  return true;
}

/// Sets positions of consecutive frames. In nuclear medicine the file numbers the slices; for several phases or time
/// slots, one sequence follows the other.
void set_even_places(const gdcm::DataSet& data, const FrameFacts& file, DicomSlice& slice) {
  std::vector<std::uint16_t> places = dicom_shorts(data, 0x0054, 0x0080);
  const std::vector<std::uint16_t> slots = dicom_shorts(data, 0x0054, 0x0070),
                                   phases = dicom_shorts(data, 0x0054, 0x0030);
  const std::size_t count = slice.each.size();
  const bool is_listed = places.size() == count;
  // The frames are those of several consecutive volumes, and the file states how many.
  const double volumes = dicom_number(data, 0x0020, 0x0105).value_or(1);
  const auto parts = static_cast<std::size_t>(std::clamp(volumes, 1.0, static_cast<double>(count)));
  const std::size_t each = !is_listed && count % parts == 0 ? count / parts : count;
  const double apart = file.slices_apart != 0 ? file.slices_apart : file.thickness > 0 ? file.thickness : 1;
  for (std::size_t k = 0; k < count; ++k) {
    DicomFrame& frame = slice.each[k];
    const double at = is_listed ? places[k] - 1.0 : static_cast<double>(k % each);
    frame.position += at * apart * glm::normalize(glm::cross(frame.row, frame.column));
    if (!is_listed) frame.time = {static_cast<double>(k / each), 0};
    if (slots.size() == count) frame.time.value += 1e5 * slots[k];
    if (phases.size() == count) frame.time.value += phases[k];
  }
  slice.frames_note = file.slices_apart != 0 ? fmt::format(
                                                   "its frames do not state their positions: they are placed one after "
                                                   "the other, {:.4g} mm apart, the stated spacing between slices",
                                                   std::abs(apart))
                      : file.thickness > 0
                          ? fmt::format(
                                "its frames do not state their positions: they are placed one after the other, {:.4g} "
                                "mm apart, the stated slice thickness",
                                apart)
                          : "its frames state neither their positions nor their distance: they are placed one after "
                            "the other, 1 mm apart, which is wrong if they show one slice at several times";
}

}  // namespace

void set_frames(const gdcm::DataSet& data, DicomSlice& slice) {
  const FrameFacts file = facts_of_file(data, slice);
  const std::vector<gdcm::DataSet> frames = dicom_items(data, 0x5200, 0x9230);
  const auto count = static_cast<std::size_t>(slice.frames);
  bool all_placed = frames.size() == count;
  FrameFacts first = file;
  for (std::size_t k = 0; k < count; ++k) {
    FrameFacts facts = file;
    facts.has_position = false;
    if (k < frames.size()) add_groups(frames[k], facts);
    all_placed = all_placed && facts.has_position;
    if (k == 0) first = facts;
    facts.frame.spacing = glm::dvec2(facts.spacing);
    slice.each.push_back(facts.frame);
  }
  slice.spacing = first.spacing;
  if (const double apart = std::abs(first.slices_apart); apart > 0)
    slice.spacing.z = apart;
  else if (first.thickness > 0)
    slice.spacing.z = first.thickness;
  slice.has_position = true;
  if (all_placed) return;
  for (DicomFrame& frame : slice.each) frame.position = file.frame.position;
  if (!set_dose_places(data, slice)) set_even_places(data, first, slice);
}

}  // namespace tessera::readers
