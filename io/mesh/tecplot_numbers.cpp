// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/tecplot_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "io/text/scanner.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

constexpr std::string_view tecplot_blanks = " \t\r\n,";

/// Largest number of values per byte of the file: a few characters can store many repetitions of a value.
constexpr double most_values_a_byte = 16;

/// Reads the numbers of a zone sequentially. "3*1.5" is the number 1.5 three times.
class NumberStream {
 public:
  NumberStream(std::string_view text, const TecplotZone& zone, const std::string& source)
      : words_(text.substr(0, zone.end), source, tecplot_blanks), zone_(zone) {
    words_.go_to(zone.numbers_at);
  }

  double next(const char* what) {
    if (left_ > 0) {
      --left_;
      return repeated_;
    }
    double value = 0;
    if (const Scanned found = words_.number(value); found == Scanned::number || found == Scanned::out_of_range)
      return value;
    std::string_view word = words_.word();
    for (; word.starts_with('#'); word = words_.word()) words_.rest_of_line();
    if (word.empty())
      words_.fail(fmt::format("the zone ends before its {} do; it is truncated, export it again", what));
    const std::size_t star = word.find('*');
    if (star == std::string_view::npos) return number(word, what);
    const auto count = number_of<std::size_t>(word.substr(0, star));
    if (!count || *count == 0) refuse(word, what);
    repeated_ = number(word.substr(star + 1), what);
    left_ = *count - 1;
    return repeated_;
  }

  std::size_t next_index(const char* what) {
    const double value = next(what);
    if (!(value >= 0 && value <= std::numeric_limits<std::uint32_t>::max()) || value != std::floor(value))
      words_.fail(fmt::format("{} is among the {}; export the file again", value, what));
    return static_cast<std::size_t>(value);
  }

  /// Throws for a count that exceeds the length of the text.
  [[noreturn]] void refuse_count(std::size_t count, const char* what) const {
    words_.fail_at(
        zone_.record_at,
        fmt::format(
            "the zone states {} {}, more than a file of this size can contain; it is truncated, export it again", count,
            what));
  }

  /// Returns how many numbers the first line with numbers has.
  [[nodiscard]] std::size_t on_first_line() const {
    const std::string_view rest = words_.rest();
    return split_words(rest.substr(0, rest.find('\n')), tecplot_blanks).size();
  }

 private:
  /// Parses a number. Also accepts Fortran's notation ("1.5D+00", "+1"). Words such as "1.#QNAN", and numbers out of
  /// range, become NaN.
  double number(std::string_view word, const char* what) const {
    std::string plain(word.substr(word.starts_with('+') ? 1 : 0));
    std::ranges::replace_if(
        plain, [](char c) { return c == 'd' || c == 'D'; }, 'e');
    double value = 0;
    const char* const end = plain.data() + plain.size();
    const auto read = std::from_chars(plain.data(), end, value);
    if (read.ec == std::errc() && read.ptr == end) return value;
    if (read.ec == std::errc::result_out_of_range || word.find('#') != std::string_view::npos)
      return std::numeric_limits<double>::quiet_NaN();
    refuse(word, what);
  }

  [[noreturn]] void refuse(std::string_view word, const char* what) const {
    words_.fail(fmt::format("{} is among the {}, and is not a number; export the file again", quote(word), what));
  }

  TextScanner words_;
  const TecplotZone& zone_;
  double repeated_ = 0;
  std::size_t left_ = 0;  ///< repetitions left
};

std::size_t nodes_an_element(TecplotZoneType type) {
  return type == TecplotZoneType::bricks ? 8 : type == TecplotZoneType::tetrahedra ? 4 : 0;
}

/// Whether values are packed by points. If the zone has no packing keyword, values are packed by points if all are at
/// nodes and the first line has one number for each variable.
bool is_by_point(const TecplotZone& zone, const NumberStream& numbers, std::size_t variables) {
  if (zone.by_point) return *zone.by_point;
  return variables != zone.nodes && numbers.on_first_line() == variables &&
         std::ranges::count(zone.of_cells, true) == 0;
}

void read_values(std::string_view text, const TecplotZone& zone, const std::string& source, NumberStream& numbers,
                 TecplotNumbers& read) {
  std::vector<std::size_t> own;
  double total = 0;
  for (std::size_t v = 0; v < zone.of_cells.size(); ++v) {
    if (zone.shared_from.contains(v) || zone.is_passive[v]) continue;
    own.push_back(v);
    total += static_cast<double>(zone.of_cells[v] ? zone.elements : zone.nodes);
  }
  if (total > most_values_a_byte * static_cast<double>(text.size()))
    fail_at(
        text, zone.record_at, source,
        fmt::format(
            "the zone states {} values, more than a file of this size can contain; it is truncated, export it again",
            total));
  const bool by_point = is_by_point(zone, numbers, own.size());
  for (const std::size_t v : own) {
    if (by_point && zone.of_cells[v])
      fail_at(text, zone.record_at, source, "values at cells cannot be packed by point; write DATAPACKING=BLOCK");
    read.values[v].resize(zone.of_cells[v] ? zone.elements : zone.nodes);
  }
  if (by_point) {
    for (std::size_t n = 0; n < zone.nodes; ++n)
      for (const std::size_t v : own) read.values[v][n] = numbers.next("values");
  } else {
    for (const std::size_t v : own)
      for (double& value : read.values[v]) value = numbers.next("values");
  }
}

void read_polyhedra(const TecplotZone& zone, NumberStream& numbers, TecplotNumbers& read) {
  std::size_t nodes = 0;
  for (std::size_t f = 0; f < zone.faces; ++f) {
    read.face_sizes.push_back(numbers.next_index("numbers of nodes of faces"));
    nodes += read.face_sizes.back();
  }
  if (nodes > zone.end) numbers.refuse_count(nodes, "nodes of faces");
  for (std::size_t n = 0; n < nodes; ++n) read.face_nodes.push_back(numbers.next_index("nodes of faces"));
  for (auto* const side : {&read.left, &read.right})
    for (std::size_t f = 0; f < zone.faces; ++f) {
      // A negative number refers to elements of other zones.
      const double element = numbers.next("elements in addition to faces");
      side->push_back(element > 0 && element <= static_cast<double>(zone.elements) ? static_cast<std::size_t>(element)
                                                                                   : 0);
    }
}

}  // namespace

TecplotNumbers read_tecplot_numbers(std::string_view text, const TecplotZone& zone, const std::string& source) {
  TecplotNumbers read;
  read.values.resize(zone.of_cells.size());
  NumberStream numbers(text, zone, source);
  read_values(text, zone, source, numbers, read);
  if (zone.connectivity_from) return read;
  if (zone.type == TecplotZoneType::polyhedra) read_polyhedra(zone, numbers, read);
  const std::size_t count = zone.elements * nodes_an_element(zone.type);
  for (std::size_t k = 0; k < count; ++k) read.connectivity.push_back(numbers.next_index("nodes of elements"));
  return read;
}

}  // namespace tessera::io
