// SPDX-License-Identifier: BSD-3-Clause
// NRRD. Source: Kindlmann, "Definition of NRRD File Format", teem.sourceforge.net/nrrd/format.html. VTK's reader
// refuses files with space directions, so the header is read here.
#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "io/files/input_file.hpp"
#include "io/text/header_text.hpp"
#include "io/text/text_file.hpp"
#include "io/volume/nrrd_axes.hpp"
#include "io/volume/volume_formats.hpp"
#include "scene/byte_order.hpp"
#include "scene/number_type.hpp"
#include "system/positional_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

using scene::NumberType;

constexpr scene::NumberTypeNames nrrd_types[] = {
    {NumberType::int8, "signed char,int8,int8_t"},
    {NumberType::uint8, "uchar,unsigned char,uint8,uint8_t"},
    {NumberType::int16, "short,short int,signed short,signed short int,int16,int16_t"},
    {NumberType::uint16, "ushort,unsigned short,unsigned short int,uint16,uint16_t"},
    {NumberType::int32, "int,signed int,int32,int32_t"},
    {NumberType::uint32, "uint,unsigned int,uint32,uint32_t"},
    {NumberType::int64, "longlong,long long,long long int,signed long long,signed long long int,int64,int64_t"},
    {NumberType::uint64, "ulonglong,unsigned long long,unsigned long long int,uint64,uint64_t"},
    {NumberType::float32, "float"},
    {NumberType::float64, "double"}};

const std::string& required_field(const NrrdFields& fields, const char* name, const std::filesystem::path& file) {
  const auto* value = fields.find(name);
  if (!value) throw damaged(file, fmt::format("its header has no field '{}'", name));
  return *value;
}

/// Returns the position after skipping `lines` lines from `offset`.
std::uint64_t after_lines(const std::filesystem::path& payload, std::uint64_t offset, std::int64_t lines) {
  if (lines == 0) return offset;
  const std::uint64_t size = require_file(payload);
  const system::PositionalFile opened(payload);
  std::vector<char> part(1 << 16);
  while (offset < size) {
    const std::uint64_t count = std::min<std::uint64_t>(part.size(), size - offset);
    opened.read(offset, reinterpret_cast<std::byte*>(part.data()), count);
    const std::string_view text(part.data(), count);
    for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n', end + 1))
      if (--lines == 0) return offset + end + 1;
    offset += count;
  }
  throw damaged(payload, "it has fewer lines than its header skips");
}

/// Sets components and time steps.
void set_other_axes(const NrrdAxes& axes, const std::vector<std::int64_t>& sizes, const std::filesystem::path& file,
                    StoredVolume& volume) {
  bool has_steps = false, has_components = false, is_first_steps = false;
  for (std::size_t a = 0; a < sizes.size(); ++a) {
    const bool before = axes.is_before(a);
    if (axes.uses[a] == NrrdAxes::Use::steps) {
      if (before && sizes[a] > 1 << 16)
        throw scene::bad_input(
            fmt::format("{}: axis {} has {} time steps; write at most 65536", file.string(), a + 1, sizes[a]));
      volume.steps *= static_cast<std::uint64_t>(sizes[a]);
      is_first_steps = before;
      volume.interleaved_steps = before && volume.steps > 1;
      if (std::exchange(has_steps, true))
        throw scene::bad_input(
            fmt::format("{}: two of its axes are time steps or lists; write only one such axis", file.string()));
    } else if (axes.uses[a] == NrrdAxes::Use::components) {
      if (sizes[a] > 64)
        throw scene::bad_input(
            fmt::format("{}: axis {} has {} components per sample; write at most 64", file.string(), a + 1, sizes[a]));
      volume.components = static_cast<int>(sizes[a]);
      volume.planar = !before && volume.components > 1;
      if (std::exchange(has_components, true))
        throw scene::bad_input(
            fmt::format("{}: two of its axes are components; write only one such axis", file.string()));
    }
  }
  if (has_steps && has_components && (is_first_steps || volume.planar))
    throw scene::bad_input(
        fmt::format("{}: it has time steps and components, so components must be its first axis and time steps its "
                    "last; reorder its axes (`unu permute`), or write one step alone",
                    file.string()));
}

/// Sets tags from the fields and keys that other programs and write_volume() use.
void set_nrrd_tags(const NrrdFields& fields, StoredVolume& volume) {
  const auto first_quoted = [](std::string_view text) {
    const std::size_t open = text.find('"');
    if (open == std::string_view::npos) return std::string(trimmed(text));
    return std::string(text.substr(open + 1, text.find('"', open + 1) - open - 1));
  };
  if (const auto* unit = fields.find("sampleunits")) volume.tags.unit = first_quoted(*unit);
  if (const auto* units = fields.find("spaceunits")) volume.tags.length_unit = first_quoted(*units);
  const auto key = [&](const char* name) {
    const auto found = fields.keys.find(name);
    return found == fields.keys.end() ? std::string() : found->second;
  };
  volume.tags.modality = key("modality");
  // 3D Slicer's segmentations have a numbered list of labels.
  volume.tags.labels = key("intent") == "label" || fields.keys.contains("Segment0_LabelValue");
}

/// Reads the header. Reads more than the file's first bytes only if the header is longer or lists files.
std::string header_of(const InputFile& file) {
  constexpr std::size_t longest_nrrd_header = 1 << 20;
  const std::string& text = file.beginning;
  const bool is_whole = text.find("LIST") == std::string::npos &&
                        (text.find("\n\n") != std::string::npos || text.find("\n\r\n") != std::string::npos);
  return is_whole || text.size() == file.size ? text : read_beginning(file.path, longest_nrrd_header);
}

StoredVolume read_nrrd_header(const InputFile& input, const std::string& text) {
  const std::filesystem::path& file = input.path;
  const NrrdFields fields = nrrd_fields_of(text, file);
  StoredVolume volume;
  volume.format = "NRRD";
  const auto sizes = header_count_list(required_field(fields, "sizes", file), file, "sizes");
  const auto dimension = header_count(required_field(fields, "dimension", file), 1, 16, file, "dimension");
  if (sizes.size() != static_cast<std::size_t>(dimension))
    throw damaged(file, fmt::format("it has {} sizes for {} dimensions", sizes.size(), dimension));
  const NrrdAxes axes = nrrd_axes_of(fields, sizes, file);
  set_other_axes(axes, sizes, file, volume);
  volume.times = nrrd_times(fields, axes, sizes, file);
  volume.has_colors = has_color_axis(fields, axes);
  for (std::size_t a = 0; a < 3; ++a) volume.grid.geometry.points[a] = sizes[axes.space[a]];

  const std::string type = lower_case(required_field(fields, "type", file));
  const auto known = scene::number_type_named(type, nrrd_types);
  if (!known)
    throw scene::bad_input(
        fmt::format("{}: its type {} is not supported; write integers, float or double", file.string(), quote(type)));
  volume.set_type(*known);
  const std::string encoding = lower_case(required_field(fields, "encoding", file));
  volume.compressed = encoding == "gzip" || encoding == "gz";
  if (encoding == "ascii" || encoding == "text" || encoding == "txt")
    volume.coding = StoredVolume::Coding::text;
  else if (encoding == "hex")
    volume.coding = StoredVolume::Coding::hex;
  else if (!volume.compressed && encoding != "raw")
    throw scene::bad_input(fmt::format("{}: its encoding {} is not supported; write raw, gzip, ascii or hex",
                                       file.string(), quote(encoding)));
  const auto* endian = fields.find("endian");
  if (!endian && scene::size_of(volume.number) > 1 && volume.coding != StoredVolume::Coding::text)
    throw scene::bad_input(
        fmt::format("{}: its header does not state the byte order of its samples; add a line 'endian: little', or big",
                    file.string()));
  volume.swapped = endian && scene::is_swapped(equals_ignoring_case(*endian, "big"));
  set_nrrd_geometry(fields, axes, sizes, file, volume);
  set_nrrd_tags(fields, volume);

  volume.payload = file;
  volume.payload_size = input.size;
  volume.offset = fields.end;
  if (const auto* detached = fields.find("datafile")) {
    const auto most = static_cast<std::uint64_t>(sizes.back()) * static_cast<std::uint64_t>(sizes[sizes.size() - 2]);
    volume.slices = header_slices(*detached, std::string_view(text).substr(fields.end), most, file, "data file");
    volume.payload = volume.slices.empty() ? header_path(*detached, file, "data file") : volume.slices.front();
    volume.payload_size = volume.offset = 0;
  }
  const auto* lines = fields.find("lineskip");
  if (lines && !volume.slices.empty() && *lines != "0")
    throw scene::bad_input(fmt::format("{}: 'line skip' is for one file of samples; leave it out", file.string()));
  if (lines)
    volume.offset = after_lines(volume.payload, volume.offset, header_count(*lines, 0, 1 << 20, file, "line skip"));
  if (const auto* bytes = fields.find("byteskip")) {
    // Lines are skipped before the gzip stream begins; bytes are skipped in the inflated data.
    if (*bytes == "-1")
      volume.at_end = true;
    else
      (volume.compressed ? volume.skip_inflated : volume.offset) +=
          static_cast<std::uint64_t>(header_count(*bytes, 0, std::int64_t{1} << 40, file, "byte skip"));
    if (volume.at_end && (volume.compressed || volume.coding != StoredVolume::Coding::binary))
      throw scene::bad_input(
          fmt::format("{}: 'byte skip: -1' is for raw samples only; state where they begin", file.string()));
  }
  return volume;
}

}  // namespace

VolumeFile open_nrrd(const InputFile& file, const VolumeOptions& options) {
  require_recognized(file);
  return with_tag_note(open_stored(read_nrrd_header(file, header_of(file)), options, file.name));
}

std::optional<std::uint64_t> end_of_nrrd(const InputFile& file) {
  return end_in_gzip(read_nrrd_header(file, file.beginning), file);
}

}  // namespace tessera::io
