// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

/// Functions for ASCII text, independent of the locale. Bytes that are not ASCII are neither letters nor blanks, and
/// are not changed.
namespace tessera {
inline namespace v0_1 {

inline constexpr std::string_view ascii_blanks = " \t\r\n\v\f";
inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  ///< of UTF-8

constexpr bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
constexpr bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
constexpr bool is_letter(char c) { return is_upper(c) || is_lower(c); }

constexpr char upper_case(char c) { return is_lower(c) ? static_cast<char>(c - 'a' + 'A') : c; }
constexpr char lower_case(char c) { return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c; }

/// The value of a hexadecimal digit; -1 for other characters.
constexpr int hex_digit(char c) {
  if (is_digit(c)) return c - '0';
  const char letter = lower_case(c);
  return letter >= 'a' && letter <= 'f' ? letter - 'a' + 10 : -1;
}

inline std::string upper_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = upper_case(c);
  return result;
}

inline std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = lower_case(c);
  return result;
}

inline bool equals_ignoring_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) { return lower_case(x) == lower_case(y); });
}

/// `text` without `blanks` at either end.
constexpr std::string_view trimmed(std::string_view text, std::string_view blanks = ascii_blanks) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// Splits `text` into the words between `blanks`.
inline std::vector<std::string_view> split_words(std::string_view text, std::string_view blanks = ascii_blanks) {
  std::vector<std::string_view> words;
  while (!(text = trimmed(text, blanks)).empty()) {
    words.push_back(text.substr(0, text.find_first_of(blanks)));
    text.remove_prefix(words.back().size());
  }
  return words;
}

/// Converts the whole word to a number, in the C locale. A leading + is allowed. Returns none for any other word.
template <class T>
std::optional<T> number_of(std::string_view word) {
  if (word.starts_with('+') && !word.substr(1).starts_with('-')) word.remove_prefix(1);
  T number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size() ? std::optional(number) : std::nullopt;
}

/// `text` with `?` for each byte that is not a printable ASCII character.
inline std::string printable_ascii(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c < ' ' || c > '~') c = '?';
  return result;
}

/// Returns text from a file or a user for use in a message: quoted, on one line, with at most 40 characters, and with
/// `?` for unprintable bytes.
inline std::string quote(std::string_view text) {
  constexpr std::size_t most = 40;
  std::string quoted = "'";
  quoted += printable_ascii(text.substr(0, most));
  return quoted += text.size() > most ? "...'" : "'";
}

/// Escapes text for XML or HTML: for an attribute's value in double quotes, or between tags.
inline std::string xml_escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

}  // namespace v0_1
}  // namespace tessera
