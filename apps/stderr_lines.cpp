// SPDX-License-Identifier: BSD-3-Clause
#include "apps/stderr_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "apps/standard_streams.hpp"
#include "tessera/program/printable.hpp"

namespace tessera::apps {
namespace {

constexpr std::string_view indent = "  ";

/// Number of columns of a text. Continuation bytes of UTF-8 do not take a column.
std::size_t columns(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// Fills lines with one piece after another.
class Lines {
 public:
  /// Puts the piece on the current line after `joint`, or on a new line. Returns false if it does not fit on either.
  bool put(std::string_view piece, std::string_view joint) {
    const std::string_view between = is_fresh_ ? "" : joint;
    if (columns(line_) + columns(between) + columns(piece) > most_columns) {
      if (indent.size() + columns(piece) > most_columns) return false;
      end_line();
      return put(piece, joint);
    }
    line_ += between;
    line_ += piece;
    is_fresh_ = false;
    return true;
  }
  /// Adds the word, which is cut at the ends of lines.
  void cut(std::string_view word, std::string_view joint) {
    if (!is_fresh_) line_ += columns(line_) + columns(joint) < most_columns ? joint : "";
    for (std::size_t at = 0; at < word.size(); ++at) {
      const bool begins = (static_cast<unsigned char>(word[at]) & 0xc0) != 0x80;
      if (begins && columns(line_) >= most_columns) end_line();
      line_ += word[at];
    }
    is_fresh_ = false;
  }
  std::string all() && { return std::move(done_) + line_; }

 private:
  void end_line() {
    done_ += line_ + "\n";
    line_ = indent;
    is_fresh_ = true;
  }

  std::string done_, line_;
  bool is_fresh_ = true;
};

std::vector<std::string_view> split(std::string_view text, std::string_view mark) {
  std::vector<std::string_view> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(mark, at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + mark.size();
  }
  return parts;
}

}  // namespace

std::string in_lines(std::string_view statement) {
  Lines lines;
  for (const std::string_view part : split(statement, "; ")) {
    if (lines.put(part, "; ")) continue;
    std::string_view joint = "; ";
    for (const std::string_view word : split(part, " ")) {
      if (!lines.put(word, joint)) lines.cut(word, joint);
      joint = " ";
    }
  }
  return std::move(lines).all();
}

void print_lines(std::string_view statement) {
  fmt::print(stderr, "{}\n", in_lines(printable(with_stream_names(std::string(statement)))));
}

std::string time_words(double milliseconds) {
  if (milliseconds >= 1000) return fmt::format("{:.3g} s", milliseconds / 1000);
  return milliseconds < 100 ? fmt::format("{:.3g} ms", milliseconds) : fmt::format("{:.0f} ms", milliseconds);
}

int digits_for(double size, double extent) {
  constexpr int least = 6, most = 17;
  if (!(extent > 0) || !(size > extent)) return least;
  return std::clamp(static_cast<int>(std::ceil(std::log10(size / extent))) + 4, least, most);
}

std::string range_words(double low, double high) {
  const int digits = digits_for(std::max(std::abs(low), std::abs(high)), high - low);
  return fmt::format("{:.{}g} to {:.{}g}", low, digits, high, digits);
}

}  // namespace tessera::apps
