// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/vtk_field_words.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>
#include <system_error>

#include "io/files/input_file.hpp"
#include "io/text/header_text.hpp"
#include "io/text/text_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

std::string attribute_in(std::string_view element, std::string_view name) {
  const std::string sought = std::string(name) + "=\"";
  const std::size_t at = element.find(sought);
  if (at == std::string_view::npos) return {};
  const std::size_t from = at + sought.size(), stop = element.find('"', from);
  return stop == std::string_view::npos ? std::string() : std::string(element.substr(from, stop - from));
}

template <class Visit>
void each_field_array(std::string_view text, const Visit& visit) {
  const std::size_t begin = text.find("<FieldData");
  if (begin == std::string_view::npos) return;
  std::string_view rest = text.substr(begin);
  rest = rest.substr(0, rest.find("</FieldData>"));
  constexpr std::string_view opening = "<DataArray";
  for (std::size_t at = rest.find(opening); at != std::string_view::npos; at = rest.find(opening, at + 1)) {
    const std::size_t close = rest.find('>', at);
    if (close == std::string_view::npos) break;
    const std::string_view content = rest.substr(close + 1);
    visit(rest.substr(at, close - at), content.substr(0, content.find('<')));
  }
}

/// Returns the characters up to the code 0.
std::string word_of_codes(std::string_view text) {
  std::string word;
  const char *at = text.data(), *const end = at + text.size();
  while (at < end) {
    if (*at == ' ' || *at == '\n' || *at == '\r' || *at == '\t') {
      ++at;
      continue;
    }
    int code = 0;
    const auto [behind, error] = std::from_chars(at, end, code);
    if (error != std::errc() || code <= 0 || code > 255) break;
    word += static_cast<char>(code);
    at = behind;
  }
  return word;
}

/// Removes and returns the first line of the text.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return trimmed(line);
}

/// Returns the time in a legacy file. Its field data precede the points: `FIELD NAME COUNT` and, for each array, `NAME
/// COMPONENTS TUPLES TYPE`; binary numbers are big-endian.
std::optional<double> legacy_time(std::string_view text) {
  const std::string_view magic = take_line(text);
  take_line(text);  // title
  const bool is_binary = take_line(text) == "BINARY";
  take_line(text);  // skips the type of the data set
  if (!magic.starts_with("# vtk DataFile") || !take_line(text).starts_with("FIELD")) return std::nullopt;
  for (int arrays = 0; arrays < 32 && !text.empty(); ++arrays) {
    std::istringstream about{std::string(take_line(text))};
    std::string name, type;
    std::size_t components = 0, tuples = 0;
    if (!(about >> name >> components >> tuples >> type)) return std::nullopt;
    const std::size_t size = type == "double" || type == "vtkIdType" ? 8 : type == "float" || type == "int" ? 4 : 0;
    if (size == 0 || components != 1 || tuples != 1) return std::nullopt;
    const bool is_time = name == "TIME" || name == "TimeValue";
    if (!is_binary) {
      const std::string_view value = take_line(text);
      if (is_time) return parse_number(value);
      continue;
    }
    if (text.size() < size) return std::nullopt;
    if (is_time && (type == "double" || type == "float")) {
      std::array<char, 8> bytes{};
      std::reverse_copy(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size), bytes.begin());
      const double value =
          size == 8 ? std::bit_cast<double>(bytes) : std::bit_cast<std::array<float, 2>>(bytes).front();
      return std::isfinite(value) ? std::optional(value) : std::nullopt;
    }
    text.remove_prefix(size);
    take_line(text);
  }
  return std::nullopt;
}

bool may_state_time(std::string_view extension) {
  constexpr std::array extensions = {".vtk", ".vtu", ".vti", ".vtr", ".vts", ".pvtu", ".pvti", ".pvtr", ".pvts"};
  return std::ranges::count(extensions, extension) > 0;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> vtk_field_words(std::string_view beginning) {
  std::vector<std::pair<std::string, std::string>> words;
  each_field_array(beginning, [&](std::string_view element, std::string_view content) {
    if (attribute_in(element, "type") == "String" && attribute_in(element, "format") == "ascii")
      words.emplace_back(attribute_in(element, "Name"), word_of_codes(content));
  });
  return words;
}

std::optional<double> vtk_time_value(const std::filesystem::path& file, std::string_view beginning) {
  const std::string extension = system::lower_extension(file);
  if (extension == ".vtk") return legacy_time(beginning);
  if (!may_state_time(extension)) return std::nullopt;
  const bool is_list = extension.starts_with(".p");
  std::optional<double> time;
  each_field_array(beginning, [&](std::string_view element, std::string_view content) {
    if (attribute_in(element, "Name") != "TimeValue") return;
    // VTK writes the range of each array. For arrays that are not text, the range gives the value of a single number.
    const std::string low = attribute_in(element, "RangeMin"), high = attribute_in(element, "RangeMax");
    if (attribute_in(element, "format") == "ascii")
      time = parse_number(trimmed(content));
    else if (low == high)
      time = parse_number(low);
  });
  if (time || !is_list) return time;
  const std::size_t piece = beginning.find("<Piece");
  const std::string first = piece == std::string_view::npos ? "" : attribute_in(beginning.substr(piece), "Source");
  return first.empty() || system::lower_extension(first).starts_with(".p") ? std::nullopt
                                                                           : vtk_time_value(file.parent_path() / first);
}

std::optional<double> vtk_time_value(const std::filesystem::path& file) {
  constexpr std::size_t longest = 1 << 16;
  std::error_code unreadable;
  if (!may_state_time(system::lower_extension(file)) || !std::filesystem::is_regular_file(file, unreadable))
    return std::nullopt;
  return vtk_time_value(file, read_beginning(file, longest));
}

}  // namespace tessera::io
