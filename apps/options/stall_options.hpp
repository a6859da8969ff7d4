// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "tessera/job.hpp"
#include "tessera/program/options.hpp"

namespace tessera::apps {

/// --stall-timeout and --on-stall; none if ranks are not to be watched. Notices go to stderr, one line each, unless
/// `quiet`. Throws Error(bad_input).
std::optional<StallSettings> stall_settings(const OptionWords& words, bool quiet);

}  // namespace tessera::apps
