// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "analysis/timing_breakdown.hpp"

/// The breakdown as text, printed by `tessera timing`, and as CSV.
namespace tessera::analysis {

/// Returns the text for one run: a table of stages for each role (average and worst process, share, CPU time; all per
/// frame), the time outside the frames, the time of exchange (moving data and waiting separately), and the overlap of
/// exchange with projection.
std::string breakdown_text(const RunTime& run);

/// Table 1 of the paper: one line per run.
std::string scaling_text(std::span<const RunTime> runs);

/// An explanation of how the numbers are counted, for the end of the output.
std::string reading_text();

/// Returns CSV with a line for each run, role and stage, in which the run's values are repeated. Milliseconds are per
/// frame, except in lines whose `part` is `once`: these contain the time outside the frames, for the whole run. Cells
/// without a value are empty.
std::string breakdown_csv(std::span<const RunTime> runs);

/// The processes of a run: `4 + 2` (separate projectors and compositors), `4 shared` or `1 process`.
std::string process_words(const RunTime& run);

}  // namespace tessera::analysis
