// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/job.hpp"
#include "tessera/program/options.hpp"

namespace tessera::apps {

/// Implements `tessera serve INPUT`: shows images in a browser until SIGINT, SIGTERM or SIGHUP. While the user changes
/// the view or an option, the images are previews; the final images are exact. Prints the address to open. Collective.
/// Throws Error.
void serve(const OptionWords& words, Job& job);

}  // namespace tessera::apps
