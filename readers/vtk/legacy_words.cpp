// SPDX-License-Identifier: BSD-3-Clause
// According to "VTK File Formats" (legacy formats, versions 1 to 5.1).
#include "readers/vtk/legacy_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include "io/files/whole_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

/// The arguments of each keyword: n is a number, t a number type, d a kind of data set, w any word.
constexpr std::array keywords = {std::pair("dataset", "d"),        std::pair("points", "nt"),
                                 std::pair("cells", "nn"),         std::pair("cell_types", "n"),
                                 std::pair("offsets", "t"),        std::pair("connectivity", "t"),
                                 std::pair("point_data", "n"),     std::pair("cell_data", "n"),
                                 std::pair("scalars", "wt"),       std::pair("vectors", "wt"),
                                 std::pair("normals", "wt"),       std::pair("tensors", "wt"),
                                 std::pair("tensors6", "wt"),      std::pair("texture_coordinates", "wnt"),
                                 std::pair("color_scalars", "wn"), std::pair("lookup_table", "w"),
                                 std::pair("field", "wn"),         std::pair("dimensions", "nnn"),
                                 std::pair("origin", "nnn"),       std::pair("spacing", "nnn"),
                                 std::pair("aspect_ratio", "nnn"), std::pair("x_coordinates", "nt"),
                                 std::pair("y_coordinates", "nt"), std::pair("z_coordinates", "nt"),
                                 std::pair("vertices", "nn"),      std::pair("lines", "nn"),
                                 std::pair("polygons", "nn"),      std::pair("triangle_strips", "nn"),
                                 std::pair("global_ids", "wt"),    std::pair("pedigree_ids", "wt"),
                                 std::pair("edge_flags", "wt"),    std::pair("metadata", "")};
constexpr std::array number_types = {"bit",       "char",   "signed_char",  "unsigned_char", "short",
                                     "long",      "int",    "unsigned_int", "unsigned_long", "unsigned_short",
                                     "vtkidtype", "float",  "vtktypeint64", "double",        "vtktypeuint64",
                                     "string",    "variant"};
constexpr std::array data_sets = {"structured_points", "structured_grid", "rectilinear_grid",
                                  "unstructured_grid", "polydata",        "field"};

template <class List>
bool is_in(const List& list, std::string_view word) {
  return std::ranges::find(list, lower_case(word)) != list.end();
}

bool is_any_number(std::string_view word) {
  const std::string text(word);
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return end == text.c_str() + text.size();
}

std::string odd_word(std::string_view word, const char* expected) {
  return fmt::format("it has {} where {} is expected", quote(std::string(word)), expected);
}

/// Returns the fault in a line that contains numbers, a keyword with its arguments, or the head of an array of FIELD
/// (name, two numbers and type); empty if there is none.
std::string odd_word_in(const std::vector<std::string_view>& words) {
  if (words.size() == 4 && is_any_number(words[1]) && is_any_number(words[2]) && is_in(number_types, words[3]))
    return "";
  if (is_any_number(words[0])) {
    const auto found = std::ranges::find_if_not(words, is_any_number);
    return found == words.end() ? "" : odd_word(*found, "a number");
  }
  const auto known = std::ranges::find(keywords, lower_case(words[0]), [](const auto& k) { return k.first; });
  if (known == keywords.end()) return odd_word(words[0], "a number or a keyword of the format");
  for (std::size_t k = 0; known->second[k] != '\0' && k + 1 < words.size(); ++k) {
    const char kind = known->second[k];
    if (kind == 'n' && !is_any_number(words[k + 1])) return odd_word(words[k + 1], "a number");
    if (kind == 't' && !is_in(number_types, words[k + 1])) return odd_word(words[k + 1], "a type of numbers");
    if (kind == 'd' && !is_in(data_sets, words[k + 1])) return odd_word(words[k + 1], "a kind of data set");
  }
  return "";
}

}  // namespace

std::string odd_legacy_word(const std::filesystem::path& file) {
  const io::WholeFile mapped(file);
  const std::string_view text = mapped.text();
  bool is_metadata = false;
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size(); ++number) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::vector<std::string_view> words = split_words(text.substr(at, end - at));
    at = end + 1;
    if (words.empty()) is_metadata = false;  // metadata ends at an empty line
    if (number < 2 || words.empty() || is_metadata) continue;
    is_metadata = lower_case(words[0]) == "metadata";
    std::string found;
    if (number > 2)
      found = odd_word_in(words);
    else if (lower_case(words[0]) != "ascii")
      found = lower_case(words[0]) == "binary" ? "" : odd_word(words[0], "ASCII or BINARY");
    if (end == text.size() && words.size() < 2) return "";  // the word may be truncated
    if (!found.empty()) return fmt::format("line {}: {}", number + 1, found);
    if (number == 2 && lower_case(words[0]) == "binary") return "";
    if (words.size() == 4 && is_in(std::array{"string", "variant"}, words[3])) return "";  // any words may follow
  }
  return "";
}

}  // namespace tessera::readers
