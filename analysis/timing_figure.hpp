// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "analysis/canvas.hpp"
#include "analysis/timing_breakdown.hpp"

/// Figure 9 of the paper: the breakdown as stacked bars, one bar per run, one panel per role.
namespace tessera::analysis {

/// Writes the figure. Bars show the average time per frame; the tick next to a bar shows the whole of the worst
/// process. Colours are those of Okabe, Ito, "Color Universal Design", 2008, which colour-blind readers can
/// distinguish; white lines separate the parts of a bar. The file appears by rename. Throws the errors of
/// check_figure_path() and of AtomicFile, and Error(system_failure) if Cairo fails.
void write_figure(std::span<const RunTime> runs, const std::filesystem::path& file);

}  // namespace tessera::analysis
