// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "tessera/job.hpp"
#include "tessera/program/options.hpp"

namespace tessera::apps {

/// Reads the options --stall-timeout and --on-stall. Returns none if ranks are not watched. Stalls are reported on
/// stderr, in one line each, unless `quiet`. Throws Error(bad_input).
std::optional<StallSettings> stall_settings(const OptionWords& words, bool quiet);

}  // namespace tessera::apps
