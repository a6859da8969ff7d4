// SPDX-License-Identifier: BSD-3-Clause
#include "io/volume/volume_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <glm/geometric.hpp>
#include <utility>

#include "cells/field_choice.hpp"
#include "io/formats/file_kinds.hpp"
#include "io/formats/inflated_file.hpp"
#include "io/formats/input_file.hpp"
#include "io/text/clean_errors.hpp"
#include "io/volume/brick_file.hpp"
#include "io/volume/file_source.hpp"
#include "io/volume/stored_payload.hpp"
#include "io/volume/stored_samples.hpp"
#include "io/volume/volume_formats.hpp"
#include "io/vtk/vtk_field_words.hpp"
#include "scene/number_type.hpp"
#include "system/gzip.hpp"

namespace tessera::io {
namespace {

/// What kind of volume a file begins as.
enum class VolumeKind { none, vtk, netcdf, hdf5, minc, xdmf, meta_image, nrrd, nifti, analyze, dicom, bricks };

/// Of NIfTI files gzip is a part of the format, so that they are inflated as they are read; others are inflated first.
VolumeKind volume_kind_of(const std::filesystem::path& file) {
  const FormatRow* const row = format_begun(file);
  switch (row == nullptr ? FileKind::unread : row->kind) {
    case FileKind::bricks:
      return VolumeKind::bricks;
    case FileKind::vtk_grid:
      return VolumeKind::vtk;
    case FileKind::netcdf:
      return VolumeKind::netcdf;
    case FileKind::hdf5:
      return VolumeKind::hdf5;
    case FileKind::minc:
      return VolumeKind::minc;
    case FileKind::xdmf:
      return VolumeKind::xdmf;
    case FileKind::nrrd:
      return VolumeKind::nrrd;
    case FileKind::meta_image:
      return VolumeKind::meta_image;
    case FileKind::nifti:
      return VolumeKind::nifti;
    case FileKind::analyze:
      return VolumeKind::analyze;
    case FileKind::dicom:
      return VolumeKind::dicom;
    default:
      return VolumeKind::none;
  }
}

/// NetCDF, HDF5 and XDMF hold all kinds of things.
bool holds_grid(const std::filesystem::path& file, const FormatRow& row) {
  if (row.kind == FileKind::netcdf) return holds_grid_by_vtk(file, "netcdf");
  if (row.kind == FileKind::hdf5) return holds_grid_by_vtk(file, "hdf5");
  if (row.kind == FileKind::xdmf) return holds_xdmf_grid(file);
  return row.holds == FileHolds::grid || row.holds == FileHolds::grid_or_mesh;
}

/// The name that counts where the beginning says nothing: x.raw of x.raw.gz.
std::filesystem::path without_gz(const std::filesystem::path& file) {
  return system::lower_extension(file) == ".gz" ? file.parent_path() / file.stem() : file;
}

void list_range(const scene::ValueRange& range, cells::FieldSummary& field) {
  field.low = range.empty() ? 0 : range.low;
  field.high = range.empty() ? 0 : range.high;
  field.nan_count = range.blanks;
}

/// The step that is wanted.
scene::TimeStepRead step_of(const StoredVolume& volume, const VolumeOptions& options, const std::string& source) {
  if (volume.steps > 1) {
    scene::TimeStepRead read = scene::chosen_step(options.time_step, volume.steps, source);
    scene::set_times(read, volume.times);
    return read;
  }
  require_no_time_step(options.time_step, source);
  return {};
}

/// The samples as they are used, where they lie or in memory; `volume` says from now on how they are.
VolumePayload usable_payload(StoredVolume& volume, std::size_t step, const std::string& source) {
  VolumePayload payload = payload_of(volume, step, source);
  if (volume.coding == StoredVolume::Coding::text) volume.swapped = false;
  if (volume.planar && volume.components > 1) payload = interleaved(volume, in_memory(std::move(payload), source));
  if (volume.wide != StoredVolume::Wide::no) {
    if (volume.coding != StoredVolume::Coding::text) {
      payload = in_memory(std::move(payload), source);
      const bool is_signed = volume.wide == StoredVolume::Wide::int64;
      auto values =
          std::make_shared<const std::vector<double>>(doubles_of_int64(payload.bytes, is_signed, volume.swapped));
      payload = {std::as_bytes(std::span<const double>(*values)), values, {}, payload.count};
      volume.swapped = false;
    }
    volume.notes.emplace_back("64-bit integers are held as doubles");
  }
  return payload;
}

/// One number of each tuple, or its length.
struct ChosenSamples {
  scene::Grid grid;
  scene::ComponentChoice of_tuple;
};

ChosenSamples chosen_samples(const StoredVolume& volume, const cells::FieldChoice& choice, int component,
                             std::size_t step, const std::string& source) {
  scene::Grid grid = volume.grid;
  grid.type = volume.number;
  grid.field_name = choice.label;
  if (component == cells::magnitude) {
    grid.type = scene::size_of(volume.number) < 4 || volume.number == scene::SampleType::float32
                    ? scene::SampleType::float32
                    : scene::SampleType::float64;
    if (grid.shift != 0)
      throw scene::bad_input(
          fmt::format("{}: its components are shifted by {}, so their magnitude has no meaning; choose one with "
                      "`field` samples:0",
                      source, grid.shift));
    grid.scale = std::abs(grid.scale);
  }
  if (volume.interleaved_steps)
    return {std::move(grid), {static_cast<int>(volume.steps), static_cast<int>(step), volume.number}};
  return {std::move(grid), {volume.components, component == cells::magnitude ? -1 : component, volume.number}};
}

std::unique_ptr<scene::SampleSource> source_of(const VolumePayload& payload, ChosenSamples samples, bool swapped,
                                               const std::string& source) {
  if (payload.in_file)
    return std::make_unique<FileSource>(std::move(samples.grid), payload.in_file->file, payload.in_file->first_byte,
                                        source, samples.of_tuple, swapped);
  return std::make_unique<scene::MemorySource>(std::move(samples.grid), payload.bytes, payload.owner, source,
                                               samples.of_tuple, swapped);
}

/// Fields, choice and source of one array of samples.
VolumeFile open_stored(StoredVolume volume, const VolumeOptions& options, const std::string& source) {
  scene::validate(volume.grid, source);
  VolumeFile result;
  result.time_step = step_of(volume, options, source);
  const std::size_t step = result.time_step.step;
  cells::FieldSummary field{.name = volume.field,
                            .association = volume.grid.geometry.association,
                            .components = volume.components,
                            .type = scene::listed_name(scene::number_type_of(volume.number))};
  field.active = volume.active;
  field.high = 1;  // until it is known; nobody chooses by it
  const cells::FieldChoice choice = cells::choose_field(options.field, std::span(&field, 1), source);
  if (volume.has_colors.value_or(cells::look_like_colors(field)))
    cells::refuse_colors(choice, field, options.field, source);
  const auto chosen = [&](int component) { return chosen_samples(volume, choice, component, step, source); };
  const auto streamed = [&](int component) {
    ChosenSamples samples = chosen(component);
    return StreamedSamples{std::move(samples.grid), samples.of_tuple, volume.swapped,
                           [&](const system::ByteSink& use) { unpack_payload(volume, step, source, use); }};
  };
  field.low = 1, field.high = 0;  // the source's
  const bool lists_lengths = volume.components > 1 && choice.component != cells::magnitude && volume.grid.shift == 0;
  if (comes_in_parts(volume) && unpacked_to_scratch(streamed(choice.component), options, source, result)) {
    if (lists_lengths) list_range(value_range(streamed(cells::magnitude)), field);
  } else {
    const VolumePayload payload = usable_payload(volume, step, source);
    result.source = source_of(payload, chosen(choice.component), volume.swapped, source);
    result.in_memory = !payload.in_file || is_inflated(payload.in_file->file);
    if (lists_lengths)
      list_range(scene::value_range(*source_of(payload, chosen(cells::magnitude), volume.swapped, source)), field);
  }
  result.format = std::move(volume.format);
  result.body_axes = volume.body_axes;
  result.axes_if_ct = volume.axes_if_ct;
  result.tags = std::move(volume.tags);
  result.notes = std::move(volume.notes);
  result.notes.insert(result.notes.end(), choice.notes.begin(), choice.notes.end());
  result.fields.push_back(std::move(field));
  return result;
}

/// Where the samples end in a gzip file with such a header; nothing if that does not tell.
std::optional<std::uint64_t> end_of_samples(const std::filesystem::path& file, VolumeKind kind) {
  if (kind != VolumeKind::meta_image && kind != VolumeKind::nrrd) return std::nullopt;
  constexpr std::uint64_t longest_header = 1 << 20;
  const InflatedFile beginning(file, longest_header);
  return beginning.read([&](const std::filesystem::path& content) -> std::optional<std::uint64_t> {
    const StoredVolume volume = kind == VolumeKind::nrrd ? read_nrrd_header(content) : read_meta_image_header(content);
    if (volume.compressed || volume.at_end || volume.coding != StoredVolume::Coding::binary) return std::nullopt;
    return volume.offset + payload_bytes(volume, content.string());
  });
}

InflatedFile inflated_as_needed(const std::filesystem::path& file, VolumeKind kind) {
  if (const auto end = end_of_samples(file, kind)) return {file, *end};
  return {file, InflatedFile::Holds::grid};
}

VolumeFile with_tag_note(VolumeFile volume) {
  if (std::string note = note_on(volume.tags); !note.empty()) volume.notes.push_back(std::move(note));
  return volume;
}

VolumeFile open_vtk(const std::filesystem::path& file, const VolumeOptions& options, const std::string& source) {
  auto plain = read_plain_vtk_grid(file, options.most_in_memory);
  VolumeFile volume = plain ? open_stored(*std::move(plain), options, source) : read_vtk_grid(file, options);
  for (const auto& [name, word] : vtk_field_words(file)) take_word(name, word, volume.body_axes, volume.tags);
  return with_tag_note(std::move(volume));
}

/// A file that says of itself what it holds.
VolumeFile open_described(const std::filesystem::path& file, VolumeKind kind, const VolumeOptions& options,
                          const std::string& source) {
  switch (kind) {
    case VolumeKind::vtk:
      require_no_time_step(options.time_step, source);
      return open_vtk(file, options, source);
    case VolumeKind::bricks:
      require_no_time_step(options.time_step, source);
      return with_tag_note(open_bricks(file, options));
    case VolumeKind::netcdf:
      return read_by_vtk(file, "netcdf", options);
    case VolumeKind::hdf5:
      return read_by_vtk(file, "hdf5", options);
    case VolumeKind::minc:
      return read_by_vtk(file, "minc", options);
    case VolumeKind::xdmf:
      return read_xdmf_grid(file, options);
    case VolumeKind::meta_image:
      return open_stored(read_meta_image_header(file), options, source);
    case VolumeKind::nrrd:
      return with_tag_note(open_stored(read_nrrd_header(file), options, source));
    case VolumeKind::nifti:
      return open_stored(read_nifti_header(file), options, source);
    case VolumeKind::analyze:
      return open_stored(read_analyze_header(file), options, source);
    case VolumeKind::dicom:
      return read_dicom(file, options);
    case VolumeKind::none:
      break;
  }
  const std::string extension = system::lower_extension(without_gz(file));
  if (extension == ".img" || extension == ".hdr") return open_stored(read_analyze_header(file), options, source);
  if (extension == ".dcm" || extension == ".dicom" || extension == ".ima") return read_dicom(file, options);
  if (extension == ".nii") return open_stored(read_nifti_header(file), options, source);
  throw scene::bad_input(fmt::format("{}: it does not begin as a {} does; check what it is", source,
                                     extension.empty() ? "volume" : extension.substr(1)));
}

}  // namespace

bool is_volume(const std::filesystem::path& file) {
  std::error_code unknown;
  if (system::lower_extension(without_gz(file)) == ".raw" && !std::filesystem::is_directory(file, unknown)) return true;
  const FormatRow* const row = format_of(file);
  return row != nullptr && holds_grid(file, *row);
}

void require_volume(const std::filesystem::path& file) {
  require_file(file);
  if (!is_volume(file))
    throw scene::bad_input(
        fmt::format("{}: it is no volume as the first step is one; give volumes only", file.string()));
}

VolumeFile open_unscanned_volume(const std::filesystem::path& file, const VolumeOptions& options) {
  const std::string source = file.string();
  require_file(file);
  return with_clean_errors(source, [&] {
    const std::filesystem::path name = without_gz(file);
    const VolumeKind kind = volume_kind_of(file);
    const bool raw = kind == VolumeKind::none && (system::lower_extension(name) == ".raw" || options.describes_raw());
    if (!raw && options.describes_raw())
      throw scene::bad_input(
          fmt::format("{}: `dims`, `type`, `spacing`, `origin`, `endian` and `skip` are for .raw files; this one says "
                      "them itself",
                      source));
    const auto open = [&](const std::filesystem::path& content) {
      if (!raw) return open_described(content, kind, options, source);
      StoredVolume volume = describe_raw(name, options);
      volume.payload = content;
      return open_stored(std::move(volume), options, source);
    };
    VolumeFile volume;
    if (is_input_folder(file) || kind == VolumeKind::nifti || kind == VolumeKind::analyze ||
        (kind == VolumeKind::none && !raw) || !system::looks_like_gzip(read_beginning(file, 2))) {
      volume = open(file);
    } else {
      const InflatedFile inflated = inflated_as_needed(file, kind);
      volume = inflated.read(open);
      for (std::string& note : volume.notes) note = inflated.renamed(std::move(note));
      volume.format += ", gzip";
    }
    if (auto note = scene::note_on(volume.time_step, options.time_step))
      volume.notes.insert(volume.notes.begin(), *note);
    return volume;
  });
}

void set_range(VolumeFile& volume, const std::filesystem::path& file, const scene::ValueRange& range) {
  volume.range = range;
  if (range.empty())
    throw scene::bad_input(fmt::format("{}: none of its {} samples is a finite number; choose another field",
                                       file.string(), volume.source->geometry().all_samples().count()));
  for (cells::FieldSummary& field : volume.fields)
    if (field.low > field.high) list_range(range, field);
  // Hounsfield's units, with air and with what scanners fill the corners with, but no -9999.
  if (const BodyAxes axes = std::exchange(volume.axes_if_ct, BodyAxes::none);
      axes != BodyAxes::none && range.low <= -900 && range.low >= -4096 && range.high >= 200)
    volume.body_axes = axes;
  if (range.blanks > 0)
    volume.notes.push_back(fmt::format("{} samples are NaN, infinite or hidden: their voxels are blank", range.blanks));
}

VolumeFile open_volume(const std::filesystem::path& file, const VolumeOptions& options) {
  VolumeFile volume = open_unscanned_volume(file, options);
  with_clean_errors(file.string(), [&] { set_range(volume, file, scene::value_range(*volume.source)); });
  return volume;
}

}  // namespace tessera::io
