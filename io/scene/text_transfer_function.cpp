// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "colormaps/function_options.hpp"
#include "io/scene/knot_list.hpp"
#include "io/scene/transfer_function_file.hpp"
#include "io/text/scanner.hpp"
#include "io/text/text_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {

namespace {

/// Maps sorted knots to the range `to` of the field. A constant field gets the colour and extinction of the knot
/// nearest to the middle of the knots' range. Returns a remark.
std::string rescale(std::vector<scene::Knot>& knots, const std::array<double, 2>& to) {
  const double low = knots.front().value, high = knots.back().value;
  if (to[0] == to[1]) {
    const double middle = 0.5 * low + 0.5 * high;
    knots = {*std::ranges::min_element(knots, {}, [&](const scene::Knot& k) { return std::abs(k.value - middle); })};
    knots.front().value = to[0];
  } else if (low < high) {
    for (scene::Knot& k : knots) k.value = std::lerp(to[0], to[1], (k.value - low) / (high - low));
  }
  return fmt::format(" (rescaled to {:.6g} to {:.6g})", to[0], to[1]);
}

}  // namespace

colormaps::LoadedTransferFunction loaded_knots(std::vector<scene::Knot> knots, const std::string& source,
                                               const colormaps::TransferFunctionOptions& options) {
  for (scene::Knot& knot : knots) knot.extinction *= options.opacity_scale;
  std::string name = source;
  if (options.unit_distance) name += " (extinctions as given; `unit_distance` does not apply)";
  if (!options.opacity_points.empty())
    throw scene::bad_input(source +
                           ": contains extinctions, which `opacity_points` cannot replace; leave `opacity_points` out");
  if (options.rescale || options.range) name += rescale(knots, options.spanned());
  return {colormaps::make_transfer_function(std::move(knots), source), name, std::nullopt, ""};
}

colormaps::LoadedTransferFunction parse_text_transfer_function(std::string_view text, const std::string& source,
                                                               const colormaps::TransferFunctionOptions& options) {
  colormaps::check(options);
  constexpr std::array<const char*, 5> column{"value", "red", "green", "blue", "extinction"};
  std::vector<scene::Knot> knots;
  TextScanner lines(text, source, ascii_blanks, '#');
  while (lines.next_line()) {
    const std::vector<std::string_view> words = split_words(lines.line());
    std::array<double, 5> numbers{};
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::string_view word = words[i];
      if (word.find(',') != std::string_view::npos)
        lines.fail(
            fmt::format("{} has a comma; separate numbers with spaces and write decimals with a point", quote(word)));
      const auto number = parse_number(word);
      if (!number)
        lines.fail(fmt::format("{} is not a finite number; each line is `value r g b extinction`", quote(word)));
      if (i < numbers.size()) numbers[i] = *number;
    }
    if (words.size() != numbers.size())
      lines.fail(fmt::format("{} number{} instead of 5; each line is `value r g b extinction`", words.size(),
                             words.size() == 1 ? "" : "s"));
    for (std::size_t i = 1; i < numbers.size(); ++i)
      if (numbers[i] < 0) lines.fail(fmt::format("{} is {}; it must not be negative", column[i], words[i]));
    if (!knots.empty() && numbers[0] < knots.back().value)
      lines.fail(fmt::format("value {} is below the one before it, {}; sort the lines by value", numbers[0],
                             knots.back().value));
    knots.push_back({numbers[0], {numbers[1], numbers[2], numbers[3]}, numbers[4]});
  }
  if (knots.empty()) throw scene::bad_input(source + ": has no knots; give at least one line `value r g b extinction`");
  return loaded_knots(std::move(knots), source, options);
}

}  // namespace tessera::io
