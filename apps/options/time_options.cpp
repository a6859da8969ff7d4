// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/time_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <limits>

#include "apps/options/argument_values.hpp"
#include "tessera/error.hpp"

namespace tessera::apps {
namespace {

std::size_t step_number(const std::string& word, int low = 0) {
  return static_cast<std::size_t>(parse_count("--time-step", word, low, std::numeric_limits<int>::max()));
}

}  // namespace

void add_time_options(CLI::App& command, std::string& time_step) {
  command
      .add_option("--time-step", time_step,
                  "Exodus, OpenFOAM, 4-D NIfTI, NRRD, .pvd ...: step counted from 0 (default: a file's last); of "
                  "render also a film of several")
      ->type_name("STEP|all|FIRST:LAST[:STRIDE]");
}

std::optional<std::size_t> one_time_step(const std::string& word) {
  if (word.empty() || time_steps(word)) return std::nullopt;
  return step_number(word);
}

void refuse_time_steps(const std::string& word) {
  if (time_steps(word))
    throw bad_input(fmt::format("--time-step: '{}' is a film, which only render makes; give one step", word));
}

std::optional<StepRange> time_steps(const std::string& word) {
  if (word == "all") return StepRange{};
  const std::size_t colon = word.find(':');
  if (colon == std::string::npos) return std::nullopt;
  StepRange range;
  range.first = step_number(word.substr(0, colon));
  const std::size_t second = word.find(':', colon + 1);
  range.last = step_number(word.substr(colon + 1, second == std::string::npos ? second : second - colon - 1));
  if (second != std::string::npos) range.stride = step_number(word.substr(second + 1), 1);
  if (*range.last < range.first)
    throw bad_input(fmt::format("--time-step: '{}' ends before it begins; give the smaller step first", word));
  return range;
}

}  // namespace tessera::apps
