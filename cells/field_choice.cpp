// SPDX-License-Identifier: BSD-3-Clause
#include "cells/field_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "scene/error.hpp"
#include "tessera/program/nearest_name.hpp"
#include "tessera/program/text.hpp"

namespace tessera::cells {
namespace {

using scene::Association;

const char* word(Association a) { return a == Association::point ? "point" : "cell"; }

bool is_floating(const FieldSummary& f) { return f.type == "float" || f.type == "double"; }

/// Whether the values number cells or points. Floats must start at 0 or 1, because pressures may well be 300 to 307.
bool counts_up(const NumberTally& numbers, const FieldSummary& f) {
  return f.components == 1 && (!is_floating(f) || numbers.low == 0 || numbers.low == 1) && numbers.counts_up();
}

void include_numbers(const BlockField& field, FieldTally& tally) {
  constexpr std::uint64_t least_of_block = 16;  // a block with a single cell counts up whatever the value
  NumberTally numbers;
  if (field.tally) {
    numbers = *field.tally;
    // Some readers tally only the smallest and the largest value, so the others may not be integers.
    numbers.whole = numbers.whole && numbers.finite + numbers.not_finite == field.tuples;
  } else {
    std::array<double, 4096> chunk;
    const int component = field.components == 1 ? 0 : magnitude;
    for (std::size_t first = 0; first < field.tuples; first += chunk.size()) {
      const std::span some(chunk.data(), std::min(chunk.size(), field.tuples - first));
      field.read(component, first, some);
      numbers.add(some);
    }
  }
  if (field.tuples > 0)
    tally.blocks_count_up =
        tally.blocks_count_up && numbers.finite >= least_of_block && counts_up(numbers, tally.summary);
  tally.numbers.add(numbers);
}

bool varies(const FieldSummary& f) {
  // Differences from rounding in float arithmetic do not count: the field is still a constant.
  return f.high - f.low > 1e-6 * std::max(std::abs(f.low), std::abs(f.high));
}

std::string label(const FieldSummary& field, int component) {
  if (component == magnitude) return field.name + ":mag";
  if (field.components == 1) return field.name;
  if (field.components <= 3) return fmt::format("{}:{}", field.name, "xyz"[component]);
  return fmt::format("{}:{}", field.name, component);
}

FieldChoice choice_of(const FieldSummary& field, std::optional<int> component) {
  const int c = component ? *component : field.components == 1 ? 0 : magnitude;
  return {field.name, field.association, c, label(field, c), false, {}};
}

std::string list(std::span<const FieldSummary> fields) {
  std::vector<std::string> names;
  for (const FieldSummary& f : fields)
    names.push_back(f.components == 1
                        ? fmt::format("{}:'{}'", word(f.association), f.name)
                        : fmt::format("{}:'{}' ({} components)", word(f.association), f.name, f.components));
  return fmt::format("{}", fmt::join(names, ", "));
}

const FieldSummary* find(std::span<const FieldSummary> fields, const std::string& name,
                         std::optional<Association> association) {
  for (const Association wanted : {Association::point, Association::cell}) {
    if (association && *association != wanted) continue;
    for (const FieldSummary& f : fields)
      if (f.association == wanted && f.name == name) return &f;
  }
  return nullptr;
}

/// Returns the component that the text after the colon names, for any array; -2 if it does not name one.
int parse_component(const std::string& text) {
  if (text == "mag" || text == "magnitude") return magnitude;
  if (text == "x" || text == "y" || text == "z") return text[0] - 'x';
  const int n = number_of<int>(text).value_or(-2);
  return n >= 0 ? n : -2;
}

/// Resolves "NAME" or "NAME:component" among the arrays of one association, or of both.
std::optional<FieldChoice> resolve(const std::string& requested, std::optional<Association> association,
                                   std::span<const FieldSummary> fields, const std::string& source) {
  if (const FieldSummary* field = find(fields, requested, association)) return choice_of(*field, std::nullopt);
  const std::size_t colon = requested.rfind(':');
  if (colon == std::string::npos) return std::nullopt;
  const FieldSummary* field = find(fields, requested.substr(0, colon), association);
  if (!field) return std::nullopt;
  const std::string word_after = requested.substr(colon + 1);
  const int component = parse_component(word_after);
  if (component == -2 || component >= field->components)
    throw scene::bad_input(fmt::format(
        "{}: field '{}' has {} component{}, but not '{}'; use {}", source, field->name, field->components,
        field->components == 1 ? "" : "s", word_after,
        field->components == 1 ? "the name alone" : fmt::format(":mag or :0 to :{}", field->components - 1)));
  return choice_of(*field, component);
}

/// Whether a name is that of labels that number cells, points, parts or materials, which are the last choice.
bool is_id_name(const std::string& name) {
  const std::string lower = lower_case(name);
  static constexpr std::array exact = {"id",   "ids",     "iblank", "rank",     "partition",  "processid",  "procid",
                                       "part", "blockid", "region", "material", "material #", "materialid", "block"};
  if (std::find(exact.begin(), exact.end(), lower) != exact.end() || lower.starts_with("vtk")) return true;
  // The name is a label if one of these is a word of it, as in "GLOBAL_IDS_POINTS" and "GlobalNodeId", but not in
  // "Fluid" or "Solid"; or if it contains two words, as in "NodeNumber", but not in "Mach number".
  constexpr std::array<std::string_view, 4> ids = {"id", "ids", "gid", "gids"};
  constexpr std::array<std::string_view, 7> counted = {"node", "element", "elem", "cell", "point", "vertex", "face"};
  constexpr std::array<std::string_view, 6> numbers = {"number", "numbers", "num", "no", "nr", "index"};
  const auto is_in = [](const auto& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  std::string word, before;
  for (std::size_t k = 0; k <= name.size(); ++k) {
    const char c = k < name.size() ? name[k] : ' ';
    const bool begins = is_upper(c) && k > 0 && is_lower(name[k - 1]);
    if (begins || !is_letter(c)) {
      if (is_in(ids, word) || (is_in(counted, before) && is_in(numbers, word))) return true;
      if (!word.empty()) before = std::exchange(word, {});
    }
    if (is_letter(c)) word += lower_case(c);
  }
  return false;
}

bool is_id(const FieldSummary& f) { return f.ids || (!f.fractions && is_id_name(f.name)); }

/// With so few values, 0, 1, 2 ... may be a quantity of a test if nothing else varies.
bool may_count_by_chance(const FieldSummary& f) {
  return f.ids && is_floating(f) && f.high - f.low < 64 && !is_label_name(f.name);
}

const FieldSummary* first_of(std::span<const FieldSummary> fields, const auto& wanted) {
  const auto f = std::find_if(fields.begin(), fields.end(), wanted);
  return f == fields.end() ? nullptr : &*f;
}

/// Returns the first field that varies and that `may_be` accepts.
const FieldSummary* first_quantity(std::span<const FieldSummary> fields, const auto& may_be) {
  const auto quantity = [&](const FieldSummary& f) { return varies(f) && may_be(f); };
  for (const Association a : {Association::point, Association::cell})
    if (const auto* f = first_of(fields, [&](const FieldSummary& s) {
          return s.association == a && s.components == 1 && quantity(s) && s.active;
        }))
      return f;
  for (const Association a : {Association::point, Association::cell})
    for (const bool scalar : {true, false})
      if (const auto* f = first_of(fields, [&](const FieldSummary& s) {
            return s.association == a && (s.components == 1) == scalar && quantity(s);
          }))
        return f;
  return nullptr;
}

std::optional<FieldChoice> default_choice(std::span<const FieldSummary> fields, bool shape) {
  const auto is_quantity = [](const FieldSummary& s) { return !is_label(s); };
  if (const auto* f =
          first_quantity(fields, [&](const FieldSummary& s) { return is_quantity(s) && !looks_like_noise(s); }))
    return choice_of(*f, std::nullopt);
  if (const auto* f = first_quantity(fields, is_quantity)) {
    FieldChoice choice = choice_of(*f, std::nullopt);
    choice.notes.push_back(
        fmt::format("'{}' is within {:.2g} of zero everywhere, so it may be noise, but no other field varies", f->name,
                    std::max(std::abs(f->low), std::abs(f->high))));
    return choice;
  }
  if (const auto* f = first_quantity(fields, may_count_by_chance)) {
    FieldChoice choice = choice_of(*f, std::nullopt);
    choice.notes.push_back(
        fmt::format("'{}' has the values {:g} to {:g}, each once, so they may be ids, but no other field varies",
                    f->name, f->low, f->high));
    return choice;
  }
  if (shape) return std::nullopt;
  if (const auto* f = first_quantity(fields, [](const FieldSummary& s) { return !is_id(s); }))
    return choice_of(*f, std::nullopt);
  if (const auto* f = first_of(fields, [&](const FieldSummary& s) { return s.high > s.low && is_quantity(s); }))
    return choice_of(*f, std::nullopt);
  if (const auto* f = first_of(fields, is_quantity)) return choice_of(*f, std::nullopt);
  if (const auto* f = first_of(fields, varies)) return choice_of(*f, std::nullopt);
  return std::nullopt;
}

FieldChoice no_array(std::span<const FieldSummary> fields, bool shape) {
  FieldChoice none{"", Association::point, 0, shape ? shape_field_name : "none", shape, {}};
  if (!shape)
    none.notes.emplace_back("the file has no field: every point has the value 1");
  else if (fields.empty())
    none.notes.emplace_back(
        "the file has no field: its shape is drawn, and parts near the default view's eye are lighter");
  else
    none.notes.push_back(
        fmt::format("only labels and indices vary among its fields: its shape is drawn, and parts near the default "
                    "view's eye are lighter; `field` draws one of {}",
                    list(fields)));
  return none;
}

}  // namespace

const BlockField* find_field(const CellBlock& block, const std::string& name, Association association) {
  for (const BlockField& f : block.fields)
    if (f.association == association && f.name == name) return &f;
  return nullptr;
}

std::vector<FieldTally> tally_fields(std::span<const CellBlock> blocks) {
  std::vector<FieldTally> tallies;
  for (const CellBlock& block : blocks)
    for (const BlockField& field : block.fields) {
      auto t = std::find_if(tallies.begin(), tallies.end(), [&](const FieldTally& known) {
        return known.summary.name == field.name && known.summary.association == field.association &&
               known.summary.components == field.components;
      });
      if (t == tallies.end()) {
        tallies.push_back({{field.name, field.association, field.components, field.type}, {}, true});
        t = tallies.end() - 1;
      }
      t->summary.active = t->summary.active || field.active;
      t->summary.ids = t->summary.ids || field.ids;
      include_numbers(field, *t);
    }
  return tallies;
}

std::vector<FieldSummary> summarize_fields(std::span<const std::vector<FieldTally>> parts) {
  std::vector<FieldTally> wholes;
  for (const auto& part : parts)
    for (const FieldTally& more : part) {
      auto whole = std::find_if(wholes.begin(), wholes.end(), [&](const FieldTally& known) {
        return known.summary.name == more.summary.name && known.summary.association == more.summary.association;
      });
      if (whole == wholes.end()) {
        wholes.push_back(more);
        continue;
      }
      whole->summary.active = whole->summary.active || more.summary.active;
      whole->summary.ids = whole->summary.ids || more.summary.ids;
      if (whole->summary.components != more.summary.components)
        continue;  // a block with another number of components
                   // counts as missing the field
      whole->numbers.add(more.numbers);
      whole->blocks_count_up = whole->blocks_count_up && more.blocks_count_up;
    }
  std::vector<FieldSummary> summaries;
  for (FieldTally& whole : wholes) {
    FieldSummary& s = summaries.emplace_back(std::move(whole.summary));
    const NumberTally& numbers = whole.numbers;
    s.nan_count = numbers.not_finite;
    if (numbers.any_finite) s.low = numbers.low, s.high = numbers.high;
    s.fractions = numbers.any_finite && !numbers.whole && is_floating(s);
    s.ids = s.ids || (numbers.any_finite && (whole.blocks_count_up || counts_up(numbers, s)));
  }
  return summaries;
}

bool looks_like_noise(const FieldSummary& field) {
  const double low = field.components == 1 ? field.low : -field.high;  // for vectors, the range is that of the length
  return low < 0 && field.high > 0 && std::max(-low, field.high) <= 1e-12;
}

bool is_label(const FieldSummary& field) { return field.ids || (!field.fractions && is_label_name(field.name)); }

bool is_label_name(const std::string& name) {
  const std::string lower = lower_case(name);
  static constexpr std::array words = {"ranks",
                                       "materials",
                                       "mat",
                                       "domain",
                                       "subdomain",
                                       "zone",
                                       "index",
                                       "indices",
                                       "label",
                                       "labels",
                                       "owner",
                                       "mpi_rank",
                                       "mpirank",
                                       "proc",
                                       "process",
                                       "attribute",
                                       "i",
                                       "j",
                                       "k",
                                       "block_i",
                                       "block_j",
                                       "block_k",
                                       "cell_index",
                                       "node_index",
                                       "point_index",
                                       "nodeid",
                                       "elementid",
                                       "cellid",
                                       "objectid",
                                       "globalid",
                                       "globalnodeid",
                                       "globalelementid",
                                       "gmsh:physical",
                                       "gmsh:geometrical",
                                       "cellentityids"};
  if (is_id_name(name) || std::find(words.begin(), words.end(), lower) != words.end()) return true;
  for (const char* begin : {"material_", "material ", "partition_", "rank_"})
    if (lower.starts_with(begin)) return true;
  return lower.ends_with("_rank") || lower.ends_with("_label") || lower.ends_with("_labels");
}

namespace {

/// Returns "did you mean 'NAME'? ", or an empty text.
std::string meant_field(const std::string& requested, std::span<const FieldSummary> fields) {
  std::vector<std::string> names;
  for (const FieldSummary& field : fields) names.push_back(field.name);
  for (const Association a : {Association::point, Association::cell})
    for (const FieldSummary& field : fields)
      if (field.association == a) names.push_back(fmt::format("{}:{}", word(a), field.name));
  const auto near = nearest_name(requested, names);
  return near ? fmt::format("did you mean '{}'? ", *near) : "";
}

}  // namespace

FieldChoice choose_field(const std::string& requested, std::span<const FieldSummary> fields, const std::string& source,
                         bool shape) {
  if (requested.empty()) {
    std::optional<FieldChoice> choice = default_choice(fields, shape);
    if (!choice) return no_array(fields, shape);
    if (fields.size() > 1)
      choice->notes.insert(choice->notes.begin(), fmt::format("field {}:'{}' chosen of {}", word(choice->association),
                                                              choice->label, list(fields)));
    return *choice;
  }
  std::optional<FieldChoice> choice;
  if (find(fields, requested, std::nullopt)) choice = resolve(requested, std::nullopt, fields, source);
  for (const Association a : {Association::point, Association::cell})
    if (const std::string prefix = fmt::format("{}:", word(a)); !choice && requested.starts_with(prefix))
      choice = resolve(requested.substr(prefix.size()), a, fields, source);
  if (!choice) choice = resolve(requested, std::nullopt, fields, source);
  if (!choice)
    throw scene::bad_input(
        fields.empty() ? fmt::format("{}: there is no field '{}', because the file has no fields; leave `field` out",
                                     source, requested)
                       : fmt::format("{}: there is no field '{}'; {}it has {}", source, requested,
                                     meant_field(requested, fields), list(fields)));
  if (choice->association == Association::point && find(fields, choice->name, Association::cell) &&
      !requested.starts_with("point:"))
    choice->notes.push_back(fmt::format(
        "'{0}' is both a point and a cell field: the point field is used, cell:{0} selects the other", choice->name));
  return *choice;
}

bool look_like_colors(const FieldSummary& field) {
  return field.type == "uint8" && (field.components == 3 || field.components == 4);
}

void refuse_colors(const FieldChoice& choice, const FieldSummary& field, const std::string& requested,
                   const std::string& source) {
  if (choice.component != magnitude || requested.ends_with(":mag") || requested.ends_with(":magnitude")) return;
  throw scene::bad_input(
      fmt::format("{}: '{}' has colours of {} components, which are not drawn as colours; choose one component with "
                  "`field` {}:0 (red), or their length with {}:mag",
                  source, field.name, field.components, field.name, field.name));
}

}  // namespace tessera::cells
