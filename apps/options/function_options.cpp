// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/function_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>

#include "apps/options/argument_values.hpp"
#include "tessera/error.hpp"

namespace tessera::apps {

void add_function_options(CLI::App& command, FunctionWords& words) {
  command
      .add_option("--range", words.range,
                  "values that colours and opacities span (default: the field's of a preset, of what is not asked for "
                  "0.5 to 99.5 % of the volume; a file is stretched)")
      ->type_name("MIN,MAX");
  command.add_flag("--log", words.log, "colours and opacities by the logarithm of the value");
  command
      .add_option("--opacity-points", words.opacity_points,
                  "opacity per unit distance at fractions of the range, like 0:0,0.3:0.02,1:0.8")
      ->type_name("T:A,...");
}

void set_function(const FunctionWords& words, TransferFunctionOptions& options) {
  options.logarithmic = words.log;
  if (!words.range.empty()) {
    const auto ends = parse_numbers("--range", words.range, 2, "two numbers; write MIN,MAX");
    options.range = {{ends[0], ends[1]}};
    if (!((*options.range)[0] < (*options.range)[1]))
      throw bad_input(fmt::format("--range: '{}' is empty; write the smaller number first", words.range));
  }
  if (words.opacity_points.empty()) return;
  for (const std::string& point : split_at_commas(words.opacity_points)) {
    const std::size_t colon = point.find(':');
    if (colon == std::string::npos)
      throw bad_input(fmt::format("--opacity-points: '{}' is no point; write T:A, like 0.3:0.02", point));
    options.opacity_points.push_back({parse_number("--opacity-points", point.substr(0, colon)),
                                      parse_number("--opacity-points", point.substr(colon + 1))});
  }
  for (std::size_t i = 0; i < options.opacity_points.size(); ++i) {
    const auto [place, opacity] = options.opacity_points[i];
    if (!(place >= (i == 0 ? 0 : options.opacity_points[i - 1][0])) || !(place <= 1))
      throw bad_input(fmt::format("--opacity-points: {} is no fraction of the range; write 0 to 1, ascending", place));
    if (!(opacity >= 0) || !(opacity <= 1))
      throw bad_input(fmt::format("--opacity-points: the opacity {} is not 0 to 1", opacity));
  }
}

}  // namespace tessera::apps
