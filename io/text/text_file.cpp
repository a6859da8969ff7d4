// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "scene/error.hpp"
#include "system/files_read.hpp"
#include "system/missing_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr std::uintmax_t largest_file = 64u << 20;

std::string_view without_mark(std::string_view text) {
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  return text;
}

}  // namespace

std::string read_text_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw system::missing_file(file);
  if (std::filesystem::is_directory(status)) throw scene::bad_input(file.string() + ": is a folder; name a file in it");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw scene::bad_input(file.string() + ": cannot be opened; check that you may read it");
  system::note_read(file);
  // Read by pieces rather than by the size: a pipe has none.
  std::string text;
  std::vector<char> piece(1u << 16);
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    text.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
    if (text.size() > largest_file)
      throw scene::bad_input(
          fmt::format("{}: is larger than {} MiB, which no such text is; check that it is the right file",
                      file.string(), largest_file >> 20));
  }
  // Files of the system's own, which have no size, refuse to be read; others fail with their disk.
  if (stream.bad() && std::filesystem::file_size(file, error) == 0)
    throw scene::bad_input(file.string() + ": it cannot be read as text; check that it is the right file");
  if (stream.bad())
    throw scene::Error(scene::ErrorCode::system_failure, file.string() + ": reading failed; check the disk");
  return text;
}

TextLines::TextLines(std::string_view text) : rest_(without_mark(text)) {}

bool TextLines::next(TextLine& line) {
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    text = text.substr(0, text.find('#'));
    line.number = number_;
    line.words = split_words(text);
    if (!line.words.empty()) return true;
  }
  return false;
}

char first_character(std::string_view text) {
  text = without_mark(text);
  const std::size_t begin = text.find_first_not_of(ascii_blanks);
  return begin == std::string_view::npos ? '\0' : text[begin];
}

std::optional<double> parse_number(std::string_view word) {
  if (word.starts_with('+') && word.size() > 1 && word[1] != '-' && word[1] != '+') word.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

}  // namespace tessera::io
