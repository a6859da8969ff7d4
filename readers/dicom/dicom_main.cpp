// SPDX-License-Identifier: BSD-3-Clause
// tessera-read-dicom: reads DICOM files by GDCM, as tessera-read-vtk does for other formats. A separate program,
// because that library and its dependencies take a while to load.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>

#include "io/files/file_beginnings.hpp"
#include "io/files/input_file.hpp"
#include "readers/common/holdings.hpp"
#include "readers/common/opened_files.hpp"
#include "readers/common/readers.hpp"
#include "readers/common/serve.hpp"
#include "readers/dicom/dicom_headers.hpp"
#include "readers/dicom/dicom_series.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// Adds a note about files that begin like DICOM but are not among the slices, because they may be missing slices.
void note_left_out(const std::vector<std::filesystem::path>& files, const std::vector<DicomSlice>& slices,
                   std::vector<std::string>& notes) {
  std::size_t count = 0;
  std::string first;
  auto slice = slices.begin();  // slices are in the order of the files
  for (const std::filesystem::path& file : files) {
    if (slice != slices.end() && slice->file == file) {
      ++slice;
    } else if (io::looks_like_dicom(io::read_beginning(file, 132))) {
      if (count++ == 0) first = file.filename().string();
    }
  }
  if (count > 0)
    notes.push_back(fmt::format("left out {} DICOM file{} without an image that GDCM can read; the first is {}", count,
                                count > 1 ? "s" : "", first));
}

/// Returns the slices in one directory or, if there are none, those in its subdirectories.
std::vector<DicomSlice> slices_in(const std::filesystem::path& folder, std::vector<std::string>& notes) {
  constexpr std::size_t most_files = 200000;
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    files.push_back(entry->path());
  const auto slices_among = [&notes](std::vector<std::filesystem::path>& found) {
    std::erase_if(found, [](const std::filesystem::path& file) {
      std::error_code unknown;
      // A DICOMDIR is skipped, because it is an index of other files.
      return !std::filesystem::is_regular_file(file, unknown) || std::filesystem::file_size(file, unknown) < 132 ||
             file.filename() == "DICOMDIR";
    });
    std::sort(found.begin(), found.end());
    std::vector<DicomSlice> slices = read_dicom_headers(found);
    if (!slices.empty()) note_left_out(found, slices, notes);
    return slices;
  };
  std::vector<DicomSlice> slices = slices_among(files);
  if (!slices.empty()) return slices;
  std::vector<std::filesystem::path> below;
  for (std::filesystem::recursive_directory_iterator entry(folder, error), end;
       !error && entry != end && below.size() < most_files; entry.increment(error))
    below.push_back(entry->path());
  return slices_among(below);
}

/// The smallest type for all values: integers exactly, others as floats; blanks require floats.
NumberType type_of(const DicomValues& values) {
  const cells::NumberTally& t = values.tally;
  const auto within = [&](double low, double high) { return values.are_whole && t.low >= low && t.high <= high; };
  if (t.not_finite > 0) return !values.are_whole || within(-0x1p24, 0x1p24) ? NumberType::float32 : NumberType::float64;
  if (within(0, 255)) return NumberType::uint8;
  if (within(-32768, 32767)) return NumberType::int16;
  if (within(0, 65535)) return NumberType::uint16;
  if (within(-0x1p31, 0x1p31 - 1)) return NumberType::int32;
  if (within(0, 0x1p32 - 1)) return NumberType::uint32;
  return values.are_whole ? NumberType::float64 : NumberType::float32;
}

/// The samples of the slices' files, each file once.
struct DicomStack {
  std::vector<DicomSlice> slices;
  std::vector<std::shared_ptr<const DicomSamples>> samples;  ///< one per slice; may include frames of other slices
};

/// Holds samples as stored; they are converted to values on demand.
io::ForeignArray hold_samples(Holdings& holdings, const DicomVolume& volume, std::vector<std::string>& notes) {
  static_cast<void>(take_opened_files());  // discards files that were only inspected
  const auto stack = std::make_shared<DicomStack>();
  stack->slices = volume.slices;
  constexpr std::size_t at_once = 1 << 15;
  DicomValues values;
  std::map<std::filesystem::path, std::shared_ptr<const DicomSamples>> opened;
  for (const DicomSlice& slice : volume.slices) {
    report_progress(static_cast<double>(&slice - volume.slices.data()) / static_cast<double>(volume.slices.size()));
    report_reading(slice.file);
    auto& samples = opened[slice.file];
    if (!samples) samples = std::make_shared<const DicomSamples>(slice);
    stack->samples.push_back(samples);
    const DicomValues own = samples->values(slice);
    values.are_whole = values.are_whole && own.are_whole;
    values.tally.not_finite += own.tally.not_finite;
    values.shared += own.shared;
    if (own.tally.any_finite) values.tally.add(std::array{own.tally.low, own.tally.high});
  }
  if (const auto blank = values.tally.not_finite;
      blank > 0 && std::any_of(volume.slices.begin(), volume.slices.end(), [](const auto& s) { return s.padding; }))
    notes.push_back(fmt::format("{} samples have the padding value that the header states: they are blank", blank));
  if (values.shared > 0)
    notes.push_back(
        fmt::format("{} samples are in several segments; the segment with the largest number is shown", values.shared));
  const std::size_t each = stack->samples.front()->frame_count();  // slices of a volume have one size
  io::ForeignArray array{
      .name = "samples", .type = type_of(values), .tuples = each * stack->slices.size(), .tally = values.tally};
  return holdings.hold(array,
                       [stack, each, type = array.type](std::uint64_t first, std::uint64_t count, std::byte* out) {
                         std::vector<double> part;
                         for (std::uint64_t k = first; k < first + count; k += part.size()) {
                           const std::size_t within = k % each;
                           part.resize(std::min<std::uint64_t>({first + count - k, each - within, at_once}));
                           stack->samples[k / each]->read(stack->slices[k / each], within, part);
                           io::with_number_type(type, [&](auto zero) {
                             using Number = decltype(zero);
                             for (const double value : part) {
                               const auto number = static_cast<Number>(value);
                               std::memcpy(out, &number, sizeof number);
                               out += sizeof number;
                             }
                           });
                         }
                       });
}

io::ForeignContents read_dicom(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  const std::string source = file.string();
  std::error_code unknown;
  const bool is_folder = std::filesystem::is_directory(file, unknown);
  std::vector<DicomSlice> slices;
  io::ForeignContents contents;
  const std::filesystem::path folder = is_folder ? file : file.parent_path().empty() ? "." : file.parent_path();
  allow_for_folder(folder);
  if (is_folder) {
    slices = slices_in(file, contents.notes);
  } else {
    const std::vector<DicomSlice> one = read_dicom_headers(std::span(&file, 1));
    if (one.empty())
      throw scene::bad_input(
          io::looks_like_dicom(io::read_beginning(file, 132))
              ? fmt::format("{}: it is a DICOM file, but GDCM finds no images in it: it is a report, plan or list, or "
                            "ends within its header; give a directory or a file of slices",
                            source)
              : fmt::format("{}: GDCM finds no images in it; give a directory or a file of slices", source));
    if (one.front().frames > 1) {
      slices = one;
    } else {
      slices = slices_in(folder, contents.notes);
      for (DicomSlice& slice : slices)
        if (std::filesystem::equivalent(slice.file, file, unknown)) slice.file = file;
    }
  }
  if (slices.empty())
    throw scene::bad_input(fmt::format("{}: none of its files is a DICOM image; give a directory of slices", source));
  std::optional<std::size_t> time_step;
  if (const auto step = request.find("time_step"); step != request.end()) time_step = step->get<std::size_t>();
  DicomVolume volume = volume_of(std::move(slices), file, time_step, source);
  const DicomSlice& first = volume.slices.front();
  allow_for_folder(
      folder, std::any_of(volume.slices.begin(), volume.slices.end(), [](const DicomSlice& s) { return s.is_packed; }));

  contents.format = fmt::format("DICOM{}{}", first.modality.empty() ? "" : " ", first.modality);
  contents.notes.insert(contents.notes.begin(), volume.notes.begin(), volume.notes.end());
  contents.time_step = volume.time_step;
  const auto is_scaled = [](const DicomSlice& s) { return s.slope != 1 || s.intercept != 0; };
  if (std::any_of(volume.slices.begin(), volume.slices.end(), is_scaled)) {
    const bool are_alike = std::all_of(volume.slices.begin(), volume.slices.end(), [&](const DicomSlice& s) {
      return s.slope == first.slope && s.intercept == first.intercept;
    });
    contents.notes.push_back(are_alike ? fmt::format("values are {:.9g} * sample + {:.9g}, as its header states",
                                                     first.slope, first.intercept)
                                       : "each slice has its own scale, which is applied");
  }
  contents.labels = !first.segments.type.empty() && first.segments.type != "FRACTIONAL";
  contents.modality = first.modality, contents.unit = first.unit;
  if (!first.unit.empty()) contents.notes.push_back("values are in " + first.unit);
  io::ForeignPart& part = contents.parts.emplace_back();
  const auto depth = static_cast<std::int64_t>(volume.slices.size());
  part.extent = {0, first.columns - 1, 0, first.rows - 1, 0, depth - 1};
  part.origin = {volume.origin.x, volume.origin.y, volume.origin.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double length = glm::length(volume.steps[axis]);
    part.spacing[axis] = length;
    for (int k = 0; k < 3; ++k) part.direction[static_cast<std::size_t>(3 * k) + axis] = volume.steps[axis][k] / length;
  }
  part.kind = io::ForeignPart::Kind::image;
  if (!volume.places.empty()) {
    part.kind = io::ForeignPart::Kind::rectilinear;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<double> c = volume.places;
      if (axis < 2) {
        c.resize(static_cast<std::size_t>(axis == 0 ? first.columns : first.rows));
        for (std::size_t k = 0; k < c.size(); ++k) c[k] = part.spacing[axis] * static_cast<double>(k);
      }
      part.coordinates.push_back(hold_vector(holdings, {.type = NumberType::float64}, std::move(c)));
    }
  }
  part.point_fields.push_back(hold_samples(holdings, volume, contents.notes));
  return contents;
}

}  // namespace
}  // namespace tessera::readers

int main() {
  using namespace tessera::readers;
  constexpr Reader readers[] = {{"dicom", read_dicom}};
  serve(readers, MayFork::yes);  // a separate process reads the headers of each part of a directory (dicom_headers.cpp)
}
