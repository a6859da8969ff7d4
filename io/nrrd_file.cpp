// NRRD. Source: Kindlmann, "Definition of NRRD File Format", teem.sourceforge.net/nrrd/format.html. VTK's reader gives
// up on files with space directions, so the header is read here.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <map>

#include "io/header_text.hpp"
#include "io/input_file.hpp"
#include "io/mapped_file.hpp"
#include "io/text_file.hpp"
#include "io/volume_formats.hpp"

namespace tessera::io {
namespace {

using scene::SampleType;

struct NrrdTypeName {
  const char* name;
  SampleType type;
};
constexpr std::array nrrd_type_names = {NrrdTypeName{"signed char", SampleType::int8},
                                        NrrdTypeName{"int8", SampleType::int8},
                                        NrrdTypeName{"int8_t", SampleType::int8},
                                        NrrdTypeName{"uchar", SampleType::uint8},
                                        NrrdTypeName{"unsigned char", SampleType::uint8},
                                        NrrdTypeName{"uint8", SampleType::uint8},
                                        NrrdTypeName{"uint8_t", SampleType::uint8},
                                        NrrdTypeName{"short", SampleType::int16},
                                        NrrdTypeName{"short int", SampleType::int16},
                                        NrrdTypeName{"signed short", SampleType::int16},
                                        NrrdTypeName{"signed short int", SampleType::int16},
                                        NrrdTypeName{"int16", SampleType::int16},
                                        NrrdTypeName{"int16_t", SampleType::int16},
                                        NrrdTypeName{"ushort", SampleType::uint16},
                                        NrrdTypeName{"unsigned short", SampleType::uint16},
                                        NrrdTypeName{"unsigned short int", SampleType::uint16},
                                        NrrdTypeName{"uint16", SampleType::uint16},
                                        NrrdTypeName{"uint16_t", SampleType::uint16},
                                        NrrdTypeName{"int", SampleType::int32},
                                        NrrdTypeName{"signed int", SampleType::int32},
                                        NrrdTypeName{"int32", SampleType::int32},
                                        NrrdTypeName{"int32_t", SampleType::int32},
                                        NrrdTypeName{"uint", SampleType::uint32},
                                        NrrdTypeName{"unsigned int", SampleType::uint32},
                                        NrrdTypeName{"uint32", SampleType::uint32},
                                        NrrdTypeName{"uint32_t", SampleType::uint32},
                                        NrrdTypeName{"float", SampleType::float32},
                                        NrrdTypeName{"double", SampleType::float64}};

constexpr std::array nrrd_int64_names = {
    "longlong", "long long", "long long int", "signed long long", "signed long long int", "int64", "int64_t"};
constexpr std::array nrrd_uint64_names = {"ulonglong", "unsigned long long", "unsigned long long int", "uint64",
                                          "uint64_t"};

std::string lower_words(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

/// NrrdFields by name, spaces in names left out, so that "space origin" and "spaceorigin" are one.
struct NrrdFields {
  std::map<std::string, std::string> values;
  std::size_t end = 0;  ///< where an attached payload begins

  [[nodiscard]] const std::string* find(const char* name) const {
    const auto v = values.find(name);
    return v == values.end() ? nullptr : &v->second;
  }
};

NrrdFields parse_fields(std::string_view text, const std::filesystem::path& file) {
  NrrdFields fields;
  bool first = true;
  while (fields.end < text.size()) {
    const std::size_t stop = std::min(text.find('\n', fields.end), text.size());
    const std::string_view line = trimmed(text.substr(fields.end, stop - fields.end));
    fields.end = std::min(stop + 1, text.size());
    if (std::exchange(first, false)) continue;  // NRRD000x
    if (line.empty()) return fields;            // the header's end
    const std::size_t colon = line.find(':');
    if (line.front() == '#') continue;
    if (colon == std::string_view::npos)
      throw damaged(file, fmt::format("{} is no line 'field: value' of its header", quote(line)));
    if (line.substr(colon).starts_with(":=")) continue;  // a key of the user's
    std::string name = lower_words(line.substr(0, colon));
    std::erase(name, ' ');
    fields.values[name] = std::string(trimmed(line.substr(colon + 1)));
    if (name == "datafile" && fields.values[name].starts_with("LIST")) return fields;  // names follow
  }
  return fields;  // .nhdr may end without a blank line
}

const std::string& required_field(const NrrdFields& fields, const char* name, const std::filesystem::path& file) {
  const auto* value = fields.find(name);
  if (!value) throw damaged(file, fmt::format("its header has no field '{}'", name));
  return *value;
}

/// One vector an axis, "none" as nothing: `(1,0,0) none (0,0.5,0)`.
std::vector<std::optional<glm::dvec3>> space_vectors_of(std::string_view text, const std::filesystem::path& file) {
  std::vector<std::optional<glm::dvec3>> vectors;
  text = trimmed(text);
  while (!text.empty()) {
    if (text.starts_with("none")) {
      vectors.emplace_back();
      text = trimmed(text.substr(4));
      continue;
    }
    const std::size_t close = text.find(')');
    if (text.front() != '(' || close == std::string_view::npos)
      throw damaged(file, fmt::format("space directions hold {}, no vector", quote(text)));
    const auto v = header_numbers(text.substr(0, close + 1), 3, file, "a space direction");
    vectors.emplace_back(glm::dvec3(v[0], v[1], v[2]));
    text = trimmed(text.substr(close + 1));
  }
  return vectors;
}

/// Where the line after `lines` more of them begins.
std::uint64_t after_lines(const std::filesystem::path& payload, std::uint64_t offset, std::int64_t lines) {
  if (lines == 0) return offset;
  require_file(payload);
  const MappedFile mapped(payload);
  for (; lines > 0; --lines) {
    const std::size_t end = offset < mapped.text().size() ? mapped.text().find('\n', offset) : std::string_view::npos;
    if (end == std::string_view::npos) throw damaged(payload, "it has fewer lines than are to be skipped");
    offset = end + 1;
  }
  return offset;
}

/// Which of the axes are those of space: three next to each other.
struct NrrdAxes {
  std::size_t count = 3;
  std::size_t skip = 0;        ///< before those of space: none or one
  bool first_is_time = false;  ///< the one before is of steps, not of components

  [[nodiscard]] bool has_time_last() const { return count > skip + 3; }
};

/// The words of `kinds`, else "none" among `space directions` tell; without either a short first of four axes is of
/// components, else the last is of time.
NrrdAxes axes_of(const NrrdFields& fields, const std::vector<std::int64_t>& sizes, const std::filesystem::path& file) {
  NrrdAxes axes{.count = sizes.size()};
  if (axes.count == 3) return axes;
  if (axes.count != 4 && axes.count != 5)
    throw scene::bad_input(
        fmt::format("{}: it has {} dimensions; a volume has three, before them components and after "
                    "them time",
                    file.string(), axes.count));
  axes.skip = axes.count == 5 || sizes[0] <= 16 ? 1 : 0;
  if (const auto* directions = fields.find("spacedirections")) {
    const auto vectors = space_vectors_of(*directions, file);
    if (vectors.size() == axes.count && axes.count == 4) axes.skip = vectors.front() ? 0 : 1;
  }
  if (const auto* kinds = fields.find("kinds")) {
    std::vector<std::string> words;
    for (std::string_view rest = trimmed(*kinds); !rest.empty();) {
      const std::size_t stop = std::min(rest.find_first_of(" \t"), rest.size());
      words.push_back(lower_words(rest.substr(0, stop)));
      rest = trimmed(rest.substr(stop));
    }
    const auto is_space = [](const std::string& w) { return w == "domain" || w == "space"; };
    if (words.size() == axes.count && axes.count == 4 && words.front() != "???" && words.front() != "none")
      axes.skip = is_space(words.front()) ? 0 : 1;
    axes.first_is_time = words.size() == axes.count && axes.skip == 1 && (words[0] == "list" || words[0] == "time");
  }
  return axes;
}

/// Of its field `space`; the others ("scanner-xyz", "3D-right-handed") say nothing of a body.
BodyAxes body_axes_of(std::string space) {
  std::ranges::transform(space, space.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* word : {"right-anterior-superior", "ras", "left-anterior-superior", "las"})
    if (space == word || space == std::string(word) + "-time" || space == std::string(word) + "t") return BodyAxes::ras;
  for (const char* word : {"left-posterior-superior", "lps"})
    if (space == word || space == std::string(word) + "-time" || space == std::string(word) + "t") return BodyAxes::lps;
  return BodyAxes::none;
}

void set_nrrd_geometry(const NrrdFields& fields, const NrrdAxes& about, const std::filesystem::path& file,
                       StoredVolume& volume) {
  const std::size_t axes = about.count, skip = about.skip;
  scene::GridGeometry& g = volume.grid.geometry;
  if (const auto* space = fields.find("space")) volume.body_axes = body_axes_of(*space);
  if (const auto* directions = fields.find("spacedirections")) {
    const auto vectors = space_vectors_of(*directions, file);
    if (vectors.size() != axes)
      throw damaged(file, fmt::format("it has {} space directions for {} axes", vectors.size(), axes));
    std::array<glm::dvec3, 3> steps;
    for (std::size_t a = 0; a < 3; ++a) {
      if (!vectors[a + skip]) throw damaged(file, fmt::format("axis {} has no space direction", a + skip));
      steps[a] = *vectors[a + skip];
    }
    set_axes(g, steps);
    if (const auto* origin = fields.find("spaceorigin")) {
      const auto o = header_numbers(*origin, 3, file, "space origin");
      g.origin = {o[0], o[1], o[2]};
    }
    return;
  }
  const auto per_axis = [&](const char* name, const char* words, double otherwise, glm::dvec3& out) {
    const auto* value = fields.find(name);
    if (!value) return;
    const auto numbers = header_numbers(*value, axes, file, words);
    for (std::size_t a = 0; a < 3; ++a)
      out[static_cast<int>(a)] = std::isnan(numbers[a + skip]) ? otherwise : numbers[a + skip];
  };
  glm::dvec3 spacing(1);
  per_axis("spacings", "spacings", 1, spacing);
  set_axes(g, {glm::dvec3(spacing.x, 0, 0), glm::dvec3(0, spacing.y, 0), glm::dvec3(0, 0, spacing.z)});
  per_axis("axismins", "axis mins", 0, g.origin);
}

}  // namespace

bool looks_like_nrrd(std::string_view beginning) { return beginning.starts_with("NRRD000"); }

StoredVolume read_nrrd_header(const std::filesystem::path& file) {
  constexpr std::size_t longest_nrrd_header = 1 << 20;
  const std::string text = read_beginning(file, longest_nrrd_header);
  const NrrdFields fields = parse_fields(text, file);
  StoredVolume volume;
  volume.format = "NRRD";

  const auto sizes = header_count_list(required_field(fields, "sizes", file), file, "sizes");
  const auto dimension = header_count(required_field(fields, "dimension", file), 1, 16, file, "dimension");
  if (sizes.size() != static_cast<std::size_t>(dimension))
    throw damaged(file, fmt::format("it has {} sizes for {} dimensions", sizes.size(), dimension));
  const NrrdAxes axes = axes_of(fields, sizes, file);
  if (axes.has_time_last()) volume.steps = static_cast<std::uint64_t>(sizes.back());
  if (axes.skip == 1) {
    if (axes.first_is_time && axes.has_time_last())
      throw scene::bad_input(
          fmt::format("{}: its first axis is a list and its last one time; write one of them alone", file.string()));
    if (sizes[0] > (axes.first_is_time ? 1 << 16 : 64))
      throw scene::bad_input(
          fmt::format("{}: its first axis holds {} of a sample; write at most 64 components", file.string(), sizes[0]));
    volume.interleaved_steps = axes.first_is_time && sizes[0] > 1;
    if (axes.first_is_time)
      volume.steps = static_cast<std::uint64_t>(sizes[0]);
    else
      volume.components = static_cast<int>(sizes[0]);
  }
  for (std::size_t a = 0; a < 3; ++a) volume.grid.geometry.points[a] = sizes[axes.skip + a];

  const std::string type = lower_words(required_field(fields, "type", file));
  const auto* known = std::find_if(nrrd_type_names.begin(), nrrd_type_names.end(),
                                   [&](const NrrdTypeName& t) { return type == t.name; });
  if (std::ranges::count(nrrd_int64_names, type) > 0)
    volume.wide = StoredVolume::Wide::int64;
  else if (std::ranges::count(nrrd_uint64_names, type) > 0)
    volume.wide = StoredVolume::Wide::uint64;
  else if (known == nrrd_type_names.end())
    throw scene::bad_input(fmt::format("{}: its type {} is none that is read; write integers, float or double",
                                       file.string(), quote(type)));
  volume.number = volume.wide == StoredVolume::Wide::no ? known->type : SampleType::float64;
  const std::string encoding = lower_words(required_field(fields, "encoding", file));
  volume.compressed = encoding == "gzip" || encoding == "gz";
  if (encoding == "ascii" || encoding == "text" || encoding == "txt")
    volume.coding = StoredVolume::Coding::text;
  else if (encoding == "hex")
    volume.coding = StoredVolume::Coding::hex;
  else if (!volume.compressed && encoding != "raw")
    throw scene::bad_input(
        fmt::format("{}: its encoding {} is not read; write raw, gzip, ascii or hex", file.string(), quote(encoding)));
  const auto* endian = fields.find("endian");
  if (!endian && scene::size_of(volume.number) > 1 && volume.coding != StoredVolume::Coding::text)
    throw damaged(file, "its header has no field 'endian'");
  volume.swapped = endian && (lower_words(*endian) == "big") != (std::endian::native == std::endian::big);
  set_nrrd_geometry(fields, axes, file, volume);

  volume.payload = file;
  volume.offset = fields.end;
  if (const auto* detached = fields.find("datafile")) {
    const auto most = static_cast<std::uint64_t>(sizes.back()) * static_cast<std::uint64_t>(sizes[sizes.size() - 2]);
    volume.slices = header_slices(*detached, std::string_view(text).substr(fields.end), most, file, "data file");
    volume.payload = volume.slices.empty() ? header_path(*detached, file, "data file") : volume.slices.front();
    volume.offset = 0;
  }
  const auto* lines = fields.find("lineskip");
  if (lines && !volume.slices.empty() && *lines != "0")
    throw scene::bad_input(fmt::format("{}: 'line skip' is for one file of samples; leave it out", file.string()));
  if (lines)
    volume.offset = after_lines(volume.payload, volume.offset, header_count(*lines, 0, 1 << 20, file, "line skip"));
  if (const auto* bytes = fields.find("byteskip")) {
    // Lines are skipped before a gzip stream begins, bytes after it is inflated.
    if (*bytes == "-1")
      volume.at_end = true;
    else
      (volume.compressed ? volume.skip_inflated : volume.offset) +=
          static_cast<std::uint64_t>(header_count(*bytes, 0, std::int64_t{1} << 40, file, "byte skip"));
    if (volume.at_end && (volume.compressed || volume.coding != StoredVolume::Coding::binary))
      throw scene::bad_input(
          fmt::format("{}: 'byte skip: -1' is for raw samples only; say where they begin", file.string()));
  }
  return volume;
}

}  // namespace tessera::io
