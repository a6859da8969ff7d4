// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "apps/options/cli_fwd.hpp"
#include "tessera/job.hpp"

namespace tessera::apps {

/// --stall-timeout and --on-stall as they stand on the command line.
struct StallWords {
  std::string timeout, on_stall = "wait";
};

/// Declares them on `tessera render`.
void add_stall_options(CLI::App& command, StallWords& words);

/// What they say; nothing if no rank is to be looked after. Notices go to stderr, one line each, unless `quiet`. Throws
/// Error(bad_input).
std::optional<StallSettings> stall_settings(const StallWords& words, bool quiet);

}  // namespace tessera::apps
