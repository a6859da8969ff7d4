// SPDX-License-Identifier: BSD-3-Clause
#include "readers/dicom/dicom_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>
#include <utility>

#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// Rounding errors of decimal strings in a header: in millimetres, and relative to a step.
constexpr double same_place = 1e-3, even_enough = 1e-2;

bool same_layout(const DicomSlice& a, const DicomSlice& b) {
  const auto are_near = [](double x, double y) { return std::abs(x - y) <= same_place * std::max(x, y); };
  return are_near(a.spacing.x, b.spacing.x) && are_near(a.spacing.y, b.spacing.y) && a.series == b.series &&
         a.columns == b.columns && a.rows == b.rows && a.frames == b.frames && a.components == b.components &&
         a.has_position == b.has_position && glm::dot(a.row, b.row) > 0.9999 && glm::dot(a.column, b.column) > 0.9999;
}

/// Groups the slices that may belong to the same volume.
std::vector<std::vector<DicomSlice>> groups_of(std::vector<DicomSlice> slices) {
  std::vector<std::vector<DicomSlice>> groups;
  for (DicomSlice& slice : slices) {
    const auto match = std::find_if(groups.begin(), groups.end(), [&](const std::vector<DicomSlice>& group) {
      // Each multi-frame file is a volume of its own.
      return slice.frames == 1 && same_layout(group.front(), slice);
    });
    if (match != groups.end())
      match->push_back(std::move(slice));
    else
      groups.emplace_back().push_back(std::move(slice));
  }
  return groups;
}

std::vector<DicomSlice> chosen_group(std::vector<DicomSlice> slices, const std::filesystem::path& named,
                                     const std::string& source, std::vector<std::string>& notes) {
  std::vector<std::vector<DicomSlice>> groups = groups_of(std::move(slices));
  const auto holds_named = [&](const std::vector<DicomSlice>& group) {
    return std::any_of(group.begin(), group.end(), [&](const DicomSlice& s) { return s.file == named; });
  };
  const auto samples_of = [](const std::vector<DicomSlice>& group) {
    const bool is_plain = group.front().components == 1, is_scan = group.front().segments.type.empty();
    return std::tuple(is_plain, is_scan, static_cast<std::int64_t>(group.size()) * group.front().frames);
  };
  auto chosen = std::find_if(groups.begin(), groups.end(), holds_named);
  if (chosen == groups.end())
    chosen = std::max_element(groups.begin(), groups.end(),
                              [&](const auto& a, const auto& b) { return samples_of(a) < samples_of(b); });
  if (chosen->front().components != 1)
    throw scene::bad_input(
        fmt::format("{}: its images are coloured, with {} numbers per sample; give a series with one number per sample",
                    source, chosen->front().components));
  if (chosen->front().is_mosaic)
    throw scene::bad_input(
        fmt::format("{}: its slices are side by side in one image (Siemens mosaic), which is not supported; convert "
                    "it: dcm2niix DIRECTORY",
                    source));
  if (groups.size() > 1)
    notes.push_back(
        fmt::format("there are slices of {} different series, sizes, spacings or directions; only the {} slices of one "
                    "group are shown; name a file of another group to show its slices",
                    groups.size(), chosen->size() * static_cast<std::size_t>(chosen->front().frames)));
  return std::move(*chosen);
}

/// Splits each multi-frame file into slices. If frames have several directions or spacings, keeps only frames with the
/// most frequent ones.
std::vector<DicomSlice> frames_as_slices(std::vector<DicomSlice> slices, std::vector<std::string>& notes) {
  if (slices.size() != 1 || slices.front().each.empty()) return slices;
  DicomSlice file = std::move(slices.front());
  const std::vector<DicomFrame> each = std::exchange(file.each, {});
  if (!file.frames_note.empty()) notes.push_back(file.frames_note);
  std::vector<std::vector<DicomSlice>> stacks;
  for (std::size_t k = 0; k < each.size(); ++k) {
    const DicomFrame& f = each[k];
    DicomSlice slice = file;
    slice.frame = slice.number = static_cast<std::int64_t>(k);
    slice.position = f.position, slice.row = f.row, slice.column = f.column;
    slice.spacing.x = f.spacing.x, slice.spacing.y = f.spacing.y;
    slice.slope = f.slope, slice.intercept = f.intercept, slice.time = f.time;
    slice.joined = {{.frame = slice.frame, .segment = f.segment}};
    const auto match = std::find_if(stacks.begin(), stacks.end(),
                                    [&](const auto& group) { return same_layout(group.front(), slice); });
    if (match != stacks.end())
      match->push_back(std::move(slice));
    else
      stacks.emplace_back().push_back(std::move(slice));
  }
  const auto most =
      std::max_element(stacks.begin(), stacks.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  if (stacks.size() > 1)
    notes.push_back(
        fmt::format("its frames have {} different directions or spacings, and only the {} frames of one are read",
                    stacks.size(), most->size()));
  return std::move(*most);
}

/// Groups slices by position along the normal. Slices at one position are sorted by time and number.
std::vector<std::vector<DicomSlice>> by_place(std::vector<DicomSlice> slices) {
  const glm::dvec3 normal = slices.front().normal();
  const auto place = [&](const DicomSlice& s) {
    return s.has_position ? glm::dot(s.position, normal) : static_cast<double>(s.number);
  };
  std::sort(slices.begin(), slices.end(), [&](const DicomSlice& a, const DicomSlice& b) {
    return std::make_tuple(place(a), a.time.value, a.number, a.file) <
           std::make_tuple(place(b), b.time.value, b.number, b.file);
  });
  // Positions that differ by less than the rounding error are merged.
  std::vector<std::vector<DicomSlice>> places;
  double last = 0;
  for (DicomSlice& slice : slices) {
    const double here = place(slice);
    if (places.empty() || here - last > same_place) places.emplace_back();
    last = here;
    places.back().push_back(std::move(slice));
  }
  for (auto& at : places)
    std::sort(at.begin(), at.end(), [](const DicomSlice& a, const DicomSlice& b) {
      return std::tie(a.time.value, a.number, a.file) < std::tie(b.time.value, b.number, b.file);
    });
  return places;
}

std::size_t chosen_step(std::optional<std::size_t> requested, std::size_t count, const std::string& source) {
  if (requested && *requested >= count)
    throw scene::bad_input(
        fmt::format("{}: there is no time step {}, the series has {}; count from 0", source, *requested, count));
  return requested.value_or(count - 1);
}

/// Returns times in seconds relative to the first of `count` slices at one position; empty if the files do not state
/// them.
std::vector<double> times_of(const std::vector<DicomSlice>& at, std::size_t count) {
  std::vector<double> times;
  for (std::size_t k = 0; k < count; ++k) {
    const DicomTime first = at.front().time, its = at[k].time;
    const double time = (its.value - first.value) * its.unit;
    if (its.unit == 0 || its.unit != first.unit || (k > 0 && time <= times.back())) return {};
    times.push_back(time);
  }
  return times;
}

/// If slices at one position have several times, returns the slices of one time.
std::vector<DicomSlice> slices_of_step(std::vector<DicomSlice> slices, std::optional<std::size_t> requested,
                                       const std::string& source, DicomVolume& volume) {
  std::vector<std::vector<DicomSlice>> places = by_place(std::move(slices));
  std::size_t least = places.front().size(), most = least;
  for (const auto& at : places) {
    least = std::min(least, at.size()), most = std::max(most, at.size());
  }
  const std::size_t step = chosen_step(requested, least, source);
  volume.time_step = {least, step};
  scene::set_times(volume.time_step, times_of(places.front(), least));
  if (most > least)
    volume.notes.push_back(
        fmt::format("some positions have {} slices, others {}; the surplus slices are left out", most, least));
  std::vector<DicomSlice> chosen;
  chosen.reserve(places.size());
  for (auto& at : places) chosen.push_back(std::move(at[step]));
  return chosen;
}

/// Returns "2 liver, 5 spleen" for the segments with these numbers.
std::string names_of(const DicomSegments& segments, const std::vector<std::int64_t>& numbers) {
  constexpr std::size_t most = 12;
  std::string words;
  for (std::size_t k = 0; k < std::min(numbers.size(), most); ++k) {
    const auto named = std::find_if(segments.names.begin(), segments.names.end(),
                                    [&](const auto& segment) { return segment.first == numbers[k]; });
    words +=
        fmt::format("{}{}{}", k > 0 ? ", " : "", numbers[k],
                    named == segments.names.end() || named->second.empty() ? "" : fmt::format(" {}", named->second));
  }
  return words + (numbers.size() > most ? fmt::format(" and {} more", numbers.size() - most) : "");
}

/// Inserts slices of zeros, because a file may omit frames in which a segment has no samples.
std::vector<DicomSlice> with_empty_slices(std::vector<DicomSlice> slices, const std::string& source) {
  if (slices.size() < 2) return slices;
  const glm::dvec3 along = slices.front().normal();
  const auto gap = [&](std::size_t k) { return glm::dot(slices[k].position - slices[k - 1].position, along); };
  double least = gap(1);
  for (std::size_t k = 2; k < slices.size(); ++k) least = std::min(least, gap(k));
  const auto are_multiples_of = [&](double step) {
    for (std::size_t k = 1; k < slices.size(); ++k)
      if (std::round(gap(k) / step) < 1 || std::abs(gap(k) / step - std::round(gap(k) / step)) > even_enough)
        return false;
    return true;
  };
  const double stated = slices.front().spacing.z, step = are_multiples_of(stated) ? stated : least;
  if (!are_multiples_of(step)) return slices;
  constexpr double most_slices = 65536;
  std::vector<DicomSlice> filled;
  for (std::size_t k = 0; k < slices.size(); ++k) {
    const double steps = k > 0 ? std::round(gap(k) / step) : 1;
    if (static_cast<double>(filled.size()) + steps > most_slices)
      throw scene::bad_input(
          fmt::format("{}: it has gaps of up to {:.4g} mm between frames, which in steps of {:.4g} mm would be more "
                      "than {:.0f} slices; correct the positions of its frames",
                      source, gap(k), step, most_slices));
    const glm::dvec3 before = k > 0 ? slices[k - 1].position : slices[k].position;
    for (int n = 1; n < steps; ++n) {
      DicomSlice empty = filled.back();
      empty.position = before + (slices[k].position - before) * (n / steps);
      empty.joined.clear();
      filled.push_back(std::move(empty));
    }
    filled.push_back(std::move(slices[k]));
  }
  return filled;
}

/// Returns one slice per position: for labels combined from all frames, for fractions from those of the chosen segment.
std::vector<DicomSlice> slices_of_segments(std::vector<DicomSlice> frames, std::optional<std::size_t> requested,
                                           const std::string& source, DicomVolume& volume) {
  const DicomSegments segments = frames.front().segments;
  const bool are_fractions = segments.type == "FRACTIONAL";
  std::vector<std::int64_t> numbers;
  numbers.reserve(frames.size());
  for (const DicomSlice& frame : frames) numbers.push_back(frame.joined.front().segment);
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  const std::size_t step = chosen_step(requested, are_fractions ? numbers.size() : 1, source);
  if (are_fractions) volume.time_step = {numbers.size(), step};
  if (numbers.back() > 0)
    volume.notes.push_back(are_fractions ? fmt::format("values are the fractions of segment {}; time steps are its "
                                                       "segments, from 0 on: {}",
                                                       names_of(segments, {numbers[step]}), names_of(segments, numbers))
                                         : fmt::format("values are segment numbers, 0 outside all segments: {}",
                                                       names_of(segments, numbers)));
  std::vector<DicomSlice> slices;
  for (std::vector<DicomSlice>& at : by_place(std::move(frames))) {
    DicomSlice slice = at.front();
    slice.joins_frames = true;
    slice.joined.clear();
    for (const DicomSlice& frame : at)
      if (!are_fractions || frame.joined.front().segment == numbers[step])
        slice.joined.push_back({frame.frame, are_fractions ? 0 : frame.joined.front().segment});
    std::ranges::stable_sort(slice.joined, {}, &DicomFrameOfSegment::segment);
    slices.push_back(std::move(slice));
  }
  return with_empty_slices(std::move(slices), source);
}

/// Sets the steps from slice to slice, and notes irregularities.
void set_places(DicomVolume& volume) {
  const std::vector<DicomSlice>& slices = volume.slices;
  const DicomSlice &first = slices.front(), &last = slices.back();
  const glm::dvec3 normal = first.normal(), whole = last.position - first.position;
  const double height = glm::dot(whole, normal);
  const auto count = static_cast<double>(slices.size() - 1);
  const glm::dvec3 mean = whole / count;
  std::vector<double> places, gaps;
  for (const DicomSlice& s : slices) places.push_back(glm::dot(s.position - first.position, normal));
  for (std::size_t k = 1; k < places.size(); ++k) gaps.push_back(places[k] - places[k - 1]);
  const double usual = [&] {
    std::vector<double> sorted = gaps;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
    return sorted[sorted.size() / 2];
  }();
  const auto [least, most] = std::minmax_element(gaps.begin(), gaps.end());
  volume.steps[2] = mean;
  if (*most - *least > even_enough * usual) {
    // The direction is that of the line from the first slice to the last.
    volume.steps[2] = whole / glm::length(whole);
    for (double& place : places) place *= glm::length(whole) / height;
    volume.places = std::move(places);
    const auto at = static_cast<std::size_t>(most - gaps.begin());
    const double missing = std::round(*most / usual) - 1;
    volume.notes.push_back(fmt::format(
        "slices are {:.4g} to {:.4g} mm apart, with the widest gap after {}{}: they are read as a rectilinear grid",
        *least, *most, slices[at].file.filename().string(),
        missing >= 1 ? fmt::format("; there {:.0f} slice{} may be missing", missing, missing > 1 ? "s" : "") : ""));
  }
  const double tilt = glm::length(glm::cross(glm::normalize(whole), normal));
  if (tilt > 1e-3)
    volume.notes.push_back(fmt::format("slices are shifted relative to each other, by {:.1f} degrees",
                                       std::asin(std::min(tilt, 1.0)) * 57.29577951308232));
}

}  // namespace

DicomVolume volume_of(std::vector<DicomSlice> slices, const std::filesystem::path& named,
                      std::optional<std::size_t> time_step, const std::string& source) {
  DicomVolume volume;
  std::vector<DicomSlice> group = chosen_group(std::move(slices), named, source, volume.notes);
  group = frames_as_slices(std::move(group), volume.notes);
  volume.slices = group.front().frames > 1 && !group.front().segments.type.empty()
                      ? slices_of_segments(std::move(group), time_step, source, volume)
                      : slices_of_step(std::move(group), time_step, source, volume);
  const DicomSlice& first = volume.slices.front();
  volume.origin = first.position;
  volume.steps = {first.row * first.spacing.x, first.column * first.spacing.y, first.normal() * first.spacing.z};
  if (volume.slices.size() == 1 && first.joins_frames)
    throw scene::bad_input(
        fmt::format("{}: all its segments are in one slice, which is not a volume; give a volume", source));
  if (volume.slices.size() == 1 && first.frames > 1)
    throw scene::bad_input(fmt::format(
        "{}: all its {} frames are at one position: they show one slice at several times, not a volume; give a volume",
        source, first.frames));
  if (volume.slices.size() == 1)
    throw scene::bad_input(
        fmt::format("{}: it is a single slice, without others of its series next to it; give a "
                    "directory of slices",
                    source));
  if (!first.has_position)
    volume.notes.push_back(
        fmt::format("its files do not state the positions of slices: they are placed by their numbers, {:.4g} mm apart",
                    first.spacing.z));
  else if (volume.slices.size() > 1)
    set_places(volume);
  return volume;
}

}  // namespace tessera::readers
