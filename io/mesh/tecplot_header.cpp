// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/tecplot_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <utility>

#include "io/text/scanner.hpp"
#include "io/text/text_file.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

bool is_tecplot_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ','; }

bool begins_number(char c) { return is_digit(c) || c == '+' || c == '-' || c == '.'; }

/// The value of a key. Quoted words are stored without quotes, lists without the outer parentheses.
struct TecplotValue {
  std::string text;
  bool is_list = false;
  std::size_t at = 0;
};

/// Parses everything except numbers.
class TecplotWords {
 public:
  TecplotWords(std::string_view text, const std::string& source) : text_(text), source_(source) {}

  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] bool at_end() const { return at_ >= text_.size(); }
  [[nodiscard]] char here() const { return text_[at_]; }
  void go_to(std::size_t at) { at_ = at; }

  /// Skips blanks, commas and comments. Returns true if a line ended.
  bool skip_blanks() {
    bool has_ended = false;
    while (!at_end() && (is_tecplot_blank(here()) || here() == '#')) {
      if (here() == '#') skip_line();
      if (at_end()) break;
      has_ended = has_ended || here() == '\n';
      ++at_;
    }
    return has_ended;
  }

  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }

  std::string word() {
    const std::size_t first = at_;
    while (!at_end() && !is_tecplot_blank(here()) && here() != '=' && here() != '(' && here() != '"') ++at_;
    return std::string(text_.substr(first, at_ - first));
  }

  std::string quoted() {
    const std::size_t first = at_++;
    std::string words;
    for (; !at_end() && here() != '"'; ++at_) {
      if (here() == '\\' && at_ + 1 < text_.size()) ++at_;
      words += here();
    }
    if (at_end()) fail(first, "a quotation is not closed; close it, or export the file again");
    ++at_;
    return words;
  }

  bool skip_equals() {
    skip_blanks();
    if (at_end() || here() != '=') return false;
    ++at_;
    skip_blanks();
    return true;
  }

  TecplotValue value(const std::string& key) {
    TecplotValue value{.text = {}, .is_list = false, .at = at_};
    if (at_end()) fail(at_, fmt::format("{} has no value; export the file again", quote(key)));
    if (here() == '"') {
      value.text = quoted();
      return value;
    }
    if (here() != '(') {
      value.text = word();
      return value;
    }
    value.is_list = true;
    int depth = 0;
    const std::size_t first = at_ + 1;
    for (; !at_end(); ++at_) {
      if (here() == '(') ++depth;
      if (here() == ')' && --depth == 0) break;
    }
    if (at_end()) fail(value.at, fmt::format("the list of {} is not closed; export the file again", quote(key)));
    value.text = text_.substr(first, at_++ - first);
    return value;
  }

  [[noreturn]] void fail(std::size_t at, const std::string& what) const { fail_at(text_, at, source_, what); }

 private:
  std::string_view text_;
  const std::string& source_;
  std::size_t at_ = 0;
};

/// Parses the numbers of a set, "[1-3,5]" or "5". The result counts from 0.
std::vector<std::size_t> numbers_of(std::string_view set, std::size_t count, const std::function<void()>& fail) {
  std::vector<std::size_t> numbers;
  const char *at = set.data(), *const end = at + set.size();
  while (at < end) {
    if (*at == '[' || *at == ']' || is_tecplot_blank(*at)) {
      ++at;
      continue;
    }
    std::size_t first = 0, step = 1;
    auto read = std::from_chars(at, end, first);
    std::size_t last = first;
    if (read.ec == std::errc() && read.ptr < end && *read.ptr == '-') read = std::from_chars(read.ptr + 1, end, last);
    if (read.ec == std::errc() && read.ptr < end && *read.ptr == ':') read = std::from_chars(read.ptr + 1, end, step);
    if (read.ec != std::errc() || first < 1 || last < first || last > count || step < 1) {
      fail();
      return numbers;
    }
    for (std::size_t n = first; n <= last; n += step) numbers.push_back(n - 1);
    at = read.ptr;
  }
  return numbers;
}

/// Splits a list into entries, which commas or blanks outside of brackets separate. Example of an entry:
/// "[4-5]=CELLCENTERED".
std::vector<std::pair<std::string, std::string>> entries_of(std::string_view list) {
  std::vector<std::pair<std::string, std::string>> entries;
  int depth = 0;
  bool has_equals = false, is_open = false;
  for (const char c : list) {
    if (depth == 0 && is_tecplot_blank(c)) {
      is_open = has_equals && entries.back().second.empty();  // blanks may follow the equals sign
      continue;
    }
    if (c == '=' && depth == 0 && !entries.empty()) {
      has_equals = is_open = true;
      continue;
    }
    if (!is_open) {
      entries.emplace_back();
      has_equals = false;
      is_open = true;
    }
    if (c == '[' || c == '(') ++depth;
    if (c == ']' || c == ')') --depth;
    (has_equals ? entries.back().second : entries.back().first) += c;
  }
  return entries;
}

class HeaderParser {
 public:
  HeaderParser(std::string_view text, const std::string& source) : text_(text), words_(text, source) {}

  TecplotHeader parse() {
    if (text_.starts_with(byte_order_mark)) words_.go_to(3);
    for (words_.skip_blanks(); !words_.at_end(); words_.skip_blanks()) {
      const std::size_t at = words_.at();
      const std::string key = upper_case(words_.word());
      if (key == "ZONE") {
        add_zone(at);
      } else if (key == "VARIABLES" && words_.skip_equals()) {
        // Files that were concatenated repeat the record of variables.
        const std::vector<std::string> earlier = std::exchange(header_.variables, {});
        read_variables();
        if (!header_.zones.empty() && header_.variables != earlier)
          words_.fail(
              at, "VARIABLES differs from the list before the zones; write zones with other variables to another file");
      } else if (key == "FILETYPE" && words_.skip_equals()) {
        if (upper_case(words_.value(key).text) == "SOLUTION")
          words_.fail(at, "it holds a solution without its grid; write FILETYPE=FULL");
      } else {
        skip_record(at);
      }
    }
    return std::move(header_);
  }

 private:
  static constexpr std::array<std::string_view, 9> records = {
      "ZONE", "TITLE", "VARIABLES", "FILETYPE", "TEXT", "GEOMETRY", "CUSTOMLABELS", "DATASETAUXDATA", "VARAUXDATA"};

  [[nodiscard]] bool begins_record(std::size_t at) const {
    if (begins_number(text_[at])) return false;  // true for most lines
    return std::ranges::any_of(records, [&](std::string_view record) {
      if (upper_case(text_.substr(at, record.size())) != record) return false;
      const std::size_t end = at + record.size();
      return end >= text_.size() || is_tecplot_blank(text_[end]) || text_[end] == '=' || text_[end] == '#';
    });
  }

  /// Returns the position of the first line at or after `at` that begins another record.
  [[nodiscard]] std::size_t next_record(std::size_t at) const {
    while (at < text_.size()) {
      const std::size_t line_end = text_.find('\n', at);
      if (line_end == std::string_view::npos) return text_.size();
      at = text_.find_first_not_of(" \t\r", line_end + 1);
      if (at == std::string_view::npos) return text_.size();
      if (begins_record(at)) return at;
    }
    return text_.size();
  }

  void skip_record(std::size_t at) { words_.go_to(next_record(at)); }

  void read_variables() {
    for (bool is_first = true;; is_first = false) {
      const bool has_ended = words_.skip_blanks();
      if (words_.at_end()) return;
      const bool is_quoted = words_.here() == '"';
      if (!is_quoted && ((has_ended && !is_first) || begins_record(words_.at()) || begins_number(words_.here())))
        return;
      const std::size_t at = words_.at();
      std::string name = is_quoted ? words_.quoted() : words_.word();
      if (!is_quoted && name.empty()) words_.fail(at, "VARIABLES has no name here; put the names in quotation marks");
      header_.variables.push_back(std::move(name));
    }
  }

  void add_zone(std::size_t at) {
    TecplotZone zone;
    zone.record_at = at;
    zone.of_cells.assign(header_.variables.size(), false);
    zone.is_passive.assign(header_.variables.size(), false);
    packing_.clear();
    for (;;) {
      words_.skip_blanks();
      if (words_.at_end() || begins_number(words_.here()) || begins_record(words_.at())) break;
      const std::size_t key_at = words_.at();
      std::string key = upper_case(words_.word());
      const bool is_note = key == "AUXDATA";
      if (is_note) {
        words_.skip_blanks();
        key = upper_case(words_.word());
      }
      if (key.empty() || !words_.skip_equals()) {
        words_.go_to(key_at);
        if (key.starts_with("NAN") || key.starts_with("INF")) break;
        words_.fail(key_at, fmt::format("{} is not a key of a zone with a value; export the file again", quote(key)));
      }
      const TecplotValue value = words_.value(key);
      if (!is_note) set(zone, key, value);
    }
    zone.numbers_at = words_.at();
    zone.end = words_.at_end() || begins_record(words_.at()) ? words_.at() : next_record(words_.at());
    words_.go_to(zone.end);
    finish(zone);
    header_.zones.push_back(std::move(zone));
  }

  std::size_t count(const std::string& key, const TecplotValue& value) const {
    std::size_t number = 0;
    const char* const end = value.text.data() + value.text.size();
    const auto read = std::from_chars(value.text.data(), end, number);
    if (read.ec != std::errc() || read.ptr != end)
      words_.fail(value.at, fmt::format("{} is {}, not a whole number; export the file again", key, quote(value.text)));
    return number;
  }

  std::size_t zone_number(const std::string& key, const TecplotValue& value) const {
    const std::size_t number = value.text.empty() ? header_.zones.size() : count(key, value);
    if (number < 1 || number > header_.zones.size())
      words_.fail(value.at, fmt::format("{} refers to zone {}, but only {} zones come before; export the file again",
                                        key, number, header_.zones.size()));
    return number - 1;
  }

  void set(TecplotZone& zone, const std::string& key, const TecplotValue& value) {
    if (key == "T") zone.name = value.text;
    if (key == "I") zone.i = count(key, value);
    if (key == "J") zone.j = count(key, value);
    if (key == "K") zone.k = count(key, value);
    if (key == "N" || key == "NODES") zone.nodes = count(key, value);
    if (key == "E" || key == "ELEMENTS") zone.elements = count(key, value);
    if (key == "FACES") zone.faces = count(key, value);
    if (key == "TOTALNUMFACENODES") zone.face_nodes = count(key, value);
    if (key == "ZONETYPE" || key == "ET") set_type(zone, upper_case(value.text), value);
    if (key == "DATAPACKING" || key == "F") set_packing(zone, upper_case(value.text), value);
    if (key == "STRANDID") zone.strand = static_cast<std::int64_t>(count(key, value));
    if (key == "SOLUTIONTIME") zone.time = parse_number(value.text);
    if (key == "VARLOCATION") set_locations(zone, value);
    if (key == "VARSHARELIST") set_shares(zone, value);
    if (key == "PASSIVEVARLIST")
      for (const std::size_t v : variables_in(value.text, value)) zone.is_passive[v] = true;
    if (key == "CONNECTIVITYSHAREZONE") zone.connectivity_from = zone_number(key, value);
    if (key == "D") set_duplicates(zone, value);
    if (key == "NV")
      words_.fail(value.at, "NV, which numbers the nodes by a variable, is not supported; write them in order");
  }

  void set_type(TecplotZone& zone, const std::string& type, const TecplotValue& value) {
    if (type == "ORDERED")
      zone.type = TecplotZoneType::ordered;
    else if (type == "FETETRAHEDRON" || type == "TETRAHEDRON")
      zone.type = TecplotZoneType::tetrahedra;
    else if (type == "FEBRICK" || type == "BRICK")
      zone.type = TecplotZoneType::bricks;
    else if (type == "FEPOLYHEDRON")
      zone.type = TecplotZoneType::polyhedra;
    else if (type == "FELINESEG" || type == "FETRIANGLE" || type == "FEQUADRILATERAL" || type == "FEPOLYGON" ||
             type == "LINESEG" || type == "TRIANGLE" || type == "QUADRILATERAL" || type == "POINT")
      zone.type = TecplotZoneType::lines_or_faces;
    else
      words_.fail(value.at, fmt::format("a zone has the type {}, which is not supported; export bricks or tetrahedra",
                                        quote(value.text)));
  }

  void set_packing(TecplotZone& zone, const std::string& packing, const TecplotValue& value) {
    packing_ = packing;
    if (packing == "POINT" || packing == "FEPOINT")
      zone.by_point = true;
    else if (packing == "BLOCK" || packing == "FEBLOCK")
      zone.by_point = false;
    else
      words_.fail(value.at, fmt::format("the packing {} is not supported; write POINT or BLOCK", quote(value.text)));
  }

  std::vector<std::size_t> variables_in(std::string_view set, const TecplotValue& value) const {
    return numbers_of(set, header_.variables.size(), [&] {
      words_.fail(value.at,
                  fmt::format("{} refers to variables other than the variables 1 to {} of the file; export it again",
                              quote(set), header_.variables.size()));
    });
  }

  static bool is_of_cells(const std::string& location) { return upper_case(location).starts_with("CELL"); }

  /// Parses "[4-5]=CELLCENTERED", or a list with a word for each variable.
  void set_locations(TecplotZone& zone, const TecplotValue& value) {
    std::size_t next = 0;
    for (const auto& [set, location] : entries_of(value.text)) {
      if (!location.empty()) {
        for (const std::size_t v : variables_in(set, value)) zone.of_cells[v] = is_of_cells(location);
      } else if (next < zone.of_cells.size()) {
        zone.of_cells[next++] = is_of_cells(set);
      }
    }
  }

  /// Parses "[1-3]=2", or a set alone, which refers to the previous zone.
  void set_shares(TecplotZone& zone, const TecplotValue& value) {
    for (const auto& [set, from] : entries_of(value.text)) {
      const std::size_t other = zone_number("VARSHARELIST", {.text = from, .is_list = false, .at = value.at});
      for (const std::size_t v : variables_in(set, value)) zone.shared_from[v] = other;
    }
  }

  /// Parses the older list of arrays that are shared with the previous zone: "(1,2,FECONNECT)".
  void set_duplicates(TecplotZone& zone, const TecplotValue& value) {
    const std::size_t other = zone_number("D", {.text = {}, .is_list = false, .at = value.at});
    for (const auto& [set, from] : entries_of(value.text)) {
      if (upper_case(set) == "FECONNECT")
        zone.connectivity_from = other;
      else
        for (const std::size_t v : variables_in(set, value)) zone.shared_from[v] = other;
    }
  }

  void finish(TecplotZone& zone) const {
    const bool is_ordered = zone.type == TecplotZoneType::ordered && !packing_.starts_with("FE");
    if (zone.type == TecplotZoneType::ordered && !is_ordered) zone.type = TecplotZoneType::lines_or_faces;
    // Some writers store the counts of nodes and elements as I and J.
    if (!is_ordered && zone.nodes == 0 && zone.elements == 0) zone.nodes = zone.i, zone.elements = zone.j;
    const double most = static_cast<double>(text_.size());
    const auto require = [&](double number, const char* what) {
      if (number > most)
        words_.fail(
            zone.record_at,
            fmt::format(
                "the zone states {} {}, more than a file of this size can contain; it is truncated, export it again",
                number, what));
    };
    if (is_ordered) {
      require(static_cast<double>(zone.i) * static_cast<double>(zone.j) * static_cast<double>(zone.k), "points");
      zone.nodes = zone.i * zone.j * zone.k;
      const auto cells = [](std::size_t n) { return n > 1 ? n - 1 : n; };
      zone.elements = zone.nodes == 0 ? 0 : cells(zone.i) * cells(zone.j) * cells(zone.k);
    }
    require(static_cast<double>(zone.nodes), "points");
    require(static_cast<double>(zone.elements), "elements");
    require(static_cast<double>(zone.faces), "faces");
    require(static_cast<double>(zone.face_nodes), "nodes of faces");
  }

  std::string_view text_;
  TecplotWords words_;
  TecplotHeader header_;
  std::string packing_;
};

}  // namespace

TecplotHeader parse_tecplot_header(std::string_view text, const std::string& source) {
  return HeaderParser(text, source).parse();
}

}  // namespace tessera::io
