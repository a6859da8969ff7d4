// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "analysis/canvas.hpp"
#include "analysis/timing_breakdown.hpp"

/// Figure 9 of the paper: the breakdown as stacked bars, one bar per run, one panel per role.
namespace tessera::analysis {

/// Bars show the average time per frame; the tick next to a bar is the worst process's whole. Colours are those of
/// Okabe, Ito, "Color Universal Design", 2008, which colour-blind readers can distinguish; white lines separate the
/// parts of a bar. The file appears by rename. Throws as check_figure_path, as AtomicFile, or Error(system_failure) if
/// Cairo fails.
void write_figure(std::span<const RunTime> runs, const std::filesystem::path& file);

}  // namespace tessera::analysis
