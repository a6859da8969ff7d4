// SPDX-License-Identifier: BSD-3-Clause
// MetaImage (.mhd, .mha). Source: the MetaIO documentation of Kitware's MetaImage format. VTK's reader drops the
// orientation, so the header is read here.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "io/text/header_text.hpp"
#include "io/text/text_file.hpp"
#include "io/volume/volume_formats.hpp"
#include "scene/byte_order.hpp"
#include "scene/number_type.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

// MET_LONG has four or eight bytes, depending on the machine that wrote the file.
constexpr scene::NumberTypeNames element_types[] = {
    {scene::NumberType::int8, "MET_CHAR"},       {scene::NumberType::uint8, "MET_UCHAR"},
    {scene::NumberType::int16, "MET_SHORT"},     {scene::NumberType::uint16, "MET_USHORT"},
    {scene::NumberType::int32, "MET_INT"},       {scene::NumberType::uint32, "MET_UINT"},
    {scene::NumberType::float32, "MET_FLOAT"},   {scene::NumberType::float64, "MET_DOUBLE"},
    {scene::NumberType::int64, "MET_LONG_LONG"}, {scene::NumberType::uint64, "MET_ULONG_LONG"}};

/// Keys in file order; the last is ElementDataFile, and a local payload begins after its line.
struct MetaHeader {
  std::map<std::string, std::string> values;
  std::size_t end = 0;

  [[nodiscard]] const std::string* find(std::initializer_list<const char*> names) const {
    for (const char* name : names)
      if (const auto v = values.find(name); v != values.end()) return &v->second;
    return nullptr;
  }
};

MetaHeader parse_meta_header(std::string_view text, const std::filesystem::path& file) {
  MetaHeader header;
  while (header.end < text.size()) {
    const std::size_t stop = std::min(text.find('\n', header.end), text.size());
    const std::string_view line = text.substr(header.end, stop - header.end);
    header.end = std::min(stop + 1, text.size());
    const std::size_t equals = line.find_first_of("=:");  // MetaIO accepts both
    if (trimmed(line).empty()) continue;
    if (equals == std::string_view::npos)
      throw damaged(file, fmt::format("line {} of its header is not of the form 'Key = value'", quote(trimmed(line))));
    const std::string key(trimmed(line.substr(0, equals)));
    header.values[key] = std::string(trimmed(line.substr(equals + 1)));
    if (key == "ElementDataFile") return header;
  }
  throw damaged(file, "its header has no ElementDataFile");
}

bool meta_is_true(const std::string* value) {
  return value && !value->empty() && (lower_case(value->front()) == 't' || *value == "1");
}

/// Number type and encoding.
void read_samples_of(const MetaHeader& header, const std::filesystem::path& file, StoredVolume& volume) {
  const auto* type = header.find({"ElementType"});
  if (!type) throw damaged(file, "its header has no ElementType");
  std::string_view word = *type;
  if (word.ends_with("_ARRAY")) word.remove_suffix(6);  // several channels
  const auto known = scene::number_type_named(word, element_types);
  if (!known)
    throw scene::bad_input(
        fmt::format("{}: its ElementType {} is not supported; write MET_UCHAR, MET_SHORT, "
                    "MET_USHORT, MET_INT, MET_FLOAT or MET_DOUBLE",
                    file.string(), quote(*type)));
  volume.set_type(*known);
  if (const auto* channels = header.find({"ElementNumberOfChannels"}))
    volume.components = static_cast<int>(header_count(*channels, 1, 64, file, "ElementNumberOfChannels"));
  const bool big = meta_is_true(header.find({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}));
  volume.swapped = scene::is_swapped(big);
  if (const auto* binary = header.find({"BinaryData"}); binary && !meta_is_true(binary))
    volume.coding = StoredVolume::Coding::text;
  volume.compressed = meta_is_true(header.find({"CompressedData"}));
  if (volume.compressed && volume.coding == StoredVolume::Coding::text)
    throw scene::bad_input(
        fmt::format("{}: its samples are text and also compressed; write them as binary numbers", file.string()));
}

/// Axes, origin, and the meaning of samples.
void read_grid(const MetaHeader& header, std::size_t axes, const std::filesystem::path& file, StoredVolume& volume) {
  const auto reals = [&](const char* what, const std::string& value, std::size_t count) {
    return header_numbers(value, count, file, what);
  };
  scene::GridGeometry& g = volume.grid.geometry;
  glm::dvec3 spacing(1);
  double first_time = 0, time_step = 0;
  if (const auto* value = header.find({"ElementSpacing", "ElementSize"})) {
    const auto s = reals("ElementSpacing", *value, axes);
    spacing = {s[0], s[1], s[2]};
    if (axes == 4) time_step = s[3];
  }
  std::array<glm::dvec3, 3> steps = {glm::dvec3(spacing.x, 0, 0), glm::dvec3(0, spacing.y, 0),
                                     glm::dvec3(0, 0, spacing.z)};
  if (const auto* value = header.find({"TransformMatrix", "Rotation", "Orientation"})) {
    const auto m = reals("TransformMatrix", *value, axes * axes);
    for (std::size_t axis = 0; axis < 3; ++axis)
      steps[axis] =
          glm::dvec3(m[axes * axis], m[axes * axis + 1], m[axes * axis + 2]) * spacing[static_cast<int>(axis)];
  }
  scene::set_axes(g, steps);
  // ITK writes this key for every image; the axes of the world are then left, posterior and superior.
  if (const auto* value = header.find({"AnatomicalOrientation"}); value && value->find('?') == std::string::npos)
    volume.body_axes = BodyAxes::lps;
  if (const auto* value = header.find({"Offset", "Position", "Origin"})) {
    const auto o = reals("Offset", *value, axes);
    g.origin = {o[0], o[1], o[2]};
    if (axes == 4) first_time = o[3];
  }
  volume.times = scene::even_times(first_time, time_step, volume.steps);
  if (const auto* value = header.find({"ElementToIntensityFunctionSlope"}))
    volume.grid.scale = reals("ElementToIntensityFunctionSlope", *value, 1)[0];
  if (const auto* value = header.find({"ElementToIntensityFunctionOffset"}))
    volume.grid.shift = reals("ElementToIntensityFunctionOffset", *value, 1)[0];
  if (volume.grid.scale != 1 || volume.grid.shift != 0)
    volume.notes.push_back(
        fmt::format("values are {:.9g} * sample + {:.9g}, as its header states", volume.grid.scale, volume.grid.shift));
}

/// Location of the samples; `lines` follow the header.
void read_payload(const MetaHeader& header, std::string_view lines, const InputFile& input, StoredVolume& volume) {
  const std::filesystem::path& file = input.path;
  const std::string& payload = *header.find({"ElementDataFile"});
  const scene::GridIndex& n = volume.grid.geometry.points;
  const auto most = static_cast<std::uint64_t>(n[2]) * static_cast<std::uint64_t>(n[1]) * volume.steps;
  volume.slices = header_slices(payload, lines, most, file, "ElementDataFile");
  const bool local = payload == "LOCAL" || payload == "Local" || payload == "local";
  volume.payload = local                   ? file
                   : volume.slices.empty() ? header_path(payload, file, "ElementDataFile")
                                           : volume.slices.front();
  volume.payload_size = local ? input.size : 0;
  volume.offset = local ? header.end : 0;
  if (const auto* value = header.find({"HeaderSize"}); value && !local) {
    if (*value == "-1" && volume.coding == StoredVolume::Coding::text)
      throw scene::bad_input(fmt::format("{}: 'HeaderSize = -1' is for binary samples only", file.string()));
    if (*value == "-1")
      volume.at_end = true;
    else
      volume.offset = static_cast<std::uint64_t>(header_count(*value, 0, std::int64_t{1} << 40, file, "HeaderSize"));
  }
}

StoredVolume read_meta_image_header(const InputFile& input) {
  const std::filesystem::path& file = input.path;
  const MetaHeader header = parse_meta_header(input.beginning, file);
  StoredVolume volume;
  volume.format = "MetaImage";
  if (const auto* object = header.find({"ObjectType"}); object && *object != "Image")
    throw scene::bad_input(fmt::format("{}: it is a {}, not an image; give a volume", file.string(), quote(*object)));
  const auto* dimensions = header.find({"NDims"});
  if (!dimensions) throw damaged(file, "its header has no NDims");
  const auto count = header_count(*dimensions, 1, 99, file, "NDims");
  if (count != 3 && count != 4)
    throw scene::bad_input(
        fmt::format("{}: it has {} dimensions; a volume has three, or four with time", file.string(), count));
  const auto axes = static_cast<std::size_t>(count);
  const auto* size = header.find({"DimSize"});
  if (!size) throw damaged(file, "its header has no DimSize");
  const auto sizes = header_count_list(*size, file, "DimSize");
  if (sizes.size() != axes) throw damaged(file, fmt::format("it has {} sizes for {} dimensions", sizes.size(), axes));
  volume.grid.geometry.points = {sizes[0], sizes[1], sizes[2]};
  if (axes == 4) volume.steps = static_cast<std::uint64_t>(sizes[3]);

  read_samples_of(header, file, volume);
  read_grid(header, axes, file, volume);
  if (const auto* modality = header.find({"Modality"}); modality != nullptr && modality->starts_with("MET_MOD_"))
    if (const std::string word = modality->substr(8); word == "CT" || word == "MR" || word == "NM" || word == "US")
      volume.tags.modality = word;
  read_payload(header, std::string_view(input.beginning).substr(header.end), input, volume);
  return volume;
}

}  // namespace

VolumeFile open_meta_image(const InputFile& file, const VolumeOptions& options) {
  require_recognized(file);
  return open_stored(read_meta_image_header(file), options, file.name);
}

std::optional<std::uint64_t> end_of_meta_image(const InputFile& file) {
  return end_in_gzip(read_meta_image_header(file), file);
}

}  // namespace tessera::io
