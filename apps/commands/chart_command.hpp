// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/program/options.hpp"

namespace tessera::apps {

/// `tessera chart INPUT`: every method at several settings on the user's data and view, timed and judged against the
/// reference; a table on stdout, the fastest setting for 1e-2 to 1e-5, and on request JSON, CSV and figures.
///
/// Budget   `--budget-seconds` (60) counts from where the input has been read. At most a third goes into the reference,
///          which looks at as many random pixels as fit (`--pixels`: so many); the rest is shared by the methods. The
///          first is measured in any case, others if what is known of their family, or a rough guess, has room. Those
///          left over are named, with a guess of a budget for all.
/// Peers    `--peer FILE.json`: a list of {"family", "name", "frame_ms": [...], "picture": FILE.pfm} of other programs,
///          judged on the same pixels by colour alone, as their pictures carry no opacity.
/// Throws Error.
void chart(const OptionWords& words);

}  // namespace tessera::apps
