// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/header_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/files/inflated_file.hpp"
#include "io/text/clean_errors.hpp"
#include "io/text/text_file.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

/// Splits a text into words, which blanks, commas and brackets separate.
std::vector<std::string_view> header_words_of(std::string_view text) { return split_words(text, " \t\r\n,()"); }

}  // namespace

std::vector<double> header_numbers(std::string_view text, std::size_t count, const std::filesystem::path& file,
                                   const char* what) {
  std::vector<double> numbers;
  for (const std::string_view word : header_words_of(text)) {
    const auto value = number_of<double>(word);
    if (!value) break;
    numbers.push_back(*value);
  }
  if (numbers.size() != count || header_words_of(text).size() != count)
    throw damaged(file, fmt::format("{} is {}, not {} number{}", what, quote(text), count, count > 1 ? "s" : ""));
  return numbers;
}

std::int64_t header_count(std::string_view text, std::int64_t low, std::int64_t high, const std::filesystem::path& file,
                          const char* what) {
  const auto value = number_of<std::int64_t>(trimmed(text));
  if (!value || *value < low || *value > high)
    throw damaged(file, fmt::format("{} is {}, not a whole number from {} to {}", what, quote(text), low, high));
  return *value;
}

std::vector<std::int64_t> header_count_list(std::string_view text, const std::filesystem::path& file,
                                            const char* what) {
  std::vector<std::int64_t> counts;
  for (const std::string_view word : header_words_of(text))
    counts.push_back(header_count(word, 1, std::int64_t{1} << 40, file, what));
  return counts;
}

scene::GridIndex header_counts(std::string_view text, const std::filesystem::path& file, const char* what) {
  const auto counts = header_count_list(text, file, what);
  if (counts.size() != 3) throw damaged(file, fmt::format("{} is {}, not three whole numbers", what, quote(text)));
  return {counts[0], counts[1], counts[2]};
}

std::filesystem::path header_path(std::string_view text, const std::filesystem::path& file, const char* what) {
  const bool is_name = std::none_of(text.begin(), text.end(), [](char c) { return c >= 0 && c < 0x20; });
  std::error_code failed;
  std::filesystem::path path = file.parent_path() / text;
  if (is_inflated(path)) require_uncompressed(file);
  // An empty name would denote the directory itself.
  if (!is_name || !std::filesystem::exists(path, failed) || std::filesystem::is_directory(path, failed))
    throw scene::bad_input(
        fmt::format("{}: {} is {}, but there is no such file; put the file there", file.string(), what, quote(text)));
  return path;
}

std::vector<std::filesystem::path> header_slices(std::string_view text, std::string_view lines, std::uint64_t most,
                                                 const std::filesystem::path& file, const char* what) {
  std::vector<std::filesystem::path> slices;
  const auto add = [&](std::string_view name) {
    if (slices.size() >= most)
      throw damaged(file, fmt::format("{} lists more files than there are slices ({})", what, most));
    slices.push_back(header_path(name, file, what));
  };
  if (text.starts_with("LIST")) {
    while (!lines.empty()) {
      const std::size_t stop = std::min(lines.find('\n'), lines.size());
      const std::string_view name = trimmed(lines.substr(0, stop));
      lines.remove_prefix(std::min(stop + 1, lines.size()));
      if (!name.empty()) add(name);
    }
    if (slices.empty()) throw damaged(file, fmt::format("{} announces a list, but no names follow", what));
    return slices;
  }
  const std::size_t percent = text.find('%');
  if (percent == std::string_view::npos) return slices;
  const std::size_t letter = text.find_first_not_of("0123456789", percent + 1);
  const std::size_t blank = text.find_first_of(" \t", percent);
  const std::string_view digits = text.substr(percent + 1, letter - std::min(letter, percent + 1));
  if (letter == std::string_view::npos || text[letter] != 'd' || blank == std::string_view::npos || digits.size() > 2)
    throw damaged(file, fmt::format("{} is {}, not of the form 'NAME%03d.raw FIRST LAST STEP'", what, quote(text)));
  const std::vector<std::string_view> words = header_words_of(text.substr(blank));
  if (words.size() < 2 || words.size() > 4)
    throw damaged(file, fmt::format("{} is {}, without its first and last number", what, quote(text)));
  constexpr std::int64_t highest = 1'000'000'000;
  const std::int64_t first = header_count(words[0], 0, highest, file, what);
  const std::int64_t last = header_count(words[1], 0, highest, file, what);
  const std::int64_t step = words.size() > 2 ? header_count(words[2], -highest, highest, file, what) : 1;
  if (step == 0 || (last - first) / step < 0)
    throw damaged(file, fmt::format("{} counts from {} to {} in steps of {}", what, first, last, step));
  const std::size_t width = digits.empty() ? 0 : static_cast<std::size_t>(std::stoi(std::string(digits)));
  for (std::int64_t k = first; step > 0 ? k <= last : k >= last; k += step) {
    std::string number = std::to_string(k);
    if (number.size() < width) number.insert(0, width - number.size(), digits.front() == '0' ? '0' : ' ');
    add(fmt::format("{}{}{}", text.substr(0, percent), number, text.substr(letter + 1, blank - letter - 1)));
  }
  return slices;
}

}  // namespace tessera::io
