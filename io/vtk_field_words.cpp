#include "io/vtk_field_words.hpp"

#include <charconv>
#include <string_view>

#include "io/header_text.hpp"
#include "io/input_file.hpp"
#include "io/text_file.hpp"

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
void each_field_array(const std::filesystem::path& file, const Visit& visit) {
  constexpr std::size_t longest = 1 << 16;
  const std::string text = read_beginning(file, longest);
  const std::size_t begin = text.find("<FieldData");
  if (begin == std::string::npos) return;
  std::string_view rest = std::string_view(text).substr(begin);
  rest = rest.substr(0, rest.find("</FieldData>"));
  constexpr std::string_view opening = "<DataArray";
  for (std::size_t at = rest.find(opening); at != std::string_view::npos; at = rest.find(opening, at + 1)) {
    const std::size_t close = rest.find('>', at);
    if (close == std::string_view::npos) break;
    const std::string_view content = rest.substr(close + 1);
    visit(rest.substr(at, close - at), content.substr(0, content.find('<')));
  }
}

/// Letters up to the code 0.
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

}  // namespace

std::vector<std::pair<std::string, std::string>> vtk_field_words(const std::filesystem::path& file) {
  std::vector<std::pair<std::string, std::string>> words;
  each_field_array(file, [&](std::string_view element, std::string_view content) {
    if (attribute_in(element, "type") == "String" && attribute_in(element, "format") == "ascii")
      words.emplace_back(attribute_in(element, "Name"), word_of_codes(content));
  });
  return words;
}

std::optional<double> vtk_time_value(const std::filesystem::path& file) {
  std::optional<double> time;
  each_field_array(file, [&](std::string_view element, std::string_view content) {
    if (attribute_in(element, "Name") != "TimeValue") return;
    // VTK writes the range of each array, and so the one value of arrays that are not text.
    const std::string low = attribute_in(element, "RangeMin"), high = attribute_in(element, "RangeMax");
    if (attribute_in(element, "format") == "ascii")
      time = parse_number(trimmed(content));
    else if (low == high)
      time = parse_number(low);
  });
  return time;
}

}  // namespace tessera::io
