// SPDX-License-Identifier: BSD-3-Clause
#include "api/options/toml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <set>
#include <utility>

#include "tessera/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::api {
namespace {

constexpr std::string_view blanks = " \t\r";

bool is_key_character(char c) { return is_letter(c) || is_digit(c) || c == '-' || c == '_'; }

void append_utf8(std::string& text, std::uint32_t code) {
  const auto tail = [&](int shift) { text += static_cast<char>(0x80 | ((code >> shift) & 0x3f)); };
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xc0 | (code >> 6));
    tail(0);
  } else if (code < 0x10000) {
    text += static_cast<char>(0xe0 | (code >> 12));
    tail(6), tail(0);
  } else {
    text += static_cast<char>(0xf0 | (code >> 18));
    tail(12), tail(6), tail(0);
  }
}

class Parser {
 public:
  Parser(std::string_view text, const std::string& source) : rest_(text), source_(source) {
    if (rest_.starts_with("\xFF\xFE") || rest_.starts_with("\xFE\xFF"))
      throw bad_input(source_ + ": is UTF-16; save it as UTF-8");
    if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
  }

  std::vector<TomlLine> parse() {
    std::vector<TomlLine> lines;
    std::set<std::string> keys;
    while (skip_to_content()) {
      TomlLine line{take_key(), {}};
      if (!keys.insert(line.key).second)
        throw fail(fmt::format("{} is given twice; keep one, or give a list: [\"a\", \"b\"]", quote(line.key)));
      if (peek() == '[')
        take_list(line.values);
      else
        line.values.push_back(take_value());
      skip(blanks);
      skip_comment();
      if (!rest_.empty() && peek() != '\n')
        throw fail(fmt::format("{} follows the value of {}; put text in quotes", quote(word()), quote(line.key)));
      lines.push_back(std::move(line));
    }
    return lines;
  }

 private:
  [[nodiscard]] Error fail(const std::string& what) const {
    return bad_input(fmt::format("{}: line {}: {}", source_, number_, what));
  }
  [[nodiscard]] char peek() const { return rest_.empty() ? '\0' : rest_.front(); }
  [[nodiscard]] std::string_view word() const { return rest_.substr(0, rest_.find_first_of(" \t\r\n")); }

  char take() {
    const char c = rest_.front();
    rest_.remove_prefix(1);
    if (c == '\n') ++number_;
    return c;
  }
  void skip(std::string_view characters) {
    while (!rest_.empty() && characters.find(rest_.front()) != std::string_view::npos) take();
  }
  void skip_comment() {
    if (peek() == '#') rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
  }
  /// Skips blanks, line ends and comments. Returns false at the end of the text.
  bool skip_to_content() {
    for (;;) {
      skip(" \t\r\n");
      if (peek() != '#') return !rest_.empty();
      skip_comment();
    }
  }

  std::string take_key() {
    if (peek() == '[') throw fail("begins a table; write options alone, as in size = \"800x600\"");
    const std::string_view line = rest_.substr(0, rest_.find('\n'));
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos)
      throw fail(fmt::format("{} has no value; write an option as in size = \"800x600\"", quote(word())));
    std::string_view key = line.substr(0, equals);
    rest_.remove_prefix(equals + 1);
    while (!key.empty() && blanks.find(key.back()) != std::string_view::npos) key.remove_suffix(1);
    if (key.empty() || !std::ranges::all_of(key, is_key_character))
      throw fail(fmt::format("{} is not an option; write one as in size = \"800x600\"", quote(key)));
    skip(blanks);
    return std::string(key);
  }

  void take_list(std::vector<std::string>& values) {
    const std::size_t begin = number_;
    take();
    for (;;) {
      if (!skip_to_content()) throw unclosed_list(begin);
      if (peek() == ']') break;
      if (peek() == '[') throw fail("has a list in a list; write one list of texts");
      values.push_back(take_value());
      if (!skip_to_content()) throw unclosed_list(begin);
      if (peek() == ',')
        take();
      else if (peek() != ']')
        throw fail(
            fmt::format("{} follows a value of a list; put a comma between values, or text in quotes", quote(word())));
    }
    take();
  }
  [[nodiscard]] Error unclosed_list(std::size_t begin) const {
    return bad_input(fmt::format("{}: line {}: the list is not closed; end it with ]", source_, begin));
  }

  std::string take_value() {
    if (rest_.starts_with("\"\"\"") || rest_.starts_with("'''"))
      throw fail("text over several lines is not supported; write \\n for a line break");
    if (peek() == '"' || peek() == '\'') return take_text();
    const std::string_view bare = rest_.substr(0, rest_.find_first_of(" \t\r\n,[]\"'#"));
    for (const char c : bare) check_character(c);
    if (bare.empty()) throw fail("a value is missing; put text in quotes");
    rest_.remove_prefix(bare.size());
    return std::string(bare);
  }

  std::string take_text() {
    const char quote = take();
    std::string text;
    for (;;) {
      if (rest_.empty() || peek() == '\n') throw fail(fmt::format("text is not closed; end it with {}", quote));
      const char c = take();
      if (c == quote) return text;
      check_character(c);
      if (c == '\\' && quote == '"')
        take_escape(text);
      else
        text += c;
    }
  }
  void check_character(char c) const {
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\r') || c == 0x7f)
      throw fail("has a control character; leave it out");
  }

  void take_escape(std::string& text) {
    constexpr std::string_view names = "btnfre\"\\";
    constexpr std::string_view meant = "\b\t\n\f\r\x1b\"\\";
    const char name = rest_.empty() ? '\0' : rest_.front();
    if (const std::size_t at = names.find(name); name != '\0' && at != std::string_view::npos) {
      text += meant[at];
      take();
      return;
    }
    const std::size_t digits = name == 'u' ? 4 : name == 'U' ? 8 : 0;
    std::uint32_t code = 0;
    const std::string_view hex = rest_.substr(std::min<std::size_t>(1, rest_.size()), digits);
    const auto [end, error] = std::from_chars(hex.data(), hex.data() + hex.size(), code, 16);
    const bool is_code = digits > 0 && hex.size() == digits && error == std::errc() && end == hex.data() + digits;
    if (!is_code || code == 0 || code > 0x10ffff || (code >= 0xd800 && code < 0xe000))
      throw fail("\\ begins no character in text in double quotes; write \\\\, or put the text in single quotes");
    append_utf8(text, code);
    rest_.remove_prefix(1 + digits);
  }

  std::string_view rest_;
  const std::string& source_;
  std::size_t number_ = 1;  ///< number of the current line
};

}  // namespace

std::vector<TomlLine> parse_toml(std::string_view text, const std::string& source) {
  return Parser(text, source).parse();
}

std::string toml_quoted(std::string_view value) {
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\')
      text += {'\\', c};
    else if (c == '\n')
      text += "\\n";
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      text += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      text += c;
  }
  return text + '"';
}

}  // namespace tessera::api
