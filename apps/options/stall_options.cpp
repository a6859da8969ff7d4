// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/stall_options.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "tessera/error.hpp"

namespace tessera::apps {

std::optional<StallSettings> stall_settings(const OptionWords& words, bool quiet) {
  StallSettings settings;
  assign(settings.ends_run, words.choice("on-stall", {false, true}));
  const std::string& timeout = words.word("stall-timeout");
  if (timeout == "0") {
    if (settings.ends_run)
      throw bad_input("--on-stall abort: --stall-timeout 0 never reports a stall; leave one of the two out");
    return std::nullopt;
  }
  if (const auto seconds = words.positive("stall-timeout")) {
    constexpr double least = 0.2, most = 1e6;
    if (*seconds < least || *seconds > most)
      throw bad_input(fmt::format("--stall-timeout: '{}' is not 0 or {} to {:.0f} seconds; give one of these", timeout,
                                  least, most));
    settings.timeout = std::chrono::milliseconds(static_cast<std::int64_t>(1000 * *seconds));
  }
  if (!quiet)
    settings.report = [](const std::string& notice) {
      fmt::print(stderr, "{}\n", with_options(notice));
      std::fflush(stderr);
    };
  return settings;
}

}  // namespace tessera::apps
