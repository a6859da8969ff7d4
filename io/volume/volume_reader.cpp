// SPDX-License-Identifier: BSD-3-Clause
#include "io/volume/volume_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "cells/field_choice.hpp"
#include "io/files/inflated_file.hpp"
#include "io/text/clean_errors.hpp"
#include "io/volume/brick_file.hpp"
#include "io/volume/file_source.hpp"
#include "io/volume/stored_payload.hpp"
#include "io/volume/stored_samples.hpp"
#include "io/volume/volume_formats.hpp"
#include "scene/number_type.hpp"

namespace tessera::io {
namespace {

/// Returns the name that determines the format if the first bytes do not: x.raw for x.raw.gz.
std::filesystem::path without_gz(const std::filesystem::path& file) {
  return system::lower_extension(file) == ".gz" ? file.parent_path() / file.stem() : file;
}

bool is_named_raw(const InputFile& file) {
  return !file.is_folder && system::lower_extension(without_gz(file.path)) == ".raw";
}

/// Whether the first bytes identify a volume.
bool describes_itself(const InputFile& file) {
  return file.is_recognized && file.format != nullptr && file.format->open_volume != nullptr;
}

[[noreturn]] void refuse_beginning(const InputFile& file) {
  const std::string extension = system::lower_extension(without_gz(file.name));
  throw scene::bad_input(fmt::format("{}: it does not begin like a {}; check what it is", file.name,
                                     extension.empty() ? "volume" : extension.substr(1)));
}

void list_range(const scene::ValueRange& range, cells::FieldSummary& field) {
  field.low = range.empty() ? 0 : range.low;
  field.high = range.empty() ? 0 : range.high;
  field.nan_count = range.blanks;
}

/// Returns the requested time step.
scene::TimeStepRead step_of(const StoredVolume& volume, const ReadOptions& options, const std::string& source) {
  if (volume.steps > 1) {
    scene::TimeStepRead read = scene::chosen_step(options.time_step, volume.steps, source);
    scene::set_times(read, volume.times);
    return read;
  }
  require_no_time_step(options.time_step, source);
  return {};
}

/// Returns the samples in a usable form, in the file or in memory, and updates `volume` to describe them.
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
    volume.notes.emplace_back("64-bit integers are stored as doubles");
  }
  return payload;
}

/// One component of each tuple, or the length of the tuple.
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

/// Inflates only the part of a gzip file that contains the samples if the header determines it, otherwise the whole
/// file.
InflatedFile inflated_as_needed(const InputFile& file, bool is_raw) {
  // If `beginning` contains the whole file, the file may be truncated within its header; inflating the whole file
  // reports that.
  const bool is_known_whole =
      file.size <= InputFile::longest_beginning && file.beginning.size() < InputFile::longest_beginning;
  const auto end_of_samples = is_raw || !file.is_recognized || is_known_whole ? nullptr : file.format->end_of_samples;
  if (const auto end = end_of_samples == nullptr ? std::nullopt : end_of_samples(file)) return {file, *end};
  return {file, InflatedFile::Holds::grid};
}

}  // namespace

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
  field.high = 1;  // a placeholder for the range, on which the choice does not depend
  const cells::FieldChoice choice = cells::choose_field(options.field, std::span(&field, 1), source);
  if (volume.has_colors.value_or(cells::look_like_colors(field)))
    cells::refuse_colors(choice, field, options.field, source);
  const auto chosen = [&](int component) { return chosen_samples(volume, choice, component, step, source); };
  const auto streamed = [&](int component) {
    ChosenSamples samples = chosen(component);
    return StreamedSamples{std::move(samples.grid), samples.of_tuple, volume.swapped,
                           [&](const system::ByteSink& use) { unpack_payload(volume, step, source, use); }};
  };
  field.low = 1, field.high = 0;  // an invalid range: the range of the source is used
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

void require_recognized(const InputFile& file) {
  if (!file.is_recognized) refuse_beginning(file);
}

VolumeFile with_tag_note(VolumeFile volume) {
  if (std::string note = note_on(volume.tags); !note.empty()) volume.notes.push_back(std::move(note));
  return volume;
}

std::optional<std::uint64_t> end_in_gzip(const StoredVolume& volume, const InputFile& file) {
  const bool are_in_file = volume.payload == file.path && !volume.compressed && !volume.at_end;
  if (!are_in_file || volume.coding != StoredVolume::Coding::binary) return std::nullopt;
  return volume.offset + payload_bytes(volume, file.name);
}

VolumeFile open_raw(const InputFile& file, const VolumeOptions& options) {
  StoredVolume volume = describe_raw(without_gz(file.name), options);
  volume.payload = file.path;
  volume.payload_size = file.size;
  return open_stored(std::move(volume), options, file.name);
}

bool is_volume(const InputFile& file) {
  if (is_named_raw(file)) return true;
  if (file.format == nullptr || file.format->open_volume == nullptr) return false;
  return file.format->holds_grid == nullptr || file.format->holds_grid(file);
}

void require_volume(const InputFile& file) {
  if (!is_volume(file))
    throw scene::bad_input(
        fmt::format("{}: it is not a volume, but the first time step is; give volumes only", file.name));
}

VolumeFile open_unscanned_volume(const InputFile& file, const ReadOptions& read, bool scratch_is_needed) {
  const VolumeOptions options{read, scratch_is_needed};
  return with_clean_errors(file.name, [&] {
    const bool is_raw = !describes_itself(file) && (is_named_raw(file) || options.describes_raw());
    if (!is_raw && options.describes_raw())
      throw scene::bad_input(
          fmt::format("{}: `dims`, `type`, `spacing`, `origin`, `endian` and `skip` are for .raw files, but this file "
                      "states them itself; leave them out",
                      file.name));
    if (!is_raw && (file.format == nullptr || file.format->open_volume == nullptr)) refuse_beginning(file);
    const auto open = [&](const InputFile& content) {
      return is_raw ? open_raw(content, options) : file.format->open_volume(content, options);
    };
    VolumeFile volume;
    if (!file.is_gzip || (!is_raw && file.format->reads_gzip)) {
      volume = open(file);
    } else {
      const InflatedFile inflated = inflated_as_needed(file, is_raw);
      volume = inflated.read(open);
      for (std::string& note : volume.notes) note = inflated.renamed(std::move(note));
      volume.format += ", gzip";
    }
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
  // The axes apply if the range is that of Hounsfield units: the lowest value is that of air or a fill value of
  // scanners, down to -4096. A fill value of -9999 is not accepted.
  if (const BodyAxes axes = std::exchange(volume.axes_if_ct, BodyAxes::none);
      axes != BodyAxes::none && range.low <= -900 && range.low >= -4096 && range.high >= 200)
    volume.body_axes = axes;
  if (range.blanks > 0)
    volume.notes.push_back(fmt::format("{} samples are NaN, infinite or hidden: their voxels are blank", range.blanks));
}

VolumeFile open_volume(const InputFile& file, const ReadOptions& options) {
  VolumeFile volume = open_unscanned_volume(file, options);
  with_clean_errors(file.name, [&] { set_range(volume, file.path, scene::value_range(*volume.source)); });
  return volume;
}

}  // namespace tessera::io
