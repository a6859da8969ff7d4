// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "analysis/timing_breakdown.hpp"

/// The breakdown in words: what `tessera timing` prints, and the same as CSV.
namespace tessera::analysis {

/// One run: a table of stages for each role (average and worst process, share, CPU time; a frame each), what lay
/// outside of the frames, exchange (moving apart from waiting), and how far it overlaps.
std::string breakdown_text(const RunTime& run);

/// Table 1 of the paper: one line a run.
std::string scaling_text(std::span<const RunTime> runs);

/// How the figures are counted, for the end of the page.
std::string reading_text();

/// One line for each run, role and stage, with the run's figures repeated; milliseconds are of a frame, but for `part`
/// `once`, which is what lay outside of the frames, of the run. A cell without a value is empty.
std::string breakdown_csv(std::span<const RunTime> runs);

/// `4 + 2` (projectors and compositors apart), `4 shared`, `1 process`.
std::string process_words(const RunTime& run);

}  // namespace tessera::analysis
