// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/plot3d_text.hpp"

#include <fmt/format.h>

#include <vector>

#include "io/text/scanner.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

TextScanner words_of(std::string_view text, const std::string& source) { return {text, source, " \t\r\n"}; }

[[noreturn]] void refuse(const TextScanner& words, std::string_view word, const char* what) {
  words.fail(fmt::format("{} {}", quote(word), what));
}

/// Counts the numbers of a text.
std::uint64_t count_numbers(std::string_view text, const std::string& source) {
  TextScanner words = words_of(text, source);
  std::uint64_t count = 0;
  double value = 0;
  for (Scanned found = words.number(value); found != Scanned::nothing; found = words.number(value), ++count) {
    if (found != Scanned::other_word) continue;
    const std::string_view word = words.word();
    const std::size_t exponent = word.find_first_of("dD");
    if (word.find('*') != std::string_view::npos)
      refuse(words, word, "is a repetition of a number, which VTK's reader does not support; write each number");
    if (exponent != std::string_view::npos && number_of<double>(word.substr(0, exponent)))
      refuse(words, word, "has an exponent that VTK's reader does not support; write it with E");
    refuse(words, word, "is not a number; a PLOT3D text file contains only numbers");
  }
  return count;
}

/// Parses the dimensions of the grids at the beginning of a file. No value if they are missing or the grids have more
/// than `most` points in total.
std::optional<std::vector<std::array<std::int32_t, 3>>> grids_of(TextScanner& words, bool multi_grid,
                                                                 std::uint64_t most) {
  std::int32_t count = 1;
  if (multi_grid) count = number_of<std::int32_t>(words.word()).value_or(0);
  if (count < 1 || static_cast<std::uint64_t>(count) > most) return std::nullopt;
  std::vector<std::array<std::int32_t, 3>> grids(static_cast<std::size_t>(count));
  std::uint64_t points_in_all = 0;
  for (auto& grid : grids) {
    std::uint64_t points = 1;
    for (std::int32_t& n : grid) {
      n = number_of<std::int32_t>(words.word()).value_or(0);
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

/// IBLANK must be integers, because the reader would stop inside other numbers.
void require_whole_iblank(std::string_view text, const Plot3dLayout& layout, const std::string& source) {
  TextScanner words = words_of(text, source);
  for (std::uint64_t k = header_numbers(layout); k > 0; --k) words.word();
  for (const auto& grid : layout.grids) {
    const std::uint64_t points = points_of(grid);
    for (std::uint64_t k = 0; k < 4 * points; ++k)
      if (const std::string_view word = words.word(); k >= 3 * points && !number_of<std::int32_t>(word))
        refuse(words, word, "is an IBLANK value, but not a whole number; correct it");
  }
}

}  // namespace

std::optional<Plot3dLayout> plot3d_text_layout(std::string_view text, const std::string& source) {
  const std::uint64_t numbers = count_numbers(text, source);
  for (const bool multi_grid : {false, true}) {
    TextScanner words = words_of(text, source);
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
  TextScanner words = words_of(text, source);
  if (grids_of(words, layout.multi_grid, numbers) != layout.grids)
    throw scene::bad_input(
        fmt::format("{}: its dimensions differ from those of the grid file; give the solution for this grid", source));
  std::uint64_t needed = header_numbers(layout);
  for (const auto& grid : layout.grids) needed += 4 + 5 * points_of(grid);
  if (numbers < needed)
    throw scene::bad_input(
        fmt::format("{}: it has only {} of the {} numbers of a PLOT3D solution; it is truncated or of another kind "
                    "(function file, OVERFLOW)",
                    source, numbers, needed));
  return numbers - needed;
}

}  // namespace tessera::io
