// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tessera/program/options.hpp"

namespace tessera::apps {

/// `tessera chart INPUT`: renders the user's data and view with every method at several settings, measures times, and
/// compares the images with the reference. Prints a table on stdout and the fastest setting for 1e-2 to 1e-5; writes
/// JSON, CSV and figures on request.
///
/// Budget   `--budget-seconds` (60) counts from when the input has been read. At most a third is for the reference,
///          which computes as many random pixels as fit (or exactly `--pixels`); the methods share the rest. The first
///          method is always measured, others if the estimate from their family, or a rough guess, fits. The remaining
///          ones are listed, with an estimate of a budget for all.
/// Peers    `--peer FILE.json`: a list of {"family", "name", "frame_ms": [...], "picture": FILE.pfm} of other programs,
///          compared on the same pixels by colour alone, as their images contain no opacity.
///
/// Throws Error.
void chart(const OptionWords& words);

}  // namespace tessera::apps
