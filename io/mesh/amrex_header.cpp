// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/amrex_header.hpp"

#include <fmt/format.h>

#include <optional>

#include "io/text/scanner.hpp"
#include "io/text/text_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

constexpr std::int64_t most_fields = 1 << 16, most_boxes = 1 << 20, most_levels = 64, most_cells = 1 << 29;

/// Parses the text word by word, or by lines where the format requires a position. Brackets and commas separate words,
/// too.
class Words {
 public:
  Words(std::string_view text, const std::string& source) : scanner_(text, source, " \t\r\n(),") {}

  /// Returns the rest of the line and moves to the next line.
  std::string_view line() { return scanner_.rest_of_line(); }

  std::string_view word(const char* what) {
    const std::string_view word = scanner_.word();
    if (word.empty()) fail(fmt::format("the file ends before {}; it is truncated, write it again", what));
    return word;
  }

  std::int64_t count(const char* what, std::int64_t low, std::int64_t high) {
    const std::string_view text = word(what);
    const auto number = number_of<std::int64_t>(text);
    if (!number || *number < low || *number > high)
      fail(fmt::format("{} is {}, but must be a whole number from {} to {}; write the file again", what, quote(text),
                       low, high));
    return *number;
  }

  double number(const char* what) {
    const std::string_view text = word(what);
    const std::optional<double> number = parse_number(text);
    if (!number) fail(fmt::format("{} is {}, but must be a number; write the file again", what, quote(text)));
    return *number;
  }

  /// Parses ((0,0,0) (7,7,7) (0,0,0)): the first cell, the last cell, and the axes along which the box has nodes
  /// instead of cells.
  AmrexBox box(const char* what) {
    AmrexBox box;
    for (std::int64_t& n : box.low) n = count(what, -most_cells, most_cells);
    for (std::int64_t& n : box.high) n = count(what, -most_cells, most_cells);
    for (int axis = 0; axis < 3; ++axis)
      if (count(what, 0, 1) != 0)
        fail(fmt::format("{} has values at nodes, which are not supported; write values at cells", what));
    for (std::size_t a = 0; a < 3; ++a)
      if (box.cells(a) < 1) fail(fmt::format("{} ends before it begins; write the file again", what));
    return box;
  }

  [[noreturn]] void fail(const std::string& problem) const { scanner_.fail(problem); }

 private:
  TextScanner scanner_;
};

}  // namespace

AmrexHeader parse_amrex_header(std::string_view text, const std::string& source) {
  AmrexHeader header;
  Words words(text, source);
  words.line();  // the program's name and version
  const auto fields = words.count("the number of fields", 1, most_fields);
  words.line();
  for (std::int64_t f = 0; f < fields; ++f) {
    header.fields.emplace_back(trimmed(words.line()));
    if (header.fields.back().empty()) words.fail(fmt::format("field {} has no name; write the file again", f));
  }
  if (const auto dimensions = words.count("the number of dimensions", 1, 3); dimensions != 3)
    throw scene::bad_input(fmt::format("{}: it has {} dimensions; give a data set of three", source, dimensions));
  words.word("the time");
  header.levels.resize(static_cast<std::size_t>(words.count("the finest level", 0, most_levels - 1)) + 1);
  for (double& low : header.low) low = words.number("the domain's low end");
  for (int axis = 0; axis < 3; ++axis) words.number("the domain's high end");
  for (std::size_t l = 1; l < header.levels.size(); ++l) words.word("a ratio of refinement");
  for (AmrexLevel& level : header.levels) level.domain = words.box("a level's domain");
  for (std::size_t l = 0; l < header.levels.size(); ++l) words.word("a level's step");
  for (AmrexLevel& level : header.levels)
    for (double& spacing : level.spacing) spacing = words.number("a level's cell size");
  if (const auto system = words.count("the coordinate system", 0, 2); system != 0)
    throw scene::bad_input(
        fmt::format("{}: its coordinates are {}, but only Cartesian coordinates are supported; give another data set",
                    source, system == 1 ? "cylindrical" : "spherical"));
  words.word("the width of the boundary");
  for (AmrexLevel& level : header.levels) {
    words.word("a level's number");
    const auto boxes = words.count("a level's number of boxes", 1, most_boxes);
    words.word("a level's time");
    words.word("a level's step");
    for (std::int64_t n = 0; n < 6 * boxes; ++n) words.number("an end of a box");
    level.cells = words.word("the name of a level's list of boxes");
  }
  return header;
}

std::vector<AmrexFab> parse_amrex_level(std::string_view text, std::size_t fields, const std::string& source) {
  Words words(text, source);
  if (const auto version = words.count("the version", 0, 1000); version != 1)
    words.fail(fmt::format(
        "its header does not list the ranges of values (version {}); write it with vismf.headerversion = 1", version));
  words.word("how values are spread over files");
  if (const auto stored = words.count("the number of fields", 0, most_fields);
      stored != static_cast<std::int64_t>(fields))
    words.fail(fmt::format("it has {} fields, but the Header lists {}; write the file again", stored, fields));
  words.word("the number of cells around a box");
  const auto boxes = words.count("the number of boxes", 1, most_boxes);
  words.word("the number after the number of boxes");
  std::vector<AmrexFab> fabs;  // grows as boxes are parsed, not by the stated count
  for (std::int64_t n = 0; n < boxes; ++n) fabs.emplace_back().box = words.box("a box");
  words.count("the number of boxes' values", boxes, boxes);
  for (AmrexFab& fab : fabs) {
    if (const std::string_view key = words.word("FabOnDisk:"); key != "FabOnDisk:")
      words.fail(fmt::format("it has {} where FabOnDisk: is required; write the file again", quote(key)));
    fab.file = words.word("a file's name");
    fab.offset = static_cast<std::uint64_t>(words.count("where values begin", 0, std::int64_t{1} << 50));
  }
  return fabs;
}

AmrexBox parse_amrex_fab(std::string_view text, std::size_t& fields, const std::string& source) {
  Words words(text, source);
  const AmrexBox box = words.box("the box of values");
  fields = static_cast<std::size_t>(words.count("the number of fields", 1, most_fields));
  return box;
}

}  // namespace tessera::io
