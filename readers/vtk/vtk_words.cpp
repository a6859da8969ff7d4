// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/vtk_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

/// VTK's message for a legacy file without a data set.
constexpr const char* no_output = "not create output";

bool has(std::string_view text, std::string_view words) { return text.find(words) != std::string_view::npos; }

/// Whether a message reports bytes that do not follow the format.
bool proves_damage(std::string_view words) {
  constexpr std::array signs = {"EOF",
                                "nd of file",
                                "Error reading",
                                "Error parsing",
                                "Parse error",
                                "Cannot read",
                                "Expected ",
                                "Illegal ",
                                "out of range",
                                "not well-formed",
                                "Unmatched ",
                                "Unrecognized keyword",
                                "Premature",
                                "truncated",
                                "undefined geometry file line",
                                "invalid VARIABLE line",
                                "entry found for patch",
                                "but mesh only has",
                                "cell type: is not supported"};  // the missing type is a truncated word
  return std::any_of(signs.begin(), signs.end(), [&](const char* sign) { return has(words, sign); });
}

/// Returns the missing file that a message names; empty if it does not name one.
std::string missing_file_in(std::string_view words, const std::string& source) {
  if (!has(words, "open") && !has(words, "not found") && !has(words, "does not exist")) return "";
  const auto is_missing = [&](std::string name, bool is_after_colon) {
    while (!name.empty() && std::string_view(":;,.\"'()").find(name.back()) != std::string_view::npos) name.pop_back();
    while (!name.empty() && std::string_view("\"'(").find(name.front()) != std::string_view::npos) name.erase(0, 1);
    std::error_code unknown;
    if (name.empty() || name == source || std::filesystem::exists(name, unknown) || unknown) return std::string();
    const std::filesystem::path path(name);
    const bool is_name = is_after_colon && path.has_extension() && !has(name, " ");
    if (path.has_parent_path() ? !std::filesystem::is_directory(path.parent_path(), unknown) : !is_name)
      return std::string();
    return path.extension() == ".gz" ? (path.parent_path() / path.stem()).string() : name;  // both names were tried
  };
  // A name may contain blanks. So everything after a colon is tried first, then each word.
  for (std::size_t at = words.find(": "); at != std::string_view::npos; at = words.find(": ", at + 1))
    if (std::string name = is_missing(std::string(words.substr(at + 2)), true); !name.empty()) return name;
  for (std::size_t at = 0; at < words.size();) {
    const std::size_t end = std::min(words.find(' ', at), words.size());
    if (std::string name = is_missing(std::string(words.substr(at, end - at)), false); !name.empty()) return name;
    at = end + 1;
  }
  return "";
}

}  // namespace

std::string words_for_users(std::string_view reported) {
  std::string text(reported);
  if (has(text, no_output)) return no_output;
  if (const std::size_t at = text.find("): "); at != std::string::npos) text.erase(0, at + 3);
  // Removes "Algorithm vtkX returned failure for request: vtkInformation", and the dump of the object's state after it.
  for (const char* const state : {"Algorithm vtk", "vtkInformation", "Debug: O", "Modified Time:"})
    text.resize(std::min(text.size(), text.find(state)));
  for (std::size_t at = 0; (at = text.find("(0x", at)) != std::string::npos;) {
    const std::size_t end = text.find(')', at);
    if (end == std::string::npos) break;
    text.erase(at, end + 1 - at);
  }
  std::string words;
  for (const char c : text) {
    const char plain = c >= ' ' && c <= '~' ? c : ' ';
    if (plain != ' ' || (!words.empty() && words.back() != ' ')) words += plain;
  }
  while (!words.empty() && std::string_view(" .!:").find(words.back()) != std::string_view::npos) words.pop_back();
  constexpr std::size_t most = 400;
  if (words.size() > most) words = words.substr(0, most) + "...";
  return words;
}

scene::Error error_of_vtk(const std::string& source, const std::string& words, const std::string& remedy) {
  if (words.empty())
    return scene::bad_input(
        fmt::format("{}: VTK's reader fails on it and gives no reason; have it written in another format", source));
  // VTK's legacy reader reports a truncated file only as a warning.
  if (has(words, "ends before its data")) return scene::bad_input(fmt::format("{}: {}; {}", source, words, remedy));
  // The file is a legacy file that contains only fields.
  if (words == no_output)
    return scene::bad_input(fmt::format("{}: it has no points and cells; give the file that has them", source));
  if (const std::string file = missing_file_in(words, source); !file.empty())
    return scene::bad_input(fmt::format("{}: it needs {}, but there is no such file; put it there", source, file));
  // The messages of some readers already begin with the name of the file.
  const std::string own = words.starts_with(source + ": ") ? words.substr(source.size() + 2) : words;
  for (const char* const odd : {"non-digit character n", "non-digit character i", "found nan", "found inf"})
    if (own.ends_with(odd))
      return scene::bad_input(fmt::format(
          "{}: {}: NaN and infinite numbers in text are not numbers to VTK's reader of OpenFOAM; write the case in "
          "binary (foamFormatConvert)",
          source, own));
  constexpr std::string_view attribute = "attribute type: ";
  if (const std::size_t at = own.find(attribute);
      at != std::string::npos && at + attribute.size() < own.size() && is_digit(own[at + attribute.size()]))
    return scene::bad_input(fmt::format(
        "{}: it has a number, {}, where the next array is expected, so an array has more numbers than it states; {}",
        source, own.substr(at + attribute.size(), own.find(' ', at + attribute.size()) - at - attribute.size()),
        remedy));
  if (proves_damage(own)) return scene::bad_input(fmt::format("{}: {}; {}", source, own, remedy));
  return scene::bad_input(fmt::format(
      "{}: VTK's reader reports: {}; correct that, or have the file written in another format", source, own));
}

}  // namespace tessera::readers
