// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/program/options.hpp"

namespace tessera::apps {

/// Implements `tessera chart INPUT`: renders the user's data and view with every method at several settings, measures
/// the times, and compares the images with the reference. Prints a table on stdout and the fastest settings for errors
/// from 1e-2 to 1e-5. Writes JSON, CSV and figures on request.
///
/// Budget   The time of `--budget-seconds` (60) begins when the input has been read. At most a third of it is used for
///          the reference, which computes as many random pixels as this time allows (or exactly `--pixels`). The
///          methods share the remaining time. The first method is always measured. Another method is measured if its
///          time, estimated from methods of its family or by a rough guess, is within the budget. The methods that were
///          not measured are listed, with an estimate of a budget for all methods.
/// Peers    `--peer FILE.json` adds results of other programs: a list of {"family", "name", "frame_ms": [...],
///          "picture": FILE.pfm}. They are compared on the same pixels, by colour alone, because their images do not
///          contain opacity.
///
/// Throws Error.
void chart(const OptionWords& words);

}  // namespace tessera::apps
