// SPDX-License-Identifier: BSD-3-Clause
#include "io/volume/nrrd_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <utility>

#include "io/text/header_text.hpp"
#include "io/text/text_file.hpp"
#include "scene/time_step_read.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

/// Splits a text into words, which blanks separate; keeps quotes.
std::vector<std::string> nrrd_words(std::string_view text) {
  std::vector<std::string> words;
  for (const std::string_view word : split_words(text)) words.push_back(lower_case(word));
  return words;
}

/// Parses one vector per axis, of three or four numbers, for example `(1,0,0) none (0,0.5,0)`. "none" and (nan, nan,
/// nan) give no value.
std::vector<std::optional<glm::dvec4>> space_vectors_of(std::string_view text, const std::filesystem::path& file) {
  std::vector<std::optional<glm::dvec4>> vectors;
  text = trimmed(text);
  while (!text.empty()) {
    if (text.starts_with("none")) {
      vectors.emplace_back();
      text = trimmed(text.substr(4));
      continue;
    }
    const std::size_t close = text.find(')');
    if (text.front() != '(' || close == std::string_view::npos)
      throw damaged(file, fmt::format("space directions contain {}, which is not a vector", quote(text)));
    const std::string_view vector = text.substr(0, close + 1);
    if (std::ranges::count(vector, ',') == 1)
      throw scene::bad_input(
          fmt::format("{}: its space has two dimensions, as the direction {} shows; write a space of three, with a "
                      "direction for each axis",
                      file.string(), quote(vector)));
    const std::size_t count = std::ranges::count(vector, ',') == 3 ? 4 : 3;
    const auto v = header_numbers(vector, count, file, "a space direction");
    if (std::ranges::all_of(v, [](double x) { return std::isnan(x); }))
      vectors.emplace_back();
    else
      vectors.emplace_back(glm::dvec4(v[0], v[1], v[2], count == 4 ? v[3] : 0));
    text = trimmed(text.substr(close + 1));
  }
  return vectors;
}

bool leads_through_space(const std::optional<glm::dvec4>& vector) {
  return vector && (vector->x != 0 || vector->y != 0 || vector->z != 0);
}

using Uses = std::vector<NrrdAxes::Use>;

bool has_three(const Uses& uses) { return std::ranges::count(uses, NrrdAxes::Use::space) == 3; }

/// Returns the uses of the axes if exactly three have a direction in space; otherwise no value.
std::optional<Uses> uses_by_directions(const NrrdFields& fields, std::size_t axes, const std::filesystem::path& file) {
  const auto* directions = fields.find("spacedirections");
  if (directions == nullptr) return std::nullopt;
  const auto vectors = space_vectors_of(*directions, file);
  if (vectors.size() != axes)
    throw damaged(file, fmt::format("it has {} space directions for {} axes", vectors.size(), axes));
  Uses uses;
  for (const auto& vector : vectors)
    uses.push_back(leads_through_space(vector) ? NrrdAxes::Use::space
                   : vector                    ? NrrdAxes::Use::steps
                                               : NrrdAxes::Use::nothing);
  return has_three(uses) ? std::optional(uses) : std::nullopt;
}

/// Returns the use that a word of `kinds` names; `nothing` for an unknown word.
NrrdAxes::Use use_of_kind(const std::string& kind) {
  if (kind == "domain" || kind == "space") return NrrdAxes::Use::space;
  if (kind == "time" || kind == "list" || kind == "point") return NrrdAxes::Use::steps;
  if (kind.empty() || kind.starts_with('?') || kind == "none" || kind == "stub") return NrrdAxes::Use::nothing;
  return NrrdAxes::Use::components;
}

/// Sets the uses that are not determined: axes before the spatial ones are components, those after them time steps.
void fill_unknown_uses(Uses& uses, const std::vector<std::int64_t>& sizes, const Uses& by_kinds) {
  const auto first = std::ranges::find(uses, NrrdAxes::Use::space) - uses.begin();
  for (std::size_t a = 0; a < uses.size(); ++a) {
    if (uses[a] == NrrdAxes::Use::space) continue;
    if (sizes[a] == 1)
      uses[a] = NrrdAxes::Use::nothing;
    else if (by_kinds[a] == NrrdAxes::Use::components || by_kinds[a] == NrrdAxes::Use::steps)
      uses[a] = by_kinds[a];
    else if (uses[a] == NrrdAxes::Use::nothing)
      uses[a] = static_cast<std::ptrdiff_t>(a) < first ? NrrdAxes::Use::components : NrrdAxes::Use::steps;
  }
}

/// Given the letters or words of anatomical axes, returns the direction of each axis of the file in
/// right-anterior-superior. No value for other texts.
std::optional<glm::dmat3> to_ras(std::string_view space) {
  struct BodyWord {
    std::string_view word;
    int axis;
    double sign;
  };
  constexpr std::array<BodyWord, 6> words = {{{"right", 0, 1},
                                              {"left", 0, -1},
                                              {"anterior", 1, 1},
                                              {"posterior", 1, -1},
                                              {"superior", 2, 1},
                                              {"inferior", 2, -1}}};
  const bool is_short = space.size() == 3;
  glm::dmat3 matrix(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    const auto* const found = std::ranges::find_if(
        words, [&](const BodyWord& w) { return space.starts_with(is_short ? w.word.substr(0, 1) : w.word); });
    if (found == words.end()) return std::nullopt;
    matrix[axis][found->axis] = found->sign;
    space.remove_prefix(is_short ? 1 : found->word.size());
  }
  if (!space.empty() || glm::determinant(matrix) == 0) return std::nullopt;
  return matrix;
}

struct NrrdSpace {
  BodyAxes axes = BodyAxes::none;
  glm::dmat3 to_world{1.0};
  std::string note{};
};

/// Interprets the field `space`.
NrrdSpace space_of(const std::string& field) {
  std::string word = lower_case(field);
  std::erase_if(word, [](char c) { return !is_letter(c) && !is_digit(c); });
  if (word.ends_with("time")) word.resize(word.size() - 4);
  if (word.size() == 4 && word.back() == 't') word.pop_back();  // RAST
  if (word == "scannerxyz" || word == "3drighthanded") return {};
  if (word == "3dlefthanded")
    return {.to_world = glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1),
            .note = "its space is left-handed and is converted: x is reversed, so that the image is not mirrored"};
  const auto matrix = to_ras(word);
  if (!matrix)
    return {.note = fmt::format("its space {} is unknown: the axes are used as stored in the file", quote(field))};
  if (*matrix == glm::dmat3(1.0)) return {.axes = BodyAxes::ras};
  if (*matrix == glm::dmat3(-1, 0, 0, 0, -1, 0, 0, 0, 1)) return {.axes = BodyAxes::lps};
  return {.axes = BodyAxes::ras,
          .to_world = *matrix,
          .note = fmt::format("its space, {}, is converted to right-anterior-superior", field)};
}

/// Positions along one axis, from the fields that have a value per axis. If samples are cell centers, the first sample
/// is half a step inside of the axis minimum.
struct AxisPlaces {
  double spacing = 1, first = 0;
};

AxisPlaces axis_places(const NrrdFields& fields, std::size_t axis, const std::vector<std::int64_t>& sizes,
                       const std::filesystem::path& file) {
  const auto number = [&](const char* name, const char* words) {
    const auto* value = fields.find(name);
    return value == nullptr ? std::nan("") : header_numbers(*value, sizes.size(), file, words)[axis];
  };
  bool of_cells = false;
  for (const char* name : {"centers", "centerings"})
    if (const auto* value = fields.find(name)) {
      const auto words = nrrd_words(*value);
      of_cells = axis < words.size() && words[axis] == "cell";
    }
  const double low = number("axismins", "axis mins"), high = number("axismaxs", "axis maxs");
  const double count = static_cast<double>(sizes[axis]) - (of_cells ? 0 : 1);
  AxisPlaces places;
  const double given = number("spacings", "spacings");
  if (!std::isnan(given))
    places.spacing = given;
  else if (std::isfinite(high - low) && high != low && count > 0)
    places.spacing = (high - low) / count;
  const double half = of_cells ? places.spacing / 2 : 0;
  if (!std::isnan(low))
    places.first = low + half;
  else if (std::isfinite(high))
    places.first = high - places.spacing * count + half;
  return places;
}

/// Parses the numbers of `space origin`. A fourth number is a time.
std::vector<double> space_origin_of(const std::string& field, const std::filesystem::path& file) {
  return header_numbers(field, std::ranges::count(field, ',') == 3 ? 4 : 3, file, "space origin");
}

/// Returns the times of an axis whose direction in a four-dimensional space is along the fourth dimension only; no
/// value for other axes.
std::optional<AxisPlaces> places_in_time(const NrrdFields& fields, std::size_t axis,
                                         const std::filesystem::path& file) {
  const auto *directions = fields.find("spacedirections"), *place = fields.find("spaceorigin");
  if (directions == nullptr) return std::nullopt;
  const auto vectors = space_vectors_of(*directions, file);
  if (axis >= vectors.size() || !vectors[axis] || leads_through_space(vectors[axis])) return std::nullopt;
  AxisPlaces places{.spacing = vectors[axis]->w};
  if (!std::isfinite(places.spacing) || places.spacing == 0) return std::nullopt;
  if (place == nullptr) return places;
  if (const auto origin = space_origin_of(*place, file); origin.size() == 4 && std::isfinite(origin[3]))
    places.first = origin[3];
  return places;
}

}  // namespace

NrrdFields nrrd_fields_of(std::string_view text, const std::filesystem::path& file) {
  NrrdFields fields;
  bool first = true;
  while (fields.end < text.size()) {
    const std::size_t stop = std::min(text.find('\n', fields.end), text.size());
    const std::string_view line = trimmed(text.substr(fields.end, stop - fields.end));
    fields.end = std::min(stop + 1, text.size());
    if (std::exchange(first, false)) continue;  // NRRD000x
    if (line.empty()) return fields;            // an empty line ends the header
    const std::size_t colon = line.find(':');
    if (line.front() == '#') continue;
    if (colon == std::string_view::npos)
      throw damaged(file, fmt::format("line {} of its header is not of the form 'field: value'", quote(line)));
    if (line.substr(colon).starts_with(":=")) {
      fields.keys[std::string(line.substr(0, colon))] = std::string(trimmed(line.substr(colon + 2)));
      continue;
    }
    std::string name = lower_case(line.substr(0, colon));
    std::erase(name, ' ');
    fields.values[name] = std::string(trimmed(line.substr(colon + 1)));
    if (name == "datafile" && fields.values[name].starts_with("LIST")) return fields;  // file names follow
  }
  return fields;  // a .nhdr may end without a blank line
}

NrrdAxes nrrd_axes_of(const NrrdFields& fields, const std::vector<std::int64_t>& sizes,
                      const std::filesystem::path& file) {
  const std::size_t count = sizes.size();
  NrrdAxes axes{.uses = Uses(count, NrrdAxes::Use::space), .space = {0, 1, 2}};
  if (count == 3) return axes;
  if (count < 3 || count > 5)
    throw scene::bad_input(fmt::format(
        "{}: it has {} dimensions; a volume has three, optionally with components before them and time after them",
        file.string(), count));
  Uses by_kinds(count, NrrdAxes::Use::nothing);
  if (const auto* kinds = fields.find("kinds")) {
    const auto words = nrrd_words(*kinds);
    for (std::size_t a = 0; a < count && words.size() == count; ++a) by_kinds[a] = use_of_kind(words[a]);
  }
  if (auto uses = uses_by_directions(fields, count, file)) {
    axes.uses = *std::move(uses);
  } else if (has_three(by_kinds)) {
    axes.uses = by_kinds;
  } else {
    // If more than three axes are domains, the last is not spatial: ITK writes four-dimensional images like this.
    const bool are_domains = std::ranges::count(by_kinds, NrrdAxes::Use::space) > 3;
    const bool skips = are_domains ? by_kinds.front() != NrrdAxes::Use::space : count == 5 || sizes[0] <= 16;
    const std::size_t skip = skips ? 1 : 0;
    std::ranges::fill(axes.uses, NrrdAxes::Use::nothing);
    for (std::size_t a = 0; a < 3; ++a) axes.uses[skip + a] = NrrdAxes::Use::space;
    if (count == 4 && skips && !are_domains && sizes[0] > 1 && by_kinds[0] == NrrdAxes::Use::nothing)
      axes.note = fmt::format(
          "its header has no line 'kinds': the first of its 4 axes, with {} samples, is used as components; add such a "
          "line if it is an axis of space",
          sizes[0]);
  }
  fill_unknown_uses(axes.uses, sizes, by_kinds);
  for (std::size_t a = 0, k = 0; a < count; ++a)
    if (axes.uses[a] == NrrdAxes::Use::space) axes.space[k++] = a;
  for (std::size_t a = axes.space[0]; a < axes.space[2]; ++a)
    if (axes.uses[a] == NrrdAxes::Use::components || axes.uses[a] == NrrdAxes::Use::steps)
      throw scene::bad_input(fmt::format(
          "{}: axis {} of {}, with {} samples, is between the axes of space; write it first or last (`unu permute`)",
          file.string(), a + 1, count, sizes[a]));
  return axes;
}

std::vector<double> nrrd_times(const NrrdFields& fields, const NrrdAxes& axes, const std::vector<std::int64_t>& sizes,
                               const std::filesystem::path& file) {
  const auto* kinds = fields.find("kinds");
  const std::vector<std::string> words = kinds != nullptr ? nrrd_words(*kinds) : std::vector<std::string>();
  for (std::size_t a = 0; a < sizes.size(); ++a) {
    if (axes.uses[a] != NrrdAxes::Use::steps || (a < words.size() && (words[a] == "list" || words[a] == "point")))
      continue;
    const auto given = [&](const char* name) {
      const auto* value = fields.find(name);
      return value != nullptr && std::isfinite(header_numbers(*value, sizes.size(), file, name)[a]);
    };
    if (const auto places = places_in_time(fields, a, file))
      return scene::even_times(places->first, places->spacing, static_cast<std::uint64_t>(sizes[a]));
    if (!given("spacings") && !(given("axismins") && given("axismaxs"))) continue;
    const AxisPlaces places = axis_places(fields, a, sizes, file);
    return scene::even_times(places.first, places.spacing, static_cast<std::uint64_t>(sizes[a]));
  }
  return {};
}

std::optional<bool> has_color_axis(const NrrdFields& fields, const NrrdAxes& axes) {
  const auto* kinds = fields.find("kinds");
  const std::vector<std::string> words = kinds != nullptr ? nrrd_words(*kinds) : std::vector<std::string>();
  for (std::size_t a = 0; a < axes.uses.size() && words.size() == axes.uses.size(); ++a) {
    if (axes.uses[a] != NrrdAxes::Use::components) continue;
    if (words[a].ends_with("-color")) return true;
    if (words[a].ends_with("vector")) return false;
  }
  return std::nullopt;
}

void set_nrrd_geometry(const NrrdFields& fields, const NrrdAxes& axes, const std::vector<std::int64_t>& sizes,
                       const std::filesystem::path& file, StoredVolume& volume) {
  scene::GridGeometry& g = volume.grid.geometry;
  NrrdSpace space;
  if (const auto* field = fields.find("space")) space = space_of(*field);
  volume.body_axes = space.axes;
  for (const std::string& note : {axes.note, space.note})
    if (!note.empty()) volume.notes.push_back(note);
  std::array<glm::dvec3, 3> steps{};
  glm::dvec3 origin(0);
  const auto* directions = fields.find("spacedirections");
  if (directions != nullptr) {
    const auto vectors = space_vectors_of(*directions, file);
    if (vectors.size() != sizes.size())
      throw damaged(file, fmt::format("it has {} space directions for {} axes", vectors.size(), sizes.size()));
    for (std::size_t a = 0; a < 3; ++a) {
      const auto& vector = vectors[axes.space[a]];
      if (!vector) throw damaged(file, fmt::format("axis {} has no space direction", axes.space[a]));
      steps[a] = glm::dvec3(*vector);
    }
  } else {
    for (std::size_t a = 0; a < 3; ++a) {
      const AxisPlaces places = axis_places(fields, axes.space[a], sizes, file);
      steps[a][static_cast<int>(a)] = places.spacing;
      origin[static_cast<int>(a)] = places.first;
    }
  }
  if (const auto* place = fields.find("spaceorigin")) {
    const auto o = space_origin_of(*place, file);
    if (std::isfinite(o[0] + o[1] + o[2])) origin = {o[0], o[1], o[2]};
  }
  for (glm::dvec3& step : steps) step = space.to_world * step;
  scene::set_axes(g, steps);
  g.origin = space.to_world * origin + 0.0;
}

}  // namespace tessera::io
