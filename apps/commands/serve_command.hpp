// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/job.hpp"
#include "tessera/program/options.hpp"

namespace tessera::apps {

/// `tessera serve INPUT`: pictures in a browser, exact and as they change, until SIGINT, SIGTERM or SIGHUP comes.
/// Prints the address to open. Collective. Throws Error.
void serve(const OptionWords& words, Job& job);

}  // namespace tessera::apps
