// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "analysis/timing_breakdown.hpp"

/// The breakdown as text, printed by `tessera timing`, and as CSV.
namespace tessera::analysis {

/// One run: a table of stages for each role (average and worst process, share, CPU time; all per frame), time outside
/// the frames, exchange (moving and waiting separately), and its overlap with projection.
std::string breakdown_text(const RunTime& run);

/// Table 1 of the paper: one line per run.
std::string scaling_text(std::span<const RunTime> runs);

/// An explanation of how the numbers are counted, for the end of the output.
std::string reading_text();

/// One line for each run, role and stage, with the run's values repeated. Milliseconds are per frame, except those of
/// `part` `once`, the time outside the frames, which are for the run. Cells without a value are empty.
std::string breakdown_csv(std::span<const RunTime> runs);

/// `4 + 2` (separate projectors and compositors), `4 shared`, `1 process`.
std::string process_words(const RunTime& run);

}  // namespace tessera::analysis
