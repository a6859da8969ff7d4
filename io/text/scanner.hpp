// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "tessera/program/text.hpp"

namespace tessera::io {

/// Returns the number, from 1, of the line that contains the byte `at` of a text.
std::size_t line_number(std::string_view text, std::size_t at);

/// Throws Error(bad_input, "SOURCE: line N: WHAT") for the line that contains the byte `at` of a text. Bytes of `what`
/// that are not printable are shown as '?'.
[[noreturn]] void fail_at(std::string_view text, std::size_t at, const std::string& source, const std::string& what);

/// Result of TextScanner::number().
enum class Scanned : std::uint8_t { number, nothing, other_word, out_of_range };

/// Reads words and numbers that the characters `blanks` separate. Reads either line by line, with next_line(), or
/// through the whole text; in the second case, `blanks` must contain the line ends if these separate words. The
/// character `comment` begins a comment, which is skipped; 0: there are no comments. A UTF-8 byte order mark at the
/// beginning is skipped. Text and source must outlive the scanner and the words that it returns.
class TextScanner {
 public:
  TextScanner(std::string_view text, const std::string& source, std::string_view blanks = ascii_blanks,
              char comment = '\0')
      : text_(text), source_(source), end_(text.size()), comment_(comment) {
    for (const char c : blanks) is_blank_[static_cast<unsigned char>(c)] = true;
    if (text.starts_with(byte_order_mark)) at_ = next_line_ = byte_order_mark.size();
  }

  /// Moves to the next line that contains more than blanks and a comment; words and numbers are then read only from
  /// that line. Returns false at the end of the text.
  bool next_line() {
    while (next_line_ < text_.size()) {
      at_ = next_line_;
      const std::string_view line = text_.substr(at_, text_.find('\n', at_) - at_);
      next_line_ = std::min(at_ + line.size() + 1, text_.size());
      end_ = at_ + (comment_ == '\0' ? line.size() : std::min(line.find(comment_), line.size()));
      if (!at_end()) return true;
    }
    return false;
  }

  /// Skips blanks and comments. Returns true if nothing else follows in the line or text.
  bool at_end() {
    for (; at_ < end_; ++at_) {
      if (is_blank(text_[at_])) continue;
      if (is_in_word(text_[at_])) return false;
      at_ = std::min(text_.find('\n', at_), end_) - 1;
    }
    return true;
  }

  /// Returns the next word; empty at the end.
  std::string_view word() {
    if (at_end()) return {};
    const std::size_t first = at_;
    while (at_ < end_ && is_in_word(text_[at_])) ++at_;
    return text_.substr(first, at_ - first);
  }

  /// Reads the next word if it is a number; a leading + is allowed. A number outside the range of a floating-point type
  /// becomes NaN.
  template <class T>
  Scanned number(T& value) {
    if (at_end()) return Scanned::nothing;
    const char* const all_end = text_.data() + end_;
    const auto [end, error] = std::from_chars(text_.data() + at_ + (text_[at_] == '+' ? 1 : 0), all_end, value);
    if (error == std::errc::invalid_argument || (end != all_end && is_in_word(*end))) return Scanned::other_word;
    at_ = static_cast<std::size_t>(end - text_.data());
    if (error == std::errc()) return Scanned::number;
    if constexpr (std::is_floating_point_v<T>) value = std::numeric_limits<T>::quiet_NaN();
    return Scanned::out_of_range;
  }

  /// Returns the rest of the current line and moves to the next line. For texts that are not read line by line with
  /// next_line().
  std::string_view rest_of_line() {
    const std::size_t first = at_, end = std::min(text_.find('\n', at_), end_);
    at_ = std::min(end + 1, end_);
    return text_.substr(first, end - first);
  }

  /// Returns the text before `mark` on this line, without surrounding blanks, and skips it and the mark. Empty if the
  /// line does not contain the mark.
  std::string_view word_before(char mark) {
    const std::string_view rest = line();
    const std::size_t found = rest.find(mark);
    if (found == std::string_view::npos) return {};
    at_ += found + 1;
    return trimmed(rest.substr(0, found));
  }

  [[nodiscard]] std::size_t at() const { return at_; }
  void go_to(std::size_t at) { at_ = at; }
  /// The unread rest of the line that next_line() selected, or of the text.
  [[nodiscard]] std::string_view line() const { return text_.substr(at_, end_ - at_); }
  /// Everything that follows, including the following lines.
  [[nodiscard]] std::string_view rest() const { return text_.substr(at_); }

  /// Calls io::fail_at() for the current position, or for `at`.
  [[noreturn]] void fail(const std::string& what) const { fail_at(at_, what); }
  [[noreturn]] void fail_at(std::size_t at, const std::string& what) const { io::fail_at(text_, at, source_, what); }
  [[nodiscard]] std::size_t line_number() const { return io::line_number(text_, at_); }

 private:
  [[nodiscard]] bool is_blank(char c) const { return is_blank_[static_cast<unsigned char>(c)]; }
  [[nodiscard]] bool is_in_word(char c) const { return !is_blank(c) && (c != comment_ || c == '\0'); }

  std::string_view text_;
  const std::string& source_;
  std::size_t at_ = 0, end_, next_line_ = 0;
  char comment_;
  std::array<bool, 256> is_blank_{};
};

}  // namespace tessera::io
