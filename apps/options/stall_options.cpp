// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/stall_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "apps/options/argument_values.hpp"
#include "apps/options/compositing_options.hpp"
#include "apps/options/setting_words.hpp"
#include "tessera/error.hpp"

namespace tessera::apps {

void add_stall_options(CLI::App& command, StallWords& words) {
  command
      .add_option(
          "--stall-timeout", words.timeout,
          "under mpirun: a rank that has been silent for so long is said to be stopped; 0: never (default: 120)")
      ->type_name("SECONDS");
  command.add_option("--on-stall", words.on_stall, "under mpirun: wait for such a rank (default), or end the run")
      ->type_name("wait|abort");
}

std::optional<StallSettings> stall_settings(const StallWords& words, bool quiet) {
  check_word("--on-stall", words.on_stall, {"wait", "abort"});
  StallSettings settings;
  settings.ends_run = words.on_stall == "abort";
  if (words.timeout == "0") {
    if (settings.ends_run)
      throw bad_input("--on-stall abort: --stall-timeout 0 looks for no stall; leave one of the two out");
    return std::nullopt;
  }
  if (!words.timeout.empty()) {
    const double seconds = parse_positive("--stall-timeout", words.timeout);
    constexpr double least = 0.2, most = 1e6;
    if (seconds < least || seconds > most)
      throw bad_input(fmt::format("--stall-timeout: '{}' is not 0 or {} to {:.0f} seconds; give one of these",
                                  words.timeout, least, most));
    settings.timeout = std::chrono::milliseconds(static_cast<std::int64_t>(1000 * seconds));
  }
  if (!quiet)
    settings.say = [](const std::string& notice) {
      fmt::print(stderr, "{}\n", with_options(notice));
      std::fflush(stderr);
    };
  return settings;
}

}  // namespace tessera::apps
