// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "analysis/canvas.hpp"
#include "analysis/timing_breakdown.hpp"

/// Figure 9 of the paper: the breakdown as stacked bars, one bar a run, one panel a role.
namespace tessera::analysis {

/// Bars are average time a frame; the tick beside a bar is the worst process's whole. Colours are of Okabe, Ito, "Color
/// Universal Design", 2008, so that colour-blind readers can tell them apart, and adjoining bars are parted by white.
/// The file appears by rename. Throws as check_figure_path, as AtomicFile, or Error(system_failure) if Cairo fails.
void write_figure(std::span<const RunTime> runs, const std::filesystem::path& file);

}  // namespace tessera::analysis
