// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/plot3d_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>
#include <vector>

#include "scene/error.hpp"
#include "scene/quote.hpp"

namespace tessera::io {
namespace {

/// Walks through the words of a text.
class Words {
 public:
  Words(std::string_view text, const std::string& source) : rest_(text), source_(source) {}

  /// The next word; empty at the end.
  std::string_view next() {
    const std::size_t first = std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size());
    line_ +=
        static_cast<std::size_t>(std::count(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(first), '\n'));
    rest_.remove_prefix(first);
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\n"));
    rest_.remove_prefix(word.size());
    return word;
  }

  void require_number(std::string_view word) const {
    if (word.front() == '+') word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc::invalid_argument && end == word.data() + word.size()) return;
    if (word.find('*') != std::string_view::npos)
      fail(word, "is a repeated number, which VTK's reader does not know; write each");
    if (end != word.data() + word.size() && (*end == 'd' || *end == 'D'))
      fail(word, "has an exponent that VTK's reader does not know; write it with E");
    fail(word, "is no number; PLOT3D in text is numbers alone");
  }

  [[nodiscard]] static std::optional<std::int32_t> whole(std::string_view word) {
    std::int32_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
  }

  [[noreturn]] void fail(std::string_view word, const char* what) const {
    throw scene::bad_input(fmt::format("{}: line {}: {} {}", source_, line_, scene::quote(word), what));
  }

 private:
  std::string_view rest_;
  const std::string& source_;
  std::size_t line_ = 1;
};

/// How many numbers there are.
std::uint64_t count_numbers(std::string_view text, const std::string& source) {
  Words words(text, source);
  std::uint64_t count = 0;
  for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++count) words.require_number(word);
  return count;
}

/// The grids that a file begins with, of at most `most` points in all; none if it does not.
std::optional<std::vector<std::array<std::int32_t, 3>>> grids_of(Words& words, bool multi_grid, std::uint64_t most) {
  std::int32_t count = 1;
  if (multi_grid) count = Words::whole(words.next()).value_or(0);
  if (count < 1 || static_cast<std::uint64_t>(count) > most) return std::nullopt;
  std::vector<std::array<std::int32_t, 3>> grids(static_cast<std::size_t>(count));
  std::uint64_t points_in_all = 0;
  for (auto& grid : grids) {
    std::uint64_t points = 1;
    for (std::int32_t& n : grid) {
      n = Words::whole(words.next()).value_or(0);
      if (n < 1) return std::nullopt;
      points *= static_cast<std::uint64_t>(n);
      if (points > most) return std::nullopt;
    }
    points_in_all += points;
    if (points_in_all > most) return std::nullopt;
  }
  return grids;
}

std::uint64_t points_of(const std::array<std::int32_t, 3>& n) {
  return static_cast<std::uint64_t>(n[0]) * static_cast<std::uint64_t>(n[1]) * static_cast<std::uint64_t>(n[2]);
}

std::uint64_t header_numbers(const Plot3dLayout& layout) {
  return (layout.multi_grid ? 1 : 0) + 3 * std::uint64_t{layout.grids.size()};
}

/// IBLANK has to be whole numbers: the reader would stop within others.
void require_whole_iblank(std::string_view text, const Plot3dLayout& layout, const std::string& source) {
  Words words(text, source);
  for (std::uint64_t k = header_numbers(layout); k > 0; --k) words.next();
  for (const auto& grid : layout.grids) {
    const std::uint64_t points = points_of(grid);
    for (std::uint64_t k = 0; k < 4 * points; ++k)
      if (const std::string_view word = words.next(); k >= 3 * points && !Words::whole(word))
        words.fail(word, "stands for IBLANK and is no whole number; mend it");
  }
}

}  // namespace

std::optional<Plot3dLayout> plot3d_text_layout(std::string_view text, const std::string& source) {
  const std::uint64_t numbers = count_numbers(text, source);
  for (const bool multi_grid : {false, true}) {
    Words words(text, source);
    const auto grids = grids_of(words, multi_grid, numbers);
    if (!grids) continue;
    Plot3dLayout layout;
    layout.is_text = true;
    layout.multi_grid = multi_grid;
    layout.double_precision = true;
    layout.grids = *grids;
    std::uint64_t points = 0;
    for (const auto& grid : layout.grids) points += points_of(grid);
    for (const std::uint64_t each : {3, 4}) {
      if (numbers != header_numbers(layout) + each * points) continue;
      layout.iblank = each == 4;
      if (layout.iblank) require_whole_iblank(text, layout, source);
      return layout;
    }
  }
  return std::nullopt;
}

std::uint64_t check_plot3d_text_solution(std::string_view text, const Plot3dLayout& layout, const std::string& source) {
  const std::uint64_t numbers = count_numbers(text, source);
  Words words(text, source);
  if (grids_of(words, layout.multi_grid, numbers) != layout.grids)
    throw scene::bad_input(
        fmt::format("{}: its dimensions are not those of the grid file; give the solution of this grid", source));
  std::uint64_t needed = header_numbers(layout);
  for (const auto& grid : layout.grids) needed += 4 + 5 * points_of(grid);
  if (numbers < needed)
    throw scene::bad_input(fmt::format(
        "{}: it has {} of the {} numbers of a PLOT3D solution; it is truncated or of another kind (function, OVERFLOW)",
        source, numbers, needed));
  return numbers - needed;
}

}  // namespace tessera::io
