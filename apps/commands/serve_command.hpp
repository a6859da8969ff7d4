// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/job.hpp"
#include "tessera/program/options.hpp"

namespace tessera::apps {

/// `tessera serve INPUT`: shows images in a browser, exact ones and previews during changes, until SIGINT, SIGTERM or
/// SIGHUP. Prints the address to open. Collective. Throws Error.
void serve(const OptionWords& words, Job& job);

}  // namespace tessera::apps
