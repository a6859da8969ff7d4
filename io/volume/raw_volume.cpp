// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <charconv>

#include "io/volume/volume_formats.hpp"
#include "scene/byte_order.hpp"

namespace tessera::io {
namespace {

/// Parses WxHxD; no value for anything else.
std::optional<scene::GridIndex> raw_dims_of(std::string_view word) {
  scene::GridIndex dims{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), dims[axis]);
    if (error != std::errc() || dims[axis] < 1 || dims[axis] > (std::int64_t{1} << 40)) return std::nullopt;
    word.remove_prefix(static_cast<std::size_t>(end - word.data()));
    if (axis < 2 && !word.starts_with('x')) return std::nullopt;
    if (axis < 2) word.remove_prefix(1);
  }
  return word.empty() ? std::optional(dims) : std::nullopt;
}

}  // namespace

std::optional<scene::SampleType> parse_sample_type(const std::string& text) {
  using scene::SampleType;
  for (const SampleType type : {SampleType::int8, SampleType::uint8, SampleType::int16, SampleType::uint16,
                                SampleType::int32, SampleType::uint32, SampleType::float32, SampleType::float64})
    if (text == scene::name_of(type)) return type;
  if (text == "float") return SampleType::float32;
  if (text == "double") return SampleType::float64;
  return std::nullopt;
}

StoredVolume describe_raw(const std::filesystem::path& file, const ReadOptions& options) {
  StoredVolume volume;
  volume.format = "raw samples";
  std::optional<scene::GridIndex> dims = options.dims;
  std::optional<scene::SampleType> type = options.type;
  std::string stem = file.stem().string();
  for (std::size_t at = 0; at < stem.size();) {
    const std::size_t stop = std::min(stem.find('_', at), stem.size());
    const std::string word = stem.substr(at, stop - at);
    if (!options.dims && raw_dims_of(word)) dims = raw_dims_of(word);
    if (!options.type && parse_sample_type(word)) type = parse_sample_type(word);
    at = stop + 1;
  }
  if (!dims || !type)
    throw scene::bad_input(
        fmt::format("{}: a raw file does not state its {}; give `dims` WxHxD `type` uint8, or name it "
                    "NAME_WxHxD_uint8.raw",
                    file.string(),
                    !dims && !type ? "dimensions and type"
                    : !dims        ? "dimensions"
                                   : "type"));
  scene::GridGeometry& g = volume.grid.geometry;
  g.points = *dims;
  g.spacing = options.spacing.value_or(glm::dvec3(1));
  g.origin = options.origin.value_or(glm::dvec3(0));
  volume.number = *type;
  volume.swapped = scene::is_swapped(options.big_endian);
  volume.offset = options.skip;
  volume.exact_size = true;  // without this check, wrong dimensions would give a skewed image instead of an error
  return volume;
}

}  // namespace tessera::io
