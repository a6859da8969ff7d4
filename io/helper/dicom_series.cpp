#include "io/helper/dicom_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>
#include <utility>

#include "scene/error.hpp"

namespace tessera::io::helper {
namespace {

/// Decimal strings of a header round to about this, in millimetres and as a share of a step.
constexpr double same_place = 1e-3, even_enough = 1e-2;

bool lie_alike(const DicomSlice& a, const DicomSlice& b) {
  return a.series == b.series && a.columns == b.columns && a.rows == b.rows && a.frames == b.frames &&
         a.components == b.components && a.has_position == b.has_position && glm::dot(a.row, b.row) > 0.9999 &&
         glm::dot(a.column, b.column) > 0.9999;
}

/// Slices that may be of one volume, in groups.
std::vector<std::vector<DicomSlice>> groups_of(std::vector<DicomSlice> slices) {
  std::vector<std::vector<DicomSlice>> groups;
  for (DicomSlice& slice : slices) {
    const auto alike = std::find_if(groups.begin(), groups.end(), [&](const std::vector<DicomSlice>& group) {
      // Frames are a volume of their own.
      return slice.frames == 1 && lie_alike(group.front(), slice);
    });
    if (alike != groups.end())
      alike->push_back(std::move(slice));
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
    const bool is_plain = group.front().components == 1;
    return std::pair(is_plain, static_cast<std::int64_t>(group.size()) * group.front().frames);
  };
  auto chosen = std::find_if(groups.begin(), groups.end(), holds_named);
  if (chosen == groups.end())
    chosen = std::max_element(groups.begin(), groups.end(),
                              [&](const auto& a, const auto& b) { return samples_of(a) < samples_of(b); });
  if (chosen->front().components != 1)
    throw scene::bad_input(
        fmt::format("{}: its pictures are coloured, of {} numbers a sample, no values of a volume; "
                    "give a series of one number a sample",
                    source, chosen->front().components));
  if (groups.size() > 1)
    notes.push_back(fmt::format("of {} stacks of slices this is one of {}; name one of its files for another",
                                groups.size(), chosen->size() * static_cast<std::size_t>(chosen->front().frames)));
  return std::move(*chosen);
}

/// Each frame of a file of several as a slice of its own; of frames that are turned against each other, those of the
/// direction that most have.
std::vector<DicomSlice> frames_as_slices(std::vector<DicomSlice> slices, std::vector<std::string>& notes) {
  if (slices.size() != 1 || slices.front().each.empty()) return slices;
  DicomSlice file = std::move(slices.front());
  const std::vector<DicomFrame> each = std::exchange(file.each, {});
  if (!file.frames_note.empty()) notes.push_back(file.frames_note);
  std::vector<std::vector<DicomSlice>> directions;
  for (std::size_t k = 0; k < each.size(); ++k) {
    const DicomFrame& f = each[k];
    DicomSlice slice = file;
    slice.frame = slice.number = static_cast<std::int64_t>(k);
    slice.position = f.position, slice.row = f.row, slice.column = f.column;
    slice.slope = f.slope, slice.intercept = f.intercept, slice.time = f.time;
    const auto alike = std::find_if(directions.begin(), directions.end(),
                                    [&](const auto& group) { return lie_alike(group.front(), slice); });
    if (alike != directions.end())
      alike->push_back(std::move(slice));
    else
      directions.emplace_back().push_back(std::move(slice));
  }
  const auto most = std::max_element(directions.begin(), directions.end(),
                                     [](const auto& a, const auto& b) { return a.size() < b.size(); });
  if (directions.size() > 1)
    notes.push_back(fmt::format("its frames lie in {} directions, of which the {} of one are read", directions.size(),
                                most->size()));
  return std::move(*most);
}

/// Slices of one place are of several times: the slices of one of them.
std::vector<DicomSlice> slices_of_step(std::vector<DicomSlice> slices, std::optional<std::size_t> wish,
                                       const std::string& source, DicomVolume& volume) {
  const glm::dvec3 normal = slices.front().normal();
  const auto place = [&](const DicomSlice& s) {
    return s.has_position ? glm::dot(s.position, normal) : static_cast<double>(s.number);
  };
  std::sort(slices.begin(), slices.end(), [&](const DicomSlice& a, const DicomSlice& b) {
    return std::make_tuple(place(a), a.time, a.number, a.file) < std::make_tuple(place(b), b.time, b.number, b.file);
  });
  // Places that differ by less than rounding are one.
  std::vector<std::vector<DicomSlice>> places;
  double last = 0;
  for (DicomSlice& slice : slices) {
    const double here = place(slice);
    if (places.empty() || here - last > same_place) places.emplace_back();
    last = here;
    places.back().push_back(std::move(slice));
  }
  std::size_t least = places.front().size(), most = least;
  for (auto& at : places) {
    std::sort(at.begin(), at.end(), [](const DicomSlice& a, const DicomSlice& b) {
      return std::tie(a.time, a.number, a.file) < std::tie(b.time, b.number, b.file);
    });
    least = std::min(least, at.size()), most = std::max(most, at.size());
  }
  if (wish && *wish >= least)
    throw scene::bad_input(
        fmt::format("{}: there is no time step {}, the series has {}; count from 0", source, *wish, least));
  const std::size_t step = wish.value_or(least - 1);
  volume.time_step = {least, step};
  if (most > least)
    volume.notes.push_back(
        fmt::format("some places have {} slices, others {}; what is beyond is left out", most, least));
  std::vector<DicomSlice> chosen;
  chosen.reserve(places.size());
  for (auto& at : places) chosen.push_back(std::move(at[step]));
  return chosen;
}

/// Steps from slice to slice, and what is odd about them.
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
    // Along the line from the first slice to the last.
    volume.steps[2] = whole / glm::length(whole);
    for (double& place : places) place *= glm::length(whole) / height;
    volume.places = std::move(places);
    const auto at = static_cast<std::size_t>(most - gaps.begin());
    const double missing = std::round(*most / usual) - 1;
    volume.notes.push_back(fmt::format(
        "slices are {:.4g} to {:.4g} mm apart, the widest gap after {}{}: a rectilinear grid", *least, *most,
        slices[at].file.filename().string(),
        missing >= 1 ? fmt::format("; there {:.0f} slice{} may be missing", missing, missing > 1 ? "s" : "") : ""));
  }
  const double tilt = glm::length(glm::cross(glm::normalize(whole), normal));
  if (tilt > 1e-3)
    volume.notes.push_back(fmt::format("slices are shifted against each other, by {:.1f} degrees",
                                       std::asin(std::min(tilt, 1.0)) * 57.29577951308232));
}

}  // namespace

DicomVolume volume_of(std::vector<DicomSlice> slices, const std::filesystem::path& named,
                      std::optional<std::size_t> time_step, const std::string& source) {
  DicomVolume volume;
  std::vector<DicomSlice> group = chosen_group(std::move(slices), named, source, volume.notes);
  volume.slices = slices_of_step(frames_as_slices(std::move(group), volume.notes), time_step, source, volume);
  const DicomSlice& first = volume.slices.front();
  volume.origin = first.position;
  volume.steps = {first.row * first.spacing.x, first.column * first.spacing.y, first.normal() * first.spacing.z};
  if (volume.slices.size() == 1 && first.frames > 1)
    throw scene::bad_input(
        fmt::format("{}: all its {} frames are at one place: times of one picture, not a volume; give a volume", source,
                    first.frames));
  if (volume.slices.size() == 1)
    throw scene::bad_input(
        fmt::format("{}: it is a single slice, without others of its series beside it; give a "
                    "folder of slices",
                    source));
  if (!first.has_position)
    volume.notes.push_back(
        fmt::format("its files do not say where slices are: by their numbers, {:.4g} mm apart", first.spacing.z));
  else if (volume.slices.size() > 1)
    set_places(volume);
  return volume;
}

}  // namespace tessera::io::helper
