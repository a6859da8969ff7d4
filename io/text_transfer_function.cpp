#include <fmt/format.h>

#include <array>

#include "io/text_file.hpp"
#include "io/transfer_function_checks.hpp"
#include "io/transfer_function_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {

LoadedTransferFunction parse_text_transfer_function(std::string_view text, const std::string& source,
                                                    const TransferFunctionOptions& options) {
  check(options);
  if (options.unit_distance)
    throw scene::bad_input(source +
                           ": gives extinctions, which need no unit distance; drop --unit-distance (to thicken or thin "
                           "the picture, scale the opacity)");
  constexpr std::array<const char*, 5> column{"value", "red", "green", "blue", "extinction"};
  std::vector<scene::Knot> knots;
  TextLines lines(text);
  for (TextLine line; lines.next(line);) {
    const auto fault = [&](const std::string& what) {
      return scene::bad_input(fmt::format("{}: line {}: {}", source, line.number, what));
    };
    std::array<double, 5> numbers{};
    for (std::size_t i = 0; i < line.words.size(); ++i) {
      const std::string_view word = line.words[i];
      if (word.find(',') != std::string_view::npos)
        throw fault(
            fmt::format("{} has a comma; separate numbers by blanks and write decimals with a point", quote(word)));
      const auto number = parse_number(word);
      if (!number)
        throw fault(fmt::format("{} is not a finite number; each line is `value r g b extinction`", quote(word)));
      if (i < numbers.size()) numbers[i] = *number;
    }
    if (line.words.size() != numbers.size())
      throw fault(fmt::format("{} number{} instead of 5; each line is `value r g b extinction`", line.words.size(),
                              line.words.size() == 1 ? "" : "s"));
    for (std::size_t i = 1; i < numbers.size(); ++i)
      if (numbers[i] < 0) throw fault(fmt::format("{} is {}; it must not be negative", column[i], line.words[i]));
    if (!knots.empty() && numbers[0] < knots.back().value)
      throw fault(fmt::format("value {} is below the one before it, {}; sort the lines by value", numbers[0],
                              knots.back().value));
    knots.push_back({numbers[0], {numbers[1], numbers[2], numbers[3]}, numbers[4] * options.opacity_scale});
  }
  if (knots.empty())
    throw scene::bad_input(source + ": holds no knot; give at least one line `value r g b extinction`");
  return {make_transfer_function(std::move(knots), source), source, std::nullopt, ""};
}

}  // namespace tessera::io
