// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/film_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/options/argument_values.hpp"
#include "apps/standard_streams.hpp"
#include "tessera/error.hpp"
#include "tessera/film_file.hpp"

namespace tessera::apps {

void add_film_options(CLI::App& command, RenderWords& words) {
  command.add_option("--frame-rate", words.frame_rate, "films: frames a second (default 25)")->type_name("FPS");
}

void set_outputs(const RenderWords& words, RenderOptions& options) {
  for (const std::string& output : words.outputs) {
    if (output == standard_stream) {
      if (options.to_standard_output) throw bad_input("-o -: is given twice; give it once");
      options.to_standard_output = true;
    } else if (is_film_name(output)) {
      options.films.emplace_back(output);
    } else {
      options.plan.outputs.emplace_back(output);
    }
  }
  if (options.to_standard_output) require_no_terminal("-o");
  if (words.report == standard_stream) {
    if (options.to_standard_output)
      throw bad_input("--report -: the picture goes to standard output too; give one of them a file");
    options.report_to_standard_output = true;
  }
  if (words.resume && options.to_standard_output)
    throw bad_input("--resume: standard output has no earlier pictures; leave it out, or write numbered pictures");
  if (words.resume && !options.films.empty())
    throw bad_input(fmt::format("--resume: {} is made as a whole; leave it out, or write numbered pictures",
                                options.films.front().string()));
  if (!words.frame_rate.empty()) {
    if (options.films.empty())
      throw bad_input("--frame-rate: is for films; name one with -o FILE.mp4, or leave it out");
    options.frame_rate = parse_positive("--frame-rate", words.frame_rate);
    if (options.frame_rate > most_film_rate)
      throw bad_input(fmt::format("--frame-rate: {} is above {}; give fewer", words.frame_rate, most_film_rate));
    if (options.frame_rate < least_film_rate)
      throw bad_input(fmt::format("--frame-rate: {} is below {}; give more", words.frame_rate, least_film_rate));
  }
}

}  // namespace tessera::apps
